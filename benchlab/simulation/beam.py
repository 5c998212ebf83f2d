"""The actuator as a beam of one dimension: a round section that stays round, in balance of force and moment about its strip.

This is the model that most papers bring for bending actuators with a strain-limiting layer: plane sections stay plane, and the pressure
on the end of the section is held by what the walls pull (for fibre-reinforced ones Polygerinos et al. 2015, IEEE Transactions on Robotics
31, 778, who take the moments about the layer). It is here to be compared with, and to show what it lacks: that windows balloon.

The section is a circle of radius R = perimeter/2π, φ from the middle of the strip, x(φ) = R·(1 − cos φ) the distance from the strip's line.
The strip's line has the stretch λ0, all else on the section

    λ(φ) = λ0 + k·x(φ)          k: angle per unstretched length; curvature of the strip's line κ = k/λ0, angle θ = k·al

Along the axis a cell is a rib, rigid, and a window, so that the window's opening is c = tw + (λ − 1)·(tw + fw). On the arc of the windows
the wall pulls with F(c) per width (beam_window); on that of the strip with h·∂W/∂λ of the fabric and the film under it, held in
width. With A = πR²:

    force      2∫ F dφR = p·A              moment about the strip's line      2∫ F·x dφR = p·A·R + M

over half the circumference; M = 0 where the actuator is free to bend; held straight k = 0 and −M is what the fixture bears. Both are
the gradient of Π(λ0, k) = walls − p·A·(λ0 + k·R), whose minimum is looked for; the enclosed volume is A·(λ0 + k·R) a length (Pappus)
and what the windows' bows add. A film linear in stretch under a stiff narrow strip has in closed form κ = p·tw/(3·h·E'·(tw + fw)), at small
p and with E' = 4·μ of an incompressible film held in width, whatever R.

ballooning b: the windows' films bow under the pressure b·p. 0 is the bare beam, whose film stays flat between the ribs; 1 is the beam whose
windows bulge as a membrane does. Nothing in it is fitted.
Not in here: a section that does not stay round, bending stiffness of layers, a weld under the strip, ends, time.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from benchlab.actuator import ShellDesign
from benchlab.errors import UsageError
from benchlab.simulation.actuator_response import Curves, Fixture, check_cap
from benchlab.simulation.beam_window import Film, Wall, window_at
from benchlab.simulation.laws.law import FloatArray
from benchlab.simulation.layup import Layup, laminate_at, pieces_of
from benchlab.simulation.response import check_pressures

_POINTS, _WEIGHTS = np.polynomial.legendre.leggauss(24)
SOFT = frozenset({"film", "bladder"})
"""Pieces that stretch along the axis in a window; where others lie across its middle, there is none."""

_MOST_STEPS = 200
_SMALLEST_STEP = 1e-11
"""Of the stretches: a Newton step below it ends the search."""


@dataclass(frozen=True)
class BeamResponse(Curves):
    """Response curves of the beam, as those of the shell cell. bow_rad: (P,), largest half angle of a window's bow.
    stiffness_Nmm2: (P,), dM/dk. ballooning: b.
    """

    bow_rad: FloatArray
    stiffness_Nmm2: FloatArray
    ballooning: float

    def bending_stiffness_Nmm2(self) -> FloatArray:
        return self.stiffness_Nmm2


def beam_response(
    design: ShellDesign,
    layup: Layup,
    pressures_MPa: Sequence[float],
    fixture: Fixture | None = None,
    cap_mm: float = 0.0,
    blocked: bool = True,
    ballooning: float = 0.0,
) -> BeamResponse:
    """The beam at growing pressures (MPa). cap_mm: rigid length at each end. blocked: also held straight. ballooning: b of the above.

    Curves end below a pressure at which there is no stable state. Raises UsageError for impossible pressures, caps or ballooning.

    >>> from benchlab.simulation.laws import Polynomial
    >>> layup = Layup("trial", "guessed", film=Polynomial(C10=1.5, C20=3.0))
    >>> wide = ShellDesign(strip_width_mm=10, window_width_mm=15)
    >>> [round(float(beam_response(wide, layup, [0.35], ballooning=b).angle_deg[0])) for b in (0, 1)]
    [208, 95]
    """
    if not 0 <= ballooning <= 1:
        raise UsageError(f"ballooning is {ballooning:g}", hint="give 0 (flat windows) to 1 (bulging ones)")
    check_cap(cap_mm, design)
    check_pressures(pressures_MPa)
    section = _Section.of(design, layup)
    rows: list[tuple[float, ...]] = []
    free, held = np.array([1.0, 0.0]), np.array([1.0, 0.0])
    limit = None
    for pressure in map(float, pressures_MPa):
        walls = _Walls(section, pressure, ballooning)
        if (found := walls.balance(free)) is None:
            limit = rows[-1][0] if rows else 0.0
            break
        free = found
        straight = walls.balance(held, straight=True) if blocked else None
        held = held if straight is None else straight
        moment = np.nan if straight is None else -float(walls.gradient(straight)[1])
        rows.append(
            (pressure, *free, walls.area_mm2(free), walls.bow_rad(free), walls.bending_stiffness_Nmm2(free), moment)
        )
    reached, stretch, k, area, bow, stiffness, moments = np.array(rows).reshape(-1, 7).T
    active = design.length_mm - 2 * cap_mm
    return BeamResponse(
        design=design,
        layup=layup,
        fixture=fixture or Fixture(),
        cap_mm=cap_mm,
        pressure_MPa=reached,
        angle_rad=k * active,
        curvature_per_mm=k / stretch,
        axial_stretch=stretch,
        volume_mm3=area * active + section.area_mm2 * 2 * cap_mm,
        moment_Nmm=moments,
        limit_pressure_MPa=limit,
        bow_rad=bow,
        stiffness_Nmm2=stiffness,
        ballooning=ballooning,
    )


@dataclass(frozen=True)
class _Arc:
    """Part of half the section that has no windows: its wall, distances x (mm) from the strip's line and widths (mm) of its points."""

    wall: Wall
    x_mm: FloatArray
    width_mm: FloatArray


@dataclass(frozen=True)
class _Section:
    """Half the section: the windows' film with distances x and widths of its points, and the arcs of fabric."""

    film: Film
    cell_mm: float
    x_mm: FloatArray
    width_mm: FloatArray
    fabric: tuple[_Arc, ...]

    @staticmethod
    def of(design: ShellDesign, layup: Layup) -> _Section:
        """From the pieces of the shell cell, as they lie across the middle of a window."""
        pieces, radius = pieces_of(design, layup), design.perimeter_mm / (2 * np.pi)
        rib, half_cell = next(p.Z_mm[1] for p in pieces if p.name == "rib"), pieces[0].Z_mm[1]
        windows: list[_Arc] = []
        fabric: list[_Arc] = []
        for start, end in pairwise(sorted({border for piece in pieces for border in piece.s_mm})):
            layers = laminate_at(pieces, (start + end) / 2, (rib + half_cell) / 2)
            s = (start + end) / 2 + (end - start) / 2 * _POINTS
            arc = _Arc(Wall(layers), radius * (1 - np.cos(s / radius)), (end - start) / 2 * _WEIGHTS)
            (windows if {layer.name for layer in layers} <= SOFT else fabric).append(arc)
        return _Section(
            Film(windows[0].wall, 2 * (half_cell - rib), radius),
            2 * half_cell,
            np.concatenate([arc.x_mm for arc in windows]),
            np.concatenate([arc.width_mm for arc in windows]),
            tuple(fabric),
        )

    @property
    def area_mm2(self) -> float:
        return float(np.pi * self.film.radius_mm**2)


class _Walls:
    """What the walls of the section do at one pressure, as functions of state = (λ0, k)."""

    def __init__(self, section: _Section, pressure_MPa: float, ballooning: float) -> None:
        from scipy.interpolate import CubicSpline

        self.section, self.pressure = section, pressure_MPa
        window = window_at(section.film, ballooning * pressure_MPa)
        self.opening = window.opening_mm
        if len(self.opening) >= 4:
            self.force = CubicSpline(window.opening_mm, window.force_N_per_mm)
            self.slope, self.energy = self.force.derivative(), self.force.antiderivative()
            self.bow = CubicSpline(window.opening_mm, window.bow_rad)
            self.swept = CubicSpline(window.opening_mm, window.volume_mm2)

    def openings(self, state: FloatArray) -> FloatArray:
        at = self.section
        return at.film.width_mm + (state[0] + state[1] * at.x_mm - 1) * at.cell_mm

    def known(self, state: FloatArray) -> bool:
        """Whether all windows have a state."""
        if len(self.opening) < 4:
            return False
        opening = self.openings(state)
        pressed = min(float((state[0] + state[1] * arc.x_mm).min()) for arc in self.section.fabric)
        return bool(opening.min() >= self.opening[0] and opening.max() <= self.opening[-1] and pressed > 0.5)

    def potential(self, state: FloatArray) -> float:
        """Π per length but for a constant (N); infinite where it is not known."""
        if not self.known(state):
            return np.inf
        at, (stretch, k) = self.section, state
        walls = (self.energy(self.openings(state)) * at.width_mm).sum() / at.cell_mm
        for arc in at.fabric:
            along = stretch + k * arc.x_mm
            walls += (arc.wall.energy_N_per_mm(along, np.ones_like(along)) * arc.width_mm).sum()
        return float(2 * walls - self.pressure * at.area_mm2 * (stretch + k * at.film.radius_mm))

    def gradient(self, state: FloatArray) -> FloatArray:
        """(2,): what the walls pull more than the pressure: force (N), and moment about the strip's line (N·mm)."""
        at = self.section
        pulled = _moments(at.x_mm, self.force(self.openings(state)) * at.width_mm, 2)
        for arc in at.fabric:
            pulled += _moments(arc.x_mm, _held_in_width(arc.wall, state[0] + state[1] * arc.x_mm) * arc.width_mm, 2)
        return pulled - self.pressure * at.area_mm2 * np.array([1.0, at.film.radius_mm])

    def hessian(self, state: FloatArray) -> FloatArray:
        at, step = self.section, 1e-5
        stiffness = _moments(at.x_mm, self.slope(self.openings(state)) * at.cell_mm * at.width_mm, 3)
        for arc in at.fabric:
            along = state[0] + state[1] * arc.x_mm
            slope = (_held_in_width(arc.wall, along + step) - _held_in_width(arc.wall, along - step)) / (2 * step)
            stiffness += _moments(arc.x_mm, slope * arc.width_mm, 3)
        return np.array([stiffness[:2], stiffness[1:]])

    def balance(self, start: FloatArray, straight: bool = False) -> FloatArray | None:
        """The state in stable balance that goes down in energy from `start`, with k = 0 where straight; None where there is none."""
        free = slice(0, 1) if straight else slice(0, 2)
        small = _SMALLEST_STEP * np.array([1.0, 1 / self.section.film.radius_mm])
        state, value = start, self.potential(start)
        for _ in range(_MOST_STEPS):
            if not np.isfinite(value):
                return None
            hessian = self.hessian(state)[free, free]
            step = np.zeros(2)
            step[free] = -np.linalg.solve(_positive(hessian), self.gradient(state)[free])
            if (np.abs(step) <= small).all():
                return state if np.linalg.eigvalsh(hessian)[0] > 0 else None
            while (ahead := self.potential(state + step)) > value + 1e-12 * abs(value) and (np.abs(step) > small).any():
                step = step / 2
            state, value = state + step, ahead
        return None

    def area_mm2(self, state: FloatArray) -> float:
        """Volume a length of actuator."""
        at = self.section
        bows = 2 * (self.swept(self.openings(state)) * at.width_mm).sum() / at.cell_mm
        return float(at.area_mm2 * (state[0] + state[1] * at.film.radius_mm) + bows)

    def bending_stiffness_Nmm2(self, state: FloatArray) -> float:
        """dM/dk, the stretch in balance."""
        (along, mixed), (_, bending) = self.hessian(state)
        return float(bending - mixed**2 / along)

    def bow_rad(self, state: FloatArray) -> float:
        return float(self.bow(self.openings(state)).max())


def _held_in_width(wall: Wall, stretch: FloatArray) -> FloatArray:
    return wall.tensions_N_per_mm(stretch, np.ones_like(stretch))[0]


def _moments(x_mm: FloatArray, pulled: FloatArray, count: int) -> FloatArray:
    """(count,): 2·Σ pulled·xⁿ, n = 0, 1, ...: of both halves of the section."""
    return np.array([2 * float((pulled * x_mm**n).sum()) for n in range(count)])


def _positive(hessian: FloatArray) -> FloatArray:
    """The matrix with its eigenvalues turned positive, so that its Newton step goes down."""
    values, vectors = np.linalg.eigh(hessian)
    values = np.maximum(np.abs(values), 1e-9 * np.abs(values).max())
    return np.asarray((vectors * values) @ vectors.T)
