"""Pressure protocols as numbers: segments, and the plan that they unroll to."""
