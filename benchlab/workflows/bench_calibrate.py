"""`benchlab bench calibrate`: gauge readings in, a bench file out."""

from __future__ import annotations

import datetime
import math
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

import benchlab
from benchlab.bench import LABEL_CEILING_SHARE, NOMINAL_GAIN_MPA_PER_V, PAPER_LIMIT_MPA, Bench, Line
from benchlab.control.regulator_line import RegulatorFit
from benchlab.control.straight_line import Interval
from benchlab.errors import InputError, UsageError, printable
from benchlab.io.bench_file import BenchFile, is_simulated, limit_notes, read_bench_file, write_bench_file
from benchlab.io.files import check_new_file, written_whole
from benchlab.io.gauge_readings import GaugeReading, fitted
from benchlab.report.bench_figure import draw_bench_figure
from benchlab.report.figures import save_png

COVERED = 0.85
"""Part of the limit that the readings should reach: what is above them is extrapolated, and told."""

FARTHEST, FARTHEST_ABOVE = 1.25, 1.10
"""A limit may be so many times the highest reading, which a new bench on 4.5 V reaches; and the second where it is above the paper's."""


@dataclass(frozen=True)
class CalibrationSettings:
    """What a bench file says besides its lines. name: of the bench. supply_V: measured with a multimeter. date: ISO.
    full_scale_MPa: at 5 V, as the regulator's label says. reference_counts: of the Nano on that supply, None where it was not asked."""

    name: str
    gauge: str
    supply_V: float
    limit_MPa: float
    date: str
    full_scale_MPa: float = 5 * NOMINAL_GAIN_MPA_PER_V
    reference_counts: float | None = None
    limit_reason: str = ""


def check_calibration_out(out: Path, overwrite: bool) -> None:
    """Raises UsageError where the bench file and its picture could not be written at the end."""
    if out.suffix.lower() not in (".yaml", ".yml"):
        raise UsageError("is not a .yaml file", file=out, hint="give --out a name that ends in .yaml")
    for path in (out, out.with_suffix(".png")):
        check_new_file(path, overwrite)


def calibrate(readings: Sequence[GaugeReading], settings: CalibrationSettings, out: Path) -> dict[str, Any]:
    """Fit the regulator's line, and the monitor's where its volts were read, and write the bench file and a PNG of its name.

    The flex sensor's line of a file that is replaced is kept. Returns what was found, as `--json` shows it. Raises InputError for
    readings that pressure should not rest on; then nothing is written.
    """
    regulator, watched = fitted(readings)
    volts, pressure = np.array([r.volts for r in readings]), np.array([r.pressure_MPa for r in readings])
    rising = np.array([bool(r.rising) for r in readings])
    old = _old(out)
    bench = Bench(
        name=settings.name,
        regulator=_line(regulator),
        monitor=None if watched is None else _line(watched),
        flex=old.bench.flex if old else None,
        limit_MPa=settings.limit_MPa,
        limit_reason=settings.limit_reason,
        full_scale_MPa=settings.full_scale_MPa,
        supply_V=settings.supply_V,
        reference_counts=settings.reference_counts,
        gauge=settings.gauge,
        date=datetime.date.fromisoformat(settings.date).isoformat(),
        calibrated=True,
    )
    _check_reach(float(pressure.max()), bench.limit_MPa)
    warnings = [*limit_notes(bench), *_by_label(bench), *regulator.warnings, *(watched.warnings if watched else ())]
    if pressure.max() < COVERED * bench.limit_MPa:
        warnings.append(
            f"the readings end at {pressure.max():.3f} MPa: up to the limit of {bench.limit_MPa:g} MPa the line is extrapolated"
        )
    if bench.flex is not None and old is not None:
        warnings.append(f"the flex sensor's line is kept from the calibration of {old.bench.date}")
    found = _summary(bench, regulator, watched, readings, warnings, out)
    figure = draw_bench_figure(bench, volts, pressure, rising.tolist(), is_simulated(bench))
    with written_whole(out.with_suffix(".png")) as temporary:
        save_png(figure, temporary)
        write_bench_file(out, BenchFile(bench, tuple(readings), old.flex_from if old else ""), _comment(found))
    return found


def _check_reach(highest_MPa: float, limit_MPa: float) -> None:
    """InputError for a limit that lies too far above what was read."""
    times = FARTHEST if limit_MPa <= PAPER_LIMIT_MPA else FARTHEST_ABOVE
    if limit_MPa > times * highest_MPa:
        raise InputError(
            f"the limit is {limit_MPa:g} MPa, and the highest reading {highest_MPa:.3f} MPa: more than {100 * times - 100:.0f} % beyond "
            "what was read",
            hint=f"give --limit-MPa up to {math.floor(1000 * times * highest_MPa) / 1000:g}, or read higher",
        )


def _by_label(bench: Bench) -> list[str]:
    """That the label, not the readings, decides how many volts are given."""
    share = 100 * (1 - bench.regulator.of(5.0) / bench.full_scale_MPa)
    if bench.ceiling_MPa >= bench.limit_MPa - 1e-9 or share <= 0:
        return []
    return [
        f"the regulator gives {share:.0f} % less than its label says: no more than {bench.ceiling_MPa:.3f} MPa is asked for, "
        f"{100 * LABEL_CEILING_SHARE:g} % above the label's volts"
    ]


def _old(out: Path) -> BenchFile | None:
    """The file that is replaced, where it is one and can be read."""
    try:
        return read_bench_file(out) if out.exists() else None
    except InputError:
        return None


def _line(fit: RegulatorFit) -> Line:
    def rounded(value: float) -> float:
        return float(f"{value:.7g}")

    return Line(rounded(fit.line.gain.value), rounded(fit.line.offset.value), rounded(fit.line.sd))


def _summary(
    bench: Bench,
    regulator: RegulatorFit,
    monitor: RegulatorFit | None,
    readings: Sequence[GaugeReading],
    warnings: Sequence[str],
    out: Path,
) -> dict[str, Any]:
    return {
        "bench": bench.name,
        "date": bench.date,
        "gauge": bench.gauge,
        "supply_V": bench.supply_V,
        "reference_counts": bench.reference_counts,
        "limit_MPa": bench.limit_MPa,
        "ceiling_code": bench.ceiling_code,
        "ceiling_MPa": round(bench.ceiling_MPa, 6),
        "ceiling_V": round(bench.volts(bench.ceiling_code), 4),
        "readings": len(readings),
        "regulator": _fit(regulator),
        "monitor": None if monitor is None else _fit(monitor),
        "warnings": list(warnings),
        "outputs": [str(out), str(out.with_suffix(".png"))],
    }


def _fit(fit: RegulatorFit) -> dict[str, Any]:
    line = fit.line
    return {
        "gain_MPa_per_V": _interval(line.gain),
        "offset_MPa": _interval(line.offset),
        "sd_MPa": line.sd,
        "r_squared": line.r_squared,
        "largest_residual_MPa": float(np.abs(fit.residual_MPa).max()),
        "bow_MPa": _interval(line.bow),
        "bow_p": _or_none(line.bow_p),
        "hysteresis_MPa": _or_none(fit.hysteresis_MPa),
    }


def _interval(found: Interval) -> dict[str, float]:
    return {"value": found.value, "low": found.low, "high": found.high}


def _or_none(value: float) -> float | None:
    return value if math.isfinite(value) else None


def _comment(found: dict[str, Any]) -> str:
    lines = [
        f"Written by benchlab {benchlab.__version__} bench calibrate; for --calibration of benchlab run and benchlab bench.",
        "",
    ]
    for name in ("regulator", "monitor"):
        if (fit := found[name]) is not None:
            gain, offset = fit["gain_MPa_per_V"], fit["offset_MPa"]
            lines.append(
                f"{name}: gain {gain['value']:.5g} MPa/V, 95 % interval {gain['low']:.5g} to {gain['high']:.5g};"
            )
            lines.append(f"  offset {offset['value']:.5f} MPa, {offset['low']:.5f} to {offset['high']:.5f};")
            lines.append(f"  residual sd {fit['sd_MPa']:.5f} MPa, largest {fit['largest_residual_MPa']:.5f} MPa.")
    lines += [printable(warning) for warning in found["warnings"]]
    return "\n".join(lines)
