"""An experiment as data: what the pressure does, how often on each sample, how the samples are mounted; and what a bench can do."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TypeAlias

import numpy as np

from benchlab.units import FloatArray

RAMP_POINTS, HOLD_POINTS = 10, 7
"""Points of a ramp and of a hold at which rivals are compared; models are exact between them."""

FIRST_HOLD_S = 0.1
"""The second point of a hold; further ones are spaced evenly in the logarithm of time, as relaxation goes."""


@dataclass(frozen=True)
class Ramp:
    """Straight from the present pressure."""

    to_MPa: float
    rate_MPa_s: float

    def points(self, start_MPa: float) -> tuple[FloatArray, FloatArray]:
        """Times from its beginning, and pressures, without the first point."""
        share = np.arange(1, RAMP_POINTS + 1) / RAMP_POINTS
        change = self.to_MPa - start_MPa
        return share * abs(change) / self.rate_MPa_s, start_MPa + share * change


@dataclass(frozen=True)
class Hold:
    """At the present pressure."""

    duration_s: float

    def points(self, start_MPa: float) -> tuple[FloatArray, FloatArray]:
        first = min(FIRST_HOLD_S, self.duration_s / 2)
        return np.geomspace(first, self.duration_s, HOLD_POINTS), np.full(HOLD_POINTS, start_MPa)


@dataclass(frozen=True)
class Triangle:
    """From low, where the pressure is already, to high and back, so many cycles."""

    low_MPa: float
    high_MPa: float
    rate_MPa_s: float
    cycles: int = 1

    def points(self, start_MPa: float) -> tuple[FloatArray, FloatArray]:
        up, down = Ramp(self.high_MPa, self.rate_MPa_s), Ramp(self.low_MPa, self.rate_MPa_s)
        (up_s, up_MPa), (down_s, down_MPa) = up.points(self.low_MPa), down.points(self.high_MPa)
        time_s = np.concatenate([up_s, up_s[-1] + down_s])
        starts_s = np.repeat(np.arange(self.cycles) * time_s[-1], len(time_s))
        return starts_s + np.tile(time_s, self.cycles), np.tile(np.concatenate([up_MPa, down_MPa]), self.cycles)


Leg: TypeAlias = Ramp | Hold | Triangle


@dataclass(frozen=True)
class Experiment:
    """One protocol, and how it is used. name: for files. what: in words. legs: from 0 MPa.

    mountings_deg: of the runs on each sample, one after the other; NaN as it was. rest_s: vented, before each run but the first.
    length_ratio: of the samples to those that were measured; other than 1 they are new ones.
    """

    name: str
    what: str
    legs: tuple[Leg, ...]
    mountings_deg: tuple[float, ...] = (math.nan,)
    rest_s: float = 0.0
    length_ratio: float = 1.0

    def trace(self) -> tuple[FloatArray, FloatArray]:
        """(T,) times and pressures of a run, from 0 s and 0 MPa."""
        times, pressures = [np.zeros(1)], [np.zeros(1)]
        for leg in self.legs:
            time_s, pressure_MPa = leg.points(float(pressures[-1][-1]))
            times.append(times[-1][-1] + time_s)
            pressures.append(pressure_MPa)
        return np.concatenate(times), np.concatenate(pressures)

    @property
    def run_s(self) -> float:
        """How long one run is."""
        return float(self.trace()[0][-1])

    @property
    def sample_s(self) -> float:
        """How long one sample is on the bench."""
        return len(self.mountings_deg) * (self.run_s + self.rest_s) - self.rest_s

    @property
    def turned(self) -> bool:
        """Whether samples are mounted in more than one way."""
        return len({angle for angle in self.mountings_deg if math.isfinite(angle)}) > 1

    @property
    def setup(self) -> str:
        """What to do beside the protocol, empty where nothing."""
        words = []
        if self.length_ratio != 1:
            words.append(
                f"make samples of each design, {self.length_ratio:g} times as long, and run the protocol on them"
            )
        if self.turned:
            angles = " then at ".join(f"{angle:g}°" for angle in self.mountings_deg)
            words.append(f"run it on each sample mounted at {angles} (0 hangs down, 90 level and bending upwards)")
        elif len(self.mountings_deg) > 1:
            words.append(f"run it {len(self.mountings_deg)} times on each sample")
        if self.rest_s:
            words.append(f"vent each sample for {self.rest_s:g} s between its runs")
        return "; ".join(words)


@dataclass(frozen=True)
class BenchLimits:
    """What may be asked for; the defaults are chosen but for the pressure, which is the paper's.

    rate_MPa_s: fastest ramp. sample_s: longest time that a sample may be on the bench, rests included. mounting_deg: as samples are
    mounted now. can_turn: whether they can be mounted in another way. other_length: whether samples of another length can be made.
    remembers: whether a sample keeps what earlier runs did to it, as a twin does not.
    """

    pressure_MPa: float = 0.35
    rate_MPa_s: float = 0.7
    sample_s: float = 900.0
    mounting_deg: float = 0.0
    can_turn: bool = True
    other_length: bool = True
    remembers: bool = True
