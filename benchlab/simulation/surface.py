"""The deformed shell as a grid of small quadrilaterals: of one whole cell, and of the whole actuator."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from benchlab.actuator import ShellDesign
from benchlab.simulation.cell import FIELDS, Cell, State
from benchlab.simulation.deformed import sheet_stress, to_space
from benchlab.simulation.laws.law import FloatArray
from benchlab.simulation.shell import DX, DY, DZ, T, X, Y, metric_at, strains

_BARE = "none"


@dataclass(frozen=True)
class Surface:
    """A tube as a grid: points_mm (m, n, 3) around and along, closed around (the last row is the first again).

    piece (m − 1, n − 1): name of the outermost layer of each face, or "cap". stretch (m − 1, n − 1): largest principal
    stretch of the film in its middle, NaN where there is none. The first row lies opposite the strip.
    """

    points_mm: FloatArray
    piece: NDArray[np.str_]
    stretch: FloatArray

    @property
    def quads_mm(self) -> FloatArray:
        """Corners (faces, 4, 3) of the faces, row by row; seen from outside they go one way round."""
        points = self.points_mm
        return np.stack([points[:-1, :-1], points[1:, :-1], points[1:, 1:], points[:-1, 1:]], axis=2).reshape(-1, 4, 3)

    @property
    def volume_mm3(self) -> float:
        """Enclosed volume between the first and the last ring, whose ends are closed by plane faces (divergence theorem)."""
        quads = self.quads_mm
        triangles = np.concatenate([quads[:, [0, 1, 2]], quads[:, [0, 2, 3]]])
        for ring, turn in ((self.points_mm[:-1, 0], -1), (self.points_mm[:-1, -1], 1)):
            centre = np.broadcast_to(ring.mean(axis=0), ring.shape)
            triangles = np.concatenate(
                [triangles, np.stack([centre, ring, np.roll(ring, -1, axis=0)], axis=1)[:, ::turn]]
            )
        return abs(float(np.linalg.det(triangles).sum())) / 6


@dataclass(frozen=True)
class _Quarter:
    """A quarter cell, finely sampled: x, y, t, tilt (m, n) in the turning frame; piece and stretch of the faces."""

    x: FloatArray
    y: FloatArray
    t: FloatArray
    tilt: FloatArray
    piece: NDArray[np.str_]
    stretch: FloatArray


def whole_cell(cell: Cell, state: State, per_element: int = 4, height_mm: float = 0.0) -> Surface:
    """One cell, from mid window to mid window with its rib in the middle, by symmetry; each element in per_element² faces.

    height_mm: along the director, 0 the middle of the film.
    """
    quarter = _quarter(cell, state, per_element, height_mm)
    half = _around(quarter)
    return _placed([_mirrored(half, 0.0), half], state)


def whole_actuator(
    cell: Cell, state: State, design: ShellDesign, cap_mm: float = 0.0, per_element: int = 2, height_mm: float = 0.0
) -> Surface:
    """The actuator from its base at the origin: as many whole windows as fit between the caps, what is left over as fabric at
    both ends, which bends as the cells do, and straight round caps.
    """
    pitch = design.window_width_mm + design.rib_width_mm
    bent = design.length_mm - 2 * cap_mm
    windows = max(0, math.floor((bent - design.rib_width_mm) / pitch + 1e-9))
    first = (bent - windows * pitch) / 2
    half = _around(_quarter(cell, state, per_element, height_mm))
    parts = [_extruded(half, 0.0, first, per_element)]
    for window in range(windows):
        start = first + window * pitch
        parts += [_shifted(half, start), _mirrored(half, start + pitch)]
    parts.append(_extruded(half, bent - first, bent, per_element))
    surface = _placed(parts, state)
    return _with_caps(surface, state, cell.radius_mm + height_mm, bent, cap_mm) if cap_mm else surface


def sections_mm(cell: Cell, state: State, per_element: int = 8) -> dict[str, FloatArray]:
    """Outlines of the cell's two planes of symmetry across the axis, "mid rib" and "mid window": (m, 2), across and from x = 0."""
    half = _around(_quarter(cell, state, per_element, 0.0))
    return {
        name: np.stack([half.y[:, column], half.x[:, column]], axis=1)
        for name, column in (("mid rib", 0), ("mid window", -1))
    }


def _quarter(cell: Cell, state: State, per_element: int, height_mm: float) -> _Quarter:
    """The nine-node elements are products of quadratics on a grid of lines, so that sampling along s and Z is exact."""
    s, Z = (np.unique(np.round(axis, 9)) for axis in cell.mesh.nodes_mm.T)
    fields = state.fields.reshape(len(s), len(Z), FIELDS)
    ends = np.linspace(-1, 1, per_element + 1)
    around, along = (_sampling(line, ends)[0] for line in (s, Z))
    at = np.einsum("ms,szf,nz->mnf", around, fields, along)
    stretch, piece = _faces(cell, state, fields, s, Z, (ends[1:] + ends[:-1]) / 2)
    return _Quarter(
        at[..., X] + height_mm * at[..., DX],
        at[..., Y] + height_mm * at[..., DY],
        at[..., T],
        height_mm * at[..., DZ],
        piece,
        stretch,
    )


def _sampling(nodes: FloatArray, places: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Matrices (m, nodes) for values and slopes of the quadratics on a line of elements, at `places` in [−1, 1] of each.

    Where `places` has both ends, the points that neighbours share stand once.
    """
    elements = (len(nodes) - 1) // 2
    shared = places[0] == -1 and places[-1] == 1
    value = np.stack([places * (places - 1) / 2, 1 - places**2, places * (places + 1) / 2], axis=1)
    slope = np.stack([places - 0.5, -2 * places, places + 0.5], axis=1)
    rows = len(places)
    values, slopes = np.zeros((2, elements * rows, len(nodes)))
    for element in range(elements):
        here = slice(element * rows, (element + 1) * rows), slice(2 * element, 2 * element + 3)
        values[here] = value
        slopes[here] = slope * 2 / (nodes[2 * element + 2] - nodes[2 * element])
    kept = np.ones(len(values), dtype=bool)
    if shared:
        kept[rows::rows] = False
    return values[kept], slopes[kept]


def _faces(
    cell: Cell, state: State, fields: FloatArray, s: FloatArray, Z: FloatArray, places: FloatArray
) -> tuple[FloatArray, NDArray[np.str_]]:
    """Largest stretch of the film, and the outermost layer, of each face."""
    (N, N_s), (M, M_Z) = _sampling(s, places), _sampling(Z, places)
    q = np.stack([np.einsum("ms,szf,nz->mnf", a, fields, b) for a, b in ((N, M), (N_s, M), (N, M_Z))], axis=2)
    stretch = np.full(q.shape[:2], np.nan)
    piece = np.full(q.shape[:2], _BARE, dtype="<U16")
    e = strains(q.reshape(-1, 3, FIELDS), state.k, state.lam).reshape(*q.shape[:2], -1)
    for laminate, elements in cell.laminates:
        for i, j in _grid_places(cell.mesh.centre_mm[elements], s, Z):
            block = np.s_[i * len(places) : (i + 1) * len(places), j * len(places) : (j + 1) * len(places)]
            if laminate.layers:
                piece[block] = laminate.layers[-1].name
            for layer in laminate.layers:
                if layer.law.incompressible:
                    middle = (layer.bottom_mm + layer.top_mm) / 2
                    C = metric_at(e[block].reshape(-1, 12), middle, laminate.curvature_per_mm)
                    stretch[block] = sheet_stress(layer.law, C).stretch[:, 0].reshape(len(places), -1)
    return stretch, piece


def _grid_places(centres: FloatArray, s: FloatArray, Z: FloatArray) -> list[tuple[int, int]]:
    """Row and column of elements by their centres."""
    row, column = (np.searchsorted(line[::2], centres[:, axis]) - 1 for axis, line in enumerate((s, Z)))
    return [(int(i), int(j)) for i, j in zip(row, column)]


def _around(quarter: _Quarter) -> _Quarter:
    """Both sides of the plane of symmetry: rows from mid window over the strip to mid window."""

    def both(values: FloatArray, sign: float = 1.0) -> FloatArray:
        return np.concatenate([sign * values[:0:-1], values])

    faces = {
        name: np.concatenate([getattr(quarter, name)[::-1], getattr(quarter, name)]) for name in ("piece", "stretch")
    }
    return _Quarter(both(quarter.x), both(quarter.y, -1.0), both(quarter.t), both(quarter.tilt), **faces)


def _shifted(part: _Quarter, along_mm: float) -> _Quarter:
    return _Quarter(part.x, part.y, part.t + along_mm, part.tilt, part.piece, part.stretch)


def _mirrored(part: _Quarter, about_mm: float) -> _Quarter:
    """The part reflected so that its rib comes to lie at `about_mm`, its columns in growing t."""
    flip = np.s_[:, ::-1]
    return _Quarter(
        part.x[flip], part.y[flip], about_mm - part.t[flip], -part.tilt[flip], part.piece[flip], part.stretch[flip]
    )


def _extruded(part: _Quarter, start_mm: float, end_mm: float, columns: int) -> _Quarter:
    """The section in the middle of the rib, drawn out along t."""
    t = np.linspace(start_mm, end_mm, columns + 2)
    wide = np.ones(len(t))
    faces = (len(part.x) - 1, columns + 1)
    return _Quarter(
        part.x[:, :1] * wide,
        part.y[:, :1] * wide,
        np.zeros_like(part.t[:, :1]) + t,
        0 * part.tilt[:, :1] * wide,
        np.broadcast_to(part.piece[:, :1], faces),
        np.broadcast_to(part.stretch[:, :1], faces),
    )


def _placed(parts: Sequence[_Quarter], state: State) -> Surface:
    """Parts that follow each other along t, in space; columns that neighbours share stand once."""

    def joined(name: str) -> FloatArray:
        return np.concatenate([getattr(part, name)[:, bool(i) :] for i, part in enumerate(parts)], axis=1)

    points = to_space(joined("x"), joined("y"), joined("t"), state.k, state.lam, joined("tilt"))
    piece, stretch = (np.concatenate([getattr(part, name) for part in parts], axis=1) for name in ("piece", "stretch"))
    return Surface(points, piece, stretch)


def _with_caps(surface: Surface, state: State, radius_mm: float, bent_mm: float, cap_mm: float) -> Surface:
    """Straight round cylinders before the base and beyond the tip. Their rings stand where the tube's own points do around."""
    rows = len(surface.points_mm)
    turn = np.linspace(-np.pi, np.pi, rows)
    x, y = radius_mm * (1 - np.cos(turn)), radius_mm * np.sin(turn)
    base = np.stack([to_space(x, y, np.zeros(rows), 0.0, 1.0, along) for along in (-cap_mm, 0.0)], axis=1)
    end = np.full(rows, bent_mm)
    tip = np.stack([to_space(x, y, end, state.k, state.lam, along) for along in (0.0, cap_mm)], axis=1)
    cap, bare = np.full((rows - 1, 2), "cap", dtype="<U16"), np.full((rows - 1, 2), np.nan)
    return Surface(
        np.concatenate([base, surface.points_mm, tip], axis=1),
        np.concatenate([cap, surface.piece, cap], axis=1),
        np.concatenate([bare, surface.stretch, bare], axis=1),
    )
