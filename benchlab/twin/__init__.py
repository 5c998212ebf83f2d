"""The simulated bench as numbers: a response curve, and effects that the curve lacks. No clock, no port, no file."""
