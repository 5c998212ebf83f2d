"""The segments of closed loop: the bending angle, in degrees, that a controller follows. The pressure is the controller's."""

from __future__ import annotations

from dataclasses import dataclass, field

from benchlab.protocol.shapes import ANGLE, level, ramp, sine
from benchlab.protocol.stretch import CannotBeginError, State, Stretch


@dataclass(frozen=True)
class AngleHold:
    """One angle for some time; the reference jumps there.

    >>> AngleHold(60.0, 5.0).begun(State()).label
    'hold 60° for 5 s'
    """

    angle_deg: float
    duration_s: float
    line: int = 0
    rounds: int = field(default=1, init=False)

    def begun(self, state: State) -> Stretch:
        return level(ANGLE, self.angle_deg, self.duration_s)


@dataclass(frozen=True)
class AngleRamp:
    """In a straight line from the present reference; either how long it takes or how fast it is.

    >>> AngleRamp(90.0, rate_deg_per_s=30.0).begun(State()).duration_s
    3.0
    """

    to_deg: float
    duration_s: float | None = None
    rate_deg_per_s: float | None = None
    line: int = 0
    rounds: int = field(default=1, init=False)

    def begun(self, state: State) -> Stretch:
        """CannotBeginError where the present angle is not known, or is there already."""
        return ramp(ANGLE, _known_angle(state), self.to_deg, self.duration_s, self.rate_deg_per_s)


@dataclass(frozen=True)
class AngleSine:
    """mean + amplitude · sin(2πft + φ), whole cycles; φ from −90° to 90° so that it goes on from the present reference, rising.

    >>> AngleSine(60.0, 30.0, 0.2, 5).begun(State(None, 60.0)).high
    90.0
    """

    mean_deg: float
    amplitude_deg: float
    frequency_Hz: float
    rounds: int
    line: int = 0

    def begun(self, state: State) -> Stretch:
        """CannotBeginError where the present reference is not known or outside of the sine."""
        return sine(ANGLE, _known_angle(state), self.mean_deg, self.amplitude_deg, self.frequency_Hz)


def _known_angle(state: State) -> float:
    if state.reference_deg is None:
        raise CannotBeginError(
            "the angle that it starts from is not known under pressure in open loop", "write a curvature hold before it"
        )
    return state.reference_deg
