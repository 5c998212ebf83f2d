"""What may be hidden in a study, one effect a file; `catalogue` knows them by name."""
