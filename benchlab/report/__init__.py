"""Figures and overlays: what people look at."""
