"""The deformed cell: where its points are in space, and how its layers are stretched and stressed there."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from benchlab.simulation.cell import FIELDS, Cell, State
from benchlab.simulation.laws.law import FloatArray, Law
from benchlab.simulation.laws.stability import tangent_MPa
from benchlab.simulation.shell import metric_at, strains


@dataclass(frozen=True)
class SheetStress:
    """Stretch and stress of a thin sheet at n points; components are ss, ZZ, sZ, along the sheet as cut.

    stretch (n, 2): principal, the larger first. strain (n, 3): Green-Lagrange. piola_MPa (n, 3): second Piola-Kirchhoff.
    cauchy_MPa (n, 3): on the deformed sheet, in axes that turn with it (R of the polar decomposition). von_mises_MPa (n,).
    """

    stretch: FloatArray
    strain: FloatArray
    piola_MPa: FloatArray
    cauchy_MPa: FloatArray
    von_mises_MPa: FloatArray


@dataclass(frozen=True)
class LayerStress:
    """A layer of one laminate, in the middle of its thickness: name, law, where (n, 2) in s and Z (mm), and what is there."""

    name: str
    law: Law
    places_mm: FloatArray
    sheet: SheetStress


@dataclass(frozen=True)
class Extremes:
    """Largest principal stretch of the film, and largest von Mises stress (MPa) of fabric and strip, at integration points."""

    film_stretch: float
    fabric_stress_MPa: float


def to_space(
    x: FloatArray, y: FloatArray, t: FloatArray, k: float, lam: float, tilt: FloatArray | float = 0.0
) -> FloatArray:
    """Points of the frame that turns with ψ = k·t, in space: (..., 3) in mm, straight along the third axis where k = 0.

    X = x cos ψ − (λ/k)(1 − cos ψ), Y = y, Z = (λ/k + x) sin ψ, written without division by k. `tilt`: further millimetres
    along the bent axis at the same ψ (of the director). The actuator bends towards −X, the side of the strip.

    >>> to_space(np.array(0.0), np.array(0.0), np.array(10.0), np.pi / 20, 1.0).round(4)  # a quarter of a circle
    array([-6.3662,  0.    ,  6.3662])
    """
    half = k * np.asarray(t) / 2
    sinc = np.sinc(half / np.pi)
    cos, sin = np.cos(2 * half), np.sin(2 * half)
    return np.stack(
        np.broadcast_arrays(
            x * cos - lam * t * np.sin(half) * sinc - tilt * sin,
            y,
            x * sin + lam * t * np.sinc(2 * half / np.pi) + tilt * cos,
        ),
        axis=-1,
    )


def node_positions_mm(cell: Cell, state: State, height_mm: float = 0.0) -> FloatArray:
    """The nodes of the quarter cell in space, (N, 3), at a height along the director."""
    x, y, t, dx, dy, dz = state.fields.reshape(-1, FIELDS).T
    return to_space(x + height_mm * dx, y + height_mm * dy, t, state.k, state.lam, height_mm * dz)


def sheet_stress(law: Law, C: FloatArray) -> SheetStress:
    """Stretch and stress of a law at right Cauchy-Green tensors C (n, 3): C_ss, C_ZZ, C_sZ.

    S = 2·∂W/∂C and σ = U·S·U/J, with J = 1 where volume is kept and √det C where the thickness is.

    >>> from benchlab.simulation.laws import Polynomial
    >>> sheet_stress(Polynomial(C10=1.0), np.array([[4.0, 0.5, 0.0]])).cauchy_MPa.round(3)  # 2·C10·(λ² − 1/λ)
    array([[7., 0., 0.]])
    """
    C11, C22, C12 = C.T
    a, b = C11 + C22, C11 * C22 - C12**2
    at = law.energy(a, b)
    S = 2 * np.stack([at.W_a + at.W_b * C22, at.W_a + at.W_b * C11, -at.W_b * C12])
    root = np.sqrt(b)
    U = np.stack([C11 + root, C22 + root, C12]) / np.sqrt(a + 2 * root)  # square root of a 2 x 2 tensor
    volume = 1.0 if law.incompressible else root
    cauchy = _congruent(U, S) / volume
    s, z, sz = cauchy
    spread = np.sqrt((C11 - C22) ** 2 + 4 * C12**2)
    larger = (a + spread) / 2
    return SheetStress(
        stretch=np.sqrt(np.stack([larger, b / larger], axis=1)),
        strain=(C - np.array([1.0, 1.0, 0.0])) / 2,
        piola_MPa=S.T,
        cauchy_MPa=cauchy.T,
        von_mises_MPa=np.sqrt(s**2 - s * z + z**2 + 3 * sz**2),
    )


def _congruent(U: FloatArray, S: FloatArray) -> FloatArray:
    """U·S·U of symmetric 2 x 2 tensors, each (3, n)."""
    (u, v, w), (p, q, r) = U, S
    return np.stack(
        [
            u * u * p + 2 * u * w * r + w * w * q,
            w * w * p + 2 * w * v * r + v * v * q,
            u * w * p + (u * v + w * w) * r + w * v * q,
        ]
    )


def layer_stresses(cell: Cell, state: State) -> tuple[LayerStress, ...]:
    """Every layer of every laminate at its integration points, in the middle of its thickness."""
    points = cell.points(state)
    nodes = cell.mesh.nodes_mm[cell.mesh.elements]
    found = []
    for laminate, elements in cell.laminates:
        e = strains(points[elements].reshape(-1, 3, FIELDS), state.k, state.lam)
        places = (cell.mesh.shape[elements][:, :, 0] @ nodes[elements]).reshape(-1, 2)
        for layer in laminate.layers:
            middle = (layer.bottom_mm + layer.top_mm) / 2
            C = metric_at(e, middle, laminate.curvature_per_mm)
            found.append(LayerStress(layer.name, layer.law, places, sheet_stress(layer.law, C)))
    return tuple(found)


def extremes(layers: tuple[LayerStress, ...]) -> Extremes:
    """The largest values among layers; NaN where there is no film or no fabric."""
    film = [layer.sheet.stretch.max() for layer in layers if layer.law.incompressible]
    fabric = [layer.sheet.von_mises_MPa.max() for layer in layers if not layer.law.incompressible]
    return Extremes(float(max(film, default=np.nan)), float(max(fabric, default=np.nan)))


def unstable_share(layers: tuple[LayerStress, ...]) -> float:
    """Share of the film's integration points at whose stretches its law is not stable after Drucker; 0 where there is no film."""
    film = [layer for layer in layers if layer.law.incompressible]
    stable = [np.linalg.eigvalsh(tangent_MPa(layer.law, *layer.sheet.stretch.T))[:, 0] > 0 for layer in film]
    return 1 - float(np.mean(np.concatenate(stable))) if stable else 0.0
