"""The tube in solid elements, layer upon layer: the film continuous on the inside, fabric and strip outside of it.

What the shells of `tube` idealise is spelt out here: layers lie on one another instead of around one middle surface, each
thins by itself, and the film's inner face is smooth, so that film and cap close a volume. The film's middle lies at R.
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from benchlab.deck.grid import FloatArray, IntArray
from benchlab.deck.tube import Tube
from benchlab.errors import UsageError
from benchlab.simulation.laws import Law

CAP = np.array([0, 0, 1.0])
"""Thickness of the cap along z (mm)."""


@dataclass(frozen=True)
class Solid:
    """Nodes (n, 3) in mm, numbered from 1; bricks (m, 20) of wall and cap, wedges (k, 15) of the cap, elements numbered in
    that order from 1; wall elements of each law; elements with pressure on their first face; node sets."""

    tube: Tube
    nodes_mm: FloatArray
    bricks: IntArray
    wedges: IntArray
    laws: dict[Law, IntArray]
    cap: IntArray
    loaded: IntArray
    node_sets: dict[str, IntArray]


def solid_of(tube: Tube) -> Solid:
    """Extrude the shells of a tube, layer by layer. Raises UsageError where the k-th layer has not one thickness everywhere."""
    thickness = _thicknesses(tube)
    radius = float(np.hypot(*tube.nodes_mm[0, :2]))
    faces = radius - thickness[0] / 2 + np.concatenate([[0.0], np.cumsum(thickness)])
    bricks: list[FloatArray] = []
    laws: dict[Law, list[int]] = {}
    loaded: list[int] = []
    for section in tube.sections:
        shells = tube.nodes_mm[tube.quads[section.elements - 1] - 1]
        for k, layer in enumerate(section.layers):
            numbers = range(len(bricks) + 1, len(bricks) + len(shells) + 1)
            laws.setdefault(layer.law, []).extend(numbers)
            loaded += numbers if k == 0 else []
            bricks += list(_extruded(_scaled(shells, faces[k] / radius), _scaled(shells, faces[k + 1] / radius)))
    wall = len(bricks)
    cap_quads, wedges, inside = _cap(tube, radius, faces)
    bricks += list(cap_quads)
    loaded += (wall + 1 + np.flatnonzero(inside)).tolist() + (len(bricks) + 1 + np.arange(len(wedges))).tolist()
    nodes, quad_numbers, wedge_numbers = _shared(np.array(bricks), np.array(wedges))
    cap = np.arange(wall + 1, len(bricks) + len(wedges) + 1)
    ribs = {name: 1 + np.flatnonzero(np.abs(nodes[:, 2] - z) < 1e-6) for name, z in zip(_ribs(tube), tube.rib_z_mm)}
    mirror_z = np.flatnonzero(nodes[:, 2] < 1e-6)
    sets = {
        "MIRROR_Y": 1 + np.flatnonzero(np.abs(nodes[:, 1]) < 1e-6),
        "MIRROR_Z": 1 + mirror_z,
        "HOLD_X": 1 + mirror_z[[np.argmin(nodes[mirror_z, 0])]],
        **ribs,
    }
    by_law = {law: np.array(numbers) for law, numbers in laws.items()}
    return Solid(tube, nodes, quad_numbers, wedge_numbers, by_law, cap, np.array(loaded), sets)


def _ribs(tube: Tube) -> list[str]:
    return [name for name in tube.node_sets if name.startswith("RIB_")]


def _thicknesses(tube: Tube) -> list[float]:
    found: list[float] = []
    for section in tube.sections:
        for k, layer in enumerate(section.layers):
            thickness = layer.top_mm - layer.bottom_mm
            if k == len(found):
                found.append(thickness)
            elif abs(found[k] - thickness) > 1e-9:
                raise UsageError(
                    f"layer {k + 1} is {found[k]:g} mm thick here and {thickness:g} mm there",
                    hint="solid elements need one thickness for each layer; use shells",
                )
    return found


def _scaled(points: FloatArray, scale: float) -> FloatArray:
    return points * [scale, scale, 1.0]


def _extruded(bottom: FloatArray, top: FloatArray) -> FloatArray:
    """(m, 8, 3) or (m, 6, 3) twice -> (m, 20, 3) or (m, 15, 3) in the node order of C3D20 and C3D15."""
    n = bottom.shape[1] // 2
    edges = (bottom[:, :n] + top[:, :n]) / 2
    return np.concatenate([bottom[:, :n], top[:, :n], bottom[:, n:], top[:, n:], edges], axis=1)


def _cap(tube: Tube, radius: float, faces: FloatArray) -> tuple[FloatArray, FloatArray, np.ndarray]:
    """Rings of bricks over the wall's end and inside of it, wedges at the centre; which bricks lie inside."""
    shells = tube.nodes_mm[tube.quads - 1]
    rim = shells[np.abs(shells[:, [1, 2], 2] - tube.length_mm).max(axis=1) < 1e-6]
    rim = rim[np.hypot(rim[:, 0, 0], rim[:, 0, 1]) > radius * (1 - 1e-6)]
    rim = rim[rim[:, 0, 2] < tube.length_mm - 1e-6]  # wall elements whose second side (corners 2, 3) is the end
    a, b, middle = rim[:, 1], rim[:, 2], rim[:, 5]
    scales = np.concatenate([faces[::-1], [0.7 * faces[0], 0.35 * faces[0]]]) / radius
    bricks, inside = [], []
    for outer, inner in pairwise(scales):
        ring = [_scaled(p, s) for p, s in ((a, inner), (a, outer), (b, outer), (b, inner), (a, (inner + outer) / 2))]
        mids = [ring[4], _scaled(middle, outer), _scaled(b, (inner + outer) / 2), _scaled(middle, inner)]
        # The rim runs clockwise seen from +z; the extrusion goes along +z.
        quad = np.stack([ring[3], ring[2], ring[1], ring[0], mids[2], mids[1], mids[0], mids[3]], axis=1)
        bricks.append(_extruded(quad, quad + CAP))
        inside += [inner < faces[0] / radius - 1e-9] * len(quad)
    s = scales[-1]
    centre = np.zeros_like(a) + np.array([0, 0, tube.length_mm])
    a, b, middle = (_scaled(p, s) for p in (a, b, middle))
    triangle = np.stack([centre, b, a, (centre + b) / 2, middle, (centre + a) / 2], axis=1)
    return np.concatenate(bricks), _extruded(triangle, triangle + CAP), np.array(inside)


def _shared(bricks: FloatArray, wedges: FloatArray) -> tuple[FloatArray, IntArray, IntArray]:
    """Points at the same place become one node."""
    points = np.vstack([bricks.reshape(-1, 3), wedges.reshape(-1, 3)])
    _, first, number = np.unique(np.round(points, 6) + 0.0, axis=0, return_index=True, return_inverse=True)
    number = number.ravel() + 1
    split = bricks.shape[0] * 20
    return points[first], number[:split].reshape(-1, 20), number[split:].reshape(-1, 15)
