"""The segments of closed loop: the bending angle, in degrees, that a controller follows. The pressure is the controller's."""

from __future__ import annotations

import math
from dataclasses import dataclass, field

from benchlab.protocol.segments import sine_range
from benchlab.protocol.stretch import DECIMALS, CannotBeginError, State, Stretch, slope
from benchlab.protocol.waves import constant, sine_from, straight


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
        label = f"hold {self.angle_deg:g}° for {self.duration_s:g} s"
        at = self.angle_deg
        return Stretch("curvature", label, self.duration_s, at, at, at, at, 0.0, constant(at), closed_loop=True)


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
        start = _known_angle(state)
        change = abs(self.to_deg - start)
        if self.rate_deg_per_s is not None and change == 0:
            raise CannotBeginError(
                f"a ramp to {self.to_deg:g}° from {start:g}° takes no time", "write a hold, or remove it"
            )
        duration_s = self.duration_s if self.rate_deg_per_s is None else change / self.rate_deg_per_s
        assert duration_s is not None
        duration_s = round(duration_s, DECIMALS)
        return Stretch(
            kind="curvature",
            label=f"ramp {start:g}° to {self.to_deg:g}° in {duration_s:g} s",
            duration_s=duration_s,
            start=start,
            end=self.to_deg,
            low=min(start, self.to_deg),
            high=max(start, self.to_deg),
            slew=slope(change, duration_s),
            of=straight(start, self.to_deg, duration_s),
            closed_loop=True,
        )


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
        start = _known_angle(state)
        low, high = sine_range(self.mean_deg, self.amplitude_deg)
        if not low <= start <= high:
            raise CannotBeginError(
                f"the sine lies between {low:g}° and {high:g}° and the present reference is {start:g}°",
                "write a curvature hold or ramp into that range before it",
            )
        period_s = round(1 / self.frequency_Hz, DECIMALS)
        return Stretch(
            kind="curvature",
            label=f"sine {self.mean_deg:g}° ± {self.amplitude_deg:g}°, {self.frequency_Hz:g} Hz",
            duration_s=period_s,
            start=start,
            end=start,
            low=low,
            high=high,
            slew=slope(2 * math.pi * self.amplitude_deg, period_s),
            of=sine_from(start, self.mean_deg, self.amplitude_deg, period_s),
            closed_loop=True,
        )


def _known_angle(state: State) -> float:
    if state.reference_deg is None:
        raise CannotBeginError(
            "the angle that it starts from is not known under pressure in open loop", "write a curvature hold before it"
        )
    return state.reference_deg
