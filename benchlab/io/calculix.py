"""CalculiX from outside: runs a deck, reads the displacements that it printed."""

from __future__ import annotations

import os
import re
import shutil
import subprocess
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from benchlab.errors import InputError, UsageError
from benchlab.io.files import check_regular_file

Displacements = dict[float, dict[str, tuple[NDArray[np.int64], NDArray[np.float64]]]]
BLOCK = re.compile(r"displacements \(vx,vy,vz\) for set (\S+) and time\s+(\S+)")


def find_calculix() -> Path | None:
    """The `ccx` program on the path, or None."""
    found = shutil.which("ccx")
    return None if found is None else Path(found)


def run_calculix(deck: Path, timeout_s: float | None = None) -> Path:
    """Run CalculiX on one thread beside the deck; returns the .dat file.

    Raises UsageError where CalculiX is absent, InputError where it stops before the end, with its first words on it.
    """
    program = find_calculix()
    if program is None:
        raise UsageError("CalculiX (ccx) is not on the path", hint="install the Debian package calculix-ccx")
    one_thread = {**os.environ, "OMP_NUM_THREADS": "1"}
    try:
        done = subprocess.run(
            [program, deck.stem], cwd=deck.parent, env=one_thread, capture_output=True, text=True, timeout=timeout_s,
            check=False,
        )  # fmt: skip
    except subprocess.TimeoutExpired:
        raise InputError(f"CalculiX was not done after {timeout_s:g} s", file=deck) from None
    complaints = re.findall(r"\*ERROR[^\n]*(?:\n(?! *\n)[^\n]*)?", done.stdout)
    if done.returncode or "Job finished" not in done.stdout:
        said = " ".join(complaints[0].split()) if complaints else f"exit code {done.returncode}"
        raise InputError(f"CalculiX stopped: {said}", file=deck, hint="see what it prints when run by hand")
    return deck.with_suffix(".dat")


def read_displacements(path: Path) -> Displacements:
    """Time -> node set -> (node numbers (n,), displacements (n, 3)) of a .dat file's *NODE PRINT, U.

    Raises InputError for a file without displacements or with one that is no number.
    """
    check_regular_file(path)
    found: Displacements = {}
    lines = iter(path.read_text(encoding="utf-8", errors="replace").splitlines())
    for line in lines:
        if not (head := BLOCK.search(line)):
            continue
        next(lines, None)
        rows = []
        for row in lines:
            if not row.strip():
                break
            rows.append(row.split())
        try:
            table = np.array(rows, dtype=float).reshape(-1, 4)
        except ValueError:
            table = np.full((1, 4), np.nan)
        if not np.isfinite(table).all():
            raise InputError("a row of displacements is not four numbers", file=path, where=f"set {head[1]}")
        found.setdefault(float(head[2]), {})[head[1]] = table[:, 0].astype(np.int64), table[:, 1:]
    if not found:
        raise InputError("holds no displacements", file=path, hint="print them with *NODE PRINT, U")
    return found
