"""The runs as models see them: pressures and times side by side, (T, R) for R runs of up to T points, and what may be done with them."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from benchlab.discrepancy.base import KNOBS, Base, between
from benchlab.units import FloatArray

PRESSURES, VALUES = 257, 33
"""Points of the tables in which curves and knobs are looked up."""


@dataclass(frozen=True)
class Scene:
    """R runs, each of up to T points in the order of time; behind its end a run stands still at its last point (dt 0).

    names: of the designs; design, sample: (R,) indices. order: (R,) place of the run on its sample from 0, NaN where it is not known.
    time_s: from the run's first point; pressure_MPa: as recorded; command_MPa, temperature_C: NaN where unknown; real: points of the run
    itself; (T, R) each. start_s, orientation_deg: (R,), NaN where unknown.
    """

    base: Base
    names: tuple[str, ...]
    design: NDArray[np.int64]
    sample: NDArray[np.int64]
    order: FloatArray
    time_s: FloatArray
    pressure_MPa: FloatArray
    command_MPa: FloatArray
    temperature_C: FloatArray
    real: NDArray[np.bool_]
    start_s: FloatArray
    orientation_deg: FloatArray

    @cached_property
    def dt_s(self) -> FloatArray:
        """(T, R): time since the point before, 0 at the first."""
        return np.diff(self.time_s, axis=0, prepend=self.time_s[:1])

    @cached_property
    def length_mm(self) -> FloatArray:
        """(R,): of the actuators, NaN where the design is not known."""
        shapes = [self.base.designs[name].shape for name in self.names]
        return np.array([np.nan if shape is None else shape.length_mm for shape in shapes])[self.design]

    @property
    def lengths_known(self) -> bool:
        return bool(np.isfinite(self.length_mm).all())

    @property
    def ordered(self) -> bool:
        """Whether some run is known to be later than another on its sample."""
        return bool(self._earlier.any())

    def full(self, quantity: str) -> FloatArray:
        """(R,): simulated quantity at the end of each design's curve."""
        return np.array([self.base.designs[name].curves[quantity][-1] for name in self.names])[self.design]

    def has(self, quantity: str) -> bool:
        """Whether every design has a curve of this quantity."""
        return all(quantity in self.base.designs[name].curves for name in self.names)

    def has_knob(self, knob: str) -> bool:
        """Whether every design knows how its curves change with this knob."""
        return all(knob in self.base.designs[name].knobs for name in self.names)

    def curve(self, quantity: str, pressure_MPa: FloatArray, knobs: Mapping[str, FloatArray | float]) -> FloatArray:
        """The simulated quantity at pressures (T, R), with the structure as the knobs say (a number, or (T, R))."""
        low, share = self._place(pressure_MPa)
        value = self._between(self._curves[quantity], low, share)
        for name, setting in knobs.items():
            if np.ndim(setting) > 0 or setting != KNOBS[name][0]:
                value = value * self._factor(name, quantity, low, share, setting)
        return value

    def slope(self, quantity: str, pressure_MPa: FloatArray) -> FloatArray:
        """d(quantity)/dp of the neutral structure at pressures (T, R)."""
        low, share = self._place(pressure_MPa)
        return self._between(np.gradient(self._curves[quantity], self._step, axis=1), low, share)

    def follow(
        self, value: FloatArray, time_constant_s: FloatArray | float, start: FloatArray | None = None
    ) -> FloatArray:
        """First-order lag of (T, R) values, exact where they go straight between points. start: (R,), the first values unless given.

        time_constant_s: a number or (T, R); 0 is no lag.
        """
        return _follow(value, self.dt_s, time_constant_s, value[0] if start is None else start)

    def follow_several(self, value: FloatArray, time_constants_s: FloatArray) -> FloatArray:
        """(T, R): mean of the first-order lags of (T, R) values with each of the time constants (K,), each from the first values."""
        each = np.broadcast_to(value[:, None], (len(value), len(time_constants_s), value.shape[1]))
        return np.asarray(
            _follow(each, self.dt_s[:, None], np.asarray(time_constants_s)[:, None], each[0]).mean(axis=1)
        )

    def delayed(self, value: FloatArray, delay_s: float) -> FloatArray:
        """(T, R) values as they were delay_s before (after, where it is negative), straight between points; still beyond a run's ends."""
        if delay_s == 0:
            return value
        asked = np.clip(self.time_s - delay_s, 0, self.time_s[-1])
        columns = (np.interp(*run) for run in zip(asked.T, self.time_s.T, value.T))
        return np.stack(list(columns), axis=1)

    def play(self, value: FloatArray, half_width: FloatArray | float, start: FloatArray | None = None) -> FloatArray:
        """Backlash: the output stands still while the input moves within ± half_width (a number or (T, R)) of it."""
        half = np.broadcast_to(half_width, value.shape)
        out = np.empty_like(value)
        state = value[0] if start is None else start
        for i in range(len(value)):
            state = np.minimum(np.maximum(state, value[i] - half[i]), value[i] + half[i])
            out[i] = state
        return out

    def largest_so_far(self, value: FloatArray) -> FloatArray:
        """(T, R): largest value of the run up to each point, and of the runs before it on the same sample where their order is known."""
        largest = np.maximum.accumulate(value, axis=0)
        return np.maximum(largest, self.before(largest[-1], -np.inf))

    def before(self, last: FloatArray, none: float) -> FloatArray:
        """(R,): largest of (R,) values over the earlier runs of each run's sample; `none` for a first or unordered run."""
        return np.asarray(np.where(self._earlier, last, none).max(axis=1, initial=none))

    def sum_before(self, last: FloatArray) -> FloatArray:
        """(R,): sum of (R,) values over the earlier runs of each run's sample; 0 for a first or unordered run."""
        return np.asarray(self._earlier @ last)

    @cached_property
    def _earlier(self) -> NDArray[np.bool_]:
        """(R, R): whether the run of the column came before that of the row, on the same sample."""
        return (self.sample[:, None] == self.sample) & (self.order < self.order[:, None])

    @cached_property
    def hold_s(self) -> FloatArray:
        """(T, R): time since the pressure stands still, 0 where it does not.

        Still: within ±1.5 % of the scene's largest pressure for 2 s and a twentieth of the run at least, above 5 % of it.
        """
        out = np.zeros_like(self.time_s)
        largest = float(np.max(self.pressure_MPa))
        for run in range(out.shape[1]):
            time, pressure = self.time_s[:, run], self.pressure_MPa[:, run]
            shortest, first = max(2.0, time[-1] / 20), 0
            while first < len(time):
                near = np.abs(pressure[first:] - pressure[first]) <= 0.015 * largest
                end = first + (len(near) if near.all() else int(np.argmin(near)))
                if pressure[first] > 0.05 * largest and time[end - 1] - time[first] >= shortest:
                    out[first:end, run] = time[first:end] - time[first]
                    first = end
                else:
                    first += 1
        return out

    @cached_property
    def holds(self) -> bool:
        return bool(self.hold_s.any())

    @cached_property
    def goes_back(self) -> bool:
        """Whether the pressure falls in some run, by a tenth of the largest at least."""
        fallen = np.maximum.accumulate(self.pressure_MPa, axis=0) - self.pressure_MPa
        return bool(fallen.max() > 0.1 * self.pressure_MPa.max())

    @cached_property
    def comes_again(self) -> bool:
        """Whether some sample is loaded more than once: in runs whose order is known, or within one."""
        return self.ordered or self.goes_back

    @cached_property
    def rates_differ(self) -> bool:
        """Whether some runs rise more than 1.5 times as fast as others (mean rate to the run's largest pressure)."""
        peak = np.argmax(self.pressure_MPa, axis=0)
        runs = np.arange(len(peak))
        time = self.time_s[peak, runs]
        moved = time > 0
        if not moved.any():
            return False
        rate = (self.pressure_MPa[peak, runs] - self.pressure_MPa[0])[moved] / time[moved]
        return bool(rate.max() > 1.5 * max(rate.min(), 1e-12))

    @property
    def shows_time(self) -> str:
        """Why a lag could not be told from a curve of another shape; empty where it can."""
        if not self.dt_s.any():
            return "there is no course in time"
        if not (self.goes_back or self.holds or self.rates_differ):
            return "all runs go up at one rate: no unloading, no hold, no second rate"
        return ""

    @cached_property
    def _top(self) -> float:
        return max(self.base.largest_pressure_MPa(name) for name in self.names)

    @cached_property
    def _step(self) -> float:
        return self._top / (PRESSURES - 1)

    @cached_property
    def _grid(self) -> FloatArray:
        return np.linspace(0.0, self._top, PRESSURES)

    @cached_property
    def _curves(self) -> dict[str, FloatArray]:
        quantities = [q for q in ("angle_deg", "volume_mL", "force_N", "stiffness_Nmm2") if self.has(q)]
        return {
            q: np.stack([self._smooth(name, self.base.designs[name].curves[q]) for name in self.names])
            for q in quantities
        }

    @cached_property
    def _knobs(self) -> dict[tuple[str, str], tuple[float, float, FloatArray]]:
        """By knob and quantity: first value, step, logarithms of factors (D, VALUES, PRESSURES)."""
        found = {}
        for knob in filter(self.has_knob, KNOBS):
            tables = [self.base.designs[name].knobs[knob] for name in self.names]
            lowest, last = max(t.values[0] for t in tables), min(t.values[-1] for t in tables)
            values = np.linspace(lowest, last, VALUES)
            for quantity in self._curves:
                if all(quantity in t.factor for t in tables):
                    logs = []
                    for name, t in zip(self.names, tables):
                        over_p = np.stack([self._smooth(name, row) for row in np.log(t.factor[quantity])])
                        logs.append(between(knob, t.values, over_p, values))
                    first, step = float(values[0]), float(values[1] - values[0])
                    found[knob, quantity] = (first, step, _none_at(KNOBS[knob][0], first, step, np.stack(logs)))
        return found

    def _smooth(self, name: str, values: FloatArray) -> FloatArray:
        """A curve on the common pressures, straight on beyond its end."""
        from scipy.interpolate import PchipInterpolator

        pressure = self.base.designs[name].pressure_MPa
        if len(pressure) == 1:
            return np.full(PRESSURES, values[0])
        inside = PchipInterpolator(pressure, values)(np.minimum(self._grid, pressure[-1]))
        slope = (values[-1] - values[-2]) / (pressure[-1] - pressure[-2])
        return np.asarray(inside + slope * np.maximum(self._grid - pressure[-1], 0.0))

    def _place(self, pressure_MPa: FloatArray) -> tuple[NDArray[np.int64], FloatArray]:
        place = pressure_MPa / self._step
        low = np.clip(np.nan_to_num(place).astype(np.int64), 0, PRESSURES - 2)
        return low, place - low

    def _between(self, table: FloatArray, low: NDArray[np.int64], share: FloatArray) -> FloatArray:
        at = table[self.design, low]
        return at + share * (table[self.design, low + 1] - at)

    def _factor(
        self, knob: str, quantity: str, low: NDArray[np.int64], share: FloatArray, setting: FloatArray | float
    ) -> FloatArray:
        if (knob, quantity) not in self._knobs:
            return np.ones_like(share)
        first, step, logs = self._knobs[knob, quantity]
        place = np.broadcast_to((np.asarray(setting) - first) / step, share.shape)
        row = np.clip(np.nan_to_num(place).astype(np.int64), 0, VALUES - 2)
        part = place - row
        share = np.clip(share, 0.0, 1.0)

        def at(which: NDArray[np.int64]) -> FloatArray:
            start = logs[self.design, which, low]
            return start + share * (logs[self.design, which, low + 1] - start)

        return np.exp(at(row) * (1 - part) + at(row + 1) * part)


def _follow(value: FloatArray, dt_s: FloatArray, time_constant_s: FloatArray | float, start: FloatArray) -> FloatArray:
    """First-order lag along the first axis; dt_s broadcasts to the values."""
    with np.errstate(divide="ignore", invalid="ignore"):
        steps = dt_s / time_constant_s
        steps = np.where(dt_s == 0, np.inf if np.all(time_constant_s == 0) else 0.0, steps)
    gone = -np.expm1(-steps)  # share of a step that is followed within dt
    mean = np.where(steps > 1e-6, 1 - gone / np.where(steps > 1e-6, steps, 1), steps / 2)
    mean = np.where(np.isinf(steps), 1.0, mean)
    kept, moved = 1 - gone[1:], gone[1:] * value[:-1] + mean[1:] * np.diff(value, axis=0)
    out = np.empty(np.broadcast_shapes(value.shape, steps.shape))
    out[0] = start
    for i, (share, move) in enumerate(zip(kept, moved)):
        np.multiply(share, out[i], out=out[i + 1])
        out[i + 1] += move
    return out


def _none_at(neutral: float, first: float, step: float, logs: FloatArray) -> FloatArray:
    """Logarithms of factors (D, VALUES, PRESSURES) such that there is none at the neutral value, which may lie between two of them."""
    row = int(np.clip((neutral - first) / step, 0, VALUES - 2))
    part = (neutral - first) / step - row
    return np.asarray(logs - (logs[:, [row]] * (1 - part) + logs[:, [row + 1]] * part))
