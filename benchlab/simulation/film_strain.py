"""How far the film of the windows is stretched."""

from __future__ import annotations

import numpy as np

from benchlab.simulation.cell import FIELDS, Cell, State
from benchlab.simulation.shell import metric_at, strains

PEAK_SHARE = 0.01
"""Of the windows' area: what is strained more than the peak. At a window's corners the strain has no bound, only a mesh has."""


def peak_film_strain(cell: Cell, state: State) -> float:
    """Largest principal nominal strain (stretch − 1) at the middle of the bare film that all but `PEAK_SHARE` of the
    windows' area stays below.

    >>> from benchlab.actuator import ShellDesign
    >>> from benchlab.simulation.laws import Polynomial
    >>> from benchlab.simulation.layup import Layup
    >>> cell = Cell.of(ShellDesign(10, 3), Layup("trial", "guessed", film=Polynomial(C10=1.5, C20=3.0)))
    >>> abs(peak_film_strain(cell, cell.round_tube())) < 1e-2
    True
    """
    q = cell.points(state)
    found, area = [], []
    for laminate, elements in cell.laminates:
        if laminate.layers and (film := laminate.layers[-1]).name == "film":
            e = strains(q[elements].reshape(-1, 3, FIELDS), state.k, state.lam)
            C = metric_at(e, (film.bottom_mm + film.top_mm) / 2, laminate.curvature_per_mm)
            found.append(_largest_stretch(C) - 1)
            area.append(cell.mesh.weight_mm2[elements].ravel())
    strain, weight = np.concatenate(found), np.concatenate(area)
    order = np.argsort(strain)
    share = np.cumsum(weight[order]) / weight.sum()
    return float(strain[order][np.searchsorted(share, 1 - PEAK_SHARE)])


def _largest_stretch(C: np.ndarray) -> np.ndarray:
    """Of C (n, 3) as C_ss, C_ZZ, C_sZ."""
    C_ss, C_ZZ, C_sZ = C.T
    return np.sqrt((C_ss + C_ZZ) / 2 + np.hypot((C_ss - C_ZZ) / 2, C_sZ))
