"""Frozen cameras, light steps and knocks, drawn."""

import numpy as np

from benchlab.vision.steadiness import Steadiness, find_shakes


def pictures(n: int) -> list[np.ndarray]:
    rng = np.random.default_rng(0)
    return [rng.integers(90, 110, (180, 320)).astype(np.uint8) for _ in range(n)]


def warned(frames: list[np.ndarray], fps: float = 30) -> list[str]:
    steadiness = Steadiness()
    for i, frame in enumerate(frames):
        steadiness.look(frame, i / fps)
    return steadiness.warnings()


def test_a_live_camera_gives_no_warning() -> None:
    assert warned(pictures(90)) == []


def test_frozen_frames_are_told_with_their_time() -> None:
    frames = pictures(120)
    frames[20:100] = [frames[20]] * 80
    (text,) = warned(frames)
    assert "identical for 2.6 s from 0.67 s" in text


def test_a_light_step_is_told() -> None:
    frames = pictures(60)
    frames[30:] = [f + np.uint8(40) for f in frames[30:]]
    (text,) = warned(frames)
    assert "jumps 1 times, first at 1.00 s" in text


def test_a_knock_moves_all_markers_at_once() -> None:
    time = np.arange(60) / 30
    xy = np.stack([np.linspace(0, 900, 10), np.zeros(10)], axis=1)[None] + np.zeros((60, 1, 1))
    xy[:, :, 1] += np.linspace(0, 1, 10) * 200 * time[:, None]
    xy[40] += 6.0
    shakes = find_shakes(xy, time)
    assert shakes.min() >= time[39] and shakes.max() <= time[41]
    assert len(find_shakes(xy[:39], time[:39])) == 0
