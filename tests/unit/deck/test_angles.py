import numpy as np
import pytest

from benchlab.deck.angles import plane_rotation_rad


def test_rotation_is_found_beneath_shift_stretch_and_warping() -> None:
    rng = np.random.default_rng(3)
    x = rng.uniform(-6, 6, 40)
    x = np.concatenate([x, -x])
    warped = 0.2 * np.cos(x)  # even in x: no rotation
    before = np.column_stack([1.1 * x, warped])
    c, s = np.cos(-0.7), np.sin(-0.7)
    after = before @ np.array([[c, s], [-s, c]]) + [3.0, 40.0]
    moved = np.column_stack([after[:, 0] - x, np.zeros_like(x), after[:, 1]])
    assert plane_rotation_rad(x, moved) == pytest.approx(-0.7)
