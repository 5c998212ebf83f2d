"""A run on a pressure bench, as the commands of `benchlab control` look at it."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from benchlab.bench import Bench
from benchlab.control.alongside import lay_alongside
from benchlab.errors import InputError
from benchlab.io.angle_series import read_angle_series
from benchlab.io.drive_file import origin, read_drive_file
from benchlab.io.journal import Journal
from benchlab.io.recorded_bench import recorded_bench
from benchlab.units import FloatArray

COVERED, ALIKE, LATE_S = 0.95, 0.9, 0.25
"""A truth spans so much of its run's time, is so correlated with the measured angle, and is not later or earlier by more."""


@dataclass(frozen=True)
class DrivenRun:
    """What was asked for and measured, tick by tick, with the bench and the plan that it was made with."""

    path: Path
    journal: Journal
    bench: Bench

    def column(self, name: str) -> FloatArray:
        """(T,) of a field of the journal's SAMPLE, at the ticks of the plan: without what was watched after the vent."""
        return np.asarray(self.journal.driven[name], dtype=float)

    @property
    def header(self) -> dict[str, Any]:
        return self.journal.header

    @property
    def title(self) -> str:
        return str(self.header.get("title", self.path.stem))

    @property
    def rate_Hz(self) -> float:
        return float(self.header["plan"]["rate_Hz"])

    @property
    def ceiling_MPa(self) -> float:
        """The most that could be asked for in this run: of the plan and of the bench."""
        return min(float(self.header["plan"]["limit_MPa"]), self.bench.ceiling_MPa)

    @property
    def simulated(self) -> bool:
        """Whether nothing in it was measured."""
        return bool(origin(self.header))

    @property
    def bench_words(self) -> str:
        """`twin, simulated (twin), seed 3` or `lab-1`: its name, and where the numbers are from."""
        seed = self.header.get("seed")
        words = [self.bench.name, origin(self.header), "" if seed is None else f"seed {seed}"]
        return ", ".join(word for word in words if word)


def read_driven(path: Path) -> DrivenRun:
    """Read a drive file. Raises UsageError and InputError as `read_drive_file`, and for a head without plan or bench."""
    journal = read_drive_file(path)
    plan = journal.header.get("plan")
    if not isinstance(plan, dict) or not all(
        isinstance(plan.get(name), float | int) for name in ("rate_Hz", "limit_MPa")
    ):
        raise InputError("does not say which plan was run", file=path, hint="was it written by `benchlab run`?")
    return DrivenRun(path, journal, recorded_bench(journal.header, path))


def truth_of(path: Path | None, run: DrivenRun) -> FloatArray | None:
    """(T,) true angle at the run's ticks, of a table on its clock; None without one.

    Raises InputError for a run of metal, and for a truth that is not of this run: another time, or another motion.
    """
    if path is None:
        return None
    if not run.simulated:
        hint = "leave --truth out"
        raise InputError("was made on a bench of which nobody knows the truth", file=run.path, hint=hint)
    seen = read_angle_series(path)
    found = lay_alongside(run.column("time_s"), run.column("angle_deg"), seen.time_s, seen.angle_deg)
    wrong = []
    if found.covered < COVERED:
        wrong.append(f"it covers {100 * found.covered:.0f} % of the run's time")
    if found.correlation < ALIKE:
        wrong.append(f"its correlation with the measured angle is {found.correlation:.2f}".replace("-", "−"))
    if abs(found.late_s) > LATE_S:
        wrong.append(
            f"it is {abs(found.late_s):.2g} s {'later' if found.late_s > 0 else 'earlier'} than the measured angle"
        )
    if wrong:
        hint = f"give {run.path.stem}.truth.csv, which was written with the run"
        raise InputError(f"is not the truth of {run.path.name}: {', and '.join(wrong)}", file=path, hint=hint)
    return found.other
