"""Circle fits against exact circles, lines, a published solution, Monte Carlo and another engine."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.linalg import eig
from scipy.optimize import least_squares

from benchlab.errors import UsageError
from benchlab.vision.circle import FITS, CircleFits, fit_circles

GANDER_GOLUB_STREBEL = np.array([(1, 7), (2, 6), (5, 8), (7, 7), (9, 5), (3, 7)], dtype=float)
UNBIASED = ["pratt", "taubin", "hyper", "geometric"]


def arc(angle_deg, length=800.0, n=10, turned_deg=0.0, start=(200.0, 300.0)):
    """(n, 2) points evenly along an arc that starts at `start` in the direction `turned_deg` and bends by angle_deg."""
    kappa = np.deg2rad(angle_deg) / length
    s = np.linspace(0, length, n)
    along = length / (n - 1) * np.arange(n) * np.sinc(kappa * s / 2 / np.pi)
    heading = np.deg2rad(turned_deg) + kappa * s / 2
    return np.stack([start[0] + along * np.cos(heading), start[1] + along * np.sin(heading)], axis=-1)


def one(points, **options) -> CircleFits:
    return fit_circles(np.asarray(points, dtype=float)[None], **options)


def test_published_geometric_solution():
    """Gander, Golub & Strebel (1994), best fit in the geometric sense."""
    fit = one(GANDER_GOLUB_STREBEL, method="geometric")
    np.testing.assert_allclose(fit.centre[0], (4.7398, 2.9835), atol=5e-5)
    assert fit.radius[0] == pytest.approx(4.7142, abs=5e-5)
    gradient = np.hypot(*(GANDER_GOLUB_STREBEL - fit.centre[0]).T) - fit.radius[0]
    assert gradient.sum() == pytest.approx(0, abs=1e-11)  # at the least-squares circle the distances add up to 0


@pytest.mark.parametrize("method", ["pratt", "taubin", "hyper"])
@pytest.mark.parametrize("points", [GANDER_GOLUB_STREBEL, 7 * GANDER_GOLUB_STREBEL @ [[0.6, 0.8], [-0.8, 0.6]] + 3])
def test_algebraic_fits_are_the_constrained_minima_of_their_papers(method, points):
    """Al-Sharadqah & Chernov (2009), Eqs for N of each method, in raw coordinates, by scipy's generalised eigensolver."""
    x, y = points.T
    z = x**2 + y**2
    rows = np.stack([z, x, y, np.ones(6)], axis=1)
    mx, my, mz = x.mean(), y.mean(), z.mean()
    constraint_taubin = np.array([[4 * mz, 2 * mx, 2 * my, 0], [2 * mx, 1, 0, 0], [2 * my, 0, 1, 0], [0, 0, 0, 0]])
    constraint_pratt = np.array([[0, 0, 0, -2], [0, 1, 0, 0], [0, 0, 1, 0], [-2, 0, 0, 0]])
    constraint = {
        "taubin": constraint_taubin,
        "pratt": constraint_pratt,
        "hyper": 2 * constraint_taubin - constraint_pratt,
    }[method]
    values, vectors = eig(rows.T @ rows / 6, constraint)
    usable = np.isfinite(values) & (values.real > 0)
    a, b, c, d = vectors[:, np.argmin(np.where(usable, values.real, np.inf))].real
    fit = one(points, method=method)
    np.testing.assert_allclose(fit.centre[0], (-b / (2 * a), -c / (2 * a)), rtol=1e-8)
    assert fit.radius[0] == pytest.approx(np.sqrt(b**2 + c**2 - 4 * a * d) / abs(2 * a), rel=1e-8)


def test_kasa_is_linear_least_squares():
    x, y = GANDER_GOLUB_STREBEL.T
    (b, c, d), *_ = np.linalg.lstsq(np.stack([x, y, np.ones(6)], axis=1), -(x**2 + y**2), rcond=None)
    fit = one(GANDER_GOLUB_STREBEL, method="kasa")
    np.testing.assert_allclose(fit.centre[0], (-b / 2, -c / 2))
    assert fit.radius[0] == pytest.approx(np.sqrt(b**2 / 4 + c**2 / 4 - d))


@pytest.mark.parametrize("method", FITS)
@pytest.mark.parametrize("angle_deg", [-350, -90, -5, 0.01, 1, 30, 180, 270, 359, 420, 700])
@pytest.mark.parametrize("turned_deg", [0, 77])
def test_exact_circles(method, angle_deg, turned_deg):
    fit = one(arc(angle_deg, turned_deg=turned_deg), method=method)
    kappa = np.deg2rad(angle_deg) / 800
    assert fit.curvature[0] == pytest.approx(kappa, abs=1e-14)
    assert fit.arc_span[0] == pytest.approx(800, rel=1e-11)
    np.testing.assert_allclose(fit.arc_positions[0], np.linspace(0, 800, 10), atol=1e-8)
    assert fit.radius[0] == pytest.approx(abs(1 / kappa), rel=1e-7)
    normal = np.deg2rad(turned_deg + 90)
    centre = np.array([200, 300]) + np.array([np.cos(normal), np.sin(normal)]) / kappa
    np.testing.assert_allclose(fit.centre[0], centre, atol=1e-7 / abs(kappa))
    assert fit.rms[0] < 1e-10
    assert fit.dof[0] == 7


@pytest.mark.parametrize("method", FITS)
@pytest.mark.parametrize("direction", [(1, 0), (0, 1), (-1, 0), (0, -1), (1, 1), (3, -1), (0.1, 0.7)])
@pytest.mark.parametrize("n", [3, 4, 10])
def test_exact_lines(method, direction, n):
    points = np.array([517.3, 71.1]) + 37.3 * np.arange(n)[:, None] * direction
    fit = one(points, method=method)
    length = np.hypot(*(points[-1] - points[0]))
    assert abs(fit.curvature[0] * length) < 1e-12
    assert fit.arc_span[0] == pytest.approx(length)
    assert np.isnan(fit.radius[0])
    assert np.isnan(fit.centre).all()
    assert fit.rms[0] < 1e-10
    assert np.isfinite(fit.curvature_sd_per_noise[0])


@pytest.mark.parametrize("method", FITS)
def test_three_points_give_their_circumcircle(method):
    fit = one([(0, 3), (4, 0), (0, 0)], method=method)
    np.testing.assert_allclose(fit.centre[0], (2, 1.5), atol=1e-12)
    assert fit.radius[0] == pytest.approx(2.5)
    assert fit.dof[0] == 0


@pytest.mark.parametrize("method", FITS)
@pytest.mark.parametrize(
    "points",
    [
        np.full((5, 2), 321.7),
        [(1, 2), (1, 2), (9, 4), (9, 4), (1, 2)],
        [(1, 2), (3, 4), (np.nan, 1), (np.inf, 2)],
        np.zeros((0, 2)),
    ],
    ids=["one place", "two places", "two points", "none"],
)
def test_fewer_than_three_places_give_nan(method, points):
    fit = one(points, method=method)
    for name in ("curvature", "curvature_sd_per_noise", "radius", "rms", "arc_span"):
        assert np.isnan(getattr(fit, name)).all(), name
    assert np.isnan(fit.residuals).all()
    assert fit.dof[0] == max(np.isfinite(points).all(axis=1).sum() - 3, 0)


def test_frames_do_not_see_each_other_and_bad_ones_stay_in_their_place():
    frames = np.stack([arc(20), np.full((10, 2), np.nan), arc(-60), arc(0)])
    fit = fit_circles(frames)
    np.testing.assert_allclose(np.rad2deg(fit.curvature * 800), [20, np.nan, -60, 0], atol=1e-9)
    np.testing.assert_array_equal(fit.dof, [7, 0, 7, 7])


def test_sign_is_positive_from_x_towards_y_and_residuals_are_positive_on_the_left():
    s = np.deg2rad([0, 20, 40, 60, 80])
    clockwise_in_a_picture = 100 * np.stack([np.sin(s), 1 - np.cos(s)], axis=-1)
    outwards = clockwise_in_a_picture.copy()
    outwards[2] += 0.5 * np.array([np.sin(s[2]), -np.cos(s[2])])
    forth, back = one(outwards, method="geometric"), one(outwards[::-1], method="geometric")
    assert forth.curvature[0] == pytest.approx(-back.curvature[0])
    assert forth.curvature[0] > 0
    assert forth.residuals[0, 2] > 0.2
    np.testing.assert_allclose(forth.residuals[0], -back.residuals[0, ::-1], atol=1e-9)


@pytest.mark.parametrize("method", FITS)
def test_unused_points_are_unused(method):
    points = arc(50) + np.random.default_rng(1).normal(size=(10, 2))
    used = np.ones(10, dtype=bool)
    used[[0, 4, 9]] = False
    spoiled = points.copy()
    spoiled[[0, 4, 9]] = [(1e6, -1e6), (np.nan, 5), (0, 0)]
    few, masked = one(points[used], method=method), one(spoiled, used=used[None], method=method)
    for name in ("curvature", "curvature_sd_per_noise", "centre", "radius", "rms", "dof", "arc_span"):
        np.testing.assert_allclose(getattr(masked, name), getattr(few, name), rtol=1e-9, err_msg=name)
    for name in ("residuals", "arc_positions", "leverage"):
        np.testing.assert_allclose(getattr(masked, name)[0, used], getattr(few, name)[0], atol=1e-9, err_msg=name)
        assert np.isnan(getattr(masked, name)[0, ~used]).all()


def test_a_nearly_straight_body_is_bent_too_much_by_kasa_only():
    """VISION.md: 10 points on an 800 px arc of 5°, 1 px noise."""
    rng = np.random.default_rng(7)
    frames = arc(5) + rng.normal(size=(20000, 10, 2))
    ratio = {m: fit_circles(frames, method=m).curvature.mean() * 800 / np.deg2rad(5) for m in FITS}
    assert ratio["kasa"] == pytest.approx(1.07, abs=0.01)
    for method in UNBIASED:
        assert ratio[method] == pytest.approx(1, abs=0.01), method


@pytest.mark.parametrize("method", UNBIASED)
@pytest.mark.parametrize("angle_deg", [0, 1, 30, 120, 270])
def test_curvature_sd_is_what_monte_carlo_finds(method, angle_deg):
    rng = np.random.default_rng(11)
    noise = 0.3
    frames = arc(angle_deg) + noise * rng.normal(size=(8000, 10, 2))
    fit = fit_circles(frames, method=method)
    exact = one(arc(angle_deg), method=method)
    assert fit.curvature.std() == pytest.approx(noise * exact.curvature_sd_per_noise[0], rel=0.03)
    assert np.median(fit.curvature_sd_per_noise) == pytest.approx(exact.curvature_sd_per_noise[0], rel=0.01)
    spread = fit.residuals.std(axis=0) / noise
    np.testing.assert_allclose(spread, np.sqrt(1 - exact.leverage[0]), rtol=0.04)


def test_leverages_add_up_to_the_three_parameters():
    np.testing.assert_allclose(np.nansum(one(arc(80)).leverage), 3)


@pytest.mark.parametrize("angle_deg", [0, 3, 90, 300])
@pytest.mark.parametrize("noise", [0.01, 20.0])
def test_geometric_agrees_with_a_general_least_squares_engine(angle_deg, noise):
    points = arc(angle_deg, turned_deg=20) + noise * np.random.default_rng(5).normal(size=(10, 2))
    fit = one(points, method="geometric")

    def distances(parameters):
        """Kåsa's quadric with unit gradient: regular on lines; x, y in units of 100 px about the middle."""
        kappa, turn, shift = parameters
        x, y = ((points - points.mean(axis=0)) / 100).T
        normal = x * np.cos(turn) + y * np.sin(turn) - shift
        along = y * np.cos(turn) - x * np.sin(turn)
        p = kappa / 2 * (normal**2 + along**2) + normal
        return 2 * p / (1 + np.sqrt(np.maximum(1 + 2 * kappa * p, 0)))

    starts = [(k, np.deg2rad(t), 0) for k in (-0.5, 0.5) for t in (0, 120, 240)]
    found = [least_squares(distances, start, xtol=1e-15, ftol=1e-15, gtol=1e-15) for start in starts]
    best = min(found, key=lambda f: f.cost)
    assert np.sqrt(2 * best.cost / 10) * 100 == pytest.approx(fit.rms[0], rel=1e-9)
    assert abs(best.x[0]) / 100 == pytest.approx(abs(fit.curvature[0]), rel=1e-6, abs=1e-9)


@settings(max_examples=60, deadline=None)
@given(
    angle_deg=st.floats(-330, 330),
    turn=st.floats(-np.pi, np.pi),
    size=st.floats(0.01, 100),
    shift=st.tuples(st.floats(-1000, 1000), st.floats(-1000, 1000)),
    seed=st.integers(0, 2**32 - 1),
    method=st.sampled_from(sorted(FITS)),
)
def test_fits_move_turn_and_grow_with_the_points(*, angle_deg, turn, size, shift, seed, method):
    points = arc(angle_deg) + np.random.default_rng(seed).normal(size=(10, 2))
    rotation = np.array([[np.cos(turn), -np.sin(turn)], [np.sin(turn), np.cos(turn)]])
    moved = size * (points @ rotation.T + shift)
    plain, other = one(points, method=method), one(moved, method=method)
    assert other.curvature[0] * size * 800 == pytest.approx(plain.curvature[0] * 800, abs=1e-7)
    assert other.arc_span[0] == pytest.approx(size * plain.arc_span[0], rel=1e-7)
    assert other.rms[0] == pytest.approx(size * plain.rms[0], rel=1e-6)
    assert other.curvature_sd_per_noise[0] * size**2 == pytest.approx(plain.curvature_sd_per_noise[0], rel=1e-6)
    mirrored = one(moved * (1, -1), method=method)
    assert mirrored.curvature[0] == pytest.approx(-other.curvature[0], rel=1e-6, abs=1e-9 / size)


def test_calls_that_cannot_work_are_refused():
    with pytest.raises(UsageError, match="kasa, pratt, taubin, hyper, geometric"):
        fit_circles(np.zeros((2, 5, 2)), method="ransac")
    with pytest.raises(UsageError, match=r"\(5, 2\)"):
        fit_circles(np.zeros((5, 2)))
    with pytest.raises(UsageError, match=r"\(2, 4\)"):
        fit_circles(np.zeros((2, 5, 2)), used=np.ones((2, 4), dtype=bool))
