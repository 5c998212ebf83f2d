"""One round of `benchlab explain --loop`: an experiment on all samples of all designs; what was measured is kept, whatever happens."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from pathlib import Path

from benchlab.discrepancy.base import Base
from benchlab.discrepancy.experiment import Experiment
from benchlab.discrepancy.measured import Measured, Run
from benchlab.discrepancy.trial import name_at
from benchlab.errors import InputError
from benchlab.io.files import make_folder
from benchlab.io.measured_table import read_measured
from benchlab.io.runs_table import write_runs_csv
from benchlab.workflows.explain_lab import Lab, Wanted

TABLE = "measured.csv"
"""All runs of a round, as `benchlab explain` reads them. A run alone is NAME.run.csv, by which a round is taken up again."""


@dataclass(frozen=True)
class Round:
    """number: from 1. folder: of its files. protocol: that is run. experiment: mountings, rests and lengths of it."""

    number: int
    folder: Path
    protocol: Path
    experiment: Experiment

    @property
    def table(self) -> Path:
        return self.folder / TABLE


def measure_round(
    one: Round,
    lab: Lab,
    base: Base,
    designs: Sequence[str],
    samples: int,
    tell: Callable[[str], None],
    runs_before: int = 0,
) -> None:
    """Make all runs of a round that are not there yet, and its table. runs_before: on each sample, in earlier rounds.

    Whatever ends it early, the table holds what was measured until then. Raises what the lab raises.
    """
    make_folder(one.folder)
    every = list(wanted_runs(one, base, designs, samples, runs_before))
    made: list[Run] = []
    try:
        for place, wanted in enumerate(every, 1):
            part = one.folder / f"{wanted.stem}.run.csv"
            if part.exists():
                made += _read(part)
                continue
            tell(f"round {one.number}, run {place} of {len(every)}: {wanted.stem}")
            run = lab.measure(_unused(wanted))
            write_runs_csv(part, [run], lab.origin)
            made.append(run)
    finally:
        if made:
            write_runs_csv(one.table, made, lab.origin)


def wanted_runs(one: Round, base: Base, designs: Sequence[str], samples: int, runs_before: int = 0) -> Iterator[Wanted]:
    """All runs of a round: sample after sample, so that each is mounted once."""
    experiment = one.experiment
    for design in designs:
        called = name_at(base, design, experiment.length_ratio)
        for sample in range(1, samples + 1):
            for place, mounting in enumerate(experiment.mountings_deg, 1):
                yield Wanted(
                    design=design,
                    called=called,
                    sample=f"s{sample}",
                    run=f"r{one.number}" if len(experiment.mountings_deg) == 1 else f"r{one.number}-{place}",
                    protocol=one.protocol,
                    folder=one.folder,
                    mounting_deg=mounting,
                    length_ratio=experiment.length_ratio,
                    rest_s=experiment.rest_s if place > 1 else 0.0,
                    index=runs_before * (experiment.length_ratio == 1) + place,
                )


def _read(part: Path) -> tuple[Run, ...]:
    """The run that was made before."""
    found = read_measured([part])
    if not isinstance(found, Measured):
        raise InputError("holds means, not a run", file=part, hint="take it away to make the run again")
    return found.runs


def _unused(wanted: Wanted) -> Wanted:
    """The same, whose run is made again: what an interrupted one left lies beside it under its own name."""
    run, again = wanted, 1
    while list(run.folder.glob(f"{run.stem}.journal")):
        again += 1
        run = replace(wanted, run=f"{wanted.run}-again{again}")
    return run
