"""`benchlab protocol`."""

from __future__ import annotations

import json
import textwrap
from pathlib import Path
from typing import Any

import click

from benchlab.cli.options import Finite
from benchlab.errors import counted, printable

MOST_ROWS = 40
"""Rows of the table of steps on the terminal."""


@click.group(short_help="Pressure protocols: what they will ask for.")
def protocol() -> None:
    """A protocol says which pressure, or which angle, a bench is asked for and when. docs/protocols.md explains every key.

    `show` checks one and shows its plan, without a bench; `list` names those that come with benchlab.
    """


@protocol.command(short_help="Check a protocol and show its plan.")
@click.argument("source", metavar="PROTOCOL")
@click.option(
    "--out", "outs", multiple=True, metavar="FILE", type=click.Path(path_type=Path),
    help="Write the plan as a picture (.png) or as a table, a row a tick (.csv). May be given again.",
)  # fmt: skip
@click.option("--max-duration-s", type=Finite("S"), default=3600.0, show_default=True, help="Longest protocol to take.")
@click.option("--rate-Hz", "rate_Hz", type=Finite("HZ"), help="Ticks a second, in place of the protocol's.")
@click.option(
    "--calibration", metavar="FILE", type=click.Path(path_type=Path),
    help="Of a bench, by `benchlab bench calibrate`: the plan is also checked against what it may be given.",
)  # fmt: skip
@click.option("--overwrite", is_flag=True, help="Replace existing files.")
@click.option("--json", "as_json", is_flag=True, help="One JSON document on standard output.")
def show(
    source: str,
    outs: tuple[Path, ...],
    max_duration_s: float,
    rate_Hz: float | None,
    calibration: Path | None,
    overwrite: bool,
    as_json: bool,
) -> None:
    """Check PROTOCOL, a file or the name of a shipped one, and show what it asks for: duration, peak, slew, samples, steps and marks. What
    `benchlab run` runs is what is shown here, tick by tick; no bench is needed, and none is opened.

    All that is wrong with a file is said at once, each with its line and what to write.

    \b
    Examples:
      benchlab protocol show linear_ramp
      benchlab protocol show mine.yaml --out mine.png --out mine.csv --calibration bench.yaml
    """
    from benchlab.workflows.protocol_show import show_protocol

    found = show_protocol(source, outs, max_duration_s, rate_Hz, calibration, overwrite)
    if as_json:
        click.echo(json.dumps(found, indent=2, allow_nan=False))
    _tell(found, err=as_json)


@protocol.command("list", short_help="The protocols that come with benchlab.")
@click.option("--json", "as_json", is_flag=True, help="One JSON document on standard output.")
def list_(as_json: bool) -> None:
    """Name, duration and purpose of the protocols that come with benchlab; `benchlab protocol show NAME` shows one.

    Each is a file to copy and change; where they lie is said too.
    """
    from benchlab.workflows.protocol_show import list_protocols

    found = list_protocols()
    if as_json:
        click.echo(json.dumps(found, indent=2, allow_nan=False))
        return
    table = _table("name", "title", "lasts, s", "peak, MPa", "angle, °")
    for one in found:
        peak = f"{one['peak_MPa']:.4g}" if one["peak_MPa"] else "-"
        table.add_row(one["name"], one["title"], f"{one['duration_s']:g}", peak, _angles(one["reference_deg"]))
    _print(table)
    click.echo(f"files to copy and change: {printable(Path(found[0]['file']).parent)}")


def _tell(found: dict[str, Any], err: bool) -> None:
    """Numbers, steps, marks and files."""
    about = textwrap.wrap(found["about"], 110, initial_indent="  ", subsequent_indent="  ")
    for line in [found["title"], *about, *_numbers(found)]:
        click.echo(printable(line), err=err)
    table = _table("from, s", "times", "lasts, s", "step", "change", "line")
    steps = found["alike_steps"]
    for step in steps[:MOST_ROWS]:
        row = [
            f"{step['first_s']:g}",
            str(step["times"]),
            f"{step['duration_s']:g}",
            step["label"],
            _change(step),
            str(step["line"]),
        ]
        table.add_row(*row)
    _print(table, err)
    if len(steps) > MOST_ROWS:
        click.echo(f"and {len(steps) - MOST_ROWS} more; --out FILE.csv has every tick", err=err)
    for event in found["events"][:MOST_ROWS]:
        click.echo(printable(f"  {event['time_s']:g} s  {event['kind']}: {event['text']}"), err=err)
    if len(found["events"]) > MOST_ROWS:
        click.echo(f"  and {len(found['events']) - MOST_ROWS} more marks and triggers", err=err)
    for path in found["outputs"]:
        click.echo(f"wrote {printable(path)}", err=err)


def _numbers(found: dict[str, Any]) -> list[str]:
    lines = [
        f"  lasts {found['duration_s']:g} s, {found['samples']} samples at {found['rate_Hz']:g} Hz, {counted(len(found['steps']), 'step')}",
    ]
    if found["peak_MPa"]:
        lines.append(f"  peak {found['peak_MPa']:.4g} MPa, limit {found['limit_MPa']:g} MPa")
    if speed := _speed(found["slew_MPa_per_s"], found["jumps"]):
        lines.append(f"  {speed}")
    if found["closed_loop"]:
        gains = "gains in the file" if found["control"] else "no gains in the file: give the run --control"
        lines.append(
            f"  controls the angle, {_angles(found['reference_deg'])}°, with up to {found['limit_MPa']:g} MPa; {gains}"
        )
    lines.append(f"  ends {'vented' if found['ends_vented'] else 'under pressure; the runner vents'}")
    return [*lines, f"  {_bench(found)}"]


def _speed(slew_MPa_per_s: float | None, jumps: dict[str, Any]) -> str:
    """How fast it is within steps, and that it jumps besides, in one line: either alone misleads."""
    ways = [
        f"{counted(count, way)} of up to {jumps[f'largest_{way}_MPa']:.4g} MPa"
        for way in ("rise", "fall")
        if (count := jumps[f"{way}s"])
    ]
    jumping = f"{' and '.join(ways)} at once, as fast as the bench can" if ways else ""
    slew = f"slew at most {slew_MPa_per_s:.4g} MPa/s" if slew_MPa_per_s else ""
    return f"{slew} within steps; besides, {jumping}" if slew and jumping else slew or jumping


def _bench(found: dict[str, Any]) -> str:
    """Which bench it was checked against, if any."""
    if bench := found["bench"]:
        return f"checked against bench {bench['name']}: fits, up to {bench['ceiling_MPa']:.4g} MPa"
    twin_MPa = found["twin_ceiling_MPa"]
    too_high = f"; too high for the twin, which takes up to {twin_MPa:g} MPa"
    over = too_high if (found["peak_MPa"] or 0) > twin_MPa else ""
    return f"not checked against a bench: --calibration FILE does that{over}"


def _change(step: dict[str, Any]) -> str:
    """By how much a step jumps as it begins, and how fast it is then."""
    low, high = step["jumps_MPa"] or (0.0, 0.0)
    jump = f"{low:+.4g} MPa at once" if low == high else f"{low:+.4g} to {high:+.4g} MPa at once"
    slew = f"{step['slew_MPa_per_s']:.4g} MPa/s" if step["slew_MPa_per_s"] else ""
    return ", ".join([jump] * bool(high) + [slew] * bool(slew)) or "-"


def _angles(reference_deg: list[float] | None) -> str:
    return "-" if reference_deg is None else f"{reference_deg[0]:g} to {reference_deg[1]:g}"


def _table(*columns: str) -> Any:
    from rich.table import Table

    table = Table(box=None, pad_edge=False)
    for column in columns:
        table.add_column(column, justify="left" if column in ("name", "title", "step", "change") else "right")
    return table


def _print(table: Any, err: bool = False) -> None:
    from rich.console import Console

    console = Console(stderr=err, highlight=False, markup=False)
    if not console.is_terminal:
        console.width = 120
    console.print(table)
