"""The peak force of each loading of a record, as it was recorded and with the load cell's zero and noise taken off."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from itertools import pairwise

import numpy as np
from scipy.ndimage import median_filter
from scipy.signal import savgol_coeffs, savgol_filter

from benchlab.errors import counted
from benchlab.force.baseline import Baseline, find_baseline
from benchlab.force.clipping import clipping_value, is_clipped
from benchlab.force.loading import TIMES_NOISE, Loading, find_loadings, half_height, in_record
from benchlab.units import FloatArray

RESOLVED_SHARE = 20
"""A peak is the top of a local parabola over this fraction of its loading."""

LEAST_WINDOW, LEAST_LOADED = 5, 15
"""Fewest readings of a parabola, and of a loading that gets one."""

WILD, POINTED = 0.02, 4.0
"""A reading that stands alone by more than this share of its loading's height, than noise does, and than the top of a pointed loading
could (so many heights over the number of its readings) is no peak."""

NO_CONTACT = "no contact seen"


@dataclass(frozen=True)
class ForcePeak:
    """One loading. number: from 1. row: of the record, where the peak is; time_s: NaN where no time is known.

    raw_N: the largest reading. baseline_N: the load cell's zero then. peak_N: the smoothed top less the zero; sd_N: its standard
    deviation, of noise and zero. lower_bound: the true peak is this or more; cut: the record begins or ends within the loading,
    whose peak may not be in it; alone: readings far from both neighbours, which do not count; coarse: too few readings for more than the
    largest; why: what is doubtful, in words.
    """

    number: int
    row: int
    time_s: float
    raw_N: float
    baseline_N: float
    peak_N: float
    sd_N: float
    lower_bound: bool = False
    cut: bool = False
    alone: int = 0
    coarse: bool = False
    why: str = ""


@dataclass(frozen=True)
class ForceRecord:
    """What a record of force came to. peaks: in order of time. loadings: those of the peaks. baseline: None without a loading.

    low_N, high_N: smallest and largest reading. clipped_at_N: None where the load cell was not at its limit.
    """

    peaks: tuple[ForcePeak, ...]
    loadings: tuple[Loading, ...]
    baseline: Baseline | None
    low_N: float
    high_N: float
    clipped_at_N: float | None
    notes: tuple[str, ...]

    @property
    def contact(self) -> bool:
        """Whether there are peaks of more than noise."""
        return bool(self.peaks) and not self.untouched

    @property
    def untouched(self) -> bool:
        """Whether the load cell was never touched; without contact a record may also be without a rest, or go down."""
        return NO_CONTACT in self.notes[:1]


def peaks_of(
    force_N: FloatArray, time_s: FloatArray | None = None, loadings: Sequence[Loading] | None = None
) -> ForceRecord:
    """The peaks of a record (n,), NaN where a reading is missing. time_s: (n,). loadings: where they are known from elsewhere (pressure,
    a column of cycles); else they are found in the force.

    The zero is that of `find_baseline`. The peak of a loading is the largest value, from half way up to half way down, of a local
    parabola (Savitzky, Golay, Anal. Chem. 36, 1627, 1964) over a twentieth of the loading's length, of five readings at least, so that
    it is not the luckiest of many noisy readings, nor one that stands alone. With fewer than 15 readings in the loading it is the
    largest reading.

    >>> force = np.repeat([1.0, 5.0, 1.0, 9.0, 1.0], 20)
    >>> [round(peak.peak_N, 3) for peak in peaks_of(force).peaks]
    [4.0, 8.0]
    """
    known = np.flatnonzero(np.isfinite(force_N))
    if not len(known):
        return ForceRecord((), (), None, math.nan, math.nan, None, ("no reading of force",))
    values, time = force_N[known], None if time_s is None else time_s[known]
    given = loadings is not None
    within = find_loadings(values) if loadings is None else [_renumbered(c, known) for c in loadings]
    low, high = float(values.min()), float(values.max())
    if not within:
        words = f"{NO_CONTACT}: the force stays between {low:.4g} and {high:.4g} N"
        return ForceRecord((), (), None, low, high, None, (NO_CONTACT, words))
    try:
        zero = find_baseline(values, time, within)
    except ValueError:
        words = "no unloaded rest in the record, so that its zero is not known"
        return ForceRecord((), tuple(within), None, low, high, None, (words,))
    clip = clipping_value(values)
    peaks = [_peak(number, values, time, cycle, zero, clip) for number, cycle in enumerate(within, start=1)]
    peaks = [_with_gaps(replace(p, row=int(known[p.row])), c, known) for p, c in zip(peaks, within)]
    notes = []
    if given and max(p.peak_N for p in peaks) < TIMES_NOISE * zero.noise_N:
        notes = [NO_CONTACT, f"{NO_CONTACT}: no peak stands out of the noise of {zero.noise_N:.2g} N"]
    back = [in_record(cycle, known) for cycle in within]
    return ForceRecord(tuple(peaks), tuple(back), zero, low, high, clip, tuple(notes))


def loadings_of_cycles(cycle: FloatArray, force_N: FloatArray) -> tuple[Loading, ...]:
    """The loadings that a column of cycle numbers (n,) tells: a stretch of equal numbers is one. force_N: (n,). None where it does
    not count."""
    known = np.isfinite(force_N) & np.isfinite(cycle)
    edges = [0, *(np.flatnonzero(np.diff(cycle) != 0) + 1).tolist(), len(cycle)]
    found = []
    for start, stop in pairwise(edges) if len(edges) > 2 else ():
        rows = np.flatnonzero(known[start:stop]) + start
        if len(rows) > 2 and np.ptp(force_N[rows]) > 0:
            first, last = half_height(force_N[rows], float(force_N[rows].min()))
            found.append(Loading(int(rows[0]), int(rows[first]), int(rows[last]), int(rows[-1]) + 1))
    return tuple(found)


def pushes_down(force_N: FloatArray) -> bool:
    """Whether a record (n,) goes from its rest, which is where it begins and ends, mainly to smaller values.

    >>> pushes_down(np.repeat([0.0, -9.0, 0.1], 20)), pushes_down(np.repeat([-50.0, -12.0, -50.0], 20))
    (True, False)
    """
    values = force_N[np.isfinite(force_N)]
    if len(values) < 3:
        return False
    edge = max(1, len(values) // 50)
    rest = float(np.median(np.concatenate([values[:edge], values[-edge:]])))
    clean = median_filter(values, 3, mode="nearest") if len(values) > 30 else values
    return rest - float(clean.min()) > 2 * (float(clean.max()) - rest) and bool(find_loadings(-values))


def _peak(
    number: int, force: FloatArray, time: FloatArray | None, cycle: Loading, zero: Baseline, clip: float | None
) -> ForcePeak:
    loaded = force[cycle.rise : cycle.fall + 1]
    window = max((len(loaded) // RESOLVED_SHARE) | 1, LEAST_WINDOW)
    gain, alone = 1.0, 0
    smooth = loaded
    if len(loaded) >= LEAST_LOADED:
        around = force[max(0, cycle.rise - window) : cycle.fall + 1 + window]
        left = cycle.rise - max(0, cycle.rise - window)
        clean = _without_wild(around, zero.noise_N, max(WILD, POINTED / len(loaded)))
        alone = int(np.count_nonzero((around != clean)[left : left + len(loaded)]))
        smooth = savgol_filter(clean, window, 2)[left : left + len(loaded)]
        smooth = np.minimum(smooth, clean.max())  # a parabola swings over at a corner
        gain = float(np.square(savgol_coeffs(window, 2)).sum())
    top = int(np.argmax(smooth))
    level, sd = zero.at(cycle.rise + top)
    whole = force[cycle.start : cycle.stop]
    clipped = is_clipped(loaded, clip)
    why = [
        f"clipped at {clip:.4g} N" if clipped else "",
        f"the record is cut at its {cycle.cut}" if cycle.cut else "",
        f"{counted(alone, 'reading')} far from both neighbours left out" if alone else "",
        f"{counted(len(loaded), 'reading')} while loaded: the largest reading" if len(loaded) < LEAST_LOADED else "",
    ]
    return ForcePeak(
        number, cycle.rise + top, math.nan if time is None else float(time[cycle.rise + top]), float(whole.max()), level,
        float(smooth[top]) - level, math.sqrt(gain * zero.noise_N**2 + sd**2), clipped, bool(cycle.cut), alone, len(loaded) < LEAST_LOADED,
        "; ".join(filter(None, why)),
    )  # fmt: skip


def _without_wild(force: FloatArray, noise_N: float, share: float) -> FloatArray:
    """Readings (n,) of which one that stands alone, far from both neighbours, is replaced by the median of the three. share: of the
    height, from which on it is far."""
    middle = median_filter(force, 3, mode="nearest")
    return np.where(np.abs(force - middle) > max(6 * noise_N, share * np.ptp(middle)), middle, force)


def _with_gaps(peak: ForcePeak, cycle: Loading, known: np.ndarray) -> ForcePeak:
    """A peak beside readings that are missing while loaded is a lower bound: a load cell over its limit gives no number."""
    missing = int(known[cycle.fall] - known[cycle.rise]) - (cycle.fall - cycle.rise)
    if not missing:
        return peak
    words = f"{missing} readings are missing while loaded"
    return replace(peak, lower_bound=True, why="; ".join(filter(None, (peak.why, words))))


def _renumbered(cycle: Loading, known: np.ndarray) -> Loading:
    """A loading of the whole record in the numbers of its known readings."""
    start, rise, fall, stop = np.searchsorted(known, (cycle.start, cycle.rise, cycle.fall, cycle.stop)).tolist()
    last = len(known) - 1
    return Loading(min(start, last), min(rise, last), min(max(fall, rise), last), max(stop, start + 1), cycle.cut)
