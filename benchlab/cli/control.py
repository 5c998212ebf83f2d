"""`benchlab control`."""

from __future__ import annotations

import json
import re
from pathlib import Path
from typing import Any

import click

from benchlab.cli.options import Finite
from benchlab.errors import counted, printable


@click.group(short_help="Curvature control: flex sensor, gains, how well it tracks.")
def control() -> None:
    """Curvature control from runs of `benchlab run`: the flex sensor's line, gains from an identified plant, how well a loop tracks.

    docs/control.md goes from a fresh bench to tracking.
    """


@control.command(short_help="Flex sensor's line from a run and the angle seen in it.")
@click.argument("run", metavar="RUN.h5", type=click.Path(path_type=Path))
@click.option(
    "--angle",
    required=True,
    type=click.Path(path_type=Path),
    help="Angle during the run: the run file of `benchlab analyze` on its film, or a table with time_s and angle_deg.",
)
@click.option(
    "--calibration",
    required=True,
    type=click.Path(path_type=Path),
    metavar="FILE",
    help="The bench file of the run's bench.",
)
@click.option("--out", type=click.Path(path_type=Path), help="Bench file to write. [default: --calibration itself]")
@click.option(
    "--angle-starts-s",
    type=Finite("S"),
    help="Time of the run at the angle's time 0. [default: a film's is the run's trigger of the camera, a table's is 0]",
)
@click.option("--overwrite", is_flag=True, help="Replace a flex line, or a file.")
@click.option("--json", "as_json", is_flag=True, help="One JSON document on standard output.")
def flex(
    run: Path,
    angle: Path,
    calibration: Path,
    out: Path | None,
    angle_starts_s: float | None,
    overwrite: bool,
    as_json: bool,
) -> None:
    """Fit the flex sensor's line, bending angle over volts, to the holds of a run, and write it into the bench file.

    Each hold is one point, since its samples are not independent. Told are gain and offset with their intervals, the standard
    deviation of one sample, tests of straightness, and what falling and rising differ by.

    \b
    Examples:
      benchlab control flex results/flex.h5 --angle results/flex_film.h5 --calibration bench.yaml
    """
    from benchlab.workflows.control_flex import calibrate_flex_sensor

    found = calibrate_flex_sensor(run, angle, calibration, out, angle_starts_s, overwrite)
    gain, offset, fit = found["gain_deg_per_V"], found["offset_deg"], found["lack_of_fit"]
    percent = 100 * found["confidence"]
    _say(f"angle = gain · volts + offset, from {counted(found['holds'], 'hold')}; R² {found['r_squared']:.5f}")
    for name, value, unit in (("gain", gain, "°/V"), ("offset", offset, "°")):
        ends = f"{value['low']:.5g} to {value['high']:.5g}"
        _say(f"  {name} {value['value']:.5g} {unit} ({percent:.0f} %: {ends})")
    _say(
        f"  one sample scatters about the line by {found['sd_deg']:.2f}°, a mean of a hold by {found['sd_of_holds_deg']:.2f}°"
    )
    lack = (
        f"; lack of fit F{tuple(fit['df'])} = {fit['F']:.3g}, p {fit['p']:.2g}" if fit else "; no level was held twice"
    )
    _say(f"  straight? bow {found['bow_deg']['value']:+.2f}°, p {_p(found['bow_p'])}{lack}")
    if found["hysteresis_deg"] is not None:
        most = found["hysteresis_max_deg"]
        _say(f"  falling less rising: {found['hysteresis_deg']:+.2f}° on the average, {most:.2f}° at most")
    _tell_replaced(found["replaced"], calibration.name)
    _tell_files(found, as_json)


@control.command(short_help="Gains from an identification run, with their margins.")
@click.argument("run", metavar="RUN.h5", type=click.Path(path_type=Path))
@click.option(
    "--out", required=True, type=click.Path(path_type=Path), help="Control file to write, for `benchlab run --control`."
)
@click.option(
    "--max-sensitivity",
    type=Finite(),
    default=1.6,
    show_default=True,
    help="Ms that gains keep at every operating point: 1.4 is cautious, 2 is fast.",
)
@click.option(
    "--closed-loop-s", type=Finite("S"), help="Closed-loop time as you wish it. [default: the shortest that is safe]"
)
@click.option(
    "--feed-forward",
    is_flag=True,
    help="Also use the inverse response curve: --design or --curve of the run; a twin has one of its own.",
)
@click.option("--overwrite", is_flag=True, help="Replace an existing file.")
@click.option("--json", "as_json", is_flag=True, help="One JSON document on standard output.")
def tune(run: Path, out: Path, overwrite: bool, as_json: bool, **options: Any) -> None:
    """Identify gain, lag and dead time from commanded pressure to bending angle at each step of an open-loop run, and write PI gains for
    them by the SIMC rule (Skogestad 2003): the fastest with which the sensitivity Ms keeps under --max-sensitivity at every one.

    \b
    Examples:
      benchlab control tune results/steps.h5 --out control.yaml
      benchlab control tune results/steps.h5 --out control.yaml --feed-forward
    """
    from benchlab.workflows.control_tune import tune_from_run

    found = tune_from_run(run, out, overwrite=overwrite, **options)
    _tell_plants(found)
    _tell_files(found, as_json)


@control.command(short_help="How well a closed-loop run tracked: figures, picture.")
@click.argument("run", metavar="RUN.h5", type=click.Path(path_type=Path))
@click.option("--out", required=True, type=click.Path(path_type=Path), help="Folder for RUN.tracking.json and .png.")
@click.option("--settle-s", type=Finite("S"), default=5.0, show_default=True, help="Left out at the beginning.")
@click.option(
    "--length-mm", type=Finite("MM"), default=180.0, show_default=True, help="Of the arc, for the tip's position."
)
@click.option(
    "--truth", type=click.Path(path_type=Path), help="True angle of a twin: a table with time_s and angle_deg."
)
@click.option("--overwrite", is_flag=True, help="Replace existing files.")
@click.option("--json", "as_json", is_flag=True, help="One JSON document on standard output.")
def track(run: Path, as_json: bool, **options: Any) -> None:
    """Compare the angle of a closed-loop run with its reference: R², RMSE, lag, error of the tip, effort, saturation, and a figure as the
    paper's Fig 8. R² is 1 − Σe²/Σ(r − mean r)².

    \b
    Examples:
      benchlab control track results/sine.h5 --out results
    """
    from benchlab.control.tracking import late_words
    from benchlab.workflows.control_track import track_run

    found = track_run(run, **options)
    for name, words in (("measured", "against the flex sensor"), ("true", "against the truth of the twin")):
        if (one := found[name]) is not None:
            lag = "" if one["lag_s"] is None else f", {late_words(one['lag_s'])}"
            r = "-" if one["r_squared"] is None else f"{one['r_squared']:.4f}"
            _say(
                f"{words}: R² {r}, RMSE {one['rmse_deg']:.2f}°, mean |e| {one['mae_deg']:.2f}°, max {one['max_deg']:.2f}°{lag}; "
                f"tip RMSE {one['tip_rmse_mm']:.2f} mm"
            )
    cost = found["measured"]
    _say(
        f"pressure: peak {cost['peak_MPa']:.4g} MPa, moved by {cost['variation_MPa_per_s']:.3g} MPa/s, at the ceiling "
        f"{100 * cost['at_ceiling']:.1f} %, at zero {100 * cost['at_zero']:.1f} % of the time"
    )
    left = f"; {cost['missing']} without an angle" if cost["missing"] else ""
    _say(f"{cost['samples']} samples after {cost['settle_s']:g} s of settling{left}")
    _tell_files(found, as_json)


def _say(line: str) -> None:
    """A line with numbers on standard error, their minus as it is printed."""
    click.echo(re.sub(r"(?<![\w.])-(?=\d)", "−", line), err=True)


def _tell_replaced(replaced: dict[str, Any] | None, file: str) -> None:
    """What the bench file had until now, where it is changed in place."""
    if replaced is None:
        return
    words = "had no flex line, and has this one now"
    if replaced["gain_deg_per_V"] is not None:
        line = f"{replaced['gain_deg_per_V']:.5g} °/V, {replaced['offset_deg']:.5g}°"
        words = f"had {line}, from {printable(replaced['from'] or 'not told')}; this line is in its place"
    _say(f"  {printable(file)} {words}")


def _p(value: float | None) -> str:
    return "not known" if value is None else f"{value:.2g}"


def _tell_plants(found: dict[str, Any]) -> None:
    from rich.console import Console
    from rich.table import Table

    table = Table("MPa", "", "gain, °/MPa", "lag, s", "dead time, s", "R²", "Ms", box=None, pad_edge=False)
    for plant in found["plants"]:
        cells = [f"{plant['pressure_MPa']:.3f}", {True: "up", False: "down", None: ""}[plant["rises"]]]
        for name, form in (("gain_deg_per_MPa", ".0f"), ("lag_s", ".3f"), ("dead_time_s", ".3f")):
            value = plant[name]
            cells.append(f"{value['value']:{form}} ({value['low']:{form}} to {value['high']:{form}})")
        table.add_row(*cells, f"{plant['r_squared']:.3f}", f"{plant['margins']['max_sensitivity']:.2f}")
    console = Console(stderr=True, highlight=False)
    if not console.is_terminal:
        console.width = 120
    console.print(table)
    worst = found["plants"][found["worst"]]
    margins = worst["margins"]
    _say(
        f"kp {found['kp_MPa_per_deg']:.4g} MPa/°, ki {found['ki_MPa_per_deg_s']:.4g} MPa/(°·s): integral time "
        f"{found['integral_time_s']:.3g} s, closed loop {found['closed_loop_s']:.3g} s; lead {found['lead_s']:.3g} s"
    )
    gain = "infinite" if margins["gain_margin"] is None else f"{margins['gain_margin']:.2f}"
    _say(
        f"worst at {worst['pressure_MPa']:.3f} MPa: gain margin {gain}, phase margin {margins['phase_margin_deg']:.0f}°, "
        f"Ms {margins['max_sensitivity']:.2f}"
    )


def _tell_files(found: dict[str, Any], as_json: bool) -> None:
    for warning in found.get("warnings", []):
        click.echo(f"  warning: {printable(warning)}", err=True)
    for path in found["outputs"]:
        click.echo(f"  wrote {printable(path)}", err=True)
    if as_json:
        click.echo(json.dumps(found, indent=2, allow_nan=False))
