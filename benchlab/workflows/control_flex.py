"""`benchlab control flex`: the flex sensor's line from a run and the angle seen in it, into the bench file."""

from __future__ import annotations

from dataclasses import asdict, replace
from pathlib import Path
from typing import Any

import numpy as np

from benchlab.bench import Line
from benchlab.control.alongside import lay_alongside
from benchlab.control.flex import FlexCalibration, calibrate_flex
from benchlab.errors import UsageError, counted
from benchlab.io.angle_series import read_angle_series
from benchlab.io.bench_file import BenchFile, read_bench_file, write_bench_file
from benchlab.io.drive_file import trigger_times_s
from benchlab.io.files import cannot_write, check_new_file, sha256, written_whole
from benchlab.io.nexus import plain
from benchlab.report.figures import save_png
from benchlab.report.flex_figure import draw_flex_figure
from benchlab.workflows.driven import DrivenRun, read_driven

NOT_STRAIGHT = 0.01
"""Under this p of a test the sensor is told not to be straight."""

LATE_S = 0.5
"""An angle that is later or earlier than the volts by more is told: the second half of a hold may be another hold's."""


def calibrate_flex_sensor(
    source: Path, angle: Path, calibration: Path, out: Path | None, angle_starts_s: float | None, overwrite: bool
) -> dict[str, Any]:
    """Fit the line and write it into the bench file `out` (default: `calibration` itself, if it has no flex line yet),
    with a picture of its name beside it.

    angle_starts_s: time of the run at which the angle's time is 0; None: the run's one trigger of the camera for a film, and 0 for
    a table, which is on the run's clock. Returns what was found, as `--json` shows it. Raises UsageError and InputError; then
    nothing was written.
    """
    run = read_driven(source)
    file = read_bench_file(calibration)
    target = out or calibration
    picture = target.with_suffix(".flex.png")
    starts, how = _starts(run, angle, angle_starts_s)
    seen = read_angle_series(angle)
    found = calibrate_flex(
        run.column("time_s"), run.column("command_MPa"), run.column("flex_V"), seen.time_s + starts, seen.angle_deg
    )
    check_new_file(target, overwrite or (target == calibration and file.bench.flex is None))
    check_new_file(picture, overwrite)
    origin = f"{source.name} (sha256 {sha256(source)[:16]}) and angles of {angle.name} (sha256 {sha256(angle)[:16]})"
    origin += "; simulated" if run.simulated else ""
    bench = replace(file.bench, flex=_short(found.bench_line))
    figure = draw_flex_figure(
        found,
        f"Flex sensor of {bench.name}{', simulated' if run.simulated else ''}",
        f"{run.bench_words}; run {source.name}, angles {angle.name}",
    )
    with written_whole(picture) as temporary:
        try:
            save_png(figure, temporary)
        except OSError as error:
            raise cannot_write(error, picture) from error
        write_bench_file(target, BenchFile(bench, file.readings, origin), _comment(found))
    late_s = lay_alongside(run.column("time_s"), run.column("flex_V"), seen.time_s + starts, seen.angle_deg).late_s
    summary = _summary(found, run, starts, how, _warnings(found, run, file, late_s), [target, picture])
    return {**summary, "replaced": _replaced(file.bench.flex, file.flex_from) if target == calibration else None}


def _starts(run: DrivenRun, angle: Path, told: float | None) -> tuple[float, str]:
    if told is not None:
        return told, "as told"
    if angle.suffix.lower() != ".h5":
        return 0.0, "the run's own clock"
    triggers = trigger_times_s(run.journal)
    if len(triggers) != 1:
        raise UsageError(
            f"the run has {len(triggers)} triggers of the camera: when did the film begin?",
            file=run.path,
            hint="give --angle-starts-s, the time of the run at the film's first frame",
        )
    return float(triggers[0]), "the run's trigger of the camera"


def _short(line: Line) -> Line:
    """To seven digits, which is finer than any volt."""
    return Line(*(float(f"{value:.7g}") for value in (line.gain, line.offset, line.sd)))


def _replaced(line: Line | None, origin: str) -> dict[str, Any]:
    """The flex line that the bench file had, None each where it had none."""
    if line is None:
        return {"gain_deg_per_V": None, "offset_deg": None, "from": None}
    return {"gain_deg_per_V": line.gain, "offset_deg": line.offset, "from": origin or None}


def _warnings(found: FlexCalibration, run: DrivenRun, file: BenchFile, late_s: float) -> list[str]:
    warnings = []
    if abs(late_s) > LATE_S:
        way = "later" if late_s > 0 else "earlier"
        warnings.append(
            f"the angle is {abs(late_s):.2f} s {way} than the volts: is it on the run's clock (--angle-starts-s)?"
        )
    if found.left_out:
        warnings.append(f"{counted(found.left_out, 'hold')} without volts or angle left out; {len(found.volts)} used")
    if run.bench.name != file.bench.name:
        warnings.append(f"the run was made on bench {run.bench.name}, and the file is of bench {file.bench.name}")
    tests = {"a bow": found.line.bow_p, "lack of fit": found.lack_of_fit.p if found.lack_of_fit else np.nan}
    for name, p in tests.items():
        if p < NOT_STRAIGHT:
            warnings.append(
                f"the sensor is not quite straight: {name} with p {max(p, 1e-13):.2g}; the middle stands "
                f"{abs(found.line.bow.value):.2f}° off the line through the ends"
            )
    span = float(np.ptp(found.angle_deg))
    if abs(found.hysteresis_deg) > 0.02 * span:
        warnings.append(f"falling and rising differ by {found.hysteresis_deg:.2f}°, more than 2 % of {span:.0f}°")
    return warnings


def _summary(
    found: FlexCalibration, run: DrivenRun, starts: float, how: str, warnings: list[str], outputs: list[Path]
) -> dict[str, Any]:
    summary: Any = plain(
        {
            "run": str(run.path),
            "simulated": run.simulated,
            "holds": len(found.volts),
            "angle_starts_s": starts,
            "angle_starts_by": how,
            "gain_deg_per_V": asdict(found.line.gain),
            "offset_deg": asdict(found.line.offset),
            "confidence": found.line.confidence,
            "sd_deg": found.sd_deg,
            "sd_of_holds_deg": found.line.sd,
            "sd_of_samples_deg": found.sample_sd_deg,
            "r_squared": found.line.r_squared,
            "bow_deg": asdict(found.line.bow),
            "bow_p": found.line.bow_p,
            "lack_of_fit": None if found.lack_of_fit is None else asdict(found.lack_of_fit),
            "hysteresis_deg": found.hysteresis_deg,
            "hysteresis_max_deg": found.hysteresis_max_deg,
            "points": [
                {"pressure_MPa": p, "volts": v, "angle_deg": a, "residual_deg": r}
                for p, v, a, r in zip(found.pressure_MPa, found.volts, found.angle_deg, found.residual_deg)
            ],
            "warnings": warnings,
            "outputs": outputs,
        }
    )
    return dict(summary)


def _comment(found: FlexCalibration) -> str:
    gain = found.line.gain
    return f"flex: by benchlab control flex, {len(found.volts)} holds; gain with 95 % interval {gain.low:.5g} to {gain.high:.5g} °/V"
