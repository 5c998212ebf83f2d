"""The vocabulary: every effect by its name, those of users too."""
