"""The segments of open loop: what a protocol is written in. Pressures in MPa, times in s.

Each has `begun(state)`: one round of it as a Stretch, begun where the segment before it ended, and `rounds`: how often that comes, one
after the other. `line` is that of the protocol file, 0 where there is none. What has to be positive is; the file's schema sees to it.
"""

from __future__ import annotations

from dataclasses import dataclass, field, replace

from benchlab.protocol.shapes import PRESSURE, level, ramp, sine
from benchlab.protocol.stretch import DECIMALS, CannotBeginError, State, Stretch, slope
from benchlab.protocol.waves import there_and_back


@dataclass(frozen=True)
class Ramp:
    """In a straight line from the present pressure; either how long it takes or how fast it is.

    >>> Ramp(0.35, duration_s=2.5).begun(State()).slew
    0.14
    """

    to_MPa: float
    duration_s: float | None = None
    rate_MPa_per_s: float | None = None
    line: int = 0
    rounds: int = field(default=1, init=False)

    def begun(self, state: State) -> Stretch:
        """CannotBeginError where the pressure is not known, or where a ramp of a given rate is there already."""
        start = known_pressure(state, "a ramp starts from the present pressure")
        return ramp(PRESSURE, start, self.to_MPa, self.duration_s, self.rate_MPa_per_s)


@dataclass(frozen=True)
class Hold:
    """At the present pressure, or at once at another one.

    >>> Hold(1.0).begun(State(0.2)).label
    'hold 0.2 MPa for 1 s'
    """

    duration_s: float
    pressure_MPa: float | None = None
    line: int = 0
    rounds: int = field(default=1, init=False)

    def begun(self, state: State) -> Stretch:
        """CannotBeginError where it is at the present pressure and that is not known."""
        if (pressure := self.pressure_MPa) is None:
            pressure = known_pressure(state, "a hold without pressure_MPa keeps the present pressure")
        return level(PRESSURE, pressure, self.duration_s)


@dataclass(frozen=True)
class Vent:
    """0 MPa at once, for some time.

    >>> Vent(2.0).begun(State(0.35)).end
    0.0
    """

    duration_s: float
    line: int = 0
    rounds: int = field(default=1, init=False)

    def begun(self, state: State) -> Stretch:
        label = f"vent for {self.duration_s:g} s"
        return replace(level(PRESSURE, 0.0, self.duration_s), kind="vent", label=label)


@dataclass(frozen=True)
class Sine:
    """mean + amplitude · sin(2πft + φ), whole cycles; φ from −90° to 90° so that it goes on from the present pressure, rising: no jump.

    >>> Sine(0.1, 0.1, 0.5, 3).begun(State(0.0)).duration_s
    2.0
    """

    mean_MPa: float
    amplitude_MPa: float
    frequency_Hz: float
    rounds: int
    line: int = 0

    def begun(self, state: State) -> Stretch:
        """CannotBeginError where the present pressure is not known or outside of the sine."""
        start = known_pressure(state, "a sine goes on from the present pressure")
        return sine(PRESSURE, start, self.mean_MPa, self.amplitude_MPa, self.frequency_Hz)


@dataclass(frozen=True)
class Triangle:
    """From low to high and back, whole cycles; either the rate of loading and unloading, or the frequency.

    >>> Triangle(0.0, 0.35, 2, rate_MPa_per_s=0.14).begun(State()).duration_s
    5.0
    """

    low_MPa: float
    high_MPa: float
    rounds: int
    rate_MPa_per_s: float | None = None
    frequency_Hz: float | None = None
    line: int = 0

    def begun(self, state: State) -> Stretch:
        """CannotBeginError where the present pressure is not low_MPa."""
        start = known_pressure(state, "a triangle starts at low_MPa")
        if start != self.low_MPa:
            raise CannotBeginError(
                f"the triangle starts at {self.low_MPa:g} MPa and the present pressure is {start:g} MPa",
                f"write a ramp to {self.low_MPa:g} MPa before it" if self.low_MPa else "write a vent before it",
            )
        change = self.high_MPa - self.low_MPa
        period_s = 2 * change / self.rate_MPa_per_s if self.rate_MPa_per_s else 1 / (self.frequency_Hz or 1)
        period_s = round(period_s, DECIMALS)
        slew = slope(2 * change, period_s)
        return Stretch(
            kind="triangle",
            label=f"triangle {self.low_MPa:g} to {self.high_MPa:g} MPa and back, {slew:.4g} MPa/s",
            duration_s=period_s,
            start=start,
            end=start,
            low=self.low_MPa,
            high=self.high_MPa,
            slew=slew,
            of=there_and_back(self.low_MPa, self.high_MPa, period_s),
        )


def known_pressure(state: State, why: str) -> float:
    """The present pressure; CannotBeginError after a closed loop, whose controller decided it."""
    if state.pressure_MPa is None:
        raise CannotBeginError(
            f"{why}, and after a curvature segment nobody knows it",
            "write a vent, or a hold with pressure_MPa, before it",
        )
    return state.pressure_MPa
