"""One outlying marker is left out; noise and bodies that are no circles are left alone."""

import numpy as np
import pytest

from benchlab.vision.circle import FITS, fit_circles, fit_circles_robustly
from benchlab.vision.circle_outliers import is_outlier, usual_scatter

NOISE = 0.05


def body(frames, n, largest_deg=70.0, unevenness=0.0, shape="linear"):
    """(frames, n, 2) markers on an 800 px body that bends more and more, its curvature uneven by ± unevenness."""
    s = np.linspace(0, 1, 801)
    along = {"linear": 2 * s - 1, "halves": np.sign(s - 0.5), "quadratic": 8 * (s - 0.5) ** 2 - 1}[shape]
    growth = np.linspace(0, np.deg2rad(largest_deg), frames)[:, None]
    heading = np.cumsum(growth * (1 + unevenness * along), axis=1) / 801
    points = np.stack([np.cumsum(np.cos(heading), axis=1), np.cumsum(np.sin(heading), axis=1)], axis=-1)
    return points[:, np.linspace(0, 800, n).round().astype(int)]


def spoiled(points, every, size, seed=3):
    """Push one random marker of every `every`-th frame by `size` px to a side; which frames, which markers."""
    rng = np.random.default_rng(seed)
    frames = np.arange(every // 2, len(points), every)
    markers = rng.integers(0, points.shape[1], len(frames))
    step = np.gradient(points, axis=1)[frames, markers]
    step /= np.linalg.norm(step, axis=1)[:, None]
    points[frames, markers] += size * np.stack([-step[:, 1], step[:, 0]], axis=1)
    return frames, markers


@pytest.mark.parametrize("n", [5, 6, 10, 20])
@pytest.mark.parametrize("noise", [None, NOISE])
def test_noise_alone_drops_nothing(n, noise):
    points = body(4000, n) + NOISE * np.random.default_rng(2).normal(size=(4000, n, 2))
    fits, used = fit_circles_robustly(points, noise=noise)
    assert (~used).sum() <= 2  # the criterion allows one frame in ten thousand
    np.testing.assert_array_equal(fits.dof, used.sum(axis=1) - 3)


@pytest.mark.parametrize("method", FITS)
def test_a_stray_marker_is_dropped_and_the_fit_is_that_without_it(method):
    points = body(300, 10, largest_deg=150) + NOISE * np.random.default_rng(4).normal(size=(300, 10, 2))
    frames, markers = spoiled(points, every=10, size=40 * NOISE)
    fits, used = fit_circles_robustly(points, method=method)
    expected = np.ones_like(used)
    expected[frames, markers] = False
    np.testing.assert_array_equal(used, expected)
    again = fit_circles(points, used, method)
    np.testing.assert_array_equal(fits.curvature, again.curvature)
    np.testing.assert_array_equal(fits.residuals, again.residuals)
    assert fits.rms.max() < 3 * NOISE


def test_five_markers_are_enough_in_a_recording_and_too_few_in_one_picture():
    points = body(200, 5) + NOISE * np.random.default_rng(5).normal(size=(200, 5, 2))
    frames, markers = spoiled(points, every=20, size=8.0)
    _, used = fit_circles_robustly(points, noise=NOISE)
    assert not used[frames, markers].any()
    _, used_alone = fit_circles_robustly(points[frames[:1]], noise=NOISE)
    assert used_alone.all()


def test_four_markers_are_all_kept():
    points = body(50, 4)
    spoiled(points, every=5, size=30.0)
    assert fit_circles_robustly(points, noise=NOISE)[1].all()


def test_a_marker_that_is_always_wrong_is_dropped_when_the_frame_itself_shows_it():
    points = body(100, 10) + NOISE * np.random.default_rng(6).normal(size=(100, 10, 2))
    points[:, 4] += (0.0, 6.0)
    _, used = fit_circles_robustly(points)
    assert not used[:, 4].any()
    assert used[:, [0, 1, 2, 3, 5, 6, 7, 8, 9]].all()


@pytest.mark.parametrize("n", [5, 6, 8, 10, 15])
@pytest.mark.parametrize("shape", ["linear", "halves", "quadratic"])
@pytest.mark.parametrize("unevenness", [0.02, 0.3, 0.95])
def test_a_body_without_constant_curvature_keeps_its_markers(n, shape, unevenness):
    points = body(150, n, 120, unevenness, shape) + NOISE * np.random.default_rng(8).normal(size=(150, n, 2))
    fits, used = fit_circles_robustly(points, noise=NOISE)
    assert used.all()
    if unevenness > 0.9:
        assert fits.rms.max() > 50 * NOISE


def test_points_left_out_before_stay_out():
    points = body(60, 10) + NOISE * np.random.default_rng(9).normal(size=(60, 10, 2))
    before = np.ones((60, 10), dtype=bool)
    before[:, 2] = False
    points[:, 2] = np.nan
    frames, markers = spoiled(points, every=7, size=20.0)
    _, used = fit_circles_robustly(points, before)
    expected = before.copy()
    expected[frames, markers] = False
    np.testing.assert_array_equal(used, expected)
    assert before[frames[markers != 2]].sum() == 9 * (markers != 2).sum()  # the caller's array is as it was


def test_exact_points_and_empty_frames_are_no_trouble():
    points = body(40, 8)
    points[10] = np.nan
    fits, used = fit_circles_robustly(points)
    assert used.sum() == 39 * 8
    assert np.isnan(fits.curvature[10])


def test_usual_scatter_is_the_noise_and_is_not_moved_by_rare_frames():
    rng = np.random.default_rng(10)
    squares = 0.09 * rng.chisquare(7, size=2000)
    squares[::5] = 1e4
    scatter, dof = usual_scatter(squares, np.full(2000, 7))
    assert np.median(scatter) == pytest.approx(0.3, rel=0.1)
    assert (dof == 7 * 15.5).all()
    nothing, none = usual_scatter(np.array([np.nan, 1.0]), np.array([7, 0]))
    assert np.isnan(nothing).all()
    assert not none.any()


def test_the_criterion_in_numbers():
    """n = 10: F = 16·6/6 = 16 is not decisive; 36 is, if the noise is known, and is not within the frame alone."""
    numbers = {"n": np.array([10]), "span": np.array([800.0]), "noise": np.array([0.0])}
    known = {"reference": np.array([1.0]), "reference_dof": np.array([np.inf])}
    unknown = {"reference": np.array([3.0]), "reference_dof": np.array([np.inf])}
    six = np.array([6.0])
    sure = {"reference": np.array([0.2]), "reference_dof": np.array([np.inf])}
    assert not is_outlier(np.array([25.0]), six, **numbers, **sure)[0]  # F = 19: smooth misfit is not excluded
    assert is_outlier(np.array([27.0]), six, **numbers, **sure)[0]
    assert not is_outlier(np.array([22.0]), six, **numbers, **known)[0]
    assert is_outlier(np.array([42.0]), six, **numbers, **known)[0]
    assert not is_outlier(np.array([42.0]), six, **numbers, **unknown)[0]
    assert is_outlier(np.array([406.0]), six, **numbers, **unknown)[0]
