"""The overlay: what is drawn lies where it was found, and can be read on bright and on dark."""

from dataclasses import replace

import numpy as np
import pytest

from benchlab.report.caption import _fitted, _width
from benchlab.report.overlay import arc_points, caption, draw_overlay
from benchlab.vision.series import CurvatureSeries

YELLOW = np.array([0, 220, 255])
RED = np.array([60, 60, 255])


def bent(theta_deg, length=300.0, start=(150.0, 80.0), n=7, flag="") -> CurvatureSeries:
    """One frame of a body of constant curvature that leaves `start` to the right and bends downwards."""
    theta = np.radians(theta_deg)
    kappa = theta / length
    s = np.linspace(0, length, n)
    x = np.sin(kappa * s) / kappa if kappa else s
    y = (1 - np.cos(kappa * s)) / kappa if kappa else 0 * s

    def one(value):
        return np.array([value], float)

    return CurvatureSeries(
        time_s=one(1.25),
        markers_px=(np.array(start) + np.stack([x, y], axis=1))[None],
        used=np.ones((1, n), bool),
        angle_rad=one(theta),
        angle_sd_rad=one(np.radians(0.3)),
        curvature_per_mm=one(theta / 180),
        curvature_sd_per_mm=one(1e-4),
        radius_mm=one(1.0),
        centre_px=one([start[0], start[1] + 1 / kappa if kappa else np.nan]),
        radius_px=one(1 / abs(kappa) if kappa else np.nan),
        curvature_per_px=one(kappa),
        fit_rms_px=one(0.1),
        centroid_sd_px=one(0.05),
        flag=(flag,),
    )


def blank(level, shape=(480, 640)):
    return np.full((*shape, 3), level, np.uint8)


def near(picture, point, colour, reach=3, tolerance=60):
    """Whether a pixel close to a point has about a colour."""
    x, y = np.round(point).astype(int)
    patch = picture[max(0, y - reach) : y + reach + 1, max(0, x - reach) : x + reach + 1].astype(int)
    return bool((np.abs(patch - colour).max(axis=2) < tolerance).any())


def on_body(theta_deg, share, length=300.0, start=(150.0, 80.0)):
    theta = np.radians(theta_deg)
    kappa, s = theta / length, share * length
    return np.array(start) + (
        np.array([np.sin(kappa * s), 1 - np.cos(kappa * s)]) / kappa if kappa else np.array([s, 0])
    )


@pytest.mark.parametrize("theta", [-60.0, 20.0, 93.2, 179.0, 250.0, 340.0, 0.0])
@pytest.mark.parametrize("level", [0, 128, 255])
def test_the_arc_runs_along_the_body_from_end_to_end(theta, level):
    start = (150.0, 240.0)
    drawn = draw_overlay(blank(level), bent(theta, start=start), 0)
    for share in (0.08, 0.25, 0.42, 0.58, 0.75, 0.92):
        assert near(drawn, on_body(theta, share, start=start), YELLOW), share


@pytest.mark.parametrize("theta", [-200.0, -1.0, 93.2, 250.0, 350.0])
def test_arc_points_lie_on_the_circle_and_span_the_markers(theta):
    series = bent(theta)
    points = arc_points(series, 0)
    np.testing.assert_allclose(np.linalg.norm(points - series.centre_px[0], axis=1), series.radius_px[0])
    np.testing.assert_allclose(points[[0, -1]], series.markers_px[0][[0, -1]], atol=1e-6)
    steps = np.linalg.norm(np.diff(points, axis=0), axis=1)
    assert steps.sum() == pytest.approx(300, rel=1e-3)


def test_a_line_is_drawn_as_a_line_whatever_the_circle():
    series = bent(0)
    np.testing.assert_allclose(arc_points(series, 0), [[150, 80], [450, 80]])
    nearly = replace(series, centre_px=np.array([[300.0, 1e9]]), radius_px=np.array([1e9]))
    np.testing.assert_allclose(arc_points(nearly, 0), [[150, 80], [450, 80]])


def test_markers_in_the_fit_are_rings_and_markers_left_out_are_crosses():
    series = bent(90, flag="markers left out")
    series.used[0, 3] = False
    series.markers_px[0, 3] += (20, -20)
    series.markers_px[0, 5] = np.nan
    series.used[0, 5] = False
    drawn = draw_overlay(blank(128), series, 0)
    assert near(drawn, series.markers_px[0, 3], RED)
    for i in (0, 1, 2, 4, 6):
        at = series.markers_px[0, i]
        assert not near(drawn, at, RED)
        assert near(drawn, np.add(at, (480 / 90 * 1.1, 0)), np.array([255, 255, 255])), i


def test_the_picture_given_is_not_changed():
    picture = blank(100)
    drawn = draw_overlay(picture, bent(60), 0)
    assert (picture == 100).all()
    assert drawn.shape == picture.shape
    assert drawn.dtype == np.uint8
    assert (drawn != picture).any()


def test_what_is_far_from_the_drawing_stays_as_it_was():
    drawn = draw_overlay(blank(77), bent(90), 0)
    assert (drawn[400:, 500:] == 77).all()


def test_the_words_of_a_frame():
    series = replace(bent(93.2, flag="not constant curvature;large uncertainty"), pressure_MPa=np.array([0.21]))
    assert caption(series, 0) == [
        "θ = 93.2° ± 0.3°",
        "t = 1.250 s   p = 0.210 MPa",
        "not constant curvature",
        "large uncertainty",
    ]
    fine = replace(series, angle_sd_rad=np.radians([0.02]), flag=("",), pressure_MPa=np.array([np.nan]))
    assert caption(fine, 0) == ["θ = 93.20° ± 0.02°", "t = 1.250 s"]
    still = replace(fine, time_s=np.array([np.nan]), names=("pin ü.jpg",))
    assert caption(still, 0)[1] == "pin ü.jpg"


def test_a_frame_without_an_angle_has_no_arc_and_says_so():
    series = replace(bent(90, flag="no markers"), angle_rad=np.array([np.nan]))
    assert caption(series, 0) == ["θ not measured", "t = 1.250 s", "no markers"]
    drawn = draw_overlay(blank(128), series, 0)
    assert not near(drawn, on_body(90, 0.25), YELLOW)


@pytest.mark.parametrize("level", [0, 255])
@pytest.mark.parametrize("shape", [(480, 640), (1080, 1920)])
def test_the_words_are_white_on_dark_and_grow_with_the_picture(level, shape):
    drawn = draw_overlay(blank(level, shape), bent(20, start=(300.0, 400.0)), 0)
    edge = shape[0] // 60
    corner = drawn[edge : shape[0] // 9, edge : shape[1] // 5].astype(int)
    assert np.percentile(corner, 20) <= 0.31 * level
    white = (corner > 230).all(axis=2)
    assert 0.02 < white.mean() < 0.4


def test_long_words_are_made_to_fit():
    text, tall = _fitted("x" * 500, 20.0, 300.0)
    assert text.endswith("...")
    assert _width(text, tall) <= 300
    assert _fitted("θ = 1°", 20.0, 300.0) == ("θ = 1°", 20.0)
    assert _fitted("\x1b[31m 中", 20.0, 300.0)[0] == "\\x1b[31m ?"


@pytest.mark.parametrize("shape", [(8, 8), (40, 30), (30, 2000), (2160, 3840)])
def test_any_size_of_picture_is_drawn_in(shape):
    series = replace(bent(90, flag="a long reason why this frame is in doubt " * 4), names=("n" * 300,))
    drawn = draw_overlay(blank(128, shape), series, 0)
    assert drawn.shape == (*shape, 3)


def test_coordinates_far_outside_are_left_out():
    series = bent(90)
    series.markers_px[0, 2] = 1e12
    series.centre_px[0] = 1e12
    assert draw_overlay(blank(128), series, 0).shape == (480, 640, 3)


def test_a_frame_that_is_not_there():
    with pytest.raises(IndexError, match="frame 1 of 1"):
        draw_overlay(blank(0), bent(10), 1)
    with pytest.raises(IndexError):
        draw_overlay(blank(0), bent(10), -1)
