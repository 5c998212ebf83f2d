"""Executes a plan on a bench: deadlines, guards, journal, and a vent at every end."""
