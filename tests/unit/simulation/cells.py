"""Cells of one material, whose behaviour is known in closed form."""

from __future__ import annotations

import numpy as np

from benchlab.simulation.cell import Cell, State
from benchlab.simulation.laws import Law
from benchlab.simulation.layup import Layer
from benchlab.simulation.mesh import cell_mesh
from benchlab.simulation.shell import Laminate

R, HALF_LENGTH = 6.0, 2.0


def uniform_tube(
    law: Law, thickness: float, moulded: bool = True, around: int = 8, along: int = 2, inner: float | None = None
) -> Cell:
    """A tube of middle radius 6 mm of one layer; the pressure acts on its inner face."""
    mesh = cell_mesh(np.linspace(0, np.pi * R, around + 1), np.linspace(0, HALF_LENGTH, along + 1))
    laminate = Laminate((Layer("wall", law, -thickness / 2, thickness / 2),), 1 / R if moulded else 0.0)
    return Cell(
        mesh=mesh,
        half_length_mm=HALF_LENGTH,
        radius_mm=R,
        inner_mm=-thickness / 2 if inner is None else inner,
        laminates=((laminate, np.arange(len(mesh.elements))),),
    )


def shaken(cell: Cell, size: float = 0.02, seed: int = 1) -> State:
    """A smooth state away from equilibrium that keeps the conditions of symmetry."""
    rng = np.random.default_rng(seed)
    tube = cell.round_tube()
    waves = np.sin(cell.mesh.nodes_mm @ rng.standard_normal((2, 6)) + rng.uniform(0, 6, 6)).ravel()
    return State(np.where(cell.held, tube.fields, tube.fields + size * waves), 0.004, 1.02)


def dense(band: np.ndarray) -> np.ndarray:
    """The symmetric matrix of a lower band."""
    n = band.shape[1]
    full = np.zeros((n, n))
    for i, row in enumerate(band):
        at = np.arange(n - i)
        full[at + i, at] = full[at, at + i] = row[: n - i]
    return full
