"""`benchlab sweep`: all combinations of some dimensions, simulated; curves, table and figure out."""

from __future__ import annotations

import functools
import itertools
import time
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any

import numpy as np

from benchlab.actuator import DIMENSIONS, ShellDesign
from benchlab.errors import BenchlabError, UsageError
from benchlab.io.files import sha256
from benchlab.io.published import published_angles
from benchlab.io.sweep_file import CURVES, Sweep, read_earlier_sweep, write_sweep_csv, write_sweep_file
from benchlab.workflows.cluster import run_anywhere
from benchlab.workflows.outputs import Outputs
from benchlab.workflows.provenance import made_by
from benchlab.workflows.simulated import Conditions, simulate_design

MOST_DESIGNS = 20_000
SAVE_EVERY_S = 30.0
"""What is done is saved so often, marked partial, and is not simulated again by a next run."""

_NOT_YET = "not simulated yet"

Progress = Callable[[int, int | None], None]


@dataclass(frozen=True)
class SweepOutputs(Outputs):
    """Files of a sweep; the ones before are vouched for by its own HDF5 file."""

    def _written_before(self) -> dict[str, str]:
        earlier = read_earlier_sweep(self.run_file)
        return {} if earlier is None else {self.run_file.name: "any", **earlier.provenance.get("outputs_sha256", {})}


@dataclass
class _Progressing:
    """Results of designs by their key, and why others have none."""

    keys: list[str]
    results: dict[str, dict[str, Any]] = field(default_factory=dict)
    errors: dict[str, BenchlabError] = field(default_factory=dict)


def sweep(
    axes: Mapping[str, tuple[float, ...]],
    conditions: Conditions,
    out: Path,
    *,
    jobs: int = 1,
    scheduler: str | None = None,
    overwrite: bool = False,
    progress: Progress | None = None,
) -> dict[str, Any]:
    """Simulate all combinations of `axes` (names of DIMENSIONS -> values in mm) and write STEM.h5, .csv and .png into `out`.

    Designs that an earlier, even interrupted, run wrote there with the same conditions and code are not simulated again. A design
    that cannot be made or simulated is a row with its reason. Returns what was found, as `--json` shows it.

    Raises UsageError and InputError, also where no design at all can be simulated; BatchError where a cluster is lost, and
    KeyboardInterrupt, after what is done has been written as partial.
    """
    started = time.monotonic()
    designs = _designs(axes)
    outputs = SweepOutputs(out, _stem(axes), overwrite)
    outputs.check(overlay=False, inputs=())
    with outputs.locked():
        done = _Progressing([conditions.key(d) if isinstance(d, ShellDesign) else "" for d in designs])
        _take_over(outputs.run_file, done, overwrite)
        reused = len(done.results)
        partial = True
        try:
            _simulate(
                designs,
                conditions,
                done,
                jobs,
                scheduler,
                progress,
                lambda: _save(axes, designs, conditions, done, outputs, True),
            )
            partial = False
        finally:
            if done.results:
                found = _save(axes, designs, conditions, done, outputs, partial)
    if not done.results:
        raise next(error for error in map(_failure, designs, map(done.errors.get, done.keys)) if error)
    failed = [_failure(design, done.errors.get(key)) for design, key in zip(designs, done.keys)]
    return {
        **_summary(found, outputs),
        "reused": reused,
        "failed": [error.as_json()["error"] for error in failed if error],
        "seconds": round(time.monotonic() - started, 3),
    }


def simulated_sweep(axes: Mapping[str, tuple[float, ...]], conditions: Conditions) -> Sweep:
    """All combinations of `axes` as `sweep` simulates them, without a file. Raises UsageError where there is no design at all."""
    designs = _designs(axes)
    done = _Progressing([conditions.key(d) if isinstance(d, ShellDesign) else "" for d in designs])
    _simulate(designs, conditions, done, 1, None, None, lambda: None)
    return _assembled(axes, designs, conditions, done, False)


def _designs(axes: Mapping[str, tuple[float, ...]]) -> list[ShellDesign | BenchlabError]:
    """Each combination as a design, or the error that it is none. Raises the first error where there is no design at all."""
    count = int(np.prod([len(values) for values in axes.values()]))
    if count > MOST_DESIGNS:
        raise UsageError(f"{count} designs, more than the limit of {MOST_DESIGNS}", hint="take larger steps")
    found: list[ShellDesign | BenchlabError] = []
    for combination in itertools.product(*axes.values()):
        try:
            found.append(ShellDesign(**dict(zip((DIMENSIONS[name] for name in axes), combination))))
        except BenchlabError as error:
            found.append(error)
    errors = [item for item in found if isinstance(item, BenchlabError)]
    if len(errors) == len(found):
        raise errors[0]
    return found


def _stem(axes: Mapping[str, tuple[float, ...]]) -> str:
    """`sweep_tw3_slw1-30`: fields that differ from the paper's, with their ends."""
    parts = []
    for name, values in axes.items():
        if values != (getattr(ShellDesign, DIMENSIONS[name], None),):
            ends = f"{values[0]:g}" + (f"-{values[-1]:g}" if len(values) > 1 else "")
            parts.append(name.removesuffix("_mm") + ends)
    return "_".join(["sweep", *parts])


def _take_over(path: Path, done: _Progressing, overwrite: bool) -> None:
    """Results of an earlier run, where their key says that they are the same."""
    earlier = None if overwrite else read_earlier_sweep(path)
    if earlier is None:
        return
    wanted = set(done.keys) - {""}
    for index, key in enumerate(earlier.key):
        if key in wanted:
            limit = float(earlier.designs["limit_pressure_MPa"][index])
            columns = {name: curve[index] for name, curve in earlier.curves.items()}
            done.results[key] = {"columns": columns, "limit_pressure_MPa": None if np.isnan(limit) else limit}


def _simulate(
    designs: Sequence[ShellDesign | BenchlabError],
    conditions: Conditions,
    done: _Progressing,
    jobs: int,
    scheduler: str | None,
    progress: Progress | None,
    save: Callable[[], object],
) -> None:
    keys = {design: key for design, key in zip(designs, done.keys) if isinstance(design, ShellDesign)}
    left = [design for design, key in keys.items() if key not in done.results]
    if not left:
        return
    saved = time.monotonic()
    for outcome in run_anywhere(left, functools.partial(simulate_design, conditions=conditions), jobs, scheduler):
        if outcome.result is not None:
            done.results[keys[outcome.item]] = outcome.result
        elif outcome.error is not None:
            done.errors[keys[outcome.item]] = outcome.error
        if progress:
            progress(
                len(keys) - len(left) + sum(keys[d] in done.results or keys[d] in done.errors for d in left), len(keys)
            )
        if time.monotonic() - saved > SAVE_EVERY_S:
            save()
            saved = time.monotonic()


def _save(
    axes: Mapping[str, tuple[float, ...]],
    designs: Sequence[ShellDesign | BenchlabError],
    conditions: Conditions,
    done: _Progressing,
    outputs: SweepOutputs,
    partial: bool,
) -> Sweep:
    """Write table, figure and the file that vouches for them, all or none."""
    from benchlab.report.figures import save_png
    from benchlab.report.sweep_figure import draw_sweep_figure

    found = _assembled(axes, designs, conditions, done, partial)
    with outputs.staged() as stage:
        write_sweep_csv(stage.table, found)
        title = f"Simulated sweep over {', '.join(name.removesuffix('_mm') for name in found.varied) or 'one design'}"
        save_png(draw_sweep_figure(found, published_angles(), title), stage.figure)
        digests = {path.name: sha256(path) for path in (stage.table, stage.figure)}
        found = replace(found, provenance={**found.provenance, "outputs_sha256": digests})
        write_sweep_file(stage.run_file, found)
    return found


def _assembled(
    axes: Mapping[str, tuple[float, ...]],
    designs: Sequence[ShellDesign | BenchlabError],
    conditions: Conditions,
    done: _Progressing,
    partial: bool,
) -> Sweep:
    shape = (len(designs), len(conditions.pressures_MPa))
    curves = {name: np.full(shape, np.nan) for name in CURVES}
    limits, areas = np.full(len(designs), np.nan), np.full(len(designs), np.nan)
    reasons, keys = [], []
    for index, (design, key) in enumerate(zip(designs, done.keys)):
        result = done.results.get(key)
        areas[index] = design.tpu_area_mm2 if isinstance(design, ShellDesign) else np.nan
        keys.append(key if result else "")
        error = _failure(design, done.errors.get(key))
        reasons.append(str(error) if error else "" if result else _NOT_YET)
        if result:
            for name in CURVES:
                curves[name][index] = result["columns"][name]
            if (limit := result["limit_pressure_MPa"]) is not None:
                limits[index] = limit
                reasons[-1] = f"no stable state beyond {limit:.4g} MPa: it bursts"
    settings = {"axes": {name: list(values) for name, values in axes.items()}, **conditions.as_json()}
    return Sweep(axes, np.array(conditions.pressures_MPa), curves, {"tpu_area_mm2": areas, "limit_pressure_MPa": limits},
                 tuple(reasons), tuple(keys), settings, made_by("numpy", "scipy"), partial)  # fmt: skip


def _failure(design: ShellDesign | BenchlabError, error: BenchlabError | None) -> BenchlabError | None:
    return design if isinstance(design, BenchlabError) else error


def _summary(found: Sweep, outputs: SweepOutputs) -> dict[str, Any]:
    """Largest angle at the last pressure, who bursts, and the files."""
    last = found.curves["angle_deg"][:, -1]
    best = None
    if np.isfinite(last).any():
        index = int(np.nanargmax(last))
        best = {**dict(zip(found.axes, found.combinations()[index])), "angle_deg": float(last[index])}
    limits = found.designs["limit_pressure_MPa"]
    return {
        "designs": len(last),
        "simulated": sum(map(bool, found.key)),
        "pressure_MPa": found.pressure_MPa.tolist(),
        "largest_angle": best,
        "bursting": [
            {**dict(zip(found.axes, combination)), "limit_pressure_MPa": float(limit)}
            for combination, limit in zip(found.combinations(), limits)
            if np.isfinite(limit)
        ],
        "points": _points(found),
        "outputs": [str(path) for path in (outputs.run_file, outputs.table, outputs.figure)],
    }


def _points(found: Sweep) -> list[dict[str, Any]]:
    """Each design with its curves, null where there is no value."""
    return [
        {
            **dict(zip(found.axes, combination)),
            **{name: [None if np.isnan(v) else float(v) for v in curve[index]] for name, curve in found.curves.items()},
            "reason": found.reason[index] or None,
        }
        for index, combination in enumerate(found.combinations())
    ]
