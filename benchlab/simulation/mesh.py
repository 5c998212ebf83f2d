"""Nine-node quadrilaterals on the quarter cell, finer towards the borders of the pieces where strains jump."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

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


def graded_lines(breaks: Sequence[float], elements: int, ratio: float = 2.0) -> FloatArray:
    """Grid lines from the first to the last of `breaks`, through each of them, about `elements` intervals in all.

    Each span between breaks gets a share by the square root of its length, at least one, and its elements grow from its
    ends towards its middle up to `ratio` times.

    >>> graded_lines([0, 1, 4], 3)
    array([0. , 1. , 2.5, 4. ])
    """
    spans = np.diff(np.asarray(breaks, dtype=float))
    share = np.sqrt(spans) / np.sqrt(spans).sum() * elements
    counts = np.maximum(1, np.round(share)).astype(int)
    lines = [float(breaks[0])]
    for start, span, count in zip(breaks[:-1], spans, counts):
        middle = (np.arange(count) + 0.5) / count
        size = 1 + (ratio - 1) * np.sin(np.pi * middle)
        lines += list(start + span * np.cumsum(size) / size.sum())
    return np.array(lines)


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
        shape[:, :, 0, node] = function.value
        shape[:, :, 1:, node] = np.moveaxis(function.grad, 0, -1)
    corners = basis.mesh.p[:, basis.mesh.t]
    return CellMesh(places[order], elements, shape, np.array(basis.dx), corners.mean(axis=1).T)
