"""Curvature control: flex sensor, plant, tuning, PI with anti-windup, feed-forward, tracking."""
