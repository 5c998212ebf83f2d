"""What the runner asks of a controller."""

from __future__ import annotations

import typing


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
