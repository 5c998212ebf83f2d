"""`benchlab design`: which window and strip widths bend to an angle; the choice and its trade-offs out."""

from __future__ import annotations

import functools
import math
import time
from collections.abc import Callable, Sequence
from dataclasses import asdict, replace
from pathlib import Path
from typing import Any

import numpy as np

from benchlab.actuator import ShellDesign
from benchlab.errors import BenchlabError, InputError, UsageError
from benchlab.simulation import inverse
from benchlab.workflows.cluster import run_anywhere
from benchlab.workflows.design_outputs import PREFERENCES, design_paths, write_designs
from benchlab.workflows.design_wish import SLW, TW, AngleMap, Wish
from benchlab.workflows.simulated import Conditions, simulate_design

ROUNDED_MM = 0.01
TOLERANCE_DEG = 0.5
"""A design found is rounded to ROUNDED_MM and simulated again; it is left out where that is further from the angle."""

CUT_ERROR_MM = 0.1
_SLOPE_STEP_MM = 0.25  # less, and the steps of the mesh are seen

Progress = Callable[[int, int | None], None]


def design(
    wish: Wish,
    conditions: Conditions,
    out: Path,
    *,
    jobs: int = 1,
    scheduler: str | None = None,
    overwrite: bool = False,
    progress: Progress | None = None,
) -> dict[str, Any]:
    """Find designs that bend to an angle at the last pressure of `conditions`, and write a table, a figure and the best of them.

    Returns what was found, as `--json` shows it. Raises UsageError where the angle (or the force) is not reached, with the
    largest that is; InputError where the disk refuses.
    """
    started = time.monotonic()
    paths = design_paths(out, wish, overwrite)
    run = functools.partial(_run, jobs=jobs, scheduler=scheduler, progress=progress)
    angles = _map(wish, conditions, run)
    places = [
        (float(line), bracket)
        for line, (x, y) in zip(angles.lines, angles.refined)
        for bracket in inverse.brackets(x, y, wish.angle_deg)
    ]
    if not places:
        raise _unreached(wish, conditions, angles)
    found = [c for c in run(places, functools.partial(_candidate, wish=wish, conditions=conditions)) if c]
    candidates = sorted(found, key=lambda c: (c["tw_mm"], c["slw_mm"]))
    if not candidates:
        raise UsageError(
            "no design found holds its angle when simulated again", hint="take another --material or range"
        )
    enough = _check_force(wish, conditions, candidates)
    best = {name: enough[row] for name, row in _best(candidates, enough).items()}
    write_designs(wish, conditions, angles, candidates, best, paths)
    return {
        "angle_deg": wish.angle_deg,
        "pressure_MPa": conditions.pressures_MPa[-1],
        "force_N": wish.force_N,
        "fixture": str(conditions.fixture),
        "material": conditions.layup.name,
        "base": asdict(wish.base),
        "largest_angle": _extreme(wish, angles, np.nanargmax),
        "candidates": candidates,
        "best": best,
        "outputs": [str(path) for name, path in paths.items() if name in ("table", "figure") or name in best],
        "seconds": round(time.monotonic() - started, 3),
    }


def _run(
    items: Sequence[Any],
    work: Callable[[Any], dict[str, Any]],
    jobs: int,
    scheduler: str | None,
    progress: Progress | None,
) -> list[dict[str, Any] | None]:
    """Results in the order of the items; None for those that failed. Raises the first error where all did."""
    results: dict[Any, dict[str, Any] | None] = {}
    errors: list[BenchlabError] = []
    for outcome in run_anywhere(items, work, jobs, scheduler):
        results[outcome.item] = outcome.result
        if outcome.error:
            errors.append(outcome.error)
        if progress:
            progress(len(results), len(items))
    if errors and len(errors) == len(items):
        raise errors[0]
    return [results[item] for item in items]


def _angle(point: ShellDesign, conditions: Conditions) -> dict[str, Any]:
    """`angle_deg` at the last pressure, NaN where it bursts before."""
    found = simulate_design(point, replace(conditions, blocked=False))
    return {"angle_deg": float(found["columns"]["angle_deg"][-1])}


def _map(wish: Wish, conditions: Conditions, run: Callable[..., list[dict[str, Any] | None]]) -> AngleMap:
    lines, nodes = np.array(wish.lines()), wish.nodes()
    work = functools.partial(_angle, conditions=conditions)

    def angles_of(points: list[tuple[float, float]]) -> np.ndarray:
        found = run([wish.design(float(a), float(b)) for a, b in points], work) if points else []
        return np.array([np.nan if f is None else f["angle_deg"] for f in found])

    grid = angles_of([(a, b) for a in lines for b in nodes]).reshape(len(lines), len(nodes))
    peaks = [(line, inverse.spline_peak(nodes, row)) for line, row in zip(lines, grid)]
    wanted = [(float(line), peak) for line, peak in peaks if peak is not None]
    more = dict(zip([line for line, _ in wanted], zip([p for _, p in wanted], angles_of(wanted))))
    refined = []
    for line, row in zip(lines, grid):
        x, y = nodes, row
        if line in more:
            place = int(np.searchsorted(nodes, more[line][0]))
            x, y = np.insert(nodes, place, more[line][0]), np.insert(row, place, more[line][1])
        refined.append((x, y))
    return AngleMap(lines, nodes, grid, tuple(refined))


def _candidate(place: tuple[float, inverse.Bracket], wish: Wish, conditions: Conditions) -> dict[str, Any]:
    """The design in a bracket, by simulation; rounded, and simulated again with its neighbours and held straight."""
    line, bracket = place

    def at(point: ShellDesign) -> float:
        return _angle(point, conditions)["angle_deg"]

    solved = inverse.solve_bracket(
        lambda x: at(wish.design(line, x)), bracket, wish.angle_deg, tolerance=ROUNDED_MM / 2
    )
    point = wish.design(line, round(solved / ROUNDED_MM) * ROUNDED_MM)
    point = replace(point, **{wish.along: round(getattr(point, wish.along), 6)})
    columns = simulate_design(point, conditions)["columns"]
    angle = float(columns["angle_deg"][-1])
    if not abs(angle - wish.angle_deg) <= TOLERANCE_DEG:
        raise InputError(f"{point.name} bends {angle:.2f} deg when rounded, {wish.angle_deg:g} are wanted")
    slopes = {name: _slope(at, point, field) for name, field in (("tw", TW), ("slw", SLW))}
    return _plain(
        {
            "tw_mm": point.window_width_mm,
            "slw_mm": point.strip_width_mm,
            "angle_deg": angle,
            "volume_mL": columns["volume_mL"][-1],
            "blocked_force_N": columns["blocked_force_N"][-1],
            "peak_film_strain": columns["peak_film_strain"][-1],
            "dangle_dtw_deg_per_0_1mm": slopes["tw"],
            "dangle_dslw_deg_per_0_1mm": slopes["slw"],
            "cut_error_deg": math.hypot(*slopes.values()),
            "whole_windows": point.whole_windows,
            "end_margin_mm": point.end_margin_mm,
            "tpu_area_mm2": point.tpu_area_mm2,
        }
    )


def _slope(at: Callable[[ShellDesign], float], point: ShellDesign, field: str) -> float:
    """Change of the angle by CUT_ERROR_MM in one dimension."""
    value = getattr(point, field)
    step = min(_SLOPE_STEP_MM, value / 4, (point.perimeter_mm - point.strip_width_mm) / 4)
    return CUT_ERROR_MM * inverse.central_slope(lambda x: at(replace(point, **{field: x})), value, step)


def _plain(row: dict[str, Any]) -> dict[str, Any]:
    return {k: v if isinstance(v, int) else float(v) if math.isfinite(v) else None for k, v in row.items()}


def _check_force(wish: Wish, conditions: Conditions, candidates: list[dict[str, Any]]) -> list[int]:
    """Indices of the candidates that reach the force. Raises UsageError where none does."""
    for row in candidates:
        row["reaches_force"] = wish.force_N is None or (row["blocked_force_N"] or 0.0) >= wish.force_N
    enough = [index for index, row in enumerate(candidates) if row["reaches_force"]]
    if not enough:
        most = max(candidates, key=lambda row: row["blocked_force_N"] or 0.0)
        raise UsageError(
            f"designs that bend {wish.angle_deg:g} deg at {conditions.pressures_MPa[-1]:g} MPa push with up to "
            f"{most['blocked_force_N'] or math.nan:.1f} N (tw {most['tw_mm']:g}, slw {most['slw_mm']:g} mm, {conditions.fixture}), not "
            f"{wish.force_N:g} N",
            hint="raise --pressure-MPa or --perimeter-mm, or state the fixture of your bench",
        )
    return enough


def _best(candidates: list[dict[str, Any]], enough: list[int]) -> dict[str, int]:
    signs = {"cut_error_deg": 1, "volume_mL": 1, "blocked_force_N": -1, "peak_film_strain": 1}
    costs = np.array(
        [[math.nan if (v := candidates[i][name]) is None else sign * v for name, sign in signs.items()] for i in enough]
    )
    return inverse.best_rows(costs, tuple(PREFERENCES))


def _extreme(wish: Wish, angles: AngleMap, which: Callable[[np.ndarray], Any]) -> dict[str, float]:
    """The largest (or smallest) true angle that was seen, and where."""
    rows = [(line, x, y) for line, (xs, ys) in zip(angles.lines, angles.refined) for x, y in zip(xs, ys)]
    line, x, angle = rows[int(which(np.array([row[2] for row in rows])))]
    point = wish.design(float(line), float(x))
    return {"tw_mm": point.window_width_mm, "slw_mm": point.strip_width_mm, "angle_deg": float(angle)}


def _unreached(wish: Wish, conditions: Conditions, angles: AngleMap) -> UsageError:
    if not np.isfinite(angles.angle_deg).any():
        return UsageError(
            f"every design in the range bursts before {conditions.pressures_MPa[-1]:g} MPa",
            hint="take a lower --pressure-MPa",
        )
    low, high = _extreme(wish, angles, np.nanargmin), _extreme(wish, angles, np.nanargmax)
    at = f"{conditions.pressures_MPa[-1]:g} MPa"

    def where(end: dict[str, float]) -> str:
        return f"{end['angle_deg']:.1f} deg at tw {end['tw_mm']:.2f}, slw {end['slw_mm']:.2f} mm"

    if wish.angle_deg > high["angle_deg"]:
        active = wish.base.length_mm - 2 * conditions.cap_mm
        longer = math.ceil(active * wish.angle_deg / high["angle_deg"] + 2 * conditions.cap_mm)
        hint = f"raise --pressure-MPa, or widen the ranges, or make it longer (the angle grows with the length: --length-mm {longer})"
        return UsageError(f"no design bends {wish.angle_deg:g} deg at {at}; the largest is {where(high)}", hint=hint)
    if wish.angle_deg < low["angle_deg"]:
        hint = "lower --pressure-MPa, or widen the ranges"
        return UsageError(
            f"every design bends more than {wish.angle_deg:g} deg at {at}; the least is {where(low)}", hint=hint
        )
    what = f"no line that was tried passes {wish.angle_deg:g} deg at {at}; seen are {where(low)} to {where(high)}"
    return UsageError(what, hint="give more values to the dimension that is a list, or a range for both")
