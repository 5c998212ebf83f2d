"""`benchlab protocol`: what a protocol will ask for, without a bench; and which protocols are shipped."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import asdict
from pathlib import Path
from typing import Any

from benchlab.devices.twin.bench import twin_bench
from benchlab.errors import InputError, UsageError, counted
from benchlab.io.files import check_new_file, written_whole
from benchlab.io.plan_table import write_plan_csv
from benchlab.io.protocol_file import protocol_path, read_protocol, shipped_protocols
from benchlab.protocol.overview import Overview, overview
from benchlab.protocol.plan import Plan

SUFFIXES = (".png", ".csv")


def show_protocol(
    protocol: str,
    outs: Sequence[Path] = (),
    max_duration_s: float = 3600.0,
    rate_Hz: float | None = None,
    calibration: Path | None = None,
    overwrite: bool = False,
) -> dict[str, Any]:
    """What `--json` prints of a protocol, after writing it to `outs`, as picture (.png) or table (.csv).

    calibration: of a bench that it has to fit. Raises UsageError and InputError; then nothing was written.
    """
    path = protocol_path(protocol)
    _check_outs(outs, (path, *([calibration] if calibration else [])), overwrite)
    plan = read_protocol(protocol, max_duration_s, rate_Hz)
    bench = _fitting(plan, path, calibration) if calibration else None
    seen = overview(plan)
    for out in outs:
        if out.suffix.lower() == ".csv":
            write_plan_csv(out, plan)
        else:
            _draw(out, plan, seen, bench["ceiling_MPa"] if bench else None)
    return {
        "protocol": str(path),
        "title": plan.title,
        "about": plan.about,
        "duration_s": plan.duration_s,
        "rate_Hz": plan.rate_Hz,
        "samples": len(plan.time_s),
        "limit_MPa": plan.limit_MPa,
        "peak_MPa": seen.peak_MPa,
        "slew_MPa_per_s": seen.slew_MPa_per_s,
        "jumps": {
            "rises": seen.rises,
            "largest_rise_MPa": seen.largest_rise_MPa,
            "falls": seen.falls,
            "largest_fall_MPa": seen.largest_fall_MPa,
        },
        "closed_loop": plan.closed_loop,
        "reference_deg": None if seen.reference_deg is None else list(seen.reference_deg),
        "control": None if plan.control is None else asdict(plan.control),
        "ends_vented": plan.ends_vented,
        "steps": [asdict(step) for step in plan.steps],
        "alike_steps": [asdict(step) for step in seen.steps],
        "events": [asdict(event) for event in plan.events],
        "bench": bench,
        "twin_ceiling_MPa": twin_bench().ceiling_MPa,
        "outputs": [str(out) for out in outs],
    }


def list_protocols() -> list[dict[str, Any]]:
    """Name, title, what for, duration and peak of each shipped protocol."""
    found = []
    for name, path in shipped_protocols().items():
        plan = read_protocol(name)
        seen = overview(plan)
        found.append(
            {
                "name": name,
                "title": plan.title,
                "about": plan.about,
                "duration_s": plan.duration_s,
                "peak_MPa": seen.peak_MPa,
                "reference_deg": None if seen.reference_deg is None else list(seen.reference_deg),
                "file": str(path),
            }
        )
    return found


def summary_line(plan: Plan, seen: Overview) -> str:
    """Duration, samples, peak, slew and jumps in words."""
    parts = [f"{plan.duration_s:g} s", f"{len(plan.time_s):,} samples at {plan.rate_Hz:g} Hz"]
    if seen.peak_MPa:
        parts.append(f"peak {seen.peak_MPa:.4g} MPa")
    if seen.slew_MPa_per_s:
        parts.append(f"slew at most {seen.slew_MPa_per_s:.4g} MPa/s")
    if jumps := seen.rises + seen.falls:
        parts.append(f"{counted(jumps, 'jump')} at once")
    if seen.reference_deg is not None:
        parts.append(f"angle {seen.reference_deg[0]:g}° to {seen.reference_deg[1]:g}°")
    return ", ".join(parts)


def _check_outs(outs: Sequence[Path], inputs: Sequence[Path], overwrite: bool) -> None:
    read = {path.resolve() for path in inputs}
    for index, out in enumerate(outs):
        if out.suffix.lower() not in SUFFIXES:
            raise UsageError("is neither a .png nor a .csv file", file=out, hint="give --out a name that ends in one")
        if out.resolve() in read or out.resolve() in {other.resolve() for other in outs[:index]}:
            raise UsageError(
                "is named twice, or read here, and would be replaced", file=out, hint="choose another --out"
            )
        check_new_file(out, overwrite)


def _fitting(plan: Plan, path: Path, calibration: Path) -> dict[str, Any]:
    """The bench, in few words, if the plan may run on it."""
    from benchlab.io.bench_file import read_bench
    from benchlab.protocol.checks import check_limits

    bench = read_bench(calibration)
    check_limits(plan, bench, path)
    if plan.closed_loop and bench.flex is None:
        what = f"controls the angle, and the flex sensor of bench {bench.name} is not calibrated"
        raise InputError(what, file=path, hint="calibrate it with `benchlab control flex`")
    return {"name": bench.name, "file": str(calibration), "ceiling_MPa": bench.ceiling_MPa}


def _draw(out: Path, plan: Plan, seen: Overview, ceiling_MPa: float | None) -> None:
    from benchlab.report.figures import save_png
    from benchlab.report.protocol_figure import draw_protocol_figure

    figure = draw_protocol_figure(plan, summary_line(plan, seen), ceiling_MPa)
    with written_whole(out) as temporary:
        save_png(figure, temporary)
