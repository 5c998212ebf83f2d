"""`benchlab bench`: what is done with a bench outside of runs."""

from __future__ import annotations

import json
from contextlib import closing
from pathlib import Path
from typing import TYPE_CHECKING

import click

from benchlab.cli.bench_calibrate import calibrate
from benchlab.cli.bench_monitor import monitor
from benchlab.cli.bench_options import bench_option, calibration_option, device_of
from benchlab.cli.options import Finite
from benchlab.errors import BenchlabError, UsageError, printable

if TYPE_CHECKING:
    from benchlab.bench import Bench


@click.group(short_help="Calibrate, vent, watch and flash a pressure bench.")
def bench() -> None:
    """Calibrate, vent, watch and flash a pressure bench. Pressure protocols are run on it by `benchlab run`."""


bench.add_command(calibrate)
bench.add_command(monitor)


@bench.command(short_help="Vent a bench, and say what was confirmed.")
@bench_option(default=None)
@calibration_option
@click.option("--json", "as_json", is_flag=True, help="One JSON document on standard output.")
def vent(bench: str, calibration: Path | None, as_json: bool) -> None:
    """Set the DAC to 0, which asks the regulator to vent, close the firmware's latch, and say what was confirmed of it: the DAC's
    code, and, where the bench file has a calibrated monitor, that the pressure is below 10 kPa within 5 s.

    It leaves with 5 where that was not confirmed: then close the supply and open the relief valve by hand.

    \b
    Examples:
      benchlab bench vent --bench serial:/dev/ttyUSB0
      benchlab bench vent --bench serial:COM3 --calibration bench.yaml
    """
    from benchlab.runner.clock import RealClock
    from benchlab.workflows.bench_vent import vent_bench
    from benchlab.workflows.open_bench import bench_of, open_bench

    spec, refused = device_of(bench), None
    try:
        calibrated = bench_of(spec, calibration)
    except BenchlabError as error:  # a vent does not wait for a file that can be read
        calibrated, refused = bench_of(spec), error
    with closing(open_bench(bench, calibrated)) as device:
        found = vent_bench(device, calibrated, RealClock())
    pressure = found["pressure_MPa"]
    seen = (
        "nobody measured the pressure: no calibrated monitor"
        if pressure is None
        else f"the monitor shows {1000 * pressure:.1f} kPa"
    )
    holds = "holds" if found["read_back"] else "acknowledged, without being read back by this old firmware,"
    click.echo(f"vented: the DAC {holds} code 0 and the latch is closed; {seen}", err=True)
    if found["dac_power_on_code"] == 0:
        click.echo("  at power-on the DAC gives code 0", err=True)
    for told in [*found["notes"], *found["unsafe"]]:
        click.echo(f"  WARNING: {printable(told)}", err=True)
    for fault in found["faults"]:
        click.echo(f"  {printable(fault)}", err=True)
    if refused is not None:
        raise refused
    if as_json:
        click.echo(json.dumps(found, indent=2, allow_nan=False))


@bench.command(short_help="Write the firmware for the Arduino IDE.")
@click.option(
    "--out",
    type=click.Path(path_type=Path),
    required=True,
    metavar="DIR",
    help="Folder that the sketch's folder is put into.",
)
@calibration_option
@click.option(
    "--full-scale-MPa",
    "full_scale_MPa",
    type=Finite("MPA"),
    help="Of a bench without a calibration: at 5 V, as its regulator's label says. [default: 0.48]",
)
@click.option(
    "--limit-MPa",
    "limit_MPa",
    type=Finite("MPA"),
    help="Of a bench without a calibration. [default: 0.35, which is the most]",
)
@click.option("--overwrite", is_flag=True, help="Replace an existing sketch.")
@click.option("--json", "as_json", is_flag=True, help="One JSON document on standard output.")
def firmware(
    out: Path,
    calibration: Path | None,
    full_scale_MPa: float | None,
    limit_MPa: float | None,
    overwrite: bool,
    as_json: bool,
) -> None:
    """Write the firmware of the Nano as a sketch for the Arduino IDE, with the bench's ceiling in it: the largest code of the DAC that it
    ever takes. Without a calibration that is the one of a new bench with the paper's regulator, 0.48 MPa at 5 V: say what the label of
    another says.

    \b
    Examples:
      benchlab bench firmware --out nano
      benchlab bench firmware --out nano --calibration bench.yaml
    """
    from benchlab.bench import new_bench
    from benchlab.io.bench_file import limit_notes, read_bench
    from benchlab.workflows.bench_firmware import write_firmware

    if calibration is None:
        new = new_bench("not calibrated")
        found = new_bench(
            new.name,
            new.limit_MPa if limit_MPa is None else limit_MPa,
            new.full_scale_MPa if full_scale_MPa is None else full_scale_MPa,
        )
    elif limit_MPa is None and full_scale_MPa is None:
        found = read_bench(calibration)
    else:
        hint = "leave --limit-MPa and --full-scale-MPa out"
        raise UsageError("--calibration has its own limit and full scale", hint=hint)
    sketch = write_firmware(out, found, overwrite)
    click.echo(
        f"wrote {printable(sketch)}: at most code {found.ceiling_code}, {found.volts(found.ceiling_code):.3f} V, "
        f"{found.ceiling_MPa:.4g} MPa by {'the calibration' if found.calibrated else _by_label(found)}",
        err=True,
    )
    for note in limit_notes(found):
        click.echo(f"warning: {printable(note)}", err=True)
    if as_json:
        document = {"outputs": [str(sketch)], "ceiling_code": found.ceiling_code, "ceiling_MPa": found.ceiling_MPa}
        click.echo(json.dumps(document, indent=2))


def _by_label(found: Bench) -> str:
    where = f"{printable(found.source)}, " if found.source else ""
    return f"{where}a regulator of {found.full_scale_MPa:g} MPa at 5 V by its label and no other: not calibrated"


@bench.command(short_help="Serial ports of this computer.")
@click.option("--json", "as_json", is_flag=True, help="One JSON document on standard output.")
def ports(as_json: bool) -> None:
    """List the serial ports of this computer with their USB ids, and say which of them may be a Nano. Nothing is opened.

    \b
    Example:
      benchlab bench ports
    """
    from benchlab.workflows.bench_ports import serial_ports

    found = serial_ports()
    if as_json:
        click.echo(json.dumps({"ports": found}, indent=2))
        return
    for port in found:
        said = [port["description"], port["usb"] and f"USB {port['usb']}", port["chip"]]
        click.echo(f"{printable(port['port'])}  {printable(', '.join(filter(None, said)) or 'no USB port')}")
    if not found:
        click.echo("no serial port; is the cable one that carries data, and does `lsusb` show the Nano?", err=True)
