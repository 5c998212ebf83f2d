"""All points of the quarter cell together: strain energy and volume, gradient and Hessian, in the fields and (k, λ)."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from benchlab.actuator import ShellDesign
from benchlab.simulation.laws.law import FloatArray
from benchlab.simulation.layup import Layup, laminate_at, pieces_of
from benchlab.simulation.mesh import CellMesh, cell_mesh, gradings, grid_lines, on_circle
from benchlab.simulation.shell import DY, DZ, Density, Laminate, T, X, Y, potential_density, volume_density

FIELDS = 6
GlobalTerm = Callable[[float, float], tuple[float, FloatArray, FloatArray]]
"""An energy of the quarter cell in (k, λ) alone: value (N·mm), gradient (2,), Hessian (2, 2). Loads enter here."""


@dataclass(frozen=True)
class Potential:
    """Π = strain energy − p·V of the quarter cell (N·mm), with N the number of nodes.

    gradient (6 N,) and border_gradient (2,) in the fields and in (k, λ). The Hessian in the fields is banded, lower form
    as LAPACK takes it (bandwidth + 1, 6 N); coupling (6 N, 2); border (2, 2). Held components have gradient 0 and a
    diagonal of 1.
    """

    value: float
    gradient: FloatArray
    border_gradient: FloatArray
    band: FloatArray
    coupling: FloatArray
    border: FloatArray


@dataclass(frozen=True)
class State:
    """Where the cell is: fields (6 N,), k (rad/mm of unstretched length) and the axial stretch λ at x = 0."""

    fields: FloatArray
    k: float
    lam: float


@dataclass(frozen=True)
class Cell:
    """The quarter cell of a design: mesh, laminates, conditions of symmetry.

    radius_mm: of the middle of the film in the round tube. inner_mm: z of the face on which the pressure acts.
    laminates: each with the numbers of its elements. terms: further energies in (k, λ).
    """

    mesh: CellMesh
    half_length_mm: float
    radius_mm: float
    inner_mm: float
    laminates: tuple[tuple[Laminate, NDArray[np.int64]], ...]
    terms: tuple[GlobalTerm, ...] = ()
    held: NDArray[np.bool_] = field(init=False)
    _places: NDArray[np.int64] = field(init=False)
    _pattern: tuple[NDArray[np.int64], NDArray[np.bool_]] = field(init=False)

    @classmethod
    def of(cls, design: ShellDesign, layup: Layup, refine: int = 1, terms: Sequence[GlobalTerm] = ()) -> Cell:
        """The cell of a design; borders of pieces are grid lines. refine: elements a default element is split in, each way."""
        pieces = pieces_of(design, layup)
        s_breaks = sorted({place for piece in pieces for place in piece.s_mm})
        Z_breaks = sorted({place for piece in pieces for place in piece.Z_mm})
        around, along = gradings(design.perimeter_mm, layup.film_thickness_mm)
        radius = design.perimeter_mm / (2 * np.pi)
        grid = cell_mesh(grid_lines(s_breaks, around, refine), grid_lines(Z_breaks, along, refine))
        grid = on_circle(grid, radius)
        shape = 1 / radius if layup.moulded else 0.0
        groups: dict[Laminate, list[int]] = {}
        for element, (s, Z) in enumerate(grid.centre_mm):
            groups.setdefault(Laminate(laminate_at(pieces, s, Z, layup.stacking), shape), []).append(element)
        return cls(
            mesh=grid,
            half_length_mm=(design.window_width_mm + design.rib_width_mm) / 2,
            radius_mm=radius,
            inner_mm=-layup.film_thickness_mm / 2,
            laminates=tuple((laminate, np.array(elements)) for laminate, elements in groups.items()),
            terms=tuple(terms),
        )

    def __post_init__(self) -> None:
        nodes, size = self.mesh.nodes_mm, FIELDS * len(self.mesh.nodes_mm)
        held = np.zeros((len(nodes), FIELDS), dtype=bool)
        s, Z = nodes.T
        seam = np.isclose(s, 0) | np.isclose(s, s.max())
        end = np.isclose(Z, 0) | np.isclose(Z, Z.max())
        held[seam, Y] = held[seam, DY] = held[end, T] = held[end, DZ] = True
        held[0, X] = True  # the origin of x: node 0 is at s = Z = 0
        places = (FIELDS * self.mesh.elements[:, :, None] + np.arange(FIELDS)).reshape(len(self.mesh.elements), -1)
        rows, columns = places[:, :, None], places[:, None, :]
        free = ~held.ravel()
        used = (rows >= columns) & free[rows] & free[columns]
        slots = ((rows - columns) * size + columns)[used]
        object.__setattr__(self, "held", held.ravel())
        object.__setattr__(self, "_places", places)
        object.__setattr__(self, "_pattern", (slots, used))

    @property
    def bandwidth(self) -> int:
        places = self._places
        return int((places.max(axis=1) - places.min(axis=1)).max())

    def round_tube(self) -> State:
        """The sheet rolled into a round tube, straight and unstretched."""
        s, Z = self.mesh.nodes_mm.T
        R, phi = self.radius_mm, s / self.radius_mm
        zero = np.zeros_like(s)
        fields = np.stack([R * (1 - np.cos(phi)), R * np.sin(phi), Z, -np.cos(phi), np.sin(phi), zero], axis=1)
        fields[:, [Y, DY]] = np.where(np.isclose(np.sin(phi), 0, atol=1e-9)[:, None], 0, fields[:, [Y, DY]])
        return State(fields.ravel(), 0.0, 1.0)

    def points(self, state: State) -> FloatArray:
        """Value, d/ds and d/dZ of the six fields at the integration points: (E, 9, 3, 6)."""
        fields = state.fields.reshape(-1, FIELDS)[self.mesh.elements]
        shape = self.mesh.shape
        return (shape.reshape(len(shape), -1, 9) @ fields).reshape(*shape.shape[:3], FIELDS)

    def densities(self, state: State, pressure_MPa: float) -> Density:
        """Ψ − p·v at all integration points, in the order of the elements: arrays (E·9, ...)."""
        q = self.points(state)
        count = len(q) * 9
        value, gradient, hessian = np.empty(count), np.empty((count, 20)), np.empty((count, 20, 20))
        for laminate, elements in self.laminates:
            part = potential_density(
                q[elements].reshape(-1, 3, FIELDS), state.k, state.lam, laminate, pressure_MPa, self.inner_mm
            )
            rows = (9 * elements[:, None] + np.arange(9)).ravel()
            value[rows], gradient[rows], hessian[rows] = part.value, part.gradient, part.hessian
        return Density(value, gradient, hessian)

    def potential(self, state: State, pressure_MPa: float) -> Potential:
        """Π with its derivatives."""
        density = self.densities(state, pressure_MPa)
        weight = self.mesh.weight_mm2.reshape(-1)
        shape = self.mesh.shape
        E, size = len(shape), FIELDS * len(self.mesh.nodes_mm)
        B = shape.reshape(E, 27, 9)
        g = (density.gradient * weight[:, None]).reshape(E, 9, 20)
        H = (density.hessian * weight[:, None, None]).reshape(E, 9, 20, 20)

        local = B.transpose(0, 2, 1) @ g[:, :, :18].reshape(E, 27, 6)
        gradient = _sums(self._places.ravel(), local.ravel(), size)
        mixed = H[:, :, :18, 18:].reshape(E, 27, 12)
        coupling_local = (B.transpose(0, 2, 1) @ mixed).reshape(E, 54, 2)
        coupling = np.stack(
            [_sums(self._places.ravel(), coupling_local[:, :, i].ravel(), size) for i in range(2)], axis=1
        )
        inner = H[:, :, :18, :18].reshape(E, 9, 3, 6, 3, 6)
        half = np.ascontiguousarray(inner.transpose(0, 1, 2, 3, 5, 4)).reshape(E, 9, 108, 3) @ shape
        stiffness = B.transpose(0, 2, 1) @ half.reshape(E, 27, 6 * 6 * 9)
        stiffness = stiffness.reshape(E, 9, 6, 6, 9).transpose(0, 1, 2, 4, 3).reshape(E, 54, 54)
        slots, used = self._pattern
        band = _sums(slots, stiffness[used], (self.bandwidth + 1) * size).reshape(-1, size)
        gradient[self.held] = 0
        coupling[self.held] = 0
        band[0, self.held] = 1

        value = float(density.value @ weight)
        border_gradient = g[:, :, 18:].sum(axis=(0, 1))
        border = H[:, :, 18:, 18:].sum(axis=(0, 1))
        for term in self.terms:
            more, slope, curvature = term(state.k, state.lam)
            value, border_gradient, border = value + more, border_gradient + slope, border + curvature
        return Potential(value, gradient, border_gradient, band, coupling, border)

    def volume_mm3(self, state: State) -> float:
        """Volume inside the whole cell, a rib and a window."""
        q = self.points(state).reshape(-1, 3, FIELDS)
        return 4 * float(volume_density(q, state.k, state.lam, self.inner_mm) @ self.mesh.weight_mm2.ravel())


def _sums(places: NDArray[np.int64], values: FloatArray, size: int) -> FloatArray:
    """Sums of the values that belong to each of `size` places."""
    return np.asarray(np.bincount(places, values, size), dtype=float)
