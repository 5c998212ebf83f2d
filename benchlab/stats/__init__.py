"""Do designs differ, and how well do they repeat: analysis of variance, comparisons of pairs, variance components."""
