"""One effect, one file: equation, constants, typical values, and where they are from."""
