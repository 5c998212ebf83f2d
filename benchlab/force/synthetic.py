"""Force traces whose peaks are known: an actuator pressed against a load cell, cycle by cycle, as a machine would record it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from benchlab.units import FloatArray


@dataclass(frozen=True)
class DrawnTrace:
    """time_s, force_N, pressure_MPa: (n,). peaks_N, peak_times_s, levels_MPa: (P,) the truth, without noise and baseline."""

    time_s: FloatArray
    force_N: FloatArray
    pressure_MPa: FloatArray
    peaks_N: FloatArray
    peak_times_s: FloatArray
    levels_MPa: FloatArray


@dataclass(frozen=True)
class CycleShape:
    """A cycle in seconds: the pressure rises, is held, is released; then a rest. The force peaks as the rise ends and then relaxes by
    the share `relaxation` of it. dip: share of the force that is lost for a moment in the middle of the hold, 0 to 1."""

    rise_s: float = 0.3
    hold_s: float = 1.5
    fall_s: float = 0.4
    rest_s: float = 1.5
    relaxation: float = 0.03
    dip: float = 0.0

    @property
    def length_s(self) -> float:
        return self.rise_s + self.hold_s + self.fall_s + self.rest_s

    def pressure(self, time_s: FloatArray) -> FloatArray:
        """Share of the level at times from the start of the cycle."""
        up = _eased(time_s / self.rise_s)
        return up * (1 - _eased((time_s - self.rise_s - self.hold_s) / self.fall_s))

    def force(self, time_s: FloatArray) -> FloatArray:
        """Share of the peak at times from the start of the cycle; 1 at `rise_s`."""
        held = np.clip(time_s - self.rise_s, 0, None)
        relaxed = 1 - self.relaxation * (1 - np.exp(-4 * held / self.hold_s))
        lost = self.dip * np.exp(-(((held - self.hold_s / 2) / (0.08 * self.hold_s)) ** 2))
        return self.pressure(time_s) * relaxed * (1 - lost)


def draw_trace(
    peaks_N: Sequence[float],
    levels_MPa: Sequence[float],
    rng: np.random.Generator,
    *,
    rate_Hz: float = 100.0,
    noise_N: float = 0.0,
    offset_N: float = 0.0,
    drift_N_per_s: float = 0.0,
    uneven: float = 0.0,
    shape: CycleShape | None = None,
    lead_s: float = 1.5,
    cut_s: tuple[float, float] = (0.0, 0.0),
) -> DrawnTrace:
    """A trace of as many cycles as there are peaks (P,), each at its pressure (P,), between rests.

    offset, drift: of the load cell's zero, the drift linear. uneven: cycles last from 1/(1 + uneven) to 1 + uneven times the shape's time.
    cut_s: seconds that are taken off at the start and at the end. The pressure is drawn without noise.

    >>> drawn = draw_trace([4.0, 8.0], [0.1, 0.2], np.random.default_rng(1), offset_N=2.0)
    >>> round(float(drawn.force_N.max()), 2), len(drawn.peaks_N)
    (10.0, 2)
    """
    shape = shape or CycleShape()
    paces = (1 + uneven) ** rng.uniform(-1, 1, len(peaks_N))
    starts = lead_s + np.concatenate([[0.0], np.cumsum(shape.length_s * paces)])
    time = np.arange(0, starts[-1], 1 / rate_Hz)
    force, pressure = np.zeros(len(time)), np.zeros(len(time))
    for start, stop, pace, peak, level in zip(starts, starts[1:], paces, peaks_N, levels_MPa):
        inside = (time >= start) & (time < stop)
        local = (time[inside] - start) / pace
        force[inside] = peak * shape.force(local)
        pressure[inside] = level * shape.pressure(local)
    force += offset_N + drift_N_per_s * time + rng.normal(0, noise_N, len(time))
    kept = (time >= cut_s[0]) & (time < starts[-1] - cut_s[1])
    tops = starts[:-1] + shape.rise_s * paces
    return DrawnTrace(
        time[kept], force[kept], pressure[kept], np.asarray(peaks_N, float), tops, np.asarray(levels_MPa, float)
    )


def _eased(x: FloatArray) -> FloatArray:
    """From 0 to 1 without a corner."""
    x = np.clip(x, 0, 1)
    return x * x * (3 - 2 * x)
