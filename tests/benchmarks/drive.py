"""What driving reaches, as one Markdown table: `python tests/benchmarks/drive.py [PART...]`, with the parts below.

drive_loop, drive_wire, drive_journal, drive_control and drive_circle measure them; run alone, they tell more. Keep the machine
otherwise idle: the parts load it themselves where a bar says so.
"""

from __future__ import annotations

import argparse
import platform
from collections.abc import Callable, Iterable
from datetime import date

import drive_circle
import drive_control
import drive_journal
import drive_loop
import drive_wire

import benchlab

Row = tuple[str, str, bool | None]

PARTS: dict[str, Callable[[], Iterable[Row]]] = {
    "late": drive_loop.late,
    "killed": drive_loop.killed,
    "fast": drive_loop.fast,
    "pty": drive_wire.pty,
    "host": drive_wire.killed,
    "noise": drive_wire.noise,
    "lockstep": drive_wire.lockstep,
    "cut": drive_journal.cut,
    "flipped": drive_journal.flipped,
    "cost": drive_journal.cost,
    "control": drive_control.rows,
    "circle": drive_circle.circles,
}
MET = {None: "", True: "met", False: "**missed**"}


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("what", nargs="*", choices=[[], *PARTS], help="what to measure [default: all]")
    parts = parser.parse_args().what or list(PARTS)
    print(f"{date.today().isoformat()}, benchlab {benchlab.__version__}, Python {platform.python_version()}\n")
    print("| what | figure | bar |\n|---|---|---|", flush=True)
    for part in parts:
        for bar, figure, met in PARTS[part]():
            print(f"| {bar} | {figure} | {MET[met]} |", flush=True)


if __name__ == "__main__":
    main()
