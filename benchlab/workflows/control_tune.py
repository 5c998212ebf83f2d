"""`benchlab control tune`: a run in open loop in, gains with their margins out."""

from __future__ import annotations

import math
from dataclasses import asdict
from pathlib import Path
from typing import Any

import numpy as np

import benchlab
from benchlab.control.plant import Identification, identify
from benchlab.control.tuning import MAX_SENSITIVITY, Tuning, tune
from benchlab.errors import InputError, UsageError, counted
from benchlab.io.control_file import control_of_tuning, write_control
from benchlab.io.files import check_new_file, sha256
from benchlab.io.nexus import plain
from benchlab.workflows.driven import DrivenRun, read_driven


def tune_from_run(
    source: Path,
    out: Path,
    *,
    feed_forward: bool,
    closed_loop_s: float | None = None,
    max_sensitivity: float = MAX_SENSITIVITY,
    overwrite: bool = False,
) -> dict[str, Any]:
    """Identify the plant in the open-loop part of a run, find gains and write the control file `out`.

    Returns what was found, as `--json` shows it. Raises UsageError and InputError; then nothing was written.
    """
    if out.suffix.lower() not in (".yaml", ".yml"):
        raise UsageError("is not a .yaml file", file=out, hint="give --out a name that ends in .yaml")
    if not 1.1 <= max_sensitivity <= 5:
        raise UsageError(f"--max-sensitivity is {max_sensitivity:g}", hint="give 1.1 to 5; 1.4 is cautious, 2 is fast")
    if closed_loop_s is not None and not 0 < closed_loop_s <= 1000:
        raise UsageError(f"--closed-loop-s is {closed_loop_s:g}", hint="give more than 0 and at most 1000")
    check_new_file(out, overwrite)
    run = read_driven(source)
    if run.bench.flex is None:
        hint = "calibrate it with `benchlab control flex`, and run again"
        raise InputError("was made without a calibrated flex sensor: it has volts and no angle", file=source, hint=hint)
    angle = np.where(np.isnan(run.column("reference_deg")), run.column("angle_deg"), np.nan)
    try:
        found = identify(run.column("time_s"), run.column("command_MPa"), angle)
        plants = [plant.cautious for plant in found.plants]
        tuning = tune(plants, run.rate_Hz, closed_loop_s, max_sensitivity)
    except InputError as error:
        raise InputError(error.what, file=source, where=error.where, hint=error.hint) from error
    origin = f"{source.name}, sha256 {sha256(source)}" + ("; simulated" if run.simulated else "")
    control = control_of_tuning(
        tuning,
        [p.pressure_MPa for p in found.plants],
        plants,
        feed_forward=feed_forward,
        rate_Hz=run.rate_Hz,
        source=origin,
    )
    write_control(out, control, _comment(found, tuning, max_sensitivity))
    return _summary(found, tuning, run, feed_forward, out)


def _comment(found: Identification, tuning: Tuning, max_sensitivity: float) -> str:
    worst = tuning.margins[tuning.worst]
    return "\n".join(
        [
            f"Written by benchlab {benchlab.__version__} control tune: SIMC (Skogestad 2003), fastest with Ms up to {max_sensitivity:g}.",
            f"{len(found.plants)} operating points by {found.method}; the worst has gain margin {worst.gain_margin:.3g}, "
            f"phase margin {worst.phase_margin_deg:.1f}°, Ms {worst.max_sensitivity:.3g}.",
        ]
    )


def _summary(found: Identification, tuning: Tuning, run: DrivenRun, feed_forward: bool, out: Path) -> dict[str, Any]:
    summary: Any = plain(
        {
            "run": str(run.path),
            "simulated": run.simulated,
            "method": found.method,
            "plants": [
                {**asdict(plant), "margins": asdict(margin)} for plant, margin in zip(found.plants, tuning.margins)
            ],
            "left_out": found.left_out,
            "kp_MPa_per_deg": tuning.kp_MPa_per_deg,
            "ki_MPa_per_deg_s": tuning.ki_MPa_per_deg_s,
            "integral_time_s": tuning.kp_MPa_per_deg / tuning.ki_MPa_per_deg_s,
            "closed_loop_s": tuning.closed_loop_s,
            "lead_s": tuning.lead_s,
            "feed_forward": feed_forward,
            "worst": tuning.worst,
            "warnings": _warnings(found),
            "outputs": [out],
        }
    )
    return dict(summary)


def _warnings(found: Identification) -> list[str]:
    warnings = list(found.left_out)
    gains = [p.gain_deg_per_MPa.value for p in found.plants]
    if max(gains) > 4 * min(gains):
        warnings.append(
            f"the gain falls from {max(gains):.0f} to {min(gains):.0f} °/MPa: a PI that is safe where it is largest is slow where it is "
            "least; feed-forward makes up for that"
        )
    if found.method == "sweep":
        warnings.append("found from a sweep: the actuator's loop is in the lag; steps between holds tell more")
    wide = [p for p in found.plants if math.isfinite(p.lag_s.high) and p.lag_s.high > 2 * p.lag_s.low]
    if wide:
        warnings.append(
            f"at {counted(len(wide), 'operating point')} the interval of the lag spans more than a factor of 2"
        )
    return warnings
