"""Display matrices as FFmpeg lays them out, for all eight orientations."""

from __future__ import annotations

import numpy as np
import pytest

from benchlab.io.orientation import orientation

ONE = 1 << 16


@pytest.mark.parametrize(
    ("a", "b", "c", "d", "expected"),
    [
        (1, 0, 0, 1, (0, False)),
        (0, 1, -1, 0, (90, False)),
        (-1, 0, 0, -1, (180, False)),
        (0, -1, 1, 0, (270, False)),
        (-1, 0, 0, 1, (0, True)),
        (1, 0, 0, -1, (180, True)),
        (0, 1, 1, 0, (270, True)),
        (0, -1, -1, 0, (90, True)),
    ],
)
def test_eight_orientations(a: int, b: int, c: int, d: int, expected: tuple[int, bool]) -> None:
    """Row vectors: x' = a x + c y, y' = b x + d y (ISO/IEC 14496-12)."""
    matrix = np.array([a * ONE, b * ONE, 0, c * ONE, d * ONE, 0, 0, 0, 1 << 30], np.int32)
    assert orientation(matrix) == expected


def test_oblique_and_singular() -> None:
    half = int(0.7071 * ONE)
    assert orientation(np.array([half, half, 0, -half, half, 0, 0, 0, 1 << 30], np.int32)) is None
    assert orientation(np.array([ONE, 0, 0, ONE, 0, 0, 0, 0, 1 << 30], np.int32)) is None
    assert orientation(np.zeros(9, np.int32)) == (0, False)
