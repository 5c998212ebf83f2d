"""`benchlab bench calibrate`."""

from __future__ import annotations

import json
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from benchlab.cli.bench_options import bench_option
from benchlab.cli.options import Finite
from benchlab.errors import InputError, UsageError, printable

if TYPE_CHECKING:
    from benchlab.io.gauge_readings import GaugeReading


@click.command(short_help="Bench file from gauge readings.")
@bench_option(default=None, required=False)
@click.option(
    "--gauge",
    metavar="TEXT",
    required=True,
    help="Which gauge: maker, type, range, class. On a twin, `twin` is a simulated one.",
)
@click.option(
    "--out", type=click.Path(path_type=Path), default=Path("bench.yaml"), show_default=True, help="Bench file to write."
)
@click.option("--name", metavar="TEXT", help="Of the bench. [default: the name of --out]")
@click.option(
    "--supply-V",
    "supply_V",
    type=Finite("V"),
    help="Between 5V and GND of the microcontroller, by a multimeter. [default: is asked for]",
)
@click.option("--unit", metavar="UNIT", help="That the gauge reads in: kPa, MPa, bar, psi. [default: is asked for]")
@click.option(
    "--readings",
    type=click.Path(path_type=Path),
    metavar="FILE",
    help="Readings that were taken before, as a table of volts, pressure_kPa and monitor_V; no bench is opened.",
)
@click.option("--date", metavar="DATE", help="Of such readings, as 2026-05-31. [default: today]")
@click.option(
    "--points",
    type=click.IntRange(4, 50),
    default=8,
    show_default=True,
    help="Levels on the way up; the same are read on the way down.",
)
@click.option(
    "--max-MPa",
    "max_MPa",
    type=Finite("MPA"),
    help="Highest level, by the nominal regulator. [default: what a bench without a calibration is given]",
)
@click.option(
    "--limit-MPa",
    "limit_MPa",
    type=Finite("MPA"),
    default=0.35,
    show_default=True,
    help="That this bench must never be asked for more than.",
)
@click.option(
    "--limit-reason", metavar="TEXT", help="Why a limit above 0.35 MPa; kept in the file and told with each run."
)
@click.option(
    "--full-scale-MPa",
    "full_scale_MPa",
    type=Finite("MPA"),
    default=0.48,
    show_default=True,
    help="At 5 V, as the regulator's label says; the readings must fit it by 10 %.",
)
@click.option(
    "--settle-s", type=Finite("S"), default=3.0, show_default=True, help="Wait at each level before its reading."
)
@click.option("--overwrite", is_flag=True, help="Replace an existing bench file; its flex sensor's line is kept.")
@click.option("--json", "as_json", is_flag=True, help="One JSON document on standard output.")
def calibrate(bench: str | None, gauge: str, out: Path, overwrite: bool, as_json: bool, **options: Any) -> None:
    """Calibrate the regulator of a bench, and its monitor where that is wired: the DAC is stepped up and down, and at each level you
    type what the gauge shows. Written is a bench file for `--calibration`, with all readings in it.

    The bench is held at a level while you read, for up to five minutes, and vented at the end, on Ctrl-C and on every error. Nothing
    goes up to a level where the readings so far foresee more than --limit-MPa. Type `r` in place of a reading to read the level before
    once more.

    Refused are readings that pressure should not rest on: too few or too close levels, pressure that falls with the volts, R² below
    0.995, a reading unlike the others, by its number, and a full scale unlike the regulator's label.

    \b
    Examples:
      benchlab bench calibrate --bench serial:/dev/ttyUSB0 --gauge "WIKA CPG1500, 0-10 bar, 0.1 %" --unit kPa
      benchlab bench calibrate --readings gauge.csv --gauge "Keller LEO 2" --supply-V 4.93 --date 2026-05-31
      benchlab bench calibrate --bench twin --gauge twin --out twin.yaml
    """
    import datetime

    from benchlab.workflows.bench_calibrate import CalibrationSettings, check_calibration_out
    from benchlab.workflows.bench_calibrate import calibrate as fit

    _check(bench, gauge, options)
    check_calibration_out(out, overwrite)
    date = options["date"] or datetime.date.today().isoformat()
    if options["readings"] is not None:
        from benchlab.io.gauge_table import read_gauge_table

        readings, supply_V, counts = list(read_gauge_table(options["readings"])), options["supply_V"], None
    else:
        from benchlab.cli.bench_measure import measure

        readings, supply_V, gauge, counts = measure(str(bench), gauge, options)
    settings = CalibrationSettings(
        options["name"] or out.stem,
        gauge,
        supply_V,
        options["limit_MPa"],
        date,
        options["full_scale_MPa"],
        counts,
        options["limit_reason"] or "",
    )
    try:
        found = fit(readings, settings, out)
    except InputError as error:
        _show_readings(readings)
        raise error
    _tell(found)
    if as_json:
        click.echo(json.dumps(found, indent=2, allow_nan=False))


def _check(bench: str | None, gauge: str, options: dict[str, Any]) -> None:
    from benchlab.units import known_unit

    if (bench is None) == (options["readings"] is None):
        raise UsageError(
            "give either --bench or --readings", hint="--bench measures, --readings takes what was measured"
        )
    if not gauge.strip():
        raise UsageError(
            "--gauge is empty", hint="say which gauge, so that a reviewer knows what the pressures rest on"
        )
    if options["readings"] is not None and (options["unit"] or options["max_MPa"]):
        raise UsageError("--unit and --max-MPa are for a bench", hint="--readings has its units in its header")
    if options["readings"] is not None and options["supply_V"] is None:
        raise UsageError("--readings needs --supply-V", hint="volts become codes by it")
    if options["supply_V"] is not None and not 4.5 <= options["supply_V"] <= 5.5:
        raise UsageError(f"--supply-V is {options['supply_V']:g}", hint="give 4.5 to 5.5, as measured")
    if (unit := options["unit"]) is not None and (known_unit(unit) or ("", ""))[0] != "pressure":
        raise UsageError(f"--unit {unit!r} is not a unit of pressure", hint="give kPa, MPa, bar or psi")
    _check_limit(options["limit_MPa"], options["full_scale_MPa"], options["limit_reason"] or "")
    if not 0.1 <= options["settle_s"] <= 600:
        raise UsageError(f"--settle-s is {options['settle_s']:g}", hint="give 0.1 to 600")
    if options["date"] is not None:
        if options["readings"] is None:
            raise UsageError("--date is of --readings", hint="what is measured now has today's date")
        _check_date(options["date"])


def _check_date(text: str) -> None:
    import datetime

    try:
        date = datetime.date.fromisoformat(text)
    except ValueError:
        raise UsageError(f"--date {text!r}", hint="write it as 2026-05-31") from None
    if date > datetime.date.today():
        raise UsageError(f"--date {text} is in the future", hint="give the day on which the readings were taken")


def _check_limit(limit_MPa: float, full_scale_MPa: float, reason: str) -> None:
    from benchlab.bench import PAPER_LIMIT_MPA

    if not 0 < limit_MPa <= 1:
        raise UsageError(f"--limit-MPa is {limit_MPa:g}", hint="give more than 0 and at most 1 MPa")
    if not 0.005 <= full_scale_MPa <= 5:
        raise UsageError(f"--full-scale-MPa is {full_scale_MPa:g}", hint="give 0.005 to 5 MPa, at 5 V")
    if limit_MPa > full_scale_MPa:
        raise UsageError(
            f"--limit-MPa is {limit_MPa:g}, and the regulator's label ends at {full_scale_MPa:g} MPa",
            hint="give --limit-MPa less, or --full-scale-MPa as the label says",
        )
    if limit_MPa > PAPER_LIMIT_MPA and not reason.strip():
        what = f"--limit-MPa is {limit_MPa:g}, above the paper's {PAPER_LIMIT_MPA:g} MPa"
        raise UsageError(what, hint="say why with --limit-reason")


def _show_readings(readings: list[GaugeReading]) -> None:
    """So that nothing typed is lost with a refusal."""
    click.echo("the readings, as --readings takes them:\nvolts,pressure_MPa,monitor_V", err=True)
    for r in readings:
        monitor = f"{r.monitor_V:.4f}" if r.monitor_V == r.monitor_V else ""
        click.echo(f"{r.volts:.4f},{r.pressure_MPa:.6g},{monitor}", err=True)


def _tell(found: dict[str, Any]) -> None:
    """The lines with their intervals, warnings and the file on standard error."""
    from benchlab.io.bench_file import SIMULATED

    for name in ("regulator", "monitor"):
        fit = found[name]
        if fit is None:
            click.echo(f"{name}: not wired, not calibrated", err=True)
            continue
        gain, offset = fit["gain_MPa_per_V"], fit["offset_MPa"]
        click.echo(
            f"{name}: {gain['value']:.5f} MPa/V ({gain['low']:.5f} to {gain['high']:.5f}), "
            f"offset {1000 * offset['value']:.2f} kPa ({1000 * offset['low']:.2f} to {1000 * offset['high']:.2f})",
            err=True,
        )
        loop = "not known" if fit["hysteresis_MPa"] is None else f"{1000 * fit['hysteresis_MPa']:+.2f} kPa"
        straight = "" if fit["bow_p"] is None else f" (p {fit['bow_p']:.2g})"
        click.echo(
            f"  sd {1000 * fit['sd_MPa']:.2f} kPa, largest residual {1000 * fit['largest_residual_MPa']:.2f} kPa, "
            f"R² {fit['r_squared']:.6f}; "
            f"bow {1000 * fit['bow_MPa']['value']:+.2f} kPa{straight}; falling less rising {loop}",
            err=True,
        )
    most = f"at most {found['ceiling_MPa']:.4g} MPa is {found['ceiling_V']:.3f} V, code {found['ceiling_code']}"
    click.echo(f"{most}, at {found['supply_V']:g} V of supply", err=True)
    for warning in found["warnings"]:
        _say(f"warning: {warning}")
    for path in found["outputs"]:
        _say(f"wrote {path}")
    if SIMULATED not in found["gauge"]:
        _say(f"write the firmware anew with `benchlab bench firmware --calibration {found['outputs'][0]} --out DIR`")


def _say(text: str) -> None:
    click.echo(f"  {printable(text)}", err=True)
