"""Sizes and orientations against files that OpenCV wrote, and bytes that lead nowhere."""

from __future__ import annotations

from pathlib import Path

import cv2
import numpy as np
import pytest

from benchlab.io.picture_header import picture_orientation, picture_size


@pytest.mark.parametrize("suffix", ["png", "jpg", "tif"])
@pytest.mark.parametrize("size", [(1, 1), (300, 7), (17, 513)])
def test_size(tmp_path: Path, suffix: str, size: tuple[int, int]) -> None:
    path = tmp_path / f"a.{suffix}"
    cv2.imwrite(str(path), np.zeros((size[1], size[0], 3), np.uint8))
    assert picture_size(path.read_bytes()) == size
    assert picture_orientation(path.read_bytes()) == (0, False)


@pytest.mark.parametrize("start", [b"\xff\xd8\xff", b"\x89PNG\r\n\x1a\n", b"II*\x00", b"MM\x00*", b"other", b""])
def test_random_bytes_end(start: bytes) -> None:
    """Whatever follows a magic number, an answer comes, and no exception."""
    rng = np.random.default_rng(5)
    for length in (0, 1, 5, 20, 3000):
        for _ in range(30):
            data = start + rng.bytes(length)
            size = picture_size(data)
            assert size is None or len(size) == 2
            assert picture_orientation(data)[0] in {0, 90, 180, 270}
