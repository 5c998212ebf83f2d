"""`benchlab bench monitor`."""

from __future__ import annotations

import json
import sys
from collections.abc import Iterator
from contextlib import closing
from pathlib import Path
from typing import TYPE_CHECKING

import click

from benchlab.cli.bench_options import bench_option, calibration_option, device_of
from benchlab.cli.options import Finite
from benchlab.errors import BenchlabError, printable

if TYPE_CHECKING:
    from rich.table import Table

    from benchlab.workflows.bench_monitor import Seen

TOLD_HZ = 5.0
"""How often the screen, or a line, says what is seen."""


@click.command(short_help="Readings of a bench, live, without arming it.")
@bench_option(default=None)
@calibration_option
@click.option("--seconds", type=Finite("S"), help="End after this. [default: until Ctrl-C]")
@click.option(
    "--rate-Hz", "rate_Hz", type=Finite("HZ"), default=20.0, show_default=True, help="Readings a second, 0.1 to 200."
)
@click.option("--out", type=click.Path(path_type=Path), metavar="FILE", help="CSV table of all readings to write.")
@click.option("--overwrite", is_flag=True, help="Replace an existing table.")
@click.option("--json-lines", is_flag=True, help="Each reading as a line of JSON on standard output.")
@click.option("--json", "as_json", is_flag=True, help="At the end, one JSON document: means, SDs, flags, faults.")
def monitor(
    bench: str,
    calibration: Path | None,
    seconds: float | None,
    rate_Hz: float,
    out: Path | None,
    overwrite: bool,
    json_lines: bool,
    as_json: bool,
) -> None:
    """Show pressure, volts, angle, flags and faults of a bench without arming it: it stays vented. Ctrl-C ends it.

    Pressure and angle are shown where the bench file has a calibrated monitor and flex sensor, volts always.

    \b
    Examples:
      benchlab bench monitor --bench serial:/dev/ttyUSB0 --calibration bench.yaml
      benchlab bench monitor --bench serial:/dev/ttyUSB0 --seconds 10 --out noise.csv --json
    """
    from benchlab.errors import UsageError
    from benchlab.io.files import check_new_file
    from benchlab.runner.clock import RealClock
    from benchlab.workflows.bench_monitor import summary, watch, write_seen
    from benchlab.workflows.open_bench import bench_doubts, bench_of, open_bench

    if not 0.1 <= rate_Hz <= 200:
        raise UsageError(f"--rate-Hz is {rate_Hz:g}", hint="give 0.1 to 200")
    if seconds is not None and seconds <= 0:
        raise UsageError(f"--seconds is {seconds:g}", hint="give more than 0")
    if json_lines and as_json:
        raise UsageError("--json-lines and --json both write to standard output", hint="give one of them")
    if out is not None:
        check_new_file(out, overwrite)
    spec = device_of(bench)
    calibrated = bench_of(spec, calibration)
    for doubt in bench_doubts(spec, calibrated):
        click.echo(f"warning: {printable(doubt)}", err=True)
    kept: list[Seen] = []
    lost: BenchlabError | None = None
    with closing(open_bench(bench, calibrated)) as device:
        shown = _shown(watch(device, calibrated, RealClock(), rate_Hz, seconds), json_lines)
        try:
            for one in shown:
                if out is not None or as_json:
                    kept.append(one)
        except KeyboardInterrupt:
            pass
        except BenchlabError as error:
            lost = error
    if out is not None:
        write_seen(out, kept)
        click.echo(f"wrote {printable(out)}: {len(kept)} readings", err=True)
    if lost is not None:
        raise lost
    if as_json:
        click.echo(json.dumps(summary(kept), indent=2, allow_nan=False))


def _shown(seen: Iterator[Seen], json_lines: bool) -> Iterator[Seen]:
    """The readings, each shown as it comes."""
    from benchlab.cli.progress import fancy

    if json_lines:
        return _as_json_lines(seen)
    return _as_table(seen) if fancy() else _as_lines(seen)


def _as_json_lines(seen: Iterator[Seen]) -> Iterator[Seen]:
    for one in seen:
        sys.stdout.write(json.dumps(one.row(), allow_nan=False) + "\n")
        sys.stdout.flush()
        yield one


def _as_lines(seen: Iterator[Seen]) -> Iterator[Seen]:
    last = -1.0
    for one in seen:
        if one.time_s - last >= 1.0 or one.faults:
            last = one.time_s
            click.echo(f"{one.time_s:8.1f} s  " + "  ".join(f"{name} {value}" for name, value in _words(one)), err=True)
        yield one


def _as_table(seen: Iterator[Seen]) -> Iterator[Seen]:
    from rich.console import Console
    from rich.live import Live

    last = -1.0
    with Live(console=Console(stderr=True), auto_refresh=False) as live:
        for one in seen:
            if one.time_s - last >= 1 / TOLD_HZ:
                last = one.time_s
                live.update(_table(one), refresh=True)
            for fault in one.faults:
                live.console.print(f"{one.time_s:.1f} s: {printable(fault.cause)}, {fault.count} times", markup=False)
            yield one


def _table(one: Seen) -> Table:
    from rich.table import Table
    from rich.text import Text

    table = Table(box=None, show_header=False, pad_edge=False)
    table.add_row("time", Text(f"{one.time_s:.1f} s", justify="right"))
    for name, value in _words(one):
        table.add_row(name, Text(value, justify="right"))
    return table


def _words(one: Seen) -> list[tuple[str, str]]:
    row = one.row()

    def told(key: str, factor: float, digits: int, unit: str, missing: str) -> str:
        return missing if row[key] is None else f"{factor * row[key]:.{digits}f} {unit}"

    return [
        ("pressure", told("pressure_MPa", 1000, 1, "kPa", "not known")),
        ("monitor", told("monitor_V", 1, 3, "V", "not wired")),
        ("flex", told("flex_V", 1, 3, "V", "not wired")),
        ("angle", told("angle_deg", 1, 1, "°", "not calibrated")),
        ("code", "not known" if row["code"] is None else str(row["code"])),
        ("says", row["status"] or "disarmed"),
    ]
