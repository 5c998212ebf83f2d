"""The fabric-shelled pneumatic bending actuator, as designed (paper, section II-A, Eqs 1, 6 and 7), and its tip as an arc."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from benchlab.errors import UsageError

SYMBOLS = {
    "strip_width_mm": "slw",
    "window_width_mm": "tw",
    "rib_width_mm": "fw",
    "perimeter_mm": "slw + wl",
    "length_mm": "al",
}
"""The paper's symbol of each field of a design."""

DIMENSIONS = {
    "tw_mm": "window_width_mm",
    "slw_mm": "strip_width_mm",
    "fw_mm": "rib_width_mm",
    "perimeter_mm": "perimeter_mm",
    "length_mm": "length_mm",
}
"""Field of a design by its short name, as options, sweeps and studies have it."""


@dataclass(frozen=True)
class ShellDesign:
    """A tube of TPU film with a windowed fabric laminated on, closed by a strain-limiting strip. Lengths in mm.

    strip_width_mm: slw, around the circumference. window_width_mm: tw, along the axis. rib_width_mm: fw, along the
    axis, between windows. perimeter_mm: slw + wl (the paper calls 40 mm the diameter; Eq 1 makes it the perimeter).
    length_mm: al.

    >>> design = ShellDesign(strip_width_mm=10, window_width_mm=3)
    >>> round(design.diameter_mm, 2), design.window_length_mm, round(design.window_count, 1)
    (12.73, 30.0, 35.6)

    Raises UsageError for a design that cannot be made: a length that is not positive, a strip as wide as the perimeter,
    a window that is longer than the actuator.
    """

    strip_width_mm: float
    window_width_mm: float
    rib_width_mm: float = 2.0
    perimeter_mm: float = 40.0
    length_mm: float = 180.0

    def __post_init__(self) -> None:
        for field, value in vars(self).items():
            if not (math.isfinite(value) and value > 0):
                raise UsageError(f"{field} ({SYMBOLS[field]}) is {value:g}", hint="give a positive length in mm")
        if self.strip_width_mm >= self.perimeter_mm:
            raise UsageError(
                f"strip_width_mm (slw) is {self.strip_width_mm:g} and leaves no window in the perimeter_mm of "
                f"{self.perimeter_mm:g}",
                hint="make the strip narrower than the perimeter, which is slw + wl",
            )
        longest = self.length_mm - 2 * self.rib_width_mm
        if self.window_width_mm > longest * (1 + 1e-12):
            raise UsageError(
                f"window_width_mm (tw) is {self.window_width_mm:g}; between two ribs of {self.rib_width_mm:g} in a "
                f"length_mm (al) of {self.length_mm:g} there is room for {max(longest, 0):g}",
                hint="make the window or the ribs narrower, or the actuator longer",
            )

    @property
    def name(self) -> str:
        """`tw3_slw10`: how files of this design are called."""
        return f"tw{self.window_width_mm:g}_slw{self.strip_width_mm:g}"

    @property
    def window_length_mm(self) -> float:
        """wl = perimeter − slw."""
        return self.perimeter_mm - self.strip_width_mm

    @property
    def diameter_mm(self) -> float:
        """Diameter of the round tube (Eq 1)."""
        return self.perimeter_mm / math.pi

    @property
    def window_count(self) -> float:
        """n of Eq 7, a real number; `whole_windows` can be cut."""
        return (self.length_mm - self.rib_width_mm) / (self.window_width_mm + self.rib_width_mm)

    @property
    def whole_windows(self) -> int:
        return math.floor(self.window_count + 1e-9)

    @property
    def end_margin_mm(self) -> float:
        """Length left over at each end when only whole windows are cut, half of it at either end."""
        return (self.window_count - self.whole_windows) * (self.window_width_mm + self.rib_width_mm) / 2

    @property
    def tpu_area_mm2(self) -> float:
        """TPU area wl·tw·n (Eq 6, with the real n of Eq 7)."""
        return self.window_length_mm * self.window_width_mm * self.window_count


def tip_position_mm(angle_rad: NDArray[np.float64], length_mm: NDArray[np.float64] | float) -> NDArray[np.float64]:
    """Tip of an arc of constant curvature, base at the origin and along z: (..., 2) as (towards the strip, along z).

    Piecewise constant curvature with one piece (Webster and Jones 2010). length_mm: of the strip's line, λ·al.

    >>> tip_position_mm(np.array([0.0, np.pi]), 180.0).round(2)
    array([[  0.  , 180.  ],
           [114.59,   0.  ]])
    """
    angle = np.asarray(angle_rad, dtype=float)
    half = np.sinc(angle / (2 * np.pi))
    return np.stack([length_mm * half * np.sin(angle / 2), length_mm * half * np.cos(angle / 2)], axis=-1)
