"""What was really there while a twin was driven, as a table: NAME.truth.csv. Simulated, and the first line says so."""

from __future__ import annotations

from pathlib import Path

from benchlab.io.files import written_whole
from benchlab.twin.truth import COLUMNS, Truth

FIRST_LINE = "# simulated, not measured: the inside of benchlab's digital twin at each exchange"


def write_truth_csv(path: Path, truth: Truth) -> None:
    """Write the columns of Truth, a row an exchange, whole or not at all. InputError where the disk refuses."""
    table = zip(*(getattr(truth, name).tolist() for name in COLUMNS))
    with written_whole(path) as temporary, temporary.open("w", encoding="utf-8", newline="\n") as file:
        file.write(f"{FIRST_LINE}\n{','.join(COLUMNS)}\n")
        file.writelines(",".join(f"{value:.9g}" for value in row) + "\n" for row in table)
