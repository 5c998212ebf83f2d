"""Rows of spots moving in known ways: hidden, swapped with clutter, merged, jumping."""

import numpy as np
import pytest

from benchlab.vision.linking import link
from benchlab.vision.markers import CANDIDATE


def row(angle_deg: float, n: int = 10, length: float = 900.0) -> np.ndarray:
    along = np.linspace(0, length, n)
    kappa = np.radians(max(angle_deg, 1e-6)) / length
    return np.stack([300 + np.sin(kappa * along) / kappa, 200 + (1 - np.cos(kappa * along)) / kappa], axis=1)


def spots(xy: np.ndarray, area: float | np.ndarray = 250.0) -> np.ndarray:
    table = np.zeros(len(xy), CANDIDATE)
    table["xy"], table["area_px2"], table["sd_px"], table["hue_rad"] = xy, area, 0.05, 1.8
    table["contrast"], table["roundness"], table["isolation"] = 100, 0.95, 0.95
    return table


ANGLES = np.linspace(0, 150, 120)


def shuffled(frame: np.ndarray, seed: int) -> np.ndarray:
    return frame[np.random.default_rng(seed).permutation(len(frame))]


def test_identity_is_kept_whatever_the_order_of_candidates() -> None:
    tracks = link([shuffled(spots(row(a)), t) for t, a in enumerate(ANGLES)])
    assert np.allclose(tracks.xy, np.array([row(a) for a in ANGLES]))
    assert set(tracks.reason) == {""}


def test_hidden_markers_are_left_out_and_come_back_as_themselves() -> None:
    truth = np.array([row(a) for a in ANGLES])
    frames = []
    for t, xy in enumerate(truth):
        hidden = [3, 4, 9] if 30 <= t < 80 else []
        frames.append(shuffled(np.delete(spots(xy), hidden), t))
    tracks = link(frames)
    assert np.isnan(tracks.xy[30:80, [3, 4, 9]]).all()
    seen = np.isfinite(tracks.xy[..., 0])
    assert seen.sum() == 120 * 10 - 50 * 3
    assert np.allclose(tracks.xy[seen], truth[seen])
    assert tracks.reason[50] == "markers left out"


def test_clutter_that_crosses_is_not_taken_for_a_hidden_marker() -> None:
    truth = np.array([row(a) for a in ANGLES])
    frames = []
    for t, xy in enumerate(truth):
        intruder = xy[5] + (t - 60) * np.array([9.0, -6.0])  # passes exactly over marker 5 in frame 60
        apart = np.hypot(*(intruder - xy[5])) > 25
        frames.append(
            spots(np.concatenate([np.delete(xy, [] if apart else [5], axis=0), intruder[None] + 4 * (not apart)]))
        )
    tracks = link(frames)
    error = np.hypot(*np.moveaxis(tracks.xy - truth, -1, 0))
    assert np.nanmax(np.where(np.arange(10) == 5, np.nan, error)) < 1e-9
    assert np.nanmax(error[:50]) < 1e-9 and np.nanmax(error[70:]) < 1e-9
    assert np.nanmax(error[:, 5]) < 30


def test_partly_covered_and_merged_spots_are_left_out() -> None:
    frames = [spots(row(a)) for a in ANGLES]
    frames[60]["area_px2"][4] *= 0.85
    frames[61]["area_px2"][6] *= 1.4
    tracks = link(frames)
    gone = np.argwhere(np.isnan(tracks.xy[..., 0]))
    assert gone.tolist() == [[60, 4], [61, 6]]


def test_damaged_and_empty_frames_say_so() -> None:
    frames: list = [spots(row(a)) for a in ANGLES]
    frames[10] = None
    frames[20] = spots(np.zeros((0, 2)))
    tracks = link(frames)
    assert (tracks.reason[10], tracks.reason[20]) == ("damaged", "no markers")
    assert np.isfinite(tracks.xy[21]).all()


def test_stills_may_jump() -> None:
    tracks = link(
        [shuffled(spots(np.add(row(a, 5), (40 * i, -30 * i))), i) for i, a in enumerate((0, 60, 120, 180, 240))],
        stills=True,
    )
    assert np.isfinite(tracks.xy).all()
    assert np.allclose(tracks.xy[4], np.add(row(240, 5), (160, -120)))


def test_the_end_that_moves_less_comes_first() -> None:
    tracks = link([spots(row(a)[::-1]) for a in ANGLES])
    assert np.allclose(tracks.xy[:, 0], (300, 200))


@pytest.mark.parametrize("frames", [[spots(np.zeros((0, 2)))] * 3, [spots(np.array([[10.0, 10], [400, 30]]))] * 3])
def test_no_row_no_tracks(frames: list) -> None:
    tracks = link(frames)
    assert tracks.xy.shape == (3, 0, 2)
    assert set(tracks.reason) == {"no markers"}


def test_a_second_row_is_told_and_a_few_stray_spots_are_not() -> None:
    two = [spots(np.concatenate([row(a), np.add(row(a, 9), (0, 450))])) for a in ANGLES]
    assert link(two).rival == 9
    stray = np.array([[1500.0, 900], [200, 950], [1700, 100]])
    assert link([spots(np.concatenate([row(a), stray])) for a in ANGLES]).rival == 0
