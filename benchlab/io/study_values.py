"""What a study came to: the angle of every cycle of every sample at the study's pressure, and what is missing and why.

Designs hold samples, samples hold recordings, recordings hold cycles. `benchlab.workflows.study_values.collect` makes one;
`benchlab.io.values_table` writes the values as a table.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from benchlab.actuator import ShellDesign
from benchlab.force.curve import BlockedForce
from benchlab.units import FloatArray

ALL_DESIGNS = "all"
"""Name of the set that every study has."""


@dataclass(frozen=True)
class Missing:
    """One thing that has no value, or whose values do not count, and why. Empty names where it is about more than one."""

    why: str
    design: str = ""
    sample: str = ""
    recording: str = ""
    cycle: int | None = None

    @property
    def what(self) -> str:
        """In words.

        >>> Missing("too slow", "tw3_slw5", "s1", "videos/a.mp4", 2).what
        'tw3_slw5 s1, videos/a.mp4, cycle 2'
        """
        parts = [f"{self.design} {self.sample}".strip(), self.recording, f"cycle {self.cycle}" if self.cycle else ""]
        return ", ".join(part for part in parts if part)


@dataclass(frozen=True)
class CycleValue:
    """The angle of one loading cycle at the study's pressure, rounded to 1e-6 deg.

    cycle: from 1 in its recording. angle_deg: NaN where there is none; `flag` then says why, and else what is doubtful.
    angle_sd_deg: NaN where it is not known. method: `held`, `interpolated` or `table`; "" where there is no value.
    peak_MPa: the largest pressure of the cycle, NaN where it is not known.
    """

    cycle: int
    angle_deg: float
    angle_sd_deg: float = math.nan
    method: str = ""
    flag: str = ""
    peak_MPa: float = math.nan

    @property
    def known(self) -> bool:
        return math.isfinite(self.angle_deg)


@dataclass(frozen=True)
class RecordingValues:
    """One recording of a sample. file: as it stands in the study file. status: `measured`, `current` (analysed before) or `read`.

    curve_deg: (P,) angle of the rising branch at `StudyValues.curve_MPa`, mean over the cycles, NaN where none reaches.
    left_out: why its values do not count, "" where they do. warnings: of its analysis. origin: `twin` or `emulated` where nothing was
    measured, else "".
    """

    file: str
    status: str
    cycles: tuple[CycleValue, ...]
    curve_deg: FloatArray
    left_out: str = ""
    warnings: tuple[str, ...] = ()
    origin: str = ""


@dataclass(frozen=True)
class SampleValues:
    """One made actuator. left_out: why it does not count, "" where it does."""

    name: str
    recordings: tuple[RecordingValues, ...]
    left_out: str = ""

    @property
    def cycles(self) -> tuple[CycleValue, ...]:
        """The cycles that count and have a value, of all recordings."""
        if self.left_out:
            return ()
        return tuple(cycle for r in self.recordings if not r.left_out for cycle in r.cycles if cycle.known)

    @property
    def origins(self) -> frozenset[str]:
        """Of the recordings that it has its value from."""
        if self.left_out:
            return frozenset()
        return frozenset(r.origin for r in self.recordings if not r.left_out and any(c.known for c in r.cycles))

    @property
    def angle_deg(self) -> float:
        """Mean over its cycles; NaN where there is none."""
        return float(np.mean([cycle.angle_deg for cycle in self.cycles])) if self.cycles else math.nan

    def curve_deg(self, points: int) -> FloatArray:
        """(P,) mean curve of its recordings that count; NaN where none has a value. points: P."""
        if self.left_out:
            return np.full(points, np.nan)
        return nan_mean(np.array([r.curve_deg for r in self.recordings if not r.left_out]).reshape(-1, points))


@dataclass(frozen=True)
class Simulated:
    """What a design should do at the study's pressure, and who says so.

    angle_deg: NaN where the curve does not reach the pressure. pressure_MPa, curve_deg: (S,), empty where only the angle is known.
    """

    angle_deg: float
    source: str
    pressure_MPa: FloatArray
    curve_deg: FloatArray


@dataclass(frozen=True)
class DesignValues:
    """One design with its samples. shell and simulated: None where the study does not tell. force: its blocked
    force, None where there is none."""

    name: str
    shell: ShellDesign | None
    simulated: Simulated | None
    samples: tuple[SampleValues, ...]
    force: BlockedForce | None = None

    @property
    def counted(self) -> tuple[SampleValues, ...]:
        """The samples with a value."""
        return tuple(sample for sample in self.samples if sample.cycles)

    @property
    def angles_deg(self) -> FloatArray:
        """(n,) the angle of each sample that counts: the mean of its cycles."""
        return np.array([sample.angle_deg for sample in self.counted])

    def curves_deg(self, points: int) -> FloatArray:
        """(n, P) θ(p) of each sample that counts, NaN where it has no value. points: P."""
        return np.array([sample.curve_deg(points) for sample in self.counted]).reshape(-1, points)

    def band_deg(self, points: int) -> tuple[FloatArray, FloatArray]:
        """(P,) mean and standard deviation over the samples; NaN where a sample that counts has no value, SD also for one."""
        curves = self.curves_deg(points)
        if not len(curves):
            return np.full(points, np.nan), np.full(points, np.nan)
        spread = curves.std(axis=0, ddof=1) if len(curves) > 1 else np.full(points, np.nan)
        return curves.mean(axis=0), spread


@dataclass(frozen=True)
class StudySet:
    """Designs that are compared with each other. x: the dimension that varies, as `slw_mm`; "" where none is named."""

    name: str
    title: str
    designs: tuple[str, ...]
    x: str = ""


@dataclass(frozen=True)
class StudyValues:
    """All values of a study.

    pressure_MPa: at which the designs are compared; hold_tolerance_MPa: how near the pressure has to be.
    curve_MPa: (P,) pressures of all curves. sets: those of the study and, last, all designs.
    failures: what has no value although it was wanted. left_out: what was left out by the study file or by its own record.
    warnings: of recordings that count. inputs: file as in the study -> SHA-256.
    """

    title: str
    notes: str
    pressure_MPa: float
    hold_tolerance_MPa: float
    curve_MPa: FloatArray
    designs: tuple[DesignValues, ...]
    sets: tuple[StudySet, ...]
    failures: tuple[Missing, ...]
    left_out: tuple[Missing, ...]
    warnings: tuple[Missing, ...]
    inputs: dict[str, str]

    def of(self, chosen: StudySet) -> tuple[DesignValues, ...]:
        """The designs of a set, in its order."""
        known = {design.name: design for design in self.designs}
        return tuple(known[name] for name in chosen.designs)

    def rows(self) -> Iterator[tuple[DesignValues, SampleValues, RecordingValues, CycleValue]]:
        """Every cycle, with and without a value, with what it is of."""
        for design in self.designs:
            for sample in design.samples:
                for recording in sample.recordings:
                    for cycle in recording.cycles:
                        yield design, sample, recording, cycle


def nan_mean(curves: FloatArray) -> FloatArray:
    """(P,) mean of (n, P) over the rows with a value; NaN where none has one.

    >>> nan_mean(np.array([[1.0, np.nan, np.nan], [3.0, 4.0, np.nan]])).tolist()
    [2.0, 4.0, nan]
    """
    known = np.isfinite(curves)
    count = known.sum(axis=0)
    total = np.where(known, curves, 0.0).sum(axis=0)
    return np.where(count > 0, total / np.maximum(count, 1), np.nan)
