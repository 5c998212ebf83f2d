"""`benchlab force`."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import click

from benchlab.cli.options import Finite
from benchlab.cli.ranges import Values
from benchlab.errors import BatchError, InputError, UsageError, counted, printable

SUFFIXES = (".csv", ".tsv", ".txt")

UNEVEN = 1.5
"""A time step that is so many times the median one is told."""


@click.command(short_help="Exports of testing machines; blocked force against pressure.")
@click.argument("files", metavar="FILE|FOLDER...", nargs=-1, required=True, type=click.Path(path_type=Path))
@click.option(
    "--columns", metavar="NAMES", help="What the columns are, as `force_N,pressure_kPa,time_s,-`; `-` for one not used."
)
@click.option("--force-unit", metavar="UNIT", help="Of a force column that names none: N, kN, lbf, kgf, gf.")
@click.option("--decimal", type=click.Choice([".", ","]), help="Decimal sign, where the file can be read with either.")
@click.option("--encoding", metavar="NAME", help="Of the file's text, where it is not found: cp1252, utf-16, gbk.")
@click.option("--sort-time", is_flag=True, help="Sort rows by time where it runs backwards.")
@click.option("--negate", is_flag=True, help="Turn the sign of the force round: pressing is negative in these exports.")
@click.option("--steps-MPa", type=Values(), help="Pressures of the cycles in order of time, lowest first, in MPa.")
@click.option(
    "--cycles", type=click.IntRange(1), help="Cycles at each step. [default: as many as there are, alike at each]"
)
@click.option(
    "--pressure", "logs", multiple=True, type=click.Path(path_type=Path),
    help="Log of the pressure on the clock of the force file; once for all files, or once for each.",
)  # fmt: skip
@click.option(
    "--tolerance-MPa", type=Finite("MPA"), help="Pressures this near are of one step. [default: 2 % of the largest]"
)
@click.option(
    "--actuator",
    "actuators",
    multiple=True,
    metavar="NAME",
    help="Name of each file's actuator. [default: the file's name]",
)
@click.option(
    "--lever-arm-mm", type=Finite("MM"), help="From the clamp to where the force acts; stated with the result."
)
@click.option("--out", type=click.Path(path_type=Path), help="Folder to write into. [default: that of the first file]")
@click.option("--overwrite", is_flag=True, help="Replace existing files.")
@click.option("--strict", is_flag=True, help="Warnings make the exit code 3.")
@click.option("--json", "as_json", is_flag=True, help="One JSON document on standard output.")
def force(
    files: tuple[Path, ...], logs: tuple[Path, ...], actuators: tuple[str, ...], out: Path | None, overwrite: bool, strict: bool,
    as_json: bool, **options: Any,
) -> int:  # fmt: skip
    """Read raw exports of testing machines (Bluehill 2, 3, Universal in any language; tables with units) and write them in N, mm and s.

    Where the pressure of each cycle is known, blocked force too: from a column of pressure in the file, a log (--pressure), or the stated
    steps (--steps-MPa), each with the same number of cycles. A file is an actuator; so is each specimen of a file with several. A folder
    stands for the .csv, .tsv and .txt files in it.

    \b
    Written to --out:
      NAME_force.csv, .h5     the table in N, mm, s, MPa (HDF5: NXdata)
      NAME_peaks.csv          a row a cycle: peak as recorded, the load cell's zero then, peak without it and its SD
      blocked_force.csv       a row a pressure: mean and SD over actuators, the line with its band, each actuator
      blocked_force.json      the same with intervals, the test of linearity, and what it was made from
      blocked_force.png, .svg the figure

    The zero is taken from the unloaded rests between cycles, from rest to rest. Actuators are the samples: cycles are averaged within
    each, and the interval of the line is that of the actuators' own lines. Forces keep the sign of the export; negative ones are refused
    unless --negate says what they mean. A peak at the load cell's limit counts as a lower bound (≥).

    A file that fails is listed, and the rest goes on (exit code 4).

    \b
    Examples:
      benchlab force Specimen_RawData_1.csv --out results
      benchlab force exports --steps-MPa 0.035:0.35:0.035 --cycles 5 --lever-arm-mm 180 --out results
      benchlab force a1.csv a2.csv --pressure log1.csv --pressure log2.csv --actuator A1 --actuator A2
      benchlab force muscle.csv --columns force_N,pressure_kPa,time_s,- --json
    """
    from benchlab.workflows.force import force as run

    files = _expanded(files)
    found = run(_inputs(files, logs, actuators), out, _settings(options), overwrite)
    _tell(found)
    if as_json:
        click.echo(json.dumps(found, indent=2, allow_nan=False))
    if found["failed"]:
        click.echo(
            f"benchlab: {len(found['files'])} of {len(files)} files read, {len(found['failed'])} failed (above)",
            err=True,
        )
        return BatchError.exit_code
    if strict and _warnings(found):
        click.echo("benchlab: there are warnings, and --strict was given", err=True)
        return InputError.exit_code
    return 0


def _expanded(paths: tuple[Path, ...]) -> tuple[Path, ...]:
    """Files as they are; for a folder, the tables in it by name."""
    files: list[Path] = []
    for path in paths:
        if not path.is_dir():
            files.append(path)
            continue
        inside = sorted(p for p in path.iterdir() if p.suffix.lower() in SUFFIXES and not p.name.startswith("."))
        if not inside:
            raise UsageError("no export in this folder", file=path, hint=f"looked for {', '.join(SUFFIXES)}")
        files += inside
    return tuple(files)


def _inputs(files: tuple[Path, ...], logs: tuple[Path, ...], actuators: tuple[str, ...]) -> list[Any]:
    from benchlab.workflows.force import ForceInput

    if actuators and len(actuators) != len(files):
        raise UsageError(
            f"{len(actuators)} names of actuators for {len(files)} files", hint="give --actuator once for each file"
        )
    if len(logs) not in (0, 1, len(files)):
        raise UsageError(
            f"{len(logs)} pressure logs for {len(files)} files", hint="give --pressure once, or once for each file"
        )
    pressures = logs * len(files) if len(logs) == 1 else logs or (None,) * len(files)
    return [ForceInput(path, name, log) for path, name, log in zip(files, actuators or ("",) * len(files), pressures)]


def _settings(options: dict[str, Any]) -> Any:
    from benchlab.io.machine_export import ExportOptions
    from benchlab.workflows.force_cycles import ForceSettings

    read = {name: options[name] for name in ("columns", "force_unit", "decimal", "encoding", "sort_time")}
    return ForceSettings(
        ExportOptions(**read), options["steps_mpa"] or (), options["cycles"], None, options["tolerance_mpa"], options["negate"],
        options["lever_arm_mm"],
    )  # fmt: skip


def _warnings(found: dict[str, Any]) -> list[str]:
    blocked = found["blocked_force"]
    return [text for one in found["files"] for text in one["warnings"]] + (blocked["warnings"] if blocked else [])


def _tell(found: dict[str, Any]) -> None:
    """Files, what was inferred, the table of pressures, the line, and what was written, on standard error."""
    for one in found["files"]:
        _tell_file(one)
    for error in found["failed"]:
        click.echo(
            f"benchlab: {InputError(error['what'], file=error['file'], where=error['where'], hint=error['hint'])}",
            err=True,
        )
    if found["blocked_force"]:
        _tell_blocked(found["blocked_force"])
    for path in found["outputs"]:
        click.echo(f"  wrote {printable(path)}", err=True)


def _tell_file(one: dict[str, Any]) -> None:
    rate, steps = "", one["time_step_s"]
    if steps is not None:
        rate = f", {one['sample_rate_Hz']:.4g} readings/s"
        uneven = steps["max"] > UNEVEN * steps["median"]
        rate += f" (uneven: steps of {steps['min']:.3g} to {steps['max']:.3g} s)" * uneven
    many = f", {len(one['specimens'])} specimens" if len(one["specimens"]) > 1 else ""
    click.echo(f"{printable(one['file'])}: {one['rows']} rows{many}{rate}", err=True)
    ranges = (f"{name} {r['min']:.5g} to {r['max']:.5g}" for name, r in one["columns"].items() if r["min"] is not None)
    click.echo(f"  {', '.join(ranges)}", err=True)
    click.echo(
        f"  found: {printable('; '.join(f'{name}: {words}' for name, words in one['inferred'].items()))}", err=True
    )
    for actuator in one["actuators"]:
        click.echo(f"  {printable(actuator['actuator'])}: {_peaks(actuator)}", err=True)
    for warning in one["warnings"]:
        click.echo(f"  warning: {printable(warning)}", err=True)


def _peaks(actuator: dict[str, Any]) -> str:
    peaks, zero = actuator["peaks"], actuator["baseline"]
    if not peaks:
        return actuator["note"]
    forces = sorted((p["peak_N"], p["lower_bound"]) for p in peaks)
    (low, _), (high, bound) = forces[0], forces[-1]
    span = f"peaks {low:.4g} to {high:.4g} N" if len(peaks) > 1 else f"peak {high:.4g} N"
    if not zero["flat_rests"]:
        return f"{counted(len(peaks), 'cycle')}; largest reading {actuator['largest_reading_N']:.4g} N; nowhere at rest"
    drift = "" if zero["slope_N_per_s"] is None else f", drifting {60 * zero['slope_N_per_s']:+.2g} N/min"
    cycles = f"{counted(len(peaks), 'cycle')} by {actuator['inferred']['cycles']}"
    return f"{cycles}; {span}{' (≥)' * bound}; zero {zero['first_N']:.3g} N{drift}, taken off"


def _tell_blocked(blocked: dict[str, Any]) -> None:
    from rich.console import Console
    from rich.table import Table
    from rich.text import Text

    from benchlab.report.document import cut
    from benchlab.report.force_figure import places_of

    names = [cut(name, 20) for name in blocked["actuators"]]
    shown = names if len(names) <= 4 else []
    table = Table(box=None, pad_edge=False)
    for head in ("pressure, MPa", "n", "mean, N", "SD, N", *shown):
        table.add_column(Text(head), justify="right")
    places = places_of(blocked["largest"]["mean_N"], blocked["largest"]["sd_N"] or float("nan"))
    for row in blocked["pressures"]:
        bound = "≥ " * row["lower_bound"]
        each = [f"{'≥ ' * a['lower_bound']}{_text(a['mean_N'], places)}" for a in row["by_actuator"]] if shown else []
        cells = [
            f"{row['pressure_MPa']:g}",
            str(row["n"]),
            f"{bound}{_text(row['mean_N'], places)}",
            _text(row["sd_N"], places),
            *each,
        ]
        table.add_row(*map(Text, cells))
    console = Console(stderr=True, highlight=False)
    if not console.is_terminal:
        console.width = 120
    console.print(table)
    for text in blocked["words"]:
        click.echo(f"  {printable(text)}", err=True)
    for warning in blocked["warnings"]:
        click.echo(f"  warning: {printable(warning)}", err=True)


def _text(value: float | None, places: int) -> str:
    return "-" if value is None else f"{value:.{places}f}"
