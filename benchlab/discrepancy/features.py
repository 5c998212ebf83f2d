"""Runs of thousands of points become features of a few dozen: means over intervals of pressure, by direction, cycle and kind of run."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from benchlab.discrepancy.base import Base
from benchlab.discrepancy.kinds import Kind, kinds_of
from benchlab.discrepancy.measured import Run
from benchlab.discrepancy.scene import Scene
from benchlab.discrepancy.segments import Segment
from benchlab.units import FloatArray

BINS = 8
"""Intervals of pressure, up to the study's largest."""

HOLD_EDGES = (0.0, 0.05, 0.2, 0.5, 1.0)
"""Intervals of a hold, as shares of its duration."""

POINTS, POINTS_AFTER_A_TURN = 3, 8
"""Points at which a model is evaluated, per interval; more in the first two after a turn, where lags and loops show."""

REST_POINTS = 6
LAST_CYCLE = 4
"""Cycles from this one on are taken together."""


@dataclass(frozen=True)
class Feature:
    """What is averaged over. kind: index of the kind of run; bin: of pressure, or of time in a hold; occurrence: how many such runs
    the sample had before (0 where the order is not known). pressure_MPa, time_s: means. seconds: length of the interval."""

    design: int
    kind: int
    occurrence: int
    quantity: str
    cycle: int
    direction: str
    bin: int
    rate_MPa_s: float
    pressure_MPa: float = np.nan
    time_s: float = np.nan
    seconds: float = np.nan

    @property
    def key(self) -> tuple[int, int, int, str, int, str, int]:
        return (self.design, self.kind, self.occurrence, self.quantity, self.cycle, self.direction, self.bin)


@dataclass(frozen=True)
class Features:
    """features: F of them, sorted. Cells, (C,) each, sorted by sample and feature: one feature of one sample. sample, feature: indices;
    value: measured mean; count: of readings. of_point: quantity → (T, R) cell of each point, −1 for none. sample_design: (S,); kinds: of runs."""

    features: tuple[Feature, ...]
    kinds: tuple[Kind, ...]
    sample_names: tuple[str, ...]
    sample_design: NDArray[np.int64]
    sample: NDArray[np.int64]
    feature: NDArray[np.int64]
    value: FloatArray
    count: FloatArray
    of_point: dict[str, NDArray[np.int64]]

    @property
    def quantities(self) -> tuple[str, ...]:
        return tuple(self.of_point)

    def only(self, kept: NDArray[np.bool_]) -> Features:
        """The same without the cells (C,) that are not kept; samples that have none left are gone."""
        samples, sample = np.unique(self.sample[kept], return_inverse=True)
        renumbered = np.full(len(kept) + 1, -1)  # the last one is for points without a cell
        renumbered[np.flatnonzero(kept)] = np.arange(kept.sum())
        return replace(
            self,
            sample_names=tuple(self.sample_names[i] for i in samples),
            sample_design=self.sample_design[samples],
            sample=sample,
            feature=self.feature[kept],
            value=self.value[kept],
            count=self.count[kept],
            of_point={quantity: renumbered[of_point] for quantity, of_point in self.of_point.items()},
        )

    def collect(self, values: dict[str, FloatArray]) -> FloatArray:
        """(C,): means of (T, R) values over the points of each cell."""
        total, number = np.zeros(len(self.value)), np.zeros(len(self.value))
        for quantity, of_point in self.of_point.items():
            where = of_point >= 0
            cells = of_point[where]
            total += np.bincount(cells, values[quantity][where], minlength=len(total))
            number += np.bincount(cells, minlength=len(total))
        return total / number


@dataclass
class _Points:
    """The points of one run as they are gathered."""

    time_s: list[float]
    pressure_MPa: list[float]
    command_MPa: list[float]
    temperature_C: list[float]
    cells: list[dict[str, tuple[Feature, float, int]]]


def features_of(runs: Sequence[Run], base: Base, top_MPa: float | None = None) -> tuple[Features, Scene]:
    """Features and scene of runs whose designs are all in the base, sorted as Measured has them. top_MPa: largest pressure of the intervals."""
    names = tuple(sorted({run.design for run in runs}))
    samples = sorted({(run.design, run.sample) for run in runs})
    top = top_MPa or max(float(np.nanmax(run.pressure_MPa)) for run in runs)
    kinds, kind_of, cuts = kinds_of(runs)
    occurrence = _occurrences(runs, kind_of)
    gathered = [
        _points(run, cut, names.index(run.design), kind, occurrence[i], top)
        for i, (run, cut, kind) in enumerate(zip(runs, cuts, kind_of))
    ]
    scene = _scene(runs, gathered, names, samples, base)
    return _features(runs, gathered, kinds, names, samples), scene


def _occurrences(runs: Sequence[Run], kind_of: Sequence[int]) -> list[int]:
    seen: dict[tuple[str, str, int], int] = {}
    out = []
    for run, kind in zip(runs, kind_of):
        if run.run_index is None:
            out.append(0)
            continue
        key = (run.design, run.sample, kind)
        out.append(seen.get(key, 0))
        seen[key] = out[-1] + 1
    return out


def _points(run: Run, cut: Sequence[Segment], design: int, kind: int, occurrence: int, top_MPa: float) -> _Points:
    points = _Points([], [], [], [], [])
    if not cut:
        _add(points, run, np.arange(len(run.time_s)), Feature(design, kind, occurrence, "", 1, "all", 0, np.nan))
        return points
    for segment in cut:
        _add(points, run, np.arange(segment.first, min(segment.first + 1, segment.last)), None)
        for place, (indices, number) in enumerate(_intervals(run, segment, top_MPa)):
            feature = None
            if segment.direction != "rest":
                cycle = min(segment.cycle, LAST_CYCLE)
                feature = Feature(design, kind, occurrence, "", cycle, segment.direction, number, segment.rate_MPa_s)
            wanted = POINTS_AFTER_A_TURN if place < 2 else POINTS
            for part in np.array_split(indices, min(wanted, len(indices))):
                _add(points, run, part, feature)
    end = cut[-1]
    _add(points, run, np.arange(end.last, end.last + 1), None)
    return points


def _intervals(run: Run, segment: Segment, top_MPa: float) -> list[tuple[NDArray[np.int64], int]]:
    """Indices of the readings in each interval of a segment, in the order of time."""
    inside = np.arange(segment.first + 1, segment.last)
    if len(inside) == 0:
        return []
    if segment.direction in ("hold", "rest"):
        since = (run.time_s[inside] - run.time_s[segment.first]) / max(segment.duration_s, 1e-12)
        number = np.clip(np.searchsorted(HOLD_EDGES, since, side="right") - 1, 0, len(HOLD_EDGES) - 2)
    else:
        expected = np.interp(
            run.time_s[inside],
            [run.time_s[segment.first], run.time_s[segment.last]],
            [segment.start_MPa, segment.end_MPa],
        )
        level = np.maximum.accumulate(run.pressure_MPa[inside]) if segment.direction == "loading" else None
        level = np.minimum.accumulate(run.pressure_MPa[inside]) if level is None else level
        straight = float(np.max(np.abs(expected - run.pressure_MPa[inside]))) < 0.05 * top_MPa
        number = np.clip(((expected if straight else level) / top_MPa * BINS).astype(int), 0, BINS - 1)
    borders = np.flatnonzero(np.diff(number)) + 1
    return [(part, int(number[part[0] - inside[0]])) for part in np.split(inside, borders)]


def _add(points: _Points, run: Run, indices: NDArray[np.int64], feature: Feature | None) -> None:
    if len(indices) == 0:
        return
    pressure = float(np.mean(run.pressure_MPa[indices]))
    points.time_s.append(float(np.mean(run.time_s[indices])))
    points.pressure_MPa.append(pressure)
    points.command_MPa.append(_mean(run.command_MPa, indices))
    points.temperature_C.append(_mean(run.temperature_C, indices))
    cells: dict[str, tuple[Feature, float, int]] = {}
    if feature is not None:
        for quantity, values in run.values.items():
            good = values[indices][np.isfinite(values[indices])]
            if len(good):
                cells[quantity] = (replace(feature, quantity=quantity), float(np.mean(good)), len(good))
    points.cells.append(cells)


def _mean(values: FloatArray | None, indices: NDArray[np.int64]) -> float:
    if values is None:
        return np.nan
    good = values[indices][np.isfinite(values[indices])]
    return float(np.mean(good)) if len(good) else np.nan


def _scene(
    runs: Sequence[Run],
    gathered: Sequence[_Points],
    names: tuple[str, ...],
    samples: Sequence[tuple[str, str]],
    base: Base,
) -> Scene:
    longest = max(len(points.time_s) for points in gathered)

    def padded(name: str) -> FloatArray:
        out = np.empty((longest, len(runs)))
        for column, points in enumerate(gathered):
            values = getattr(points, name)
            out[: len(values), column] = values
            out[len(values) :, column] = values[-1]
        return out

    time = padded("time_s")
    real = np.zeros(time.shape, dtype=bool)
    for column, points in enumerate(gathered):
        real[: len(points.time_s), column] = True
    number = {name: i for i, name in enumerate(names)}
    place = {sample: i for i, sample in enumerate(samples)}
    return Scene(
        base=base,
        names=names,
        design=np.array([number[run.design] for run in runs]),
        sample=np.array([place[run.design, run.sample] for run in runs]),
        order=_order(runs),
        time_s=np.maximum.accumulate(time - time[0], axis=0),
        pressure_MPa=padded("pressure_MPa"),
        command_MPa=padded("command_MPa"),
        temperature_C=padded("temperature_C"),
        real=real,
        start_s=np.array([np.nan if run.start_s is None else run.start_s for run in runs]),
        orientation_deg=np.array([np.nan if run.orientation_deg is None else run.orientation_deg for run in runs]),
    )


def _order(runs: Sequence[Run]) -> FloatArray:
    """(R,): place of each run on its sample, from 0, NaN where the order is not known."""
    out = np.full(len(runs), np.nan)
    for i, run in enumerate(runs):
        if run.run_index is not None:
            same = [r.run_index for r in runs if (r.design, r.sample) == (run.design, run.sample)]
            out[i] = sum(other is not None and other < run.run_index for other in same)
    return out


def _features(
    runs: Sequence[Run],
    gathered: Sequence[_Points],
    kinds: Sequence[Kind],
    names: tuple[str, ...],
    samples: Sequence[tuple[str, str]],
) -> Features:
    place = {sample: i for i, sample in enumerate(samples)}
    found: dict[tuple, list[tuple[int, int, str, Feature, float, int]]] = {}
    for column, (run, points) in enumerate(zip(runs, gathered)):
        sample = place[run.design, run.sample]
        for row, cells in enumerate(points.cells):
            for quantity, (feature, value, count) in cells.items():
                found.setdefault((sample, feature.key), []).append((row, column, quantity, feature, value, count))
    keys = sorted({key for _, key in found})
    index = {key: i for i, key in enumerate(keys)}
    cells = sorted(found, key=lambda cell: (cell[0], index[cell[1]]))
    shape = (max(len(points.time_s) for points in gathered), len(runs))
    quantities = sorted({key[3] for key in keys})
    of_point = {quantity: np.full(shape, -1) for quantity in quantities}
    value, count = np.zeros(len(cells)), np.zeros(len(cells))
    about: dict[int, list[tuple[float, float, float, Feature]]] = {}
    for number, cell in enumerate(cells):
        entries = found[cell]
        count[number] = sum(entry[5] for entry in entries)
        value[number] = sum(entry[4] for entry in entries) / len(entries)
        for row, column, quantity, _, _, _ in entries:
            of_point[quantity][row, column] = number
        times = [gathered[column].time_s[row] - gathered[column].time_s[0] for row, column, *_ in entries]
        pressures = [gathered[column].pressure_MPa[row] for row, column, *_ in entries]
        about.setdefault(index[cell[1]], []).append(
            (
                float(np.mean(pressures)),
                float(np.mean(times)),
                float(np.ptp(times)) * len(times) / max(len(times) - 1, 1),
                entries[0][3],
            )
        )
    features = []
    for i in range(len(keys)):
        numbers = np.array([entry[:3] for entry in about[i]]).mean(axis=0)
        rate = float(np.mean([entry[3].rate_MPa_s for entry in about[i]]))
        features.append(
            replace(
                about[i][0][3],
                rate_MPa_s=rate,
                pressure_MPa=numbers[0],
                time_s=numbers[1],
                seconds=numbers[2],
            )
        )
    return Features(
        features=tuple(features),
        kinds=tuple(kinds),
        sample_names=tuple(f"{design} {sample}" for design, sample in samples),
        sample_design=np.array([names.index(design) for design, _ in samples]),
        sample=np.array([cell[0] for cell in cells]),
        feature=np.array([index[cell[1]] for cell in cells]),
        value=value,
        count=count,
        of_point=of_point,
    )
