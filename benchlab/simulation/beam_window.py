"""One window of the beam: the force that opens it, as its film stays flat between two ribs or bows out under pressure.

Ribs are rigid hoops of the tube's radius R. The film between two of them, tw long as cut, spans the opening c. It bows into an arc of
half angle α (sag (c/2)·tan(α/2)), of one meridional stretch λ_m and the hoop stretch λ_h that its distance y from the hoop gives:

    λ_m = (c/tw)·α/sin α          λ_h = 1 + y/R          y(ξ) = (c/2)·(cos ξα − cos α)/sin α,   −1 ≤ ξ ≤ 1 along the arc

Per width of the circumference the energy less the work of the pressure q that bows it is

    w(c, α) = tw·h·⟨W(λ_m, λ_h)⟩ − q·v(c, α)          v = ∫ (y + y²/(2R)) dz,   z along the axis

⟨ ⟩ the mean along the arc, v the volume between the film and the hoop's cylinder. The bow is in balance where ∂w/∂α = 0 (Laplace's
law of a membrane with two curvatures, in the mean); then the force per width with which the window pulls on its ribs is F = ∂w/∂c.
For a window that is narrow against R this is the long strip under pressure, q = T/ρ with ρ = c/(2·sin α), which pulls on its ribs with
F = T·cos α. At one opening a bowed film is longer than a flat one, hence tighter, and pulls harder; sin α = q·c/(2·T) grows with c, so
wide windows gain most, and open least. With q = 0 the film is flat, α = 0, and F is its nominal tension at the stretches (c/tw, 1).
Not in here: contact, film bending, what the strip's edges do to a bow near them.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from benchlab.simulation.laws.law import FloatArray
from benchlab.simulation.layup import Layer

OPENINGS = np.concatenate((np.geomspace(0.6, 1.0, 33)[:-1], np.geomspace(1.0, 5.0, 105)))
"""Openings c/tw of the tables, about evenly in their logarithm; the window as cut is one of them."""

WIDEST_BOW_RAD = np.pi / 2
"""Half angle α beyond which a window would hang over its ribs and touch its neighbour: no state is looked for there."""

_SMALLEST_BOW_RAD = 1e-5
_POINTS, _WEIGHTS = np.polynomial.legendre.leggauss(8)
_XI, _SHARE = (1 + _POINTS) / 2, _WEIGHTS / 2
"""Gauss points along half the arc, and their shares of it."""


@dataclass(frozen=True)
class Wall:
    """Layers of a sheet that strain alike."""

    layers: tuple[Layer, ...]

    def energy_N_per_mm(self, meridional: FloatArray, hoop: FloatArray) -> FloatArray:
        """Σ h·W at stretches of one shape."""
        m2, h2 = meridional**2, hoop**2
        return sum((each.thickness_mm * each.law.energy(m2 + h2, m2 * h2).W for each in self.layers), np.zeros_like(m2))

    def tensions_N_per_mm(self, meridional: FloatArray, hoop: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Nominal tensions Σ h·∂W/∂λ_m and Σ h·∂W/∂λ_h at stretches of one shape."""
        m2, h2 = meridional**2, hoop**2
        along, around = np.zeros_like(m2), np.zeros_like(m2)
        for each in self.layers:
            at = each.law.energy(m2 + h2, m2 * h2)
            along = along + 2 * each.thickness_mm * meridional * (at.W_a + h2 * at.W_b)
            around = around + 2 * each.thickness_mm * hoop * (at.W_a + m2 * at.W_b)
        return along, around


@dataclass(frozen=True)
class Film:
    """What a window is covered with, its length as cut tw, and the radius R of the hoops (mm)."""

    wall: Wall
    width_mm: float
    radius_mm: float


@dataclass(frozen=True)
class Window:
    """A window at one pressure, (C,) each over growing openings: opening_mm, force_N_per_mm F, bow_rad α, volume_mm2 v (per width)."""

    opening_mm: FloatArray
    force_N_per_mm: FloatArray
    bow_rad: FloatArray
    volume_mm2: FloatArray


def window_at(film: Film, pressure_MPa: float) -> Window:
    """The window at the pressure q that bows its film: the openings at which there is a state; none where it bursts at all of them.

    >>> from benchlab.simulation.laws import Polynomial
    >>> film = Film(Wall((Layer("film", Polynomial(C10=1.5, C20=3.0), 0.0, 0.3),)), width_mm=9.0, radius_mm=6.37)
    >>> flat, bowed = window_at(film, 0.0), window_at(film, 0.3)
    >>> pulls = [np.interp(10.8, each.opening_mm, each.force_N_per_mm) for each in (flat, bowed)]  # stretched by a fifth
    >>> [round(float(each), 2) for each in (*pulls, np.degrees(np.interp(10.8, bowed.opening_mm, bowed.bow_rad)))]
    [0.86, 1.43, 25.78]
    """
    opening = film.width_mm * OPENINGS
    bow = bow_rad(film, opening, pressure_MPa) if pressure_MPa > 0 else np.zeros_like(opening)
    kept = _longest_run(np.isfinite(bow))
    opening, bow = opening[kept], bow[kept]
    force, volume = force_and_volume(film, opening, bow, pressure_MPa)
    return Window(opening, force, bow, volume)


def bow_rad(film: Film, opening_mm: FloatArray, pressure_MPa: float) -> FloatArray:
    """(C,): the smallest half angle α at which the bow is in balance; NaN where there is none up to WIDEST_BOW_RAD."""
    from scipy.optimize.elementwise import find_root

    tried = np.linspace(_SMALLEST_BOW_RAD, WIDEST_BOW_RAD, 33)
    slopes = np.stack([bow_slope(film, opening_mm, np.full_like(opening_mm, each), pressure_MPa) for each in tried])
    after = np.argmax(slopes >= 0, axis=0)  # 0: at once, as under no pressure; or never
    low, high = tried[np.maximum(after - 1, 0)], tried[np.maximum(after, 1)]
    found = find_root(lambda bow, opening: bow_slope(film, opening, bow, pressure_MPa), (low, high), args=(opening_mm,))
    never = (slopes < 0).all(axis=0)
    return np.where(never, np.nan, np.where(slopes[0] >= 0, 0.0, found.x))


def bow_slope(film: Film, opening_mm: FloatArray, bow: FloatArray, pressure_MPa: float) -> FloatArray:
    """(C,): ∂w/∂α at openings c and half angles α > 0."""
    c, alpha = opening_mm[..., None], bow[..., None]
    sin, cos = np.sin(alpha), np.cos(alpha)
    sin_xi, cos_xi = np.sin(_XI * alpha), np.cos(_XI * alpha)
    rise, along = _rise(alpha), alpha * cos_xi / sin  # y = (c/2)·rise, dz = (c/2)·along·dξ
    d_rise = 1 - _XI * sin_xi / sin - rise * cos / sin
    d_along = (cos_xi - alpha * _XI * sin_xi) / sin - along * cos / sin
    tension_m, tension_h = film.wall.tensions_N_per_mm(
        c / film.width_mm * alpha / sin + 0 * rise, 1 + c / 2 * rise / film.radius_mm
    )
    d_arc = (sin - alpha * cos) / sin**2
    strained = tension_m * c * d_arc + tension_h * film.width_mm * c / 2 * d_rise / film.radius_mm
    half = c / 2
    swept = half**2 * 2 * (d_rise * along + rise * d_along)
    swept = swept + half**3 / film.radius_mm * (2 * rise * d_rise * along + rise**2 * d_along)
    return np.asarray(((strained - pressure_MPa * swept) * _SHARE).sum(-1))


def force_and_volume(
    film: Film, opening_mm: FloatArray, bow: FloatArray, pressure_MPa: float
) -> tuple[FloatArray, FloatArray]:
    """(C,) each: F = ∂w/∂c (N/mm) and v (mm²) at openings c and half angles α."""
    c, alpha = opening_mm[..., None], np.maximum(bow, 1e-15)[..., None]  # flat is a bow too small to be seen
    rise, arc = _rise(alpha), alpha / np.sin(alpha)
    along = arc * np.cos(_XI * alpha)
    half = c / 2
    tension_m, tension_h = film.wall.tensions_N_per_mm(
        c / film.width_mm * arc + 0 * rise, 1 + half * rise / film.radius_mm
    )
    first = (half**2 * 2 * rise * along * _SHARE).sum(-1)
    second = (half**3 / film.radius_mm * rise**2 * along * _SHARE).sum(-1)
    pulled = ((tension_m * arc + tension_h * film.width_mm / 2 * rise / film.radius_mm) * _SHARE).sum(-1)
    return pulled - pressure_MPa * (2 * first + 3 * second) / opening_mm, first + second


def _rise(alpha: FloatArray) -> FloatArray:
    """(cos ξα − cos α)/sin α, as a product, which does not cancel."""
    return np.asarray(2 * np.sin((1 + _XI) * alpha / 2) * np.sin((1 - _XI) * alpha / 2) / np.sin(alpha))


def _longest_run(kept: np.ndarray) -> slice:
    """The longest run of True."""
    edges = np.flatnonzero(np.diff(np.concatenate(([0], kept.astype(int), [0]))))
    starts, ends = edges[::2], edges[1::2]
    if not len(starts):
        return slice(0, 0)
    best = int(np.argmax(ends - starts))
    return slice(int(starts[best]), int(ends[best]))
