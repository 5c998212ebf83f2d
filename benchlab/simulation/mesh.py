"""Nine-node quadrilaterals on the quarter cell, finer towards the borders of the pieces where strains jump."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray
from skfem import Basis, ElementQuad2, MeshQuad

from benchlab.simulation.laws.law import FloatArray

NODES_PER_ELEMENT = 9


@dataclass(frozen=True)
class CellMesh:
    """Elements E, nodes N, nine integration points an element.

    nodes_mm: (N, 2) s and Z, sorted by s, then Z. elements: (E, 9) numbers of nodes. shape: (E, 9, 3, 9) for integration
    point, value | d/ds | d/dZ, and node. weight_mm2: (E, 9). centre_mm: (E, 2).
    """

    nodes_mm: FloatArray
    elements: NDArray[np.int64]
    shape: FloatArray
    weight_mm2: FloatArray
    centre_mm: FloatArray


@dataclass(frozen=True)
class Grading:
    """Sizes of elements in mm: at most `fabric_mm` where the sheet is stiff; in the last span, the film of the window,
    `first_mm` at the border of the fabric and `growth` times more from one to the next, up to `largest_mm`."""

    fabric_mm: float
    first_mm: float
    growth: float
    largest_mm: float


def gradings(perimeter_mm: float, film_mm: float) -> tuple[Grading, Grading]:
    """Sizes around the circumference and along the axis: the film bends within a length of about its thickness from the
    border of the fabric, so that the first element has to be smaller (docs/decisions/0006)."""
    fabric, largest = perimeter_mm / 32, perimeter_mm / 20
    return Grading(fabric, film_mm, 1.6, largest), Grading(fabric, film_mm / 3, 1.8, largest)


def grid_lines(breaks: Sequence[float], grading: Grading, split: int = 1) -> FloatArray:
    """Grid lines from the first to the last of `breaks` (mm), through each of them; every element split in `split`.

    >>> grid_lines([0, 1, 4], Grading(fabric_mm=1, first_mm=0.5, growth=2, largest_mm=2)).round(3)
    array([0.   , 1.   , 1.429, 2.286, 4.   ])
    """
    lines = [float(breaks[0])]
    for start, end in pairwise(breaks[:-1]):
        lines += list(np.linspace(start, end, math.ceil((end - start) / grading.fabric_mm - 1e-9) + 1)[1:])
    sizes = _growing(breaks[-1] - breaks[-2], grading)
    lines += list(breaks[-2] + np.cumsum(sizes))
    lines[-1] = float(breaks[-1])
    return np.interp(np.arange((len(lines) - 1) * split + 1) / split, np.arange(len(lines)), lines)


def _growing(length: float, grading: Grading) -> FloatArray:
    """Sizes that grow as the grading says and add up to `length`."""
    sizes = [min(grading.first_mm, length)]
    while sum(sizes) < length:
        sizes.append(min(sizes[-1] * grading.growth, grading.largest_mm))
    if len(sizes) > 1 and sum(sizes) - length > sizes[-1] / 2:
        sizes.pop()
    return np.array(sizes) * length / sum(sizes)


def cell_mesh(s_lines: FloatArray, Z_lines: FloatArray) -> CellMesh:
    """The mesh of the rectangle between the outermost of the grid lines (mm)."""
    basis = Basis(MeshQuad.init_tensor(s_lines, Z_lines), ElementQuad2(), intorder=5)
    places = basis.doflocs.T
    order = np.lexsort(np.round(places.T[::-1], 9))
    rank = np.empty_like(order)
    rank[order] = np.arange(len(order))
    elements = rank[basis.element_dofs.T]
    shape = np.empty((*basis.dx.shape, 3, NODES_PER_ELEMENT))
    for node in range(NODES_PER_ELEMENT):
        function = basis.basis[node][0]
        shape[:, :, 0, node] = np.asarray(function)
        shape[:, :, 1:, node] = np.moveaxis(function.grad, 0, -1)
    corners = basis.mesh.p[:, basis.mesh.t]
    return CellMesh(places[order], elements, shape, np.array(basis.dx), corners.mean(axis=1).T)


def on_circle(mesh: CellMesh, radius_mm: float) -> CellMesh:
    """The same mesh with s the arc length of the circle as the elements draw it, a little shorter than the true one, so that the
    round tube is not strained by being drawn."""
    phi = mesh.nodes_mm[mesh.elements, 0] / radius_mm
    circle = radius_mm * np.stack([-np.cos(phi), np.sin(phi)], axis=-1)
    length = np.linalg.norm(mesh.shape[:, :, 1] @ circle, axis=-1)
    shape = mesh.shape.copy()
    shape[:, :, 1] /= length[:, :, None]
    return replace(mesh, shape=shape, weight_mm2=mesh.weight_mm2 * length)
