"""Runs of thousands of points become features of a few dozen: means over intervals of pressure, by direction, cycle and kind of run."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field, replace

import numpy as np
from numpy.typing import NDArray

from benchlab.discrepancy.against import Against, against_of
from benchlab.discrepancy.base import Base
from benchlab.discrepancy.kinds import Kind, kinds_of
from benchlab.discrepancy.measured import Run
from benchlab.discrepancy.points import DIRECTIONS, Points, points_of
from benchlab.discrepancy.scene import Scene
from benchlab.units import FloatArray


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


@dataclass(frozen=True)
class Features:
    """features: F of them, sorted. Cells, (C,) each, sorted by sample and feature: one feature of one sample. sample, feature: indices;
    value: measured mean; count: of readings. of_point: quantity → (T, R) cell of each point, −1 for none. sample_design: (S,); kinds: of
    runs. against: further columns named by the user, (F,) each.
    """

    features: tuple[Feature, ...]
    kinds: tuple[Kind, ...]
    sample_names: tuple[str, ...]
    sample_design: NDArray[np.int64]
    sample: NDArray[np.int64]
    feature: NDArray[np.int64]
    value: FloatArray
    count: FloatArray
    of_point: dict[str, NDArray[np.int64]]
    against: Against = field(default_factory=dict)

    @property
    def quantities(self) -> tuple[str, ...]:
        return tuple(self.of_point)

    def of_quantity(self, name: str) -> NDArray[np.bool_]:
        """(F,): which features are of that quantity."""
        return np.array([feature.quantity == name for feature in self.features])

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


def features_of(runs: Sequence[Run], base: Base, top_MPa: float | None = None) -> tuple[Features, Scene]:
    """Features and scene of runs whose designs are all in the base, sorted as Measured has them. top_MPa: upper end of the intervals,
    the largest recorded pressure unless given.
    """
    names = tuple(sorted({run.design for run in runs}))
    samples = sorted({(run.design, run.sample) for run in runs})
    top = top_MPa or max(float(np.nanmax(run.pressure_MPa)) for run in runs)
    kinds, kind_of, cuts = kinds_of(runs)
    gathered = [points_of(run, cut, top) for run, cut in zip(runs, cuts)]
    scene = _scene(runs, gathered, names, samples, base)
    features = _features(runs, gathered, kinds, np.array([kind_of, _occurrences(runs, kind_of)]), names, samples)
    return replace(features, against=_against(runs, gathered, features)), scene


def _against(runs: Sequence[Run], gathered: Sequence[Points], features: Features) -> Against:
    feature = np.append(features.feature, -1)  # the last one is for points without a cell
    places = [
        np.array([feature[of_point[: len(points.time_s), column]] for of_point in features.of_point.values()])
        for column, points in enumerate(gathered)
    ]
    return against_of(runs, [points.against for points in gathered], places, len(features.features))


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


def _scene(
    runs: Sequence[Run],
    gathered: Sequence[Points],
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
    gathered: Sequence[Points],
    kinds: Sequence[Kind],
    kind_and_occurrence: NDArray[np.int64],
    names: tuple[str, ...],
    samples: Sequence[tuple[str, str]],
) -> Features:
    """Points of one sample in one interval become a cell, cells of one interval a feature."""
    place = {sample: i for i, sample in enumerate(samples)}
    quantities = sorted({quantity for points in gathered for quantity in points.values})
    parts: list[FloatArray] = []
    for column, (run, points) in enumerate(zip(runs, gathered)):
        kind, occurrence = kind_and_occurrence[:, column]
        head = [place[run.design, run.sample], names.index(run.design), kind, occurrence]
        for quantity, values in points.values.items():
            row = np.flatnonzero(np.isfinite(values) & (points.cycle >= 0))
            key = [quantities.index(quantity), points.cycle[row], points.direction[row], points.bin[row]]
            about = [
                points.rate_MPa_s,
                points.pressure_MPa,
                points.time_s - points.time_s[0],
                values,
                points.counts[quantity],
            ]
            columns = [*head, *key, *(values[row] for values in about), row, column]
            parts.append(np.array([np.broadcast_to(values, row.shape) for values in columns]))
    table = np.concatenate(parts, axis=1)
    keys, feature_of = np.unique(table[1:8].astype(int), axis=1, return_inverse=True)
    cell_keys, cell = np.unique(np.array([table[0].astype(int), feature_of.ravel()]), axis=1, return_inverse=True)
    cell, number = cell.ravel(), cell_keys.shape[1]
    points_in = np.bincount(cell, minlength=number)

    def per_cell(row: int) -> FloatArray:
        return np.asarray(np.bincount(cell, table[row], minlength=number) / points_in)

    first, last = np.full(number, np.inf), np.full(number, -np.inf)
    np.minimum.at(first, cell, table[10])
    np.maximum.at(last, cell, table[10])
    seconds = (last - first) * points_in / np.maximum(points_in - 1, 1)
    per_feature = np.bincount(cell_keys[1])
    rate, pressure, time, length = (
        np.bincount(cell_keys[1], values) / per_feature for values in (per_cell(8), per_cell(9), per_cell(10), seconds)
    )
    of_point = {}
    for i, quantity in enumerate(quantities):
        of_point[quantity] = np.full((max(len(points.time_s) for points in gathered), len(runs)), -1)
        mine = table[4] == i
        of_point[quantity][table[13, mine].astype(int), table[14, mine].astype(int)] = cell[mine]
    features = tuple(
        Feature(
            design, kind, occurrence, quantities[quantity], cycle, DIRECTIONS[direction], place, *map(float, numbers)
        )
        for (design, kind, occurrence, quantity, cycle, direction, place), *numbers in zip(
            keys.T.tolist(), rate, pressure, time, length
        )
    )
    return Features(
        features=features,
        kinds=tuple(kinds),
        sample_names=tuple(f"{design} {sample}" for design, sample in samples),
        sample_design=np.array([names.index(design) for design, _ in samples]),
        sample=cell_keys[0],
        feature=cell_keys[1],
        value=per_cell(11),
        count=np.asarray(np.bincount(cell, table[12], minlength=number), dtype=float),
        of_point=of_point,
    )
