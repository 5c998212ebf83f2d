"""PI gains from an identified plant by the SIMC rule, with the margins that they have at every operating point.

Skogestad, Simple analytic rules for model reduction and PID controller tuning, J. Process Control 13, 291 (2003).
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from benchlab.errors import InputError

MAX_SENSITIVITY = 1.6
"""Ms that gains must keep at every operating point; SIMC with a closed-loop time of one dead time has 1.59."""


LOOP_PERIODS = 1.5
"""Dead time of the loop itself, in its periods: half of one for holding the pressure, one from measuring to asking."""


@dataclass(frozen=True)
class Lag:
    """A first-order plant with dead time, K·exp(−L·s)/(τ·s + 1): K in degrees per MPa, τ and L in seconds."""

    gain_deg_per_MPa: float
    lag_s: float
    dead_time_s: float


@dataclass(frozen=True)
class Margins:
    """Of a loop: factor on its gain to instability; phase left where its gain is 1; additional dead time to instability; Ms, the largest
    |1/(1 + loop)|; how slow it is: frequency at which its gain is 1. Infinite where there is no such frequency."""

    gain_margin: float
    phase_margin_deg: float
    delay_margin_s: float
    max_sensitivity: float
    crossover_rad_per_s: float

    @property
    def stable(self) -> bool:
        return self.gain_margin > 1 and self.phase_margin_deg > 0


@dataclass(frozen=True)
class Tuning:
    """Gains, how they were found, and what they have. closed_loop_s: SIMC's τc. lead_s: the plant's median lag and dead time, the preview
    for a feed-forward. margins: at each operating point, in their order; worst: index of the one with the largest Ms."""

    kp_MPa_per_deg: float
    ki_MPa_per_deg_s: float
    closed_loop_s: float
    lead_s: float
    margins: tuple[Margins, ...]
    worst: int


def simc(plant: Lag, closed_loop_s: float) -> tuple[float, float]:
    """(kp, ki): kp = τ/(K·(τc + L)), ki = kp/min(τ, 4·(τc + L)) (Skogestad 2003, Eqs 23 and 24).

    >>> [round(gain, 3) for gain in simc(Lag(1.0, 8.0, 1.0), closed_loop_s=1.0)]
    [4.0, 0.5]
    """
    slowest = closed_loop_s + plant.dead_time_s
    kp = plant.lag_s / (plant.gain_deg_per_MPa * slowest)
    return kp, kp / min(plant.lag_s, 4 * slowest)


def margins(kp: float, ki: float, plant: Lag) -> Margins:
    """Margins of a PI, kp + ki/s, on a plant, from the frequency response of the continuous loop.

    With ki = kp/τ they have closed forms: with k = kp·K/τ, phase margin π/2 − k·L, gain margin π/(2·k·L).

    >>> found = margins(0.5, 0.5, Lag(1.0, 1.0, 1.0))  # SIMC with τc = L
    >>> round(found.gain_margin, 2), round(found.phase_margin_deg, 1), round(found.max_sensitivity, 2)
    (3.14, 61.4, 1.59)
    """
    if kp == 0 and ki == 0:
        return Margins(math.inf, math.inf, math.inf, 1.0, 0.0)
    K, lag, dead = plant.gain_deg_per_MPa, plant.lag_s, plant.dead_time_s
    w = np.geomspace(1e-4 / max(lag, dead), 3e3 / min(lag, dead or lag), 20_000)
    size = K * np.hypot(kp, ki / w) / np.hypot(1, lag * w)
    phase = np.arctan2(kp * w, ki) - math.pi / 2 - np.arctan(lag * w) - dead * w
    crossings = _falling(w, np.log(size))
    turned = _falling(w, phase + math.pi)
    gain_margin = min((1 / float(np.interp(x, w, size)) for x in turned), default=math.inf)
    left = [(math.pi + float(np.interp(x, w, phase)), x) for x in crossings]
    near = (w < 30 * max(crossings, default=1 / lag)) | (w < (10 * math.pi / dead if dead else 0))
    loop = size * np.exp(1j * phase)
    return Margins(
        gain_margin=gain_margin,
        phase_margin_deg=math.degrees(min((rad for rad, _ in left), default=math.inf)),
        delay_margin_s=min((rad / x for rad, x in left), default=math.inf),
        max_sensitivity=max(1.0, float(np.max(1 / np.abs(1 + loop[near])))),
        crossover_rad_per_s=max(crossings, default=0.0),
    )


def tune(
    plants: Sequence[Lag],
    rate_Hz: float,
    closed_loop_s: float | None = None,
    max_sensitivity: float = MAX_SENSITIVITY,
) -> Tuning:
    """SIMC gains for a plant known at several operating points, safe at all of them.

    The rule is applied to the operating point at which its own choice, τc = L, allows the least kp. To each dead time of the plant one
    and a half periods of the loop are added: the pressure is held between ticks, and is found from the angle of the tick before. τc is
    the shortest with which Ms is at most max_sensitivity at every operating point: for one plant about its dead time, which is
    SIMC's choice for fast control. closed_loop_s: τc as it is wished; it is refused where Ms is larger than that.

    Raises InputError for no plant, for one with a gain, lag or dead time that no bench has, and where no gains are safe.
    """
    _check(plants)
    held = [_in_loop(plant, rate_Hz) for plant in plants]
    one = min(held, key=lambda plant: simc(plant, plant.dead_time_s)[0])
    lead = float(np.median([p.lag_s + p.dead_time_s for p in plants])) + 0.5 / rate_Hz
    if closed_loop_s is not None:
        found = _tuned(one, held, closed_loop_s, lead)
        if not _safe(found, max_sensitivity):
            raise InputError(
                f"a closed-loop time of {closed_loop_s:g} s gives Ms {found.margins[found.worst].max_sensitivity:.3g} where at most "
                f"{max_sensitivity:g} is wanted",
                hint="ask for a longer one, or leave it to the rule",
            )
        return found
    return _fastest(one, held, lead, max_sensitivity)


def margins_at(kp: float, ki: float, plants: Sequence[Lag], rate_Hz: float) -> tuple[Margins, ...]:
    """Margins of given gains at each operating point, with the dead time of a loop at rate_Hz, as `tune` has them.

    >>> [found.stable for found in margins_at(0.8, 0.0, [Lag(400.0, 0.1, 0.0)], rate_Hz=100)]
    [False]
    """
    return tuple(margins(kp, ki, _in_loop(plant, rate_Hz)) for plant in plants)


def _in_loop(plant: Lag, rate_Hz: float) -> Lag:
    return Lag(plant.gain_deg_per_MPa, plant.lag_s, plant.dead_time_s + LOOP_PERIODS / rate_Hz)


def _fastest(one: Lag, plants: Sequence[Lag], lead_s: float, max_sensitivity: float) -> Tuning:
    """The shortest safe τc, to a thousandth, between a tenth of the dead time and a thousand times it."""
    low, high = math.log(0.1 * one.dead_time_s), math.log(1000 * one.dead_time_s)
    if not _safe(_tuned(one, plants, math.exp(high), lead_s), max_sensitivity):
        raise InputError(
            f"no gains keep Ms under {max_sensitivity:g} at every operating point: their lags and gains differ too much",
            hint="identify over a smaller range of pressure",
        )
    while high - low > 1e-3:
        middle = (low + high) / 2
        low, high = (
            (low, middle) if _safe(_tuned(one, plants, math.exp(middle), lead_s), max_sensitivity) else (middle, high)
        )
    return _tuned(one, plants, math.exp(high), lead_s)


def _tuned(one: Lag, plants: Sequence[Lag], closed_loop_s: float, lead_s: float) -> Tuning:
    kp, ki = simc(one, closed_loop_s)
    found = tuple(margins(kp, ki, plant) for plant in plants)
    worst = int(np.argmax([m.max_sensitivity if m.stable else math.inf for m in found]))
    return Tuning(kp, ki, closed_loop_s, lead_s, found, worst)


def _safe(found: Tuning, max_sensitivity: float) -> bool:
    return all(m.stable and m.max_sensitivity <= max_sensitivity for m in found.margins)


def _check(plants: Sequence[Lag]) -> None:
    if not plants:
        raise InputError("no operating point to tune for", hint="identify the plant from a run with steps")
    for number, plant in enumerate(plants, start=1):
        demands = {
            "a gain above 0 (pressure must bend it)": 0 < plant.gain_deg_per_MPa < math.inf,
            "a lag above 0": 0 < plant.lag_s < math.inf,
            "a dead time of 0 or more": 0 <= plant.dead_time_s < math.inf,
        }
        for demand, met in demands.items():
            if not met:
                what = (
                    f"gain {plant.gain_deg_per_MPa:g} °/MPa, lag {plant.lag_s:g} s, dead time {plant.dead_time_s:g} s"
                )
                raise InputError(
                    f"{what} cannot be tuned: it needs {demand}", where=f"operating point {number} of {len(plants)}"
                )


def _falling(w: np.ndarray, values: np.ndarray) -> list[float]:
    """Where values, over w, go through 0 from above."""
    at = np.flatnonzero((values[:-1] > 0) & (values[1:] <= 0))
    share = values[at] / (values[at] - values[at + 1])
    return [float(x) for x in w[at] + share * (w[at + 1] - w[at])]
