"""The meshes: closed, whole, normals outwards, laminates where the design has them."""

import math

import numpy as np
import pytest

from benchlab.actuator import ShellDesign
from benchlab.deck.abaqus import cut_in_four
from benchlab.deck.sheets import sheets_of
from benchlab.deck.solid import Solid, solid_of
from benchlab.deck.tube import Extent, Tube, tube_of
from benchlab.errors import UsageError
from benchlab.simulation.laws import Polynomial
from benchlab.simulation.layup import Layup

DESIGN = ShellDesign(strip_width_mm=10, window_width_mm=3)
LAYUP = Layup("test", "guess", film=Polynomial(C10=1.5, C20=3.0))
R = DESIGN.diameter_mm / 2
HEX_FACES = [(0, 1, 2, 3), (4, 5, 6, 7), (0, 1, 5, 4), (1, 2, 6, 5), (2, 3, 7, 6), (3, 0, 4, 7)]
WEDGE_FACES = [(0, 1, 2), (3, 4, 5), (0, 1, 4, 3), (1, 2, 5, 4), (2, 0, 3, 5)]


@pytest.fixture(scope="module")
def tube() -> Tube:
    return tube_of(DESIGN, LAYUP, Extent(2))


@pytest.fixture(scope="module")
def solid(tube: Tube) -> Solid:
    return solid_of(tube)


def enclosed_mm3(tube: Tube) -> float:
    """Volume by the divergence theorem over four-node and three-node shells; the mirror planes add nothing to ∮ y dA_y."""
    fine = cut_in_four(tube)
    x = fine.nodes_mm
    a, b, c, d = (x[fine.quads[:, k] - 1] for k in range(4))
    triangles = [(a, b, c), (a, c, d), tuple(x[fine.triangles[:, k] - 1] for k in range(3))]
    return sum(float((np.cross(q - p, r - p)[:, 1] / 2 * (p + q + r)[:, 1] / 3).sum()) for p, q, r in triangles)


@pytest.mark.parametrize("extent", [Extent(2), Extent(3, from_window=True, margin_mm=1.5)])
def test_shells_close_half_a_cylinder_with_normals_outwards(extent: Extent) -> None:
    tube = tube_of(DESIGN, LAYUP, extent, around_mm=1.0)
    assert enclosed_mm3(tube) == pytest.approx(math.pi * R**2 / 2 * tube.length_mm, rel=2e-3)


def test_edges_of_shells_are_shared_by_two_or_lie_on_a_mirror_plane(tube: Tube) -> None:
    edges: dict[tuple[int, int], int] = {}
    for elements, n in ((tube.quads, 4), (tube.triangles, 3)):
        for row in elements:
            for k in range(n):
                edge = tuple(sorted((int(row[k]), int(row[(k + 1) % n]))))
                edges[edge] = edges.get(edge, 0) + 1
    for edge, count in edges.items():
        y, z = tube.nodes_mm[np.array(edge) - 1][:, 1:].T
        assert count == (1 if (np.abs(y) < 1e-9).all() or (np.abs(z) < 1e-9).all() else 2), edge


def test_laminates_lie_where_the_design_has_them(tube: Tube) -> None:
    area: dict[tuple[str, ...], float] = {}
    for section in tube.sections:
        corners = tube.nodes_mm[tube.quads[section.elements - 1][:, :4] - 1]
        s = R * np.arctan2(corners[..., 1], -corners[..., 0])
        size = np.ptp(s, axis=1) * np.ptp(corners[..., 2], axis=1)
        names = tuple(layer.name for layer in section.layers)
        area[names] = area.get(names, 0.0) + float(size.sum())
    # Two windows of 3 mm, and ribs of 1 + 2 + 2 mm; 5 mm of half the circumference is strip.
    assert area == pytest.approx({("film", "strip"): 5 * 11, ("film",): 15 * 6, ("film", "rib"): 15 * 5})


def test_the_full_length_has_whole_windows_and_margins() -> None:
    extent = Extent.of(DESIGN, None)
    assert (2 * extent.cells - 1, extent.from_window) == (35, True)  # Eq 7: 35.6
    assert tube_of(DESIGN, LAYUP, extent).length_mm == pytest.approx(90.0)
    even = ShellDesign(strip_width_mm=10, window_width_mm=9)  # Eq 7: 16.2
    assert (Extent.of(even, None).cells, Extent.of(even, None).from_window) == (8, False)
    assert tube_of(even, LAYUP, Extent.of(even, None)).length_mm == pytest.approx(90.0)


def test_solids_have_positive_volume_and_the_film_its_thickness(solid: Solid) -> None:
    x = solid.nodes_mm[solid.bricks - 1]
    e = [x[:, 1] - x[:, 0], x[:, 3] - x[:, 0], x[:, 4] - x[:, 0]]
    volume = np.einsum("ij,ij->i", np.cross(e[0], e[1]), e[2])
    assert volume.min() > 0
    w = solid.nodes_mm[solid.wedges - 1]
    assert np.einsum("ij,ij->i", np.cross(w[:, 1] - w[:, 0], w[:, 2] - w[:, 0]), w[:, 3] - w[:, 0]).min() > 0
    film = solid.nodes_mm[solid.bricks[solid.laws[LAYUP.film] - 1] - 1][..., :2]
    radii = np.hypot(film[..., 0], film[..., 1])[:, :8]
    assert (radii.min(), radii.max()) == (pytest.approx(R - 0.15), pytest.approx(R + 0.15))


def test_loaded_faces_of_solids_close_the_inside(solid: Solid) -> None:
    """Loaded first faces, seen from inside: enclosed volume, and no loaded face in the interior of the body."""
    faces: dict[tuple[int, ...], int] = {}
    for elements, kinds in ((solid.bricks, HEX_FACES), (solid.wedges, WEDGE_FACES)):
        for row in elements:
            for kind in kinds:
                face = tuple(sorted(int(row[k]) for k in kind))
                faces[face] = faces.get(face, 0) + 1
    assert max(faces.values()) == 2
    volume = 0.0
    bricks = len(solid.bricks)
    for number in solid.loaded:
        row = solid.bricks[number - 1][:4] if number <= bricks else solid.wedges[number - bricks - 1][:3]
        assert faces[tuple(sorted(map(int, row)))] == 1
        p = solid.nodes_mm[row - 1]
        for a, b in zip(range(1, len(p)), range(2, len(p))):  # first faces turn against their element's inside
            normal = np.cross(p[a] - p[0], p[b] - p[0]) / 2
            volume += normal[1] * (p[0] + p[a] + p[b])[1] / 3
    assert volume == pytest.approx(math.pi * (R - 0.15) ** 2 / 2 * solid.tube.length_mm, rel=0.015)


def test_sheets_share_nodes_and_keep_triangle_numbers(tube: Tube) -> None:
    sheets = sheets_of(tube)
    extra = len(sheets.quads) - len(tube.quads)
    assert extra == sum(len(s.elements) for s in tube.sections if len(s.layers) == 2)
    assert len(sheets.nodes_mm) == len(tube.nodes_mm)
    np.testing.assert_array_equal(sheets.wall, tube.wall)
    numbers = np.concatenate([sheets.wall, sheets.cap, *(s.elements for s in sheets.overlays)])
    assert sorted(numbers) == list(range(1, len(sheets.quads) + len(sheets.triangles) + 1))
    assert set(sheets.cap_loaded) <= set(sheets.cap)


@pytest.mark.parametrize("make", [sheets_of, solid_of])
def test_thicknesses_that_do_not_fit_are_refused(make) -> None:
    uneven = Layup("uneven", "guess", film=Polynomial(C10=1.5), strip_thickness_mm=0.6)
    with pytest.raises(UsageError, match=r"0\.3"):
        make(tube_of(DESIGN, uneven, Extent(1)))


@pytest.mark.parametrize("size", [0.0, -1.0, math.nan])
def test_impossible_sizes_are_refused(size: float) -> None:
    with pytest.raises(UsageError, match="along_mm"):
        tube_of(DESIGN, LAYUP, Extent(1), along_mm=size)
    with pytest.raises(UsageError, match="0 cells"):
        Extent.of(DESIGN, 0)
