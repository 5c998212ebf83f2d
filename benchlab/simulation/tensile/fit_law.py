"""Coefficients of hyperelastic laws from uniaxial tests, with what these tests do and do not say about them."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from benchlab.errors import InputError, UsageError
from benchlab.simulation.laws import Law
from benchlab.simulation.laws.biaxial import PLAUSIBLE, biaxial_factor
from benchlab.simulation.laws.homogeneous import MODES, nominal_stress_MPa
from benchlab.simulation.laws.law import FloatArray
from benchlab.simulation.laws.stability import SEARCHED, StableRange, is_stable, stable_ranges
from benchlab.simulation.tensile.models import SOLVERS, Solution
from benchlab.simulation.tensile.regression import equal_weights, inseparable, precision

LEAST_POINTS = 12.0
"""Independent points that a comparison of laws grants the tests at least."""


@dataclass(frozen=True)
class Specimen:
    """One uniaxial test: stretch and nominal stress (MPa), shape (n,), loading only, n >= 6."""

    stretch: FloatArray
    stress_MPa: FloatArray

    def __post_init__(self) -> None:
        stretch, stress = np.asarray(self.stretch, dtype=float), np.asarray(self.stress_MPa, dtype=float)
        if stretch.shape != stress.shape or stretch.ndim != 1 or len(stretch) < 6:
            raise InputError(f"{stretch.size} points in a test", hint="six are the least that a law is fitted to")
        if not (np.isfinite(stretch).all() and np.isfinite(stress).all() and (stretch > 0).all()):
            raise InputError(
                "a test with stretches or stresses that are not finite, or stretches that are not positive"
            )
        if float(np.ptp(stretch)) < 0.01:
            raise InputError(f"stretches from {stretch.min():.4g} to {stretch.max():.4g}", hint="pull by 1 % or more")


@dataclass(frozen=True)
class Coefficient:
    """A fitted coefficient with its 95 % interval; `unit` is "MPa" or "" for an exponent."""

    name: str
    value: float
    low: float
    high: float
    unit: str


@dataclass(frozen=True)
class LawFit:
    """One law fitted to all specimens together.

    condition_number: of the scaled design; above 30 the coefficients in `not_separated` are known only together.
    effective_points: independent points that the tests are worth, after the correlation of neighbouring residuals.
    aicc: Akaike's criterion (Hurvich and Tsai 1989) with that number of points or 12, comparable within one `fit_laws`; None
    where the law has too many coefficients for the points.
    stable: Drucker's stability, a range for each test mode. stable_over_data: whether
    these ranges cover the fitted stretches in all modes. biaxial_factor: see `biaxial_factor`. notes: what a reader must know, in words.
    """

    name: str
    law: Law
    coefficients: tuple[Coefficient, ...]
    r_squared: float
    rmse_MPa: float
    condition_number: float
    not_separated: tuple[str, ...]
    residual_correlation: float
    effective_points: float
    degrees_of_freedom: float
    aicc: float | None
    stretch_range: tuple[float, float]
    stable: tuple[StableRange, ...]
    stable_over_data: bool
    biaxial_factor: float
    notes: tuple[str, ...]

    @property
    def plausible(self) -> bool:
        """Stable over the data, and in biaxial tension within a factor of two of what a law of I1 alone would give."""
        return self.stable_over_data and 1 / PLAUSIBLE <= self.biaxial_factor <= PLAUSIBLE


def fit_law(name: str, specimens: Sequence[Specimen]) -> LawFit:
    """Fit one law of SOLVERS by weighted least squares of the nominal stress, each specimen counting alike.

    Raises UsageError for an unknown law or no specimen, InputError for fewer points than coefficients.

    >>> stretch = np.linspace(1.0, 3.0, 50)
    >>> fit = fit_law("neo-hooke", [Specimen(stretch, 2 * 0.4 * (stretch - stretch**-2))])
    >>> round(fit.coefficients[0].value, 6), fit.stable_over_data
    (0.4, True)
    """
    if name not in SOLVERS:
        raise UsageError(f"no law is called {name!r}", hint=f"use one of {', '.join(SOLVERS)}")
    if not specimens:
        raise UsageError("no test to fit a law to")
    sizes = [len(specimen.stretch) for specimen in specimens]
    stretch = np.concatenate([specimen.stretch for specimen in specimens])
    stress = np.concatenate([specimen.stress_MPa for specimen in specimens])
    weights = equal_weights(sizes)
    found = SOLVERS[name](stretch, stress, weights)
    if len(stretch) <= len(found.names) + 1:
        raise InputError(
            f"{len(stretch)} points for the {len(found.names)} coefficients of {name}", hint="use a smaller law"
        )
    residual = stress - nominal_stress_MPa(found.law, stretch)
    known = precision(found.J, residual, sizes)
    condition, together = inseparable(found.J, sizes)
    power = float(weights @ residual**2)
    spread = float(weights @ (stress - np.average(stress, weights=weights)) ** 2)
    limits = float(stretch.min()), float(stretch.max())
    stable = stable_ranges(found.law, (min(SEARCHED[0], limits[0]), max(SEARCHED[1], limits[1])))
    fit = LawFit(
        name=name,
        law=found.law,
        coefficients=_coefficients(found, known.half_width),
        r_squared=1 - power / spread if spread > 0 else math.nan,
        rmse_MPa=math.sqrt(power / len(stretch)),
        condition_number=condition,
        not_separated=tuple(found.names[i] for i in together),
        residual_correlation=known.residual_correlation,
        effective_points=known.effective_points,
        degrees_of_freedom=known.degrees,
        aicc=None,
        stretch_range=limits,
        stable=stable,
        stable_over_data=all(one.covers(*limits) for one in stable) and _stable_at(found.law, limits),
        biaxial_factor=biaxial_factor(found.law, limits[1]),
        notes=found.notes,
    )
    return replace(_scored([fit], len(stretch))[0], notes=(*found.notes, *_notes(fit, len(specimens))))


def fit_laws(specimens: Sequence[Specimen], names: Sequence[str] = tuple(SOLVERS)) -> tuple[LawFit, ...]:
    """Fit several laws, in the order of `names`, with criteria that can be compared."""
    return _scored([fit_law(name, specimens) for name in names], sum(len(one.stretch) for one in specimens))


def recommended(fits: Sequence[LawFit]) -> LawFit:
    """The law with the lowest AICc among the plausible ones; where no AICc is known, the lowest RMSE.

    Only a guide: a test in one mode does not know how a law does in another. Raises InputError where no law is plausible.
    """
    plausible = [fit for fit in fits if fit.plausible]
    if not plausible:
        tried = ", ".join(fit.name for fit in fits)
        raise InputError(
            f"no fitted law is stable over the stretches of the test and plausible in biaxial tension ({tried})",
            hint="fit a smaller range with --max-stretch, or choose one with --law all the same",
        )
    if scored := [fit for fit in plausible if fit.aicc is not None]:
        return min(scored, key=lambda fit: (fit.aicc, len(fit.coefficients)))
    return min(plausible, key=lambda fit: (fit.rmse_MPa, len(fit.coefficients)))


def thinned(stretch: FloatArray, stress_MPa: FloatArray, bins: int = 200) -> Specimen:
    """A test as at most `bins` points: means over equal steps of stretch, so that no stretch counts more for being sampled densely.

    A test with no more points than that is only sorted.
    """
    order = np.argsort(stretch, kind="stable")
    stretch, stress_MPa = np.asarray(stretch, dtype=float)[order], np.asarray(stress_MPa, dtype=float)[order]
    if len(stretch) <= bins:
        return Specimen(stretch, stress_MPa)
    edges = np.linspace(stretch[0], stretch[-1], bins + 1)
    at = np.clip(np.searchsorted(edges, stretch, side="right") - 1, 0, bins - 1)
    count = np.bincount(at, minlength=bins)
    full = count > 0
    means = (np.bincount(at, values, bins)[full] / count[full] for values in (stretch, stress_MPa))
    return Specimen(*means)


def _scored(fits: Sequence[LawFit], points: int) -> tuple[LawFit, ...]:
    """AICc with one number of points for all: the effective one of the law that fits best, at least LEAST_POINTS, at most all.

    A smooth test that every law misses by a wave would otherwise count for less than a law has coefficients.
    """
    best = min(fits, key=lambda fit: fit.rmse_MPa)
    n = min(points, max(best.effective_points, LEAST_POINTS))
    scored = []
    for fit in fits:
        k = len(fit.coefficients) + 1
        room = n - k - 1
        aicc = n * math.log(max(fit.rmse_MPa, 1e-300) ** 2) + 2 * k + 2 * k * (k + 1) / room if room > 0 else None
        scored.append(replace(fit, aicc=aicc))
    return tuple(scored)


def _stable_at(law: Law, limits: tuple[float, float]) -> bool:
    """Stability at a finer look over the fitted stretches themselves."""
    steps = np.geomspace(*limits, 2001)
    return all(bool(np.all(is_stable(law, steps, mode))) for mode in MODES)


def _coefficients(found: Solution, half_width: FloatArray) -> tuple[Coefficient, ...]:
    return tuple(
        Coefficient(
            name, float(value), float(value - half), float(value + half), "" if name.startswith("alpha") else "MPa"
        )
        for name, value, half in zip(found.names, found.values, half_width)
    )


def _notes(fit: LawFit, specimens: int) -> list[str]:
    notes = []
    if fit.not_separated:
        notes.append(
            f"these tests hardly separate {' and '.join(fit.not_separated)} (condition number {fit.condition_number:.0f}): "
            "they are known together, not each; a planar or biaxial test would tell them apart"
        )
    if unsure := [c.name for c in fit.coefficients if c.low <= 0 <= c.high and len(fit.coefficients) > 1]:
        notes.append(f"not told apart from zero: {', '.join(unsure)}")
    if specimens > 1:
        notes.append(
            f"intervals from the scatter of {specimens} specimens ({fit.degrees_of_freedom:.0f} degrees of freedom)"
        )
    else:
        notes.append(
            f"one specimen: intervals hold for it, not for the material; neighbouring residuals correlate with "
            f"{fit.residual_correlation:.2f}, so the curve is worth about {fit.effective_points:.0f} independent points"
        )
    if not 1 / PLAUSIBLE <= fit.biaxial_factor <= PLAUSIBLE:
        notes.append(
            f"in equibiaxial tension up to {fit.biaxial_factor:.2g} times the stress of a law of I1 alone: no uniaxial test supports that"
            if math.isfinite(fit.biaxial_factor)
            else "pushes where it should pull, in uniaxial or equibiaxial tension"
        )
    for one in fit.stable:
        if not one.covers(*fit.stretch_range):
            notes.append(f"unstable (Drucker) in {one.mode} tension outside stretches {one.low:.3g} to {one.high:.3g}")
    return notes
