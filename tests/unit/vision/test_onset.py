"""Onsets of drawn rises."""

import numpy as np
import pytest

from benchlab.errors import InputError
from benchlab.vision.onset import find_onset

TIME = np.arange(0, 4, 1 / 60)


@pytest.mark.parametrize("start", [0.25, 0.5, 1.2])
@pytest.mark.parametrize("sign", [1, -1])
def test_a_noisy_ramp_starts_where_it_was_drawn(start: float, sign: int) -> None:
    rng = np.random.default_rng(3)
    rise = sign * 120 * np.clip((TIME - start) / 2.5, 0, 1) + rng.normal(0, 0.1, len(TIME)) + 4
    assert find_onset(TIME, rise) == pytest.approx(start, abs=0.03)


def test_motion_from_the_first_frame_and_missing_values() -> None:
    rise = 100 * TIME / 4
    rise[10:14] = np.nan
    assert find_onset(TIME, rise) == pytest.approx(0, abs=0.03)


def test_nothing_moves() -> None:
    with pytest.raises(InputError, match="nothing moves"):
        find_onset(TIME, np.full(len(TIME), 3.0))
    with pytest.raises(InputError, match="too few"):
        find_onset(TIME[:3], TIME[:3])
