"""Rotation of a cross-section from the displacements of its nodes."""

from __future__ import annotations

import numpy as np

from benchlab.deck.grid import FloatArray


def plane_rotation_rad(x_mm: FloatArray, displacements_mm: FloatArray) -> float:
    """Rotation of a plane z = const about y that fits best (least squares; Kabsch in two dimensions).

    x_mm (n,): undeformed x of its nodes. displacements_mm (n, 3). Positive from z towards −x: towards the strip.

    >>> x = np.array([-1.0, 0.0, 1.0])
    >>> turned = np.column_stack([x * np.cos(0.1) - x, 0 * x, x * np.sin(0.1)])
    >>> round(plane_rotation_rad(x, turned), 6)
    0.1
    """
    before = x_mm - x_mm.mean()
    x, z = (x_mm + displacements_mm[:, 0]), displacements_mm[:, 2]
    return float(np.arctan2(before @ (z - z.mean()), before @ (x - x.mean())))
