"""From a recorded tensile test to the loading curve that a law is fitted to: first loading only, up to the break, from zero force."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from benchlab.errors import InputError
from benchlab.simulation.laws.law import FloatArray

UNLOADS = 0.02
"""Return of the stretch, as a share of its whole range, that ends the first loading."""

BREAKS = 0.2
"""Fall of the stress below its maximum, as a share of it, that is a break; the curve ends at the maximum."""

SLACK = (0.01, 0.06)
"""Shares of the largest stress between which a line is laid to find where the specimen becomes taut."""

LEAST_SLACK = 0.005
"""Strain below which slack is left as it is."""

_LEAST = 6


@dataclass(frozen=True)
class LoadingCurve:
    """Stretch and nominal stress (MPa), shape (n,), and in words what was left out or changed."""

    stretch: FloatArray
    stress_MPa: FloatArray
    notes: tuple[str, ...]


def loading_curve(
    stretch: FloatArray, stress_MPa: FloatArray, remove_slack: bool = True, max_stretch: float | None = None
) -> LoadingCurve:
    """The first loading of a test, shape (n,) both, up to its break or `max_stretch`.

    remove_slack: where the line through the stresses between 1 and 6 % of the largest meets zero at more than 0.5 % strain, the
    test starts there and stretches are counted from that length (as ASTM D882, annex A1, compensates the toe).
    Raises InputError where no loading is left.

    >>> stretch = np.concatenate([np.linspace(1, 2, 50), np.linspace(2, 1, 50)])
    >>> curve = loading_curve(stretch, stretch - 1)
    >>> len(curve.stretch), curve.notes[0]
    (50, 'it unloads at stretch 2: only the first loading is used, 50 of 100 points')
    """
    stretch, stress = np.asarray(stretch, dtype=float), np.asarray(stress_MPa, dtype=float)
    notes: list[str] = []
    end = _first_loading(stretch, notes)
    end = _until_break(stretch[:end], stress[:end], notes)
    stretch, stress = stretch[:end], stress[:end]
    _check_pulls(stretch, stress)
    if remove_slack:
        stretch, stress = _taut(stretch, stress, notes)
    if max_stretch is not None:
        kept = stretch <= max_stretch
        if not kept.all():
            notes.append(
                f"stretches above {max_stretch:g} are left out: {int(kept.sum())} of {len(kept)} points are used"
            )
        stretch, stress = stretch[kept], stress[kept]
    if len(stretch) < _LEAST:
        hint = "record more densely, or raise --max-stretch"
        raise InputError(f"{len(stretch)} points in the first loading, fewer than {_LEAST}", hint=hint)
    at_rest = np.abs(stretch - 1) < 0.002
    if at_rest.any() and abs(start := float(stress[at_rest][0])) > 0.02 * float(np.abs(stress).max()):
        notes.append(
            f"the stress at the start is {start:.3g} MPa, not zero: was the load tared, or the specimen preloaded?"
        )
    return LoadingCurve(stretch, stress, tuple(notes))


def _first_loading(stretch: FloatArray, notes: list[str]) -> int:
    """How many points until the first unloading."""
    highest = np.maximum.accumulate(stretch)
    back = np.flatnonzero(highest - stretch > UNLOADS * float(np.ptp(stretch)))
    if not back.size:
        return len(stretch)
    end = int(np.argmax(stretch[: back[0]])) + 1
    later = float(stretch.max())
    further = f" (later it goes to {later:.4g})" if later > stretch[end - 1] * 1.001 else ""
    notes.append(
        f"it unloads at stretch {stretch[end - 1]:.4g}{further}: only the first loading is used, {end} of {len(stretch)} points"
    )
    return end


def _until_break(stretch: FloatArray, stress: FloatArray, notes: list[str]) -> int:
    """How many points until the largest stress, if the specimen breaks or slips after it."""
    top = int(np.argmax(stress))
    fall = 1 - float(stress[top:].min()) / float(stress[top]) if stress[top] > 0 else 0.0
    if fall < BREAKS:
        return len(stress)
    notes.append(
        f"the stress falls by {100 * min(fall, 1):.0f} % after its largest, {stress[top]:.4g} MPa at stretch {stretch[top]:.4g} (break or "
        f"slip): the curve ends there, {top + 1} of {len(stress)} points"
    )
    return top + 1


def _check_pulls(stretch: FloatArray, stress: FloatArray) -> None:
    if len(stretch) < _LEAST:
        hint = "does the file start with unloading, or is the order of the columns another?"
        raise InputError(f"{len(stretch)} points in the first loading, fewer than {_LEAST}", hint=hint)
    if stretch.min() <= 0:
        raise InputError(
            f"a stretch of {stretch.min():.4g}", hint="check the gauge length and the sign of the extension"
        )
    if np.ptp(stretch) < 0.01 or np.ptp(stress) == 0:
        what = f"stretches from {stretch.min():.4g} to {stretch.max():.4g}, stresses from {stress.min():.4g} to {stress.max():.4g} MPa"
        raise InputError(what, hint="a law needs a test that pulls by 1 % or more")
    if np.corrcoef(stretch, stress)[0, 1] < 0:
        raise InputError(
            "the stress falls as the stretch grows", hint="is the sign of a column turned round, or their order?"
        )


def _taut(stretch: FloatArray, stress: FloatArray, notes: list[str]) -> tuple[FloatArray, FloatArray]:
    """The test from where the specimen is taut, its stretches counted from there."""
    top = float(stress.max())
    over = np.flatnonzero(stress > SLACK[1] * top)
    under = np.flatnonzero(stress[: over[0]] < SLACK[0] * top) if over.size else np.array([], dtype=int)
    line = slice(int(under[-1]) + 1 if under.size else 0, int(over[0]) + 1 if over.size else 0)
    if line.stop - line.start < 3 or np.ptp(stretch[line]) == 0:
        return stretch, stress
    slope, offset = np.polyfit(stretch[line], stress[line], 1)
    zero = -offset / slope if slope > 0 else 1.0
    if zero - max(1.0, float(stretch[0])) < LEAST_SLACK:
        return stretch, stress
    kept = stretch >= zero
    notes.append(
        f"slack at the start: the specimen is taut at {100 * (zero - 1):.2g} % strain, where the line through {100 * SLACK[0]:g} to "
        f"{100 * SLACK[1]:g} % of the largest stress meets zero; stretches count from there"
    )
    return stretch[kept] / zero, stress[kept]
