"""ArUco markers drawn at known places, and the scale that they give."""

import cv2
import numpy as np
import pytest

from benchlab.errors import InputError, UsageError
from benchlab.vision.aruco import find_aruco, refine_square
from benchlab.vision.scale import scale_from_aruco


def aruco_picture(
    *, side_px=100.0, turned_deg=0.0, tilt=0.0, identity=7, dictionary=cv2.aruco.DICT_4X4_50, centre=(321.3, 243.7)
):
    """(480, 640) grey picture of one marker with a side of side_px, and its four corners (4, 2)."""
    # twice as wide as its black square: 6 cells of marker with 3 cells of white around
    cells = cv2.aruco.generateImageMarker(cv2.aruco.getPredefinedDictionary(dictionary), identity, 600)
    page = cv2.copyMakeBorder(cells, 300, 300, 300, 300, cv2.BORDER_CONSTANT, value=255)
    turn = np.deg2rad(turned_deg)
    square = side_px / 2 * np.array([(-1, -1), (1, -1), (1, 1), (-1, 1)])
    depth = 1 + tilt * square[:, :1] / side_px
    corners = (square / depth) @ np.array([[np.cos(turn), np.sin(turn)], [-np.sin(turn), np.cos(turn)]]) + centre
    on_page = np.array([(299.5, 299.5), (899.5, 299.5), (899.5, 899.5), (299.5, 899.5)])
    # each pixel is the mean of 4×4 samples, as a camera integrates over its pixels
    fine = 4 * corners + 1.5
    warp = cv2.getPerspectiveTransform(on_page.astype(np.float32), fine.astype(np.float32))
    large = cv2.warpPerspective(page, warp, (2560, 1920), flags=cv2.INTER_AREA, borderValue=200)
    return cv2.GaussianBlur(cv2.resize(large, (640, 480), interpolation=cv2.INTER_AREA), (0, 0), 0.7), corners


@pytest.mark.parametrize("turned_deg", [0, 17, 45, 100, 200])
@pytest.mark.parametrize("side_px", [60.0, 137.4, 300.0])
def test_aruco_gives_the_drawn_scale(turned_deg, side_px):
    picture, corners = aruco_picture(side_px=side_px, turned_deg=turned_deg)
    identities, found = find_aruco(picture)
    assert identities.tolist() == [7]
    np.testing.assert_allclose(found[0], corners, atol=0.15)
    scale = scale_from_aruco(picture, 25.0)
    assert scale.mm_per_px == pytest.approx(25.0 / side_px, rel=0.001)
    assert scale.sd_mm_per_px < 0.005 * scale.mm_per_px
    assert not scale.assumed
    assert scale.source.startswith("ArUco marker 7 of 4x4_50, sides 25 mm and ")


def test_a_slightly_tilted_marker_has_a_larger_uncertainty_that_covers_the_truth():
    picture, _ = aruco_picture(side_px=120.0, turned_deg=10, tilt=0.05)
    scale, flat = scale_from_aruco(picture, 30.0), scale_from_aruco(aruco_picture(side_px=120.0)[0], 30.0)
    assert abs(scale.mm_per_px - 0.25) < 2 * scale.sd_mm_per_px
    assert scale.sd_mm_per_px > 3 * flat.sd_mm_per_px


def test_a_strongly_tilted_marker_is_refused():
    with pytest.raises(InputError, match=r"ArUco marker 7 of 4x4_50 are .* px, which differ by more than 15 %"):
        scale_from_aruco(aruco_picture(side_px=120.0, tilt=0.3)[0], 30.0)


def test_no_marker_says_what_was_seen():
    with pytest.raises(InputError, match=r"no 4x4_50 ArUco marker in the 640×480 picture: no dark square"):
        scale_from_aruco(np.full((480, 640), 128, np.uint8), 25.0)
    picture, _ = aruco_picture(dictionary=cv2.aruco.DICT_6X6_250, identity=200)
    with pytest.raises(InputError, match=r"\d+ four-sided shapes carry no code of this set"):
        scale_from_aruco(picture, 25.0)
    assert find_aruco(picture, "6x6_250")[0].tolist() == [200]
    with pytest.raises(UsageError, match=r"no ArUco set is called '9x9'; choose one of .*4x4_50"):
        scale_from_aruco(picture, 25.0, "9x9")


@pytest.mark.parametrize("blur_px", [0.7, 1.5])
def test_corners_of_a_noisy_blurred_marker(blur_px):
    picture, corners = aruco_picture(side_px=150.0, turned_deg=33)
    noise = np.random.default_rng(4).normal(scale=4, size=picture.shape)
    rough = np.clip(cv2.GaussianBlur(picture, (0, 0), blur_px) + noise, 0, 255).round().astype(np.uint8)
    np.testing.assert_allclose(find_aruco(rough)[1][0], corners, atol=0.1)


def test_a_square_without_contrast_has_no_corners():
    square = np.array([(20.0, 20.0), (60, 20), (60, 60), (20, 60)])
    assert np.isnan(refine_square(np.full((80, 80), 90, np.uint8), square)).all()
    assert np.isnan(refine_square(np.full((80, 80), 90, np.uint8), np.zeros((4, 2)))).all()
