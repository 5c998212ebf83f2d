"""Lines of a structured mesh, and eight-node quadrilaterals on it."""

from __future__ import annotations

import math
from collections.abc import Iterable
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

IntArray = NDArray[np.int64]
FloatArray = NDArray[np.float64]


def lines(borders: Iterable[float], size: float) -> FloatArray:
    """Borders and between them equal steps no longer than `size`; sorted, shape (n,).

    >>> lines([0, 1, 3], 1.0).tolist()
    [0.0, 1.0, 2.0, 3.0]
    """
    at = sorted({round(float(b), 9) for b in borders})
    pieces = [np.linspace(a, b, max(1, math.ceil((b - a) / size - 1e-9)) + 1)[:-1] for a, b in pairwise(at)]
    return np.concatenate([*pieces, [at[-1]]])


def halved(x: FloatArray) -> FloatArray:
    """The lines and the middles between them, shape (2n − 1,)."""
    return np.insert(x, np.arange(1, len(x)), (x[1:] + x[:-1]) / 2)


def quadrilaterals(columns: int, rows: int) -> tuple[IntArray, IntArray, IntArray]:
    """Eight-node quadrilaterals of `columns` × `rows` elements on the halved grid.

    Returns (quads, u, v): quads (columns·rows, 8) of node numbers from 0, first the corners, then the middles of the
    sides, going first along v, so that normal = e_v × e_u; u, v (nodes,) are indices into the halved lines.
    """
    number = np.full((2 * columns + 1, 2 * rows + 1), -1, np.int64)
    u, v = np.array([(i, j) for i in range(2 * columns + 1) for j in range(2 * rows + 1) if not (i % 2 and j % 2)]).T
    number[u, v] = np.arange(len(u))
    i, j = (2 * k.ravel() for k in np.meshgrid(np.arange(columns), np.arange(rows), indexing="ij"))
    around = [(0, 0), (0, 2), (2, 2), (2, 0), (0, 1), (1, 2), (2, 1), (1, 0)]
    return np.stack([number[i + a, j + b] for a, b in around], axis=1), u, v
