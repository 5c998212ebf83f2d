"""The tube as eight-node shells: half of it (mirror plane y = 0), from a mirror plane z = 0 to a stiff end cap.

Undeformed it is round, radius R = P/2π: s = 0, the middle of the strip, lies at x = −R; shell normals point outwards.
The pressure acts on the inner face of the shells, at R − t/2, and on the cap inside the film's inner face, so that film and
cap close a volume. In CalculiX this holds where all sections have one thickness (`sheets`) or layers are solids (`solid`):
the cells then bend alike up to the last two before the cap. Composites of unlike thickness step at the border of every
window, where CalculiX ties their edges into rigid knots; the loads on the two sides of a step do not balance when it turns,
and the angle rises from cell to cell towards the cap (group `cells` of tests/benchmarks/predict_reference.py).
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from benchlab.actuator import ShellDesign
from benchlab.deck.grid import FloatArray, IntArray, halved, lines, quadrilaterals
from benchlab.errors import UsageError
from benchlab.simulation.layup import Layer, Layup, laminate_at, pieces_of


@dataclass(frozen=True)
class Extent:
    """How much of the tube is modelled: `cells` from mid rib or mid window (z = 0) to a last whole rib and `margin_mm`."""

    cells: int
    from_window: bool = False
    margin_mm: float = 0.0

    @classmethod
    def of(cls, design: ShellDesign, cells: int | None) -> Extent:
        """N cells from mid rib, or for None half the actuator: whole windows, end margins, mirrored at mid length."""
        if cells is None:
            whole = design.whole_windows
            return cls((whole + 1) // 2, from_window=whole % 2 == 1, margin_mm=design.end_margin_mm)
        if cells < 1:
            raise UsageError(f"{cells} cells", hint="give one cell or more")
        return cls(cells)


@dataclass(frozen=True)
class Section:
    """Elements (numbers from 1) of one laminate, the inner layer first. bonded: the elements share their nodes with others."""

    name: str
    layers: tuple[Layer, ...]
    elements: IntArray
    bonded: bool = False

    @property
    def thickness_mm(self) -> float:
        return sum(layer.top_mm - layer.bottom_mm for layer in self.layers)


@dataclass(frozen=True)
class Tube:
    """Nodes (n, 3) in mm, numbered from 1; quads (m, 8) and triangles (k, 6) of node numbers, elements numbered in that
    order from 1; sections of the wall; cap elements; node sets; z of the rib mid-planes, in the order of RIB_001, ...;
    overlays: sections of further elements on nodes of the wall.
    """

    design: ShellDesign
    layup: Layup
    extent: Extent
    nodes_mm: FloatArray
    quads: IntArray
    triangles: IntArray
    sections: tuple[Section, ...]
    cap: IntArray
    cap_loaded: IntArray
    cap_thickness_mm: float
    node_sets: dict[str, IntArray]
    rib_z_mm: FloatArray
    overlays: tuple[Section, ...] = ()

    @property
    def wall(self) -> IntArray:
        return np.sort(np.concatenate([section.elements for section in self.sections]))

    @property
    def length_mm(self) -> float:
        return float(self.nodes_mm[:, 2].max())


CAP_THICKNESS_MM = 2.0
INSIDE = 1e-6  # mm; a point on the border of the quarter cell is taken as just inside


def tube_of(
    design: ShellDesign,
    layup: Layup,
    extent: Extent,
    around_mm: float = 1.7,
    along_mm: float = 1.0,
    edge_mm: float | None = None,
) -> Tube:
    """Mesh of the half tube; elements are at most `around_mm` by `along_mm`; with `edge_mm`, two rows of that length lie on
    either side of every border of a window, where the film bends. Raises UsageError on sizes that are not positive."""
    sizes = {"around_mm": around_mm, "along_mm": along_mm} | ({} if edge_mm is None else {"edge_mm": edge_mm})
    for name, size in sizes.items():
        if not (math.isfinite(size) and size > 0):
            raise UsageError(f"element size {name} is {size}", hint="give a positive length in mm")
    for name in ("seam_margin_mm", "bladder_N_per_mm"):
        if getattr(layup, name):
            raise UsageError(
                f"decks are written without {name}, which {layup.name} has", hint="set it to 0 in the material file"
            )
    pieces = pieces_of(design, layup)
    radius = design.perimeter_mm / (2 * math.pi)
    s = lines([b for piece in pieces for b in piece.s_mm], around_mm)
    ribs, borders = _stations(design, extent)
    z = lines(borders if edge_mm is None else _with_edges(borders, ribs, design, edge_mm), along_mm)
    quads, u, v = quadrilaterals(len(s) - 1, len(z) - 1)
    angle = halved(s)[u] / radius
    wall = np.column_stack([-radius * np.cos(angle), radius * np.sin(angle), halved(z)[v]])
    mid_s, mid_z = (k.ravel() for k in np.meshgrid((s[1:] + s[:-1]) / 2, (z[1:] + z[:-1]) / 2, indexing="ij"))
    fold = np.abs(mid_z[:, None] - ribs).min(axis=1)
    fold[mid_z > ribs[-1]] = 0.0  # the last rib and the margin
    fold = np.clip(fold, INSIDE, (design.window_width_mm + design.rib_width_mm) / 2 - INSIDE)
    laminates: dict[tuple[Layer, ...], list[int]] = {}
    for number, (at, to) in enumerate(zip(mid_s, fold), start=1):
        laminates.setdefault(laminate_at(pieces, at, to), []).append(number)
    sections = tuple(
        Section(f"LAMINATE_{k}", layers, np.array(found))
        for k, (layers, found) in enumerate(laminates.items(), start=1)
    )
    film = min(section.thickness_mm for section in sections)
    rim = np.flatnonzero(v == v.max())[np.argsort(u[v == v.max()])]
    cap_nodes, cap_quads, cap_triangles, loaded = _cap(wall[rim], rim, len(wall), radius, film, len(quads))
    nodes = np.vstack([wall, cap_nodes])
    elements = np.arange(len(quads) + 1, len(quads) + len(cap_quads) + len(cap_triangles) + 1)
    at_rib = {f"RIB_{k:03d}": 1 + np.flatnonzero(np.abs(wall[:, 2] - at) < 1e-6) for k, at in enumerate(ribs, start=1)}
    sets = {
        "ALL": np.arange(1, len(nodes) + 1),
        "MIRROR_Y": 1 + np.flatnonzero(np.abs(nodes[:, 1]) < 1e-9),
        "MIRROR_Z": 1 + np.flatnonzero(nodes[:, 2] < 1e-9),
        "HOLD_X": 1 + np.flatnonzero((u == 0) & (v == 0)),
        "CAP_CENTRE": np.array([len(wall) + 1]),
        **at_rib,
    }
    return Tube(
        design, layup, extent, nodes, np.vstack([quads, cap_quads]) + 1, cap_triangles + 1, sections, elements,
        loaded, CAP_THICKNESS_MM, sets, ribs,
    )  # fmt: skip


def _stations(design: ShellDesign, extent: Extent) -> tuple[FloatArray, FloatArray]:
    """z of the rib mid-planes, and of all borders between rib, window and ends."""
    rib, window, cell = design.rib_width_mm, design.window_width_mm, design.window_width_mm + design.rib_width_mm
    count = extent.cells + (0 if extent.from_window else 1)
    ribs = np.array([(k + (0.5 if extent.from_window else 0)) * cell for k in range(count)], dtype=np.float64)
    borders = [0.0, *(ribs - rib / 2), *(ribs + rib / 2), *ribs, ribs[-1] + rib / 2 + extent.margin_mm]
    if extent.from_window:
        borders.append(window / 2)
    return ribs, np.array([b for b in borders if b >= 0], dtype=float)


def _with_edges(borders: FloatArray, ribs: FloatArray, design: ShellDesign, edge_mm: float) -> FloatArray:
    """Borders, and beside every border of a window two more to either side."""
    if 5 * edge_mm > min(design.rib_width_mm, design.window_width_mm):
        raise UsageError(f"element size edge_mm is {edge_mm:g}, too long for rib or window", hint="give less, or none")
    at = np.concatenate([ribs - design.rib_width_mm / 2, ribs + design.rib_width_mm / 2])
    more = (at[:, None] + edge_mm * np.array([-2, -1, 1, 2])).ravel()
    return np.concatenate([borders, more[(more > edge_mm / 2) & (more < borders.max() - edge_mm / 2)]])


def _cap(
    rim_mm: FloatArray, rim: IntArray, first: int, radius: float, film_mm: float, quads: int
) -> tuple[FloatArray, IntArray, IntArray, IntArray]:
    """A flat half disc that shares the rim's nodes: rings of quads around triangles at the centre, normals along +z.

    Returns new nodes, quads and triangles of indices from 0, and the numbers (from 1) of the elements that are loaded.
    """
    scales = np.array([1.0, 1 - film_mm / 2 / radius, 0.7, 0.35])
    half = halved(scales)
    centre = np.array([[0.0, 0.0, rim_mm[0, 2]]])
    nodes, number = [centre], first + 1
    grid = np.full((len(half), len(rim)), -1, np.int64)
    grid[0] = rim
    for ring in range(1, len(half)):
        used = np.arange(0, len(rim), 1 if ring % 2 == 0 else 2)
        grid[ring, used] = number + np.arange(len(used))
        number += len(used)
        nodes.append(rim_mm[used] * [half[ring], half[ring], 1.0])
    spokes = number + np.arange((len(rim) + 1) // 2)
    nodes.append(rim_mm[::2] * [scales[-1] / 2, scales[-1] / 2, 1.0])
    # Around the cap from x = −R to x = +R over y > 0 is clockwise seen from +z.
    order = [(2, 2), (0, 2), (0, 0), (2, 0), (1, 2), (0, 1), (1, 0), (2, 1)]
    cap_quads = [
        [grid[2 * ring + a, i + b] for a, b in order]
        for ring in range(len(scales) - 1)
        for i in range(0, len(rim) - 1, 2)
    ]
    triangles = [
        [first, grid[-1, i + 2], grid[-1, i], spokes[i // 2 + 1], grid[-1, i + 1], spokes[i // 2]]
        for i in range(0, len(rim) - 1, 2)
    ]
    columns = (len(rim) - 1) // 2
    loaded = np.arange(quads + columns + 1, quads + len(cap_quads) + len(triangles) + 1)
    return np.vstack(nodes), np.array(cap_quads), np.array(triangles), loaded
