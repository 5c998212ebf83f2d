"""The twin's regulator and sensors as they truly are: what a calibration of its bench should find."""

from __future__ import annotations

from benchlab.bench import NOMINAL_GAIN_MPA_PER_V, Line

SUPPLY_V = 5.0
"""Of the microcontroller, reference of its DAC and ADC."""

REGULATOR = Line(NOMINAL_GAIN_MPA_PER_V, 0.0)
"""Pressure (MPa) over volts at the regulator's input: the paper's, 0 to 5 V is 0 to 0.48 MPa."""

MONITOR = Line(0.12, -0.12)
"""Pressure (MPa) over volts at its monitor output: 1 to 5 V is 0 to 0.48 MPa, as the analogue output of SMC's regulators."""

FLEX = Line(1 / 0.015, -1.0 / 0.015)
"""Bending angle (degrees) over volts at the flex sensor's divider: 1 V straight and 15 mV a degree, chosen so that 200° fit into 4 V.
Linear in curvature, as the paper says of its sensor; along the strip, which hardly stretches, that is linear in the bending angle."""
