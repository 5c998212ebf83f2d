"""What the runner asks of a controller, and the controller for the gains of a protocol or a control file."""

from __future__ import annotations

import typing

from numpy.typing import ArrayLike

from benchlab.control.feed_forward import FeedForward, InverseCurve
from benchlab.control.pi import PI
from benchlab.errors import InputError


class Controller(typing.Protocol):
    """From reference and measured bending angle (degrees) to a pressure (MPa) between 0 and the limit it was made with."""

    lead_s: float
    """How far ahead of time it wants to know the reference."""

    def start(self, pressure_MPa: float) -> None:
        """Begin at this pressure, without a bump."""
        ...

    def pressure_MPa(self, reference_deg: float, ahead_deg: float, angle_deg: float, dt_s: float) -> float:
        """The pressure to ask for now. ahead_deg: the reference lead_s from now. angle_deg: measured."""
        ...


def controller_of(
    kp_MPa_per_deg: float,
    ki_MPa_per_deg_s: float,
    ceiling_MPa: float,
    feed_forward: bool = False,
    lead_s: float = 0.0,
    curve: tuple[ArrayLike, ArrayLike] | None = None,
) -> Controller:
    """A PI, or with feed_forward the inverse of `curve` (pressures in MPa, angles in degrees: (P,) each) with PI on the remainder.

    The fields of a protocol's Control, and the bench's ceiling. Raises InputError for impossible gains, for feed-forward without a
    curve, and for a curve that does not grow.

    >>> controller_of(0.001, 0.01, 0.35).lead_s
    0.0
    """
    pi = PI(kp_MPa_per_deg, ki_MPa_per_deg_s, ceiling_MPa)
    if not feed_forward:
        return pi
    if curve is None:
        raise InputError(
            "feed-forward needs a response curve", hint="give one with --design, or set feed_forward: false"
        )
    return FeedForward(pi, InverseCurve(*curve, ceiling_MPa=ceiling_MPa), lead_s)
