"""From a design to what a laser cuts: the windowed fabric, the TPU film and the strip, unrolled and laid side by side.

design + settings -> parts (`parts.py`) -> sheet (`layout.py`) -> DXF or SVG (`benchlab.io.cut_file`).
Axes on the drawing: x along the actuator, y around it; mm, y upwards.
"""
