"""The truth of a twin as a table: what was really there at each exchange of a simulated run, a row each."""

from __future__ import annotations

import csv
from pathlib import Path

from benchlab.io.files import cannot_write, written_whole
from benchlab.twin.truth import COLUMNS, Truth


def write_truth_csv(path: Path, truth: Truth) -> None:
    """Write the columns of a Truth, whole or not at all: nothing in it was measured. InputError where the disk refuses."""
    with written_whole(path) as temporary:
        try:
            with temporary.open("w", encoding="utf-8", newline="") as file:
                writer = csv.writer(file, lineterminator="\n")
                writer.writerow(COLUMNS)
                for row in zip(*(getattr(truth, name) for name in COLUMNS), strict=True):
                    writer.writerow([f"{value:.7g}" for value in row])
        except OSError as error:
            raise cannot_write(error, path) from error
