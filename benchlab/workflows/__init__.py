"""One file per verb: open, compute, save."""
