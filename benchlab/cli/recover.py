"""`benchlab recover`."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import click

from benchlab.errors import InputError, counted, printable

MOST_GAPS = 5
"""Holes in the record that are told one by one."""


@click.command(short_help="Files of a run from its journal, after a crash.")
@click.argument("journal", metavar="JOURNAL", type=click.Path(path_type=Path))
@click.option("--out", type=click.Path(path_type=Path), help="Folder for the files. [default: beside the journal]")
@click.option("--overwrite", is_flag=True, help="Replace existing files.")
@click.option("--strict", is_flag=True, help="Exit code 3 where something is lost or the record of the end is missing.")
@click.option("--json", "as_json", is_flag=True, help="One JSON document on standard output.")
def recover(journal: Path, out: Path | None, overwrite: bool, strict: bool, as_json: bool) -> int:
    """Make the drive file, table and picture of a run from its JOURNAL, as `benchlab run` does at its end.

    Everything up to the last whole record is there, whatever died: the program, the computer, the disk. What is cut or damaged is left
    out and told; no number whose checksum does not fit is used. The journal itself is only read: keep it.

    \b
    Writes beside the journal, or into --out (made if the folder above it exists):
      NAME.h5    the drive file (HDF5, NXdata)
      NAME.csv   a row a tick
      NAME.png   pressure and angle against time

    Exit codes: 0 the files are made, whatever the journal lacks; with --strict, 3 where it lacks something: the files are made too.

    \b
    Example:
      benchlab recover results/linear_ramp.journal --out recovered
    """
    from benchlab.workflows.drive_outputs import write_results

    found = write_results(journal, out, overwrite)
    _tell(found)
    if as_json:
        click.echo(json.dumps(found, indent=2, allow_nan=False))
    if strict and (found["lost"] or not found["complete"]):
        click.echo("benchlab: the journal is not whole, and --strict was given", err=True)
        return InputError.exit_code
    return 0


def _tell(found: dict[str, Any]) -> None:
    """How complete, what was lost, whether it was vented, and the files, on standard error."""
    planned = "" if found["ticks_planned"] is None else f" of {found['ticks_planned']}"
    lines = [f"{printable(found['title'])}: {found['ticks']}{planned} ticks, up to {found['last_time_s']:.3f} s"]
    if found["complete"]:
        ended = f"{found['reason']}: {found['words']}" if found["words"] else str(found["reason"])
        good = found["vented"] and found["empty"] is not False
        vented = f"{found['left']}{'' if good else ': look at the bench'}"
        lines.append(f"  its end is recorded: {printable(ended)}; {vented}")
    else:
        lines.append(
            f"  no record of its end; the last that was asked for is {found['last_command_MPa']:.4g} MPa, and whether it was vented is "
            "not known from here: a bench of metal vents itself when it hears nothing"
        )
    lines += [f"  lost: {printable(words)}" for words in found["lost"]] or ["  nothing is lost of what was written"]
    lines += [f"  {words}" for words in found["gaps"][:MOST_GAPS]]
    if len(found["gaps"]) > MOST_GAPS:
        lines.append(
            f"  and {len(found['gaps']) - MOST_GAPS} more holes, {counted(found['missing_ticks'], 'tick')} in all"
        )
    if found["origin"] != "measured":
        lines.append(f"  {printable(found['origin'])}")
    lines += [f"  wrote {printable(path)}" for path in found["outputs"]]
    for line in lines:
        click.echo(line, err=True)
