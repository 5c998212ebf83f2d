"""Who measures, when `benchlab explain --loop` wants a run: a lab whose bench is a twin, or one in which somebody mounts samples."""

from __future__ import annotations

import math
from dataclasses import dataclass
from pathlib import Path
from typing import Protocol

import numpy as np

from benchlab.discrepancy.measured import Run
from benchlab.errors import BenchError
from benchlab.io.drive_file import cycles_of, write_drive_file
from benchlab.io.files import sha256
from benchlab.io.journal import Journal, read_journal
from benchlab.runner.stop import Stop
from benchlab.units import FloatArray
from benchlab.workflows.run import Driven, drive
from benchlab.workflows.run_prepare import Prepared

INTERRUPTED = 130


@dataclass(frozen=True)
class Wanted:
    """One run that is to be made. design: of the base, whose samples are length_ratio times as long. called: design as files name it.

    mounting_deg: NaN as it is. rest_s: vented before it. index: of the run on its sample, from 1 over all rounds. folder: for its files.
    """

    design: str
    called: str
    sample: str
    run: str
    protocol: Path
    folder: Path
    mounting_deg: float = math.nan
    length_ratio: float = 1.0
    rest_s: float = 0.0
    index: int = 1

    @property
    def stem(self) -> str:
        """Of its files."""
        return f"{self.called}_{self.sample}_{self.run}"


class Lab(Protocol):
    """origin: where its numbers are from, as tables say it. about: the same in words, with what was chosen. remembers: whether its samples
    keep what earlier runs did to them."""

    @property
    def origin(self) -> str: ...

    @property
    def about(self) -> str: ...

    @property
    def remembers(self) -> bool: ...

    def measure(self, wanted: Wanted) -> Run:
        """Make the run; its drive file lies in the folder. Raises BenchError where it did not go to its end, KeyboardInterrupt where
        somebody ended it."""
        ...


def driven_whole(prepared: Prepared) -> tuple[Driven, Journal]:
    """Drive, and write the drive file beside the journal. Raises BenchError for a run that did not go to its end, and KeyboardInterrupt
    for one that somebody ended; what it measured stays in its files."""
    driven = drive(prepared, Stop(pausable=not prepared.fast))
    journal = read_journal(driven.journal)
    if len(journal.samples):
        source = {"file": driven.journal.name, "sha256": sha256(driven.journal)}
        write_drive_file(prepared.path(".h5"), journal, source)
    if driven.end.exit_code == INTERRUPTED:
        raise KeyboardInterrupt
    if not driven.end.completed:
        hint = f"see {driven.journal}; call the same command again when the bench is right: what was measured is kept"
        raise BenchError(f"{driven.end.reason}: {driven.end.cause.words}", where=prepared.stem.name, hint=hint)
    return driven, journal


def run_of(
    wanted: Wanted, journal: Journal, time_s: FloatArray, angle_deg: FloatArray, start_s: float | None, ordered: bool
) -> Run:
    """The run at the moments (N,) at which its angle was seen, on the clock of the journal. ordered: whether earlier runs matter."""
    samples = journal.driven
    clock = samples["time_s"]
    at = np.clip(np.searchsorted(clock, time_s, side="right") - 1, 0, len(clock) - 1)
    return Run(
        design=wanted.called,
        sample=wanted.sample,
        run=wanted.run,
        time_s=time_s,
        pressure_MPa=np.interp(time_s, clock, samples["pressure_MPa"]),
        values={"angle_deg": angle_deg},
        command_MPa=np.interp(time_s, clock, samples["command_MPa"]),
        cycle=cycles_of(journal)[: len(clock)][at].astype(float),
        run_index=float(wanted.index) if ordered else None,
        start_s=start_s,
        orientation_deg=None if math.isnan(wanted.mounting_deg) else wanted.mounting_deg,
    )
