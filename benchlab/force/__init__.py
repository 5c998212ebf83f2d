"""Blocked force: peaks of each cycle in a force trace, zeroed, and the line of force against pressure."""
