"""Curvature, angle and their uncertainty from tracks whose truth is drawn: Monte Carlo is the judge of the error bars."""

import numpy as np
import pytest

from benchlab.vision.curvature import Body, measure_curvature, track_jitter
from benchlab.vision.linking import Tracks
from benchlab.vision.scale import scale_given

LENGTH_PX, LENGTH_MM, N = 900.0, 180.0, 10
GIVEN = Body(LENGTH_MM, scale=scale_given(LENGTH_MM / LENGTH_PX))


def arcs(angle_deg: np.ndarray, n: int = N) -> np.ndarray:
    """(T, n, 2) points along arcs of the given bending angles, length LENGTH_PX."""
    along = np.linspace(0, LENGTH_PX, n)
    kappa = np.radians(np.where(angle_deg == 0, 1e-12, angle_deg))[:, None] / LENGTH_PX
    return np.stack([300 + np.sin(kappa * along) / kappa, 200 + 2 * np.sin(kappa * along / 2) ** 2 / kappa], axis=2)


def tracks(xy: np.ndarray) -> Tracks:
    return Tracks(xy, np.full(xy.shape[:2], 0.05), ("",) * len(xy))


def series(xy: np.ndarray, body: Body = GIVEN, **options: object):
    return measure_curvature(tracks(xy), np.arange(len(xy)) / 60, body, **options)  # type: ignore[arg-type]


def test_exact_arcs_give_exact_angles_with_and_without_a_scale() -> None:
    angle = np.linspace(0, 300, 61)
    for body in (GIVEN, Body(LENGTH_MM), Body(LENGTH_MM, span_mm=LENGTH_MM)):
        found, scale = series(arcs(angle), body)
        assert np.degrees(found.angle_rad) == pytest.approx(angle, abs=1e-6)
        assert scale.mm_per_px == pytest.approx(0.2, rel=1e-9)
        assert found.radius_mm[-1] == pytest.approx(LENGTH_MM / np.radians(300))
        assert set(found.flag) == {""}
    assert found.curvature_per_mm[0] == pytest.approx(0, abs=1e-12)
    assert np.isnan(found.radius_mm[0])


@pytest.mark.parametrize("angle_deg", [0.0, 2.0, 60.0, 180.0, 300.0])
@pytest.mark.parametrize("n", [4, 5, 10])
@pytest.mark.parametrize("given", [True, False])
def test_two_sd_cover_as_many_errors_as_they_should(angle_deg: float, n: int, given: bool) -> None:
    rng = np.random.default_rng(int(angle_deg) + n)
    frames, noise = 3000, 0.3
    xy = arcs(np.full(frames, angle_deg), n) + rng.normal(0, noise, (frames, n, 2))
    found, _ = series(xy, GIVEN if given else Body(LENGTH_MM))
    error = np.degrees(np.abs(found.angle_rad)) - angle_deg if angle_deg else np.degrees(found.angle_rad)
    sd = np.degrees(found.angle_sd_rad)
    covered = np.mean(np.abs(error) <= 2 * sd)
    assert 0.94 <= covered <= 0.97  # a normal error lies within 2 sd in 95.4 % of all cases
    assert np.median(sd) == pytest.approx(error.std(), rel=0.08)
    assert np.median(found.centroid_sd_px) == pytest.approx(noise, rel=0.05)


def test_a_short_recording_pools_all_its_frames() -> None:
    xy = arcs(np.linspace(20, 60, 10))
    xy[:5] += np.random.default_rng(6).normal(0, 0.2, (5, N, 2))
    noise = series(xy)[0].centroid_sd_px
    assert np.ptp(noise) == pytest.approx(0, abs=1e-12) and noise[0] == pytest.approx(0.2 / np.sqrt(2), rel=0.3)


def test_three_markers_take_their_noise_from_the_jitter_in_time() -> None:
    rng = np.random.default_rng(1)
    xy = arcs(np.linspace(20, 80, 2000), 3) + rng.normal(0, 0.2, (2000, 3, 2))
    found, _ = series(xy)
    error = np.degrees(found.angle_rad) - np.linspace(20, 80, 2000)
    assert 0.93 <= np.mean(np.abs(error) <= 2 * np.degrees(found.angle_sd_rad)) <= 0.975


def test_jitter_sees_noise_and_not_motion() -> None:
    rng = np.random.default_rng(2)
    xy = arcs(60 * (1 - np.cos(np.linspace(0, 20, 1500)))) + rng.normal(0, 0.07, (1500, N, 2))
    assert track_jitter(tracks(xy)) == pytest.approx(0.07, rel=0.05)
    assert np.isnan(track_jitter(tracks(xy[:5])))


def test_the_sign_follows_the_largest_bend_and_flips() -> None:
    angle = np.linspace(-10, 90, 50)
    for mirrored in (1, -1):
        xy = arcs(angle) * (1, mirrored)
        assert np.degrees(series(xy)[0].angle_rad) == pytest.approx(angle, abs=1e-6)
        assert np.degrees(series(xy, flip=True)[0].angle_rad) == pytest.approx(-angle, abs=1e-6)


def test_one_outlying_marker_is_left_out_and_flagged() -> None:
    rng = np.random.default_rng(3)
    xy = arcs(np.full(100, 70.0)) + rng.normal(0, 0.05, (100, N, 2))
    xy[40, 6] += (8, -5)
    found, _ = series(xy)
    assert not found.used[40, 6] and found.used[40].sum() == N - 1
    assert "outlier left out" in found.flag[40] and found.flag[39] == ""
    assert np.degrees(found.angle_rad[40]) == pytest.approx(70, abs=0.2)


def test_a_body_of_varying_curvature_is_flagged_and_keeps_its_markers() -> None:
    share = np.linspace(0, 1, N)
    heading = np.radians(100) * share**2
    steps = np.stack([np.cos(heading), np.sin(heading)], axis=1) * LENGTH_PX / (N - 1)
    xy = np.cumsum(steps, axis=0)[None] + np.random.default_rng(4).normal(0, 0.05, (80, N, 2))
    found, _ = series(xy)
    assert all("not constant curvature" in flag for flag in found.flag)
    assert found.used.all()


def test_frames_without_enough_markers_are_empty_with_a_reason() -> None:
    xy = arcs(np.full(20, 50.0))
    xy[5, 2:] = np.nan
    reasons = [""] * 20
    reasons[5] = "markers left out"
    xy[6], reasons[6] = np.nan, "damaged"
    found, _ = measure_curvature(Tracks(xy, np.full((20, N), 0.05), tuple(reasons)), np.arange(20) / 30, GIVEN)
    assert np.isnan(found.angle_rad[5:7]).all() and np.isfinite(np.delete(found.angle_rad, [5, 6])).all()
    assert found.flag[5:7] == ("fewer than 3 markers", "damaged")
