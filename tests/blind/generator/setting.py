"""How a study is laid out: designs, samples, runs, order, what is written down beside the readings."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from tests.blind.generator.runs import Run, blocked_run, fast_run, hold_run, slow_run
from tests.blind.generator.solved import DESIGNS, LENGTH_MM
from tests.blind.generator.station import FloatArray, Sample, Station

MOST_ROWS = 60_000


@dataclass(frozen=True)
class Layout:
    """What is asked for; the rest is drawn.

    designs: of the five published, by number. lengths_mm: each design is made in each. runs: of slow, fast, hold, shut (hold with the valve
    closed), blocked. ordered: the order of the runs on a sample is known, and what happens to a sample stays with it; otherwise every run
    begins rested. orientations_deg: turned through from sample to sample; none: not written down (hanging). session: start_s is
    written down. temperature: temperature_C is, and the room gets warmer or not (warming). command: command_MPa is written down.
    """

    designs: tuple[int, ...] = (0, 1, 2, 3, 4)
    samples: int = 5
    lengths_mm: tuple[float, ...] = (LENGTH_MM,)
    runs: tuple[str, ...] = ("slow", "fast", "hold")
    ordered: bool = True
    orientations_deg: tuple[float, ...] = ()
    session: bool = False
    temperature: bool = False
    warming: bool = False
    command: bool = False


@dataclass(frozen=True)
class Room:
    """Temperature of the session: room_C + rise_C·(1 − exp(−t/warm_s))."""

    room_C: float
    rise_C: float
    warm_s: float

    def temperature_C(self, session_s: FloatArray) -> FloatArray:
        return np.asarray(self.room_C + self.rise_C * (1 - np.exp(-session_s / self.warm_s)))


@dataclass(frozen=True)
class Setting:
    """samples: S, in the order of the table. orientation_deg (S,). starts_s (R, S)."""

    layout: Layout
    samples: tuple[Sample, ...]
    runs: tuple[Run, ...]
    orientation_deg: FloatArray
    starts_s: FloatArray
    room: Room

    @classmethod
    def draw(cls, layout: Layout, rng: np.random.Generator) -> Setting:
        samples = made([(*DESIGNS[i], length) for length in layout.lengths_mm for i in layout.designs], layout.samples)
        runs = _runs(layout, len(samples), rng)
        turned = np.array(layout.orientations_deg or (0.0,))
        orientation = turned[np.array([int(one.sample[1:]) - 1 for one in samples]) % len(turned)]
        begun = _starts(runs, len(samples), rng)
        rise = rng.uniform(6, 12) * rng.choice([-0.7, 1.0]) if layout.warming else 0.0
        room = Room(23 + rng.uniform(-0.5, 0.5), rise, rng.uniform(0.15, 0.5) * float(begun.max()))
        return cls(layout, samples, runs, orientation, begun, room)

    def stations(self, substeps: int) -> list[tuple[Run, Station]]:
        return [
            (run, self.station(run, substeps, number, starts))
            for number, (run, starts) in enumerate(zip(self.runs, self.starts_s), 1)
        ]

    def station(self, run: Run, substeps: int, number: int, starts_s: FloatArray) -> Station:
        """With an empty memory; number: of the run, from 1."""
        time = run.times_s(substeps)
        return Station(
            time_s=time,
            samples=self.samples,
            start_s=starts_s,
            orientation_deg=self.orientation_deg,
            ordinal=number,
            shut=run.shut(time),
            temperature_C=self.room.temperature_C(time[:, None] + starts_s),
        )

    def thinned(self) -> Setting:
        """One sample of each design."""
        designs = [(one.tw_mm, one.slw_mm, one.length_mm) for one in self.samples]
        kept = np.array([designs.index(one) for one in dict.fromkeys(designs)])
        samples = tuple(self.samples[i] for i in kept)
        return replace(
            self, samples=samples, orientation_deg=self.orientation_deg[kept], starts_s=self.starts_s[:, kept]
        )

    def made_again(self, length_mm: float | None, count: int) -> tuple[Sample, ...]:
        """As many new samples of each design, of another length where one is given; S6 follows S5."""
        designs = list(dict.fromkeys((one.tw_mm, one.slw_mm, one.length_mm) for one in self.samples))
        if length_mm is not None:
            designs = list(dict.fromkeys((tw, slw, length_mm) for tw, slw, _ in designs))
        return made(designs, count, first=self.layout.samples + 1)


def made(designs: Sequence[tuple[float, float, float]], count: int, first: int = 1) -> tuple[Sample, ...]:
    """Samples S1, S2 … of each (tw, slw, length)."""
    return tuple(
        Sample(named(tw, slw, length), f"S{number}", tw, slw, length)
        for tw, slw, length in designs
        for number in range(first, first + count)
    )


def named(tw_mm: float, slw_mm: float, length_mm: float) -> str:
    name = f"tw{tw_mm:g}_slw{slw_mm:g}"
    return name if length_mm == LENGTH_MM else f"{name}_al{length_mm:g}"


def _runs(layout: Layout, samples: int, rng: np.random.Generator) -> tuple[Run, ...]:
    """In an order of the study's own; readings as often as the table has room for."""
    peak = rng.uniform(0.34, 0.35)
    fast_Hz = float(rng.integers(30, 51)) if samples <= 16 else float(rng.integers(25, 33))
    draw = {
        "slow": lambda: slow_run(rng, 20.0, peak),
        "fast": lambda: fast_run(rng, fast_Hz, peak),
        "hold": lambda: hold_run(rng, 20.0),
        "shut": lambda: hold_run(rng, 20.0, shut=True),
        "blocked": lambda: blocked_run(rng, 20.0),
    }
    names = [str(name) for name in rng.permutation(layout.runs)]
    runs = [draw[name]() for name in names]
    room = (MOST_ROWS / samples - sum(r.rows for r in runs if r.name == "fast")) / max(
        1, sum(r.rows for r in runs if r.name != "fast")
    )
    if room < 1:
        runs = [r if r.name == "fast" else replace(r, rate_Hz=np.floor(20 * room * 2) / 2) for r in runs]
    return tuple(runs)


def _starts(runs: Sequence[Run], samples: int, rng: np.random.Generator) -> FloatArray:
    """(R, S): sample by sample in a random order, with breaks."""
    found = np.empty((len(runs), samples))
    now = 0.0
    for sample in rng.permutation(samples):
        now += rng.uniform(60, 180)
        for number, run in enumerate(runs):
            found[number, sample] = round(now, 1)
            now += run.duration_s + rng.uniform(30, 90)
    return found
