"""How well a run followed its reference, and what it cost in pressure (paper, section III and Fig 8)."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from benchlab.actuator import tip_position_mm
from benchlab.errors import InputError
from benchlab.units import FloatArray

LONGEST_LAG_S = 1.0
"""The lag is looked for up to here; it must be under half a period of what is followed."""


@dataclass(frozen=True)
class Tracking:
    """Error e = reference − angle over samples after the settle-in, in degrees.

    samples, missing: with an angle, without one. r_squared: 1 − Σe²/Σ(r − mean r)², the share of the reference's variance that was
    followed; correlation_squared: Pearson's, which forgives a wrong size and offset. rmse_deg, mae_deg, max_deg: of |e|. bias_deg: mean
    of e. lag_s: shift at which angle and reference correlate best, above 0 where the angle is late; NaN for a reference that stands still.
    tip_rmse_mm, tip_max_mm: distance of the tips of two arcs of constant curvature with length_mm.
    variation_MPa: total variation Σ|Δu| = ∫|du| of the commanded pressure; variation_MPa_per_s: over the time. peak_MPa: largest command.
    at_ceiling, at_zero: share of samples with the command at a limit.
    """

    samples: int
    missing: int
    settle_s: float
    duration_s: float
    r_squared: float
    correlation_squared: float
    rmse_deg: float
    mae_deg: float
    max_deg: float
    bias_deg: float
    lag_s: float
    tip_rmse_mm: float
    tip_max_mm: float
    variation_MPa: float
    variation_MPa_per_s: float
    peak_MPa: float
    at_ceiling: float
    at_zero: float


def track(
    time_s: FloatArray,
    reference_deg: FloatArray,
    angle_deg: FloatArray,
    command_MPa: FloatArray,
    ceiling_MPa: float,
    settle_s: float = 0.0,
    length_mm: float = 180.0,
) -> Tracking:
    """Compare an angle with its reference, both (T,) over time_s (T,), with the pressure commanded for it (T,).

    Samples without a reference are passed over, and those of the first settle_s after the first one with a reference. The angle may
    be the measured one or, on a simulated bench, the true one. length_mm: of the arc for the tip.

    Raises InputError where fewer than three samples are left.

    >>> t = np.arange(0, 10, 0.01)
    >>> found = track(t, 60 + 50 * np.sin(t), 60 + 50 * np.sin(t - 0.1), np.full(1000, 0.1), ceiling_MPa=0.35)
    >>> round(found.lag_s, 3), round(found.rmse_deg, 1), round(found.r_squared, 3)
    (0.1, 3.6, 0.988)
    """
    time_s, reference, angle, command = (
        np.asarray(a, dtype=float) for a in (time_s, reference_deg, angle_deg, command_MPa)
    )
    used = np.isfinite(reference)
    if used.any():
        used &= time_s >= time_s[used][0] + settle_s - 1e-9
    known = used & np.isfinite(angle)
    if known.sum() < 3:
        raise InputError(
            f"{int(known.sum())} samples with a reference and an angle after {settle_s:g} s of settling; three are the least",
            hint="is it a closed-loop run, with a calibrated flex sensor, longer than the settle-in?",
        )
    r, m = reference[known], angle[known]
    error = r - m
    tips = [tip_position_mm(np.radians(values), length_mm) for values in (r, m)]
    apart = np.hypot(*(tips[0] - tips[1]).T)
    asked, duration = command[used], float(np.ptp(time_s[used]))
    variation = float(np.abs(np.diff(asked)).sum())
    return Tracking(
        samples=len(r),
        missing=int(used.sum() - known.sum()),
        settle_s=settle_s,
        duration_s=duration,
        r_squared=_one_minus_ratio(error, r),
        correlation_squared=_correlation(r, m) ** 2,
        rmse_deg=_rms(error),
        mae_deg=float(np.abs(error).mean()),
        max_deg=float(np.abs(error).max()),
        bias_deg=float(error.mean()),
        lag_s=lag_s(time_s[known], r, m),
        tip_rmse_mm=_rms(apart),
        tip_max_mm=float(apart.max()),
        variation_MPa=variation,
        variation_MPa_per_s=variation / duration,
        peak_MPa=float(asked.max()),
        at_ceiling=float((asked >= ceiling_MPa - 1e-6).mean()),
        at_zero=float((asked <= 1e-6).mean()),
    )


def lag_s(time_s: FloatArray, reference: FloatArray, measured: FloatArray, longest_s: float = LONGEST_LAG_S) -> float:
    """By how much `measured` is late, (T,) each: where its correlation with the reference is largest, between samples by a parabola.

    NaN where either stands still, or where the best lag is at the end of what is looked at (longest_s, at most a third of the record).
    """
    dt = float(np.median(np.diff(time_s)))
    grid = np.arange(time_s[0], time_s[-1] + dt / 2, dt)
    r, m = (np.interp(grid, time_s, values) for values in (reference, measured))
    if np.ptp(r) == 0 or np.ptp(m) == 0:
        return math.nan
    most = min(round(longest_s / dt), len(grid) // 3)
    found = np.array([_correlation(r[max(0, -k) : len(r) - max(0, k)], m[max(0, k) : len(m) - max(0, -k)])
                      for k in range(-most, most + 1)])  # fmt: skip
    best = int(np.argmax(found))
    if not 0 < best < 2 * most:
        return math.nan
    before, at, after = found[best - 1 : best + 2]
    curved = before - 2 * at + after
    between = 0.5 * (before - after) / curved if curved < 0 else 0.0
    return float((best - most + between) * dt)


def late_words(late_s: float) -> str:
    """A lag in words.

    >>> late_words(0.031), late_words(-0.007), late_words(0.0001)
    ('late by 31 ms', 'ahead by 7 ms', 'neither late nor ahead')
    """
    ms = f"{abs(1000 * late_s):.0f}"
    return "neither late nor ahead" if ms == "0" else f"{'late' if late_s > 0 else 'ahead'} by {ms} ms"


def _rms(values: FloatArray) -> float:
    return math.sqrt(float(np.square(values).mean()))


def _one_minus_ratio(error: FloatArray, reference: FloatArray) -> float:
    total = float(np.square(reference - reference.mean()).sum())
    return 1 - float(np.square(error).sum()) / total if total > 0 else math.nan


def _correlation(a: FloatArray, b: FloatArray) -> float:
    a, b = a - a.mean(), b - b.mean()
    size = math.sqrt(float(a @ a) * float(b @ b))
    return float(a @ b) / size if size > 0 else math.nan
