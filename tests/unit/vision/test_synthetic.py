"""Drawn pictures against closed forms: what is drawn is where the truth says, to hundredths of a pixel."""

from __future__ import annotations

from dataclasses import replace

import cv2
import numpy as np
import pytest
from scipy.integrate import quad

from benchlab.errors import UsageError
from benchlab.vision.picture import Planes
from benchlab.vision.synthetic import (
    MARKER_RGB,
    MarkerTruth,
    Scene,
    Thing,
    draw_frame,
    draw_frames,
    marker_truth,
    paint,
)
from benchlab.vision.synthetic.coverage import ellipse_coverage
from benchlab.vision.synthetic.encode import subsample, ycc_matrix
from benchlab.vision.synthetic.geometry import to_picture
from benchlab.vision.synthetic.layers import exposure_angles

CLEAN = Scene(width=800, height=560, length_px=500.0, base_px=(140.3, 60.7), noise_sd=0.0, light_gradient=0.0)


def drawn(scene: Scene, angle_deg: float, previous_deg: float | None = None) -> Planes:
    previous = angle_deg if previous_deg is None else previous_deg
    return draw_frame(scene, np.deg2rad(angle_deg), np.deg2rad(previous), np.random.default_rng(1))


def truth(scene: Scene, *angles_deg: float) -> MarkerTruth:
    return marker_truth(scene, np.deg2rad(angles_deg))


def marker_weights(scene: Scene, plane: str, angle_deg: float, previous_deg: float | None = None) -> np.ndarray:
    """How much the markers change a plane: the picture less the same one with markers of the body's colour."""
    blank = replace(scene, marker_rgb=scene.body_rgb)
    with_markers, without = (getattr(drawn(s, angle_deg, previous_deg), plane).astype(float) for s in (scene, blank))
    return np.abs(with_markers - without)


def centroids(weights: np.ndarray, around: np.ndarray, reach: float) -> np.ndarray:
    """(N, 2) weighted centroid, in sample units, within `reach` of each expected place."""
    y, x = np.mgrid[: weights.shape[0], : weights.shape[1]]
    near = [np.hypot(x - place[0], y - place[1]) <= reach for place in around]
    return np.array([[np.average(axis[n], weights=weights[n]) for axis in (x, y)] for n in near])


def luma_error(scene: Scene, angle_deg: float, previous_deg: float | None = None, reach: float = 18.0) -> float:
    """The largest distance, along x or y, of a luma centroid from the truth."""
    true = truth(scene, angle_deg).positions_px[0]
    return np.abs(centroids(marker_weights(scene, "luma", angle_deg, previous_deg), true, reach) - true).max()


def test_the_body_is_an_arc_of_the_bending_angle_and_a_line_at_zero() -> None:
    scene = replace(CLEAN, width=4000, height=4000, base_px=(2000.0, 2000.0), heading_rad=0.4, bend_sign=-1)
    for angle in (0.0, 1e-12, 1e-5, 0.3, np.pi, np.deg2rad(300)):
        along = np.linspace(0, scene.length_px, scene.markers)
        kappa = -angle / scene.length_px
        expected = [
            (
                2000 + quad(lambda s, k=kappa: np.cos(0.4 + k * s), 0, end)[0],
                2000 + quad(lambda s, k=kappa: np.sin(0.4 + k * s), 0, end)[0],
            )
            for end in along
        ]
        found = marker_truth(scene, np.array([angle])).positions_px[0]
        np.testing.assert_allclose(found, expected, atol=1e-8)


def test_half_a_circle_ends_a_diameter_away() -> None:
    positions = truth(CLEAN, 180).positions_px[0]
    np.testing.assert_allclose(positions[-1], (140.3, 60.7 + 2 * 500 / np.pi), atol=1e-9)


@pytest.mark.parametrize("angle_deg", [0.0, 0.01, 45.0, 180.0, 300.0])
def test_every_drawn_marker_is_where_the_truth_says(angle_deg: float) -> None:
    assert (truth(CLEAN, angle_deg).visible == 1).all()
    assert luma_error(CLEAN, angle_deg) < 0.02


@pytest.mark.parametrize(
    "change",
    [
        {"marker_rgb": MARKER_RGB["green"]},
        {"marker_rgb": MARKER_RGB["blue"], "matrix": "bt601", "full_range": True},
        {"marker_radius_px": 5.0},
        {"blur_px": 2.0, "marker_radius_px": 8.0},
        {"blur_px": 0.0},
        {"light_gradient": 0.3},
        {"tilt_rad": 0.3, "tilt_axis_rad": 0.5},
        {"lens_k1": -0.6, "lens_k2": 0.3, "focal_px": 1000.0},
        {"marker_offset_px": tuple((0.7 * k % 2 - 1, 1 - 1.1 * k % 2) for k in range(10))},
        {"width": 801, "height": 561},
    ],
    ids=",".join,
)
def test_the_truth_holds_for_every_camera_and_light(change: dict) -> None:
    assert luma_error(replace(CLEAN, **change), 120) < 0.02


def test_a_disc_covers_its_area_about_its_centre() -> None:
    places = np.random.default_rng(3).uniform(30, 31, (300, 2))
    windows, corners = ellipse_coverage(places, np.broadcast_to(9 * np.eye(2), (300, 2, 2)))
    area, index = windows.sum(axis=(1, 2)), np.arange(windows.shape[1])
    found = np.stack([(windows.sum(axis=axis) * index).sum(axis=1) / area for axis in (1, 2)], axis=1) + corners
    assert np.abs(found - places).max() < 0.005
    np.testing.assert_allclose(area, np.pi * 81, rtol=5e-4)
    assert windows.max() <= 1.0001


def test_an_ellipse_covers_its_area_and_has_its_moments() -> None:
    shape = np.array([[[8.0, 3.0], [-1.0, 5.0]]])
    windows, corners = ellipse_coverage(np.array([[20.4, 21.7]]), shape)
    y, x = np.mgrid[: windows.shape[1], : windows.shape[1]] + corners[0][::-1, None, None]
    weight = windows[0] / windows[0].sum()
    offset = np.stack([x - 20.4, y - 21.7])
    assert windows[0].sum() == pytest.approx(np.pi * abs(np.linalg.det(shape[0])), rel=1e-3)
    second = np.einsum("ihw,jhw,hw->ij", offset, offset, weight)
    np.testing.assert_allclose(second, shape[0] @ shape[0].T / 4 + np.eye(2) / 12, atol=0.02)


@pytest.mark.parametrize(
    ("siting", "right", "wrong"), [("left", (0, 0.5), (0.5, 0.5)), ("centre", (0.5, 0.5), (0, 0.5))]
)
def test_chroma_agrees_with_luma_at_its_own_siting_only(
    siting: str, right: tuple[float, float], wrong: tuple[float, float]
) -> None:
    scene = replace(CLEAN, chroma_siting=siting)
    true = truth(scene, 100).positions_px[0]
    assert drawn(scene, 100).chroma_offset == right
    luma = centroids(marker_weights(scene, "luma", 100), true, 18)
    chroma = marker_weights(scene, "cr", 100)
    placed_right, placed_wrong = (2 * centroids(chroma, (true - at) / 2, 9) + at for at in (right, wrong))
    assert np.abs(placed_right - luma).max() < 0.03
    np.testing.assert_allclose(np.abs((placed_wrong - luma).mean(axis=0)), (0.5, 0), atol=0.03)


@pytest.mark.parametrize("siting", ["left", "centre"])
def test_a_linear_field_sampled_at_its_siting_keeps_its_values(siting: str) -> None:
    y, x = np.mgrid[:8, :12].astype(np.float32)
    sampled = subsample(3 * x + 7 * y, siting)
    j, i = np.mgrid[:4, 1:6]
    expected = 3 * (2 * i + (0.5 if siting == "centre" else 0)) + 7 * (2 * j + 0.5)
    np.testing.assert_allclose(sampled[:, 1:], expected)


def test_known_colours_become_the_known_levels_of_their_standard() -> None:
    red = np.array([255, 0, 0, 1])
    np.testing.assert_allclose(ycc_matrix("bt709", full_range=False) @ red, (62.56, 102.34, 240.0), atol=0.01)
    np.testing.assert_allclose(ycc_matrix("bt601", full_range=True) @ red, (76.245, 84.97, 255.5), atol=0.01)
    scene = replace(CLEAN, background_rgb=(40.0, 90.0, 200.0), full_range=True, matrix="bt601")
    planes = drawn(scene, 0)
    luma = 0.299 * 40 + 0.587 * 90 + 0.114 * 200
    corner = (planes.luma[-5, 5], planes.cb[-5, 5], planes.cr[-5, 5])
    assert corner == (round(luma), round(128 + (200 - luma) / 1.772), round(128 + (40 - luma) / 1.402))
    assert (planes.full_range, planes.matrix) == (True, "bt601")


def test_odd_pictures_have_chroma_rounded_up() -> None:
    planes = drawn(replace(CLEAN, width=801, height=561, noise_sd=1.0), 30)
    assert (planes.luma.shape, planes.cb.shape, planes.cr.shape) == ((561, 801), (281, 401), (281, 401))


def test_motion_smears_a_marker_about_its_place_in_mid_exposure() -> None:
    scene = replace(CLEAN, exposure_fraction=0.6, body_width_px=60.0)
    assert luma_error(scene, 90, previous_deg=84, reach=24) < 0.03
    still, moving = marker_weights(scene, "luma", 90), marker_weights(scene, "luma", 90, previous_deg=84)
    assert (moving > 2).sum() > (still > 2).sum() * 1.1
    assert moving.sum() == pytest.approx(still.sum(), rel=0.005)


def test_the_exposure_has_at_least_five_parts_and_steps_of_a_pixel_at_most() -> None:
    assert exposure_angles(CLEAN, 1.0, 1.0).tolist() == [1.0]
    few = exposure_angles(CLEAN, 1.0, 0.999)
    assert len(few) == 5
    many = exposure_angles(CLEAN, 1.0, 0.8)
    assert many.mean() == pytest.approx(1.0)
    assert many[-1] - many[0] == pytest.approx(0.2 * 0.25 * (1 - 1 / len(many)))
    steps = np.diff(marker_truth(CLEAN, many).positions_px[:, -1], axis=0)
    assert np.linalg.norm(steps, axis=1).max() <= 1.0


def test_the_lens_is_that_of_opencv() -> None:
    scene = replace(CLEAN, lens_k1=-0.2, lens_k2=0.05, focal_px=700.0)
    points = np.random.default_rng(5).uniform((0, 0), (800, 560), (50, 2))
    middle = np.array([399.5, 279.5])
    rays = np.column_stack([(points - middle) / 700, np.ones(50)])
    camera = np.array([[700, 0, 399.5], [0, 700, 279.5], [0, 0, 1]])
    expected, _ = cv2.projectPoints(rays, np.zeros(3), np.zeros(3), camera, np.array([-0.2, 0.05, 0, 0]))
    np.testing.assert_allclose(to_picture(scene, points), expected[:, 0], atol=1e-6)


def test_the_tilt_is_a_plane_seen_by_a_pinhole_camera() -> None:
    scene = replace(CLEAN, tilt_rad=0.35, tilt_axis_rad=0.8, focal_px=900.0)
    points = np.random.default_rng(6).uniform((0, 0), (800, 560), (50, 2))
    middle = np.array([399.5, 279.5])
    on_plane = np.column_stack([points - middle, np.zeros(50)])
    camera = np.array([[900, 0, 399.5], [0, 900, 279.5], [0, 0, 1]])
    axis = 0.35 * np.array([np.cos(0.8), np.sin(0.8), 0])
    expected, _ = cv2.projectPoints(on_plane, axis, np.array([0.0, 0.0, 900.0]), camera, np.zeros(4))
    np.testing.assert_allclose(to_picture(scene, points), expected[:, 0], atol=1e-6)
    step = to_picture(scene, middle + 0.01 * np.array([np.cos(0.8), np.sin(0.8)])) - middle
    assert np.linalg.norm(step) == pytest.approx(0.01)


CLUTTER = (
    Thing("cable", (400, 500), (700, 6)),
    Thing("glove", (640, 300), (180, 140), drift_px=(-2, 0)),
    Thing("dots", (300, 300), (200, 120)),
    Thing("hand", (500, 420), (200, 150), turn_rad=2.0),
)


def test_clutter_is_drawn_and_leaves_the_truth_alone() -> None:
    scene = replace(CLEAN, clutter=CLUTTER)
    plain, full = truth(CLEAN, 20, 60), truth(scene, 20, 60)
    np.testing.assert_array_equal(plain.positions_px, full.positions_px)
    np.testing.assert_array_equal(full.visible, 1)
    for thing in CLUTTER:
        alone = drawn(replace(CLEAN, clutter=(thing,)), 60)
        assert np.abs(alone.cr.astype(int) - drawn(CLEAN, 60).cr).max() > 10, thing.kind
    assert luma_error(scene, 60) < 0.02


def test_a_drifting_thing_is_elsewhere_in_a_later_frame() -> None:
    base = replace(CLEAN, clutter=(Thing("dots", (300, 400), (200, 120), drift_px=(4, -2)),))
    first, later = (draw_frame(base, 0.0, 0.0, np.random.default_rng(1), frame) for frame in (0, 20))
    np.testing.assert_array_equal(first.luma[330:470, 180:420], later.luma[290:430, 260:500])
    assert (first.cr != later.cr).any()


def test_a_plate_hides_markers_in_the_truth_and_in_the_picture() -> None:
    third = truth(CLEAN, 0).positions_px[0, 2]
    plate = Thing("plate", (third[0], third[1]), (30, 60))
    scene = replace(CLEAN, occluders=(plate,))
    hidden = truth(scene, 0)
    assert hidden.visible[0, 2] == 0
    assert np.isnan(hidden.positions_px[0, 2]).all()
    assert (np.delete(hidden.visible[0], 2) == 1).all()
    x, y = np.rint(third).astype(int)
    window = np.s_[(y - 9) // 2 : (y + 9) // 2, (x - 9) // 2 : (x + 9) // 2]
    assert drawn(CLEAN, 0).cr[window].max() > 180
    assert drawn(scene, 0).cr[window].max() < 132


def test_a_half_hidden_marker_keeps_its_place_and_says_half() -> None:
    third = truth(CLEAN, 0).positions_px[0, 2]
    scene = replace(CLEAN, occluders=(Thing("plate", (third[0] + 30, third[1]), (60, 60)),))
    half = truth(scene, 0)
    assert half.visible[0, 2] == pytest.approx(0.5, abs=0.03)
    np.testing.assert_array_equal(half.positions_px[0, 2], third)


def test_markers_that_leave_the_picture_have_no_place() -> None:
    scene = replace(CLEAN, base_px=(-0.5, 300.0), heading_rad=np.pi)
    gone = truth(scene, 0)
    assert gone.visible[0, 0] == pytest.approx(0.5, abs=0.03)
    assert (gone.visible[0, 1:] == 0).all()
    assert np.isnan(gone.positions_px[0, 1:]).all()
    planes = drawn(scene, 0)
    assert planes.cr[:, 1:6].max() > 180
    assert planes.cr[:, 12:].max() < 130


def test_nothing_of_the_body_in_view_is_just_the_bench() -> None:
    planes = drawn(replace(CLEAN, base_px=(-2000.0, -2000.0)), 0)
    assert len(np.unique(planes.luma)) == 1


def test_drawing_only_what_moves_gives_the_whole_picture(monkeypatch: pytest.MonkeyPatch) -> None:
    scene = replace(CLEAN, clutter=CLUTTER, occluders=(Thing("plate", (300, 100), (30, 90)),), body_shading=0.4)
    quick = drawn(scene, 70, 69)
    monkeypatch.setattr(paint, "_moving_part", lambda scene, *_: (0, 0, scene.width, scene.height))
    whole = drawn(scene, 70, 69)
    for name in ("luma", "cb", "cr"):
        unlike = np.abs(getattr(quick, name).astype(int) - getattr(whole, name))
        assert unlike.max() <= 1, name
        assert (unlike > 0).mean() < 1e-4, name  # a level that lies on the edge between two may round either way


def test_the_same_seed_gives_the_same_pixels_and_another_one_does_not() -> None:
    scene, angles = replace(CLEAN, noise_sd=2.0), np.deg2rad([10.0, 12.0, 14.0])
    one, two, other = (list(draw_frames(scene, angles, np.random.default_rng(seed))) for seed in (1, 1, 2))
    for a, b, c in zip(one, two, other, strict=True):
        for name in ("luma", "cb", "cr"):
            np.testing.assert_array_equal(getattr(a, name), getattr(b, name))
        assert (a.luma != c.luma).mean() > 0.5
    assert (one[0].luma[300:] != one[1].luma[300:]).mean() > 0.5


def test_noise_has_the_spread_that_the_matrix_leaves() -> None:
    scene = replace(CLEAN, noise_sd=6.0, full_range=True)
    planes = drawn(scene, 0)
    luma = 6 * np.sqrt(0.2126**2 + 0.7152**2 + 0.0722**2)
    assert planes.luma[200:].std() == pytest.approx(np.hypot(luma, np.sqrt(1 / 12)), rel=0.02)
    red = 6 * np.sqrt((1 - 0.2126) ** 2 + 0.7152**2 + 0.0722**2) / 1.5748 * np.sqrt(0.5 * (6 / 16))
    assert planes.cr[100:].std() == pytest.approx(np.hypot(red, np.sqrt(1 / 12)), rel=0.03)


def test_a_highlight_is_a_bright_spot_off_the_middle() -> None:
    x, y = np.rint(truth(CLEAN, 0).positions_px[0, 4]).astype(int)
    plain, bright = drawn(CLEAN, 0), drawn(replace(CLEAN, highlight=0.9), 0)
    assert int(bright.luma[y - 3, x - 3]) > int(plain.luma[y - 3, x - 3]) + 80
    assert bright.luma[y + 4, x + 4] == plain.luma[y + 4, x + 4]


@pytest.mark.parametrize(
    ("change", "word"),
    [
        ({"markers": 1}, "markers"),
        ({"width": 8}, "width"),
        ({"marker_radius_px": 0.0}, "above 0"),
        ({"marker_offset_px": ((0.0, 0.0),)}, "marker_offset_px"),
        ({"bend_sign": 0}, "bend_sign"),
        ({"exposure_fraction": 1.5}, "exposure_fraction"),
        ({"noise_sd": -1.0}, "noise_sd"),
        ({"tilt_rad": 1.5}, "tilt_rad"),
        ({"chroma_siting": "top"}, "left or centre"),
        ({"matrix": "bt2020"}, "bt601 or bt709"),
    ],
)
def test_a_scene_that_cannot_be_drawn_is_refused(change: dict, word: str) -> None:
    with pytest.raises(UsageError, match=word):
        replace(CLEAN, **change)


def test_an_unknown_thing_is_refused_with_the_known_ones() -> None:
    with pytest.raises(UsageError, match=r"no shape is called cat.*cable"):
        Thing("cat", (0, 0), (1, 1))
