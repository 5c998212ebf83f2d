"""Feed-forward from a response curve: the pressure at which the actuator should bend as wanted, and PI on what is left."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import ArrayLike

from benchlab.control.pi import PI
from benchlab.cubic import Cubic
from benchlab.errors import InputError


class InverseCurve:
    """The pressure of an angle, p(θ), as the monotone cubic (PCHIP: Fritsch and Carlson, SIAM J. Numer. Anal. 17, 238, 1980) through
    the points of a response curve θ(p).

    pressure_MPa, angle_deg: (P,) growing both. Where the curve begins above 0 MPa, the point of no pressure and no angle, at which
    every simulation begins, is put before it. Points beyond the first at or above ceiling_MPa are not used. clamped: calls so far for an
    angle that the curve does not reach; they give the pressure at its end.

    Raises InputError, naming where, for a curve that does not grow, is not a number, or has fewer than two points.

    >>> inverse = InverseCurve([0.1, 0.2, 0.3], [40.0, 80.0, 110.0], ceiling_MPa=0.35)
    >>> round(inverse(40.0), 6), round(inverse(200.0), 6), inverse.clamped
    (0.1, 0.3, 1)
    """

    def __init__(self, pressure_MPa: ArrayLike, angle_deg: ArrayLike, ceiling_MPa: float = math.inf) -> None:
        p, angle = np.asarray(pressure_MPa, dtype=float), np.asarray(angle_deg, dtype=float)
        if p.ndim != 1 or p.shape != angle.shape:
            raise InputError(f"a curve of {p.size} pressures and {angle.size} angles", hint="give one angle a pressure")
        if not (np.isfinite(p).all() and np.isfinite(angle).all()):
            raise InputError("the response curve has points that are not numbers", hint="leave them out")
        if len(p) and p[0] > 0:
            p, angle = np.concatenate([[0.0], p]), np.concatenate([[0.0], angle])
        last = int(np.searchsorted(p, ceiling_MPa - 1e-9)) + 1
        p, angle = p[:last], angle[:last]
        if len(p) < 2:
            raise InputError("a response curve needs two points", hint="simulate more pressures")
        _check_growing(p, angle)
        self.clamped = 0
        self._first_deg, self._last_deg = float(angle[0]), float(angle[-1])
        self._line = Cubic(angle, p)

    def __call__(self, angle_deg: float) -> float:
        """Pressure (MPa) at an angle (degrees); a few microseconds."""
        if not self._first_deg <= angle_deg <= self._last_deg:
            self.clamped += 1
            angle_deg = self._last_deg if angle_deg > self._last_deg else self._first_deg
        return self._line.value(angle_deg)


class FeedForward:
    """u = p(reference lead_s from now) + PI on reference − measured, within the same limits and without windup.

    The preview makes up for the lag of regulator, line and actuator, which the plant's identification finds; the PI corrects
    what the curve does not know: loops, softening, another sample. Its integral starts without a bump, see PI.

    >>> drive = FeedForward(PI(0.0, 0.0, ceiling_MPa=0.35), InverseCurve([0.1, 0.2], [40.0, 80.0]), lead_s=0.1)
    >>> drive.start(0.1)
    >>> [round(drive.pressure_MPa(40.0, ahead, 40.0, 0.01), 4) for ahead in (40.0, 80.0)]
    [0.1, 0.2]
    """

    def __init__(self, pi: PI, inverse: InverseCurve, lead_s: float = 0.0) -> None:
        if not 0 <= lead_s < 10:
            raise InputError(f"a lead of {lead_s:g} s", hint="give 0 s or more, about the lag of the plant")
        self.pi, self.inverse, self.lead_s = pi, inverse, lead_s

    @property
    def limited(self) -> int:
        """Calls so far whose pressure was cut at a limit."""
        return self.pi.limited

    def start(self, pressure_MPa: float) -> None:
        """Begin at this pressure, without a bump."""
        self.inverse.clamped = 0
        self.pi.start(pressure_MPa)

    def pressure_MPa(self, reference_deg: float, ahead_deg: float, angle_deg: float, dt_s: float) -> float:
        """The pressure to ask for now. ahead_deg: the reference lead_s from now. Raises as PI does."""
        return self.pi.around(self.inverse(ahead_deg), reference_deg, angle_deg, dt_s)


def _check_growing(pressure_MPa: np.ndarray, angle_deg: np.ndarray) -> None:
    for name, values, unit in (("pressure", pressure_MPa, "MPa"), ("angle", angle_deg, "°")):
        stuck = np.flatnonzero(np.diff(values) <= 0)
        if len(stuck):
            i = int(stuck[0])
            raise InputError(
                f"the {name} of the response curve does not grow from {values[i]:.6g} to {values[i + 1]:.6g} {unit}",
                where=f"between {pressure_MPa[i]:g} and {pressure_MPa[i + 1]:g} MPa",
                hint="only a curve that grows has one pressure for each angle; use another, or PI without feed-forward",
            )
