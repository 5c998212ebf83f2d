"""One effect, one file: its physics and source, its equation, its parameters, what it looks like and which test shows it."""
