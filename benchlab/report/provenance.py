"""Where a report comes from: command, time, versions, and the sums of all that was read."""

from __future__ import annotations

import shlex
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from benchlab.report.document import Cell, Column, Items, Section, Table, cut
from benchlab.report.rounding import words

PROVENANCE = "Provenance"


def provenance_section(
    rows: Sequence[tuple[str, str]], made: Mapping[str, Any], inputs: Mapping[str, str], numbers: str
) -> Section:
    """rows: what comes first. made: as workflows.provenance.made_by gives it. inputs: SHA-256 by file. numbers: file that has these."""
    versions = ", ".join(f"{name} {version}" for name, version in made["versions"].items())
    command = shlex.join([Path(made["argv"][0]).name, *made["argv"][1:]])
    told = [*rows, ("Command", command), ("Made", made["created"]), ("Versions", versions)]
    if made.get("git"):
        told.append(("Source", f"commit {made['git']}"))
    files = tuple((words(name, 80), Cell(digest, f"{digest[:16]}…")) for name, digest in inputs.items())
    columns = (Column("file", "file", False), Column("sha256", "SHA-256", False))
    note = f"The whole sums stand in the CSV file and in {numbers}."
    table = Table("inputs", "What was read.", columns, files, note)
    return Section(PROVENANCE, (Items(tuple((what, cut(text, 400)) for what, text in told)), table))
