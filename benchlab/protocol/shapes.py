"""What pressure in open loop and angle in closed loop have in common: a level, a ramp, a sine, begun where the segment before ended."""

from __future__ import annotations

import math
from dataclasses import dataclass

from benchlab.protocol.stretch import DECIMALS, CannotBeginError, Stretch, slope
from benchlab.protocol.waves import constant, sine_from, straight


@dataclass(frozen=True)
class Quantity:
    """How values are written, and what the kernel does with them. kind: of all its steps, empty where each has its own.

    >>> PRESSURE.pair(0.1, "to", 0.3), ANGLE.pair(10, "to", 30)
    ('0.1 to 0.3 MPa', '10° to 30°')
    """

    name: str
    unit: str
    kind: str
    remedy: str

    def one(self, value: float) -> str:
        return f"{value:g}{self.unit}"

    def pair(self, first: float, between: str, second: float) -> str:
        """Two values; a unit that stands apart from its value stands once."""
        return f"{first:g}{'' if self.unit.startswith(' ') else self.unit} {between} {self.one(second)}"


PRESSURE = Quantity("pressure", " MPa", "", "write a ramp into that range before it")
ANGLE = Quantity("reference", "°", "curvature", "write a curvature hold or ramp into that range before it")


def level(of: Quantity, at: float, duration_s: float) -> Stretch:
    """One value for some time."""
    label = f"hold {of.one(at)} for {duration_s:g} s"
    return Stretch(of.kind or "hold", label, duration_s, at, at, at, at, 0.0, constant(at), of is ANGLE)


def ramp(of: Quantity, start: float, to: float, duration_s: float | None, rate: float | None) -> Stretch:
    """In a straight line; either how long it takes or how fast it is. CannotBeginError where one of a given rate is there already."""
    change = abs(to - start)
    if rate is not None and change == 0:
        raise CannotBeginError(
            f"a ramp to {of.one(to)} from {of.one(start)} takes no time", "write a hold, or remove it"
        )
    duration_s = duration_s if rate is None else change / rate
    assert duration_s is not None
    duration_s = round(duration_s, DECIMALS)
    return Stretch(
        kind=of.kind or "ramp",
        label=f"ramp {of.pair(start, 'to', to)} in {duration_s:g} s",
        duration_s=duration_s,
        start=start,
        end=to,
        low=min(start, to),
        high=max(start, to),
        slew=slope(change, duration_s),
        of=straight(start, to, duration_s),
        closed_loop=of is ANGLE,
    )


def sine(of: Quantity, start: float, mean: float, amplitude: float, frequency_Hz: float) -> Stretch:
    """A cycle that goes on from `start`, rising. CannotBeginError where that is outside of it."""
    low, high = round(mean - amplitude, DECIMALS), round(mean + amplitude, DECIMALS)
    if not low <= start <= high:
        where = f"the sine lies between {of.pair(low, 'and', high)}"
        raise CannotBeginError(f"{where} and the present {of.name} is {of.one(start)}", of.remedy)
    period_s = round(1 / frequency_Hz, DECIMALS)
    return Stretch(
        kind=of.kind or "sine",
        label=f"sine {of.pair(mean, '±', amplitude)}, {frequency_Hz:g} Hz",
        duration_s=period_s,
        start=start,
        end=start,
        low=low,
        high=high,
        slew=slope(2 * math.pi * amplitude, period_s),
        of=sine_from(start, mean, amplitude, period_s),
        closed_loop=of is ANGLE,
    )
