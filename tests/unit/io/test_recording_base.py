"""From stored pixels to displayed ones, against the picture itself turned by numpy."""

from __future__ import annotations

from fractions import Fraction
from pathlib import Path

import numpy as np
import pytest

from benchlab.io.planes import display_bgr
from benchlab.io.recording_base import RecordingInfo, displayed_size
from benchlab.vision.picture import Planes


def facts(rotation_deg: int, mirrored: bool, aspect: Fraction = Fraction(1)) -> RecordingInfo:
    width, height = displayed_size(12, 8, aspect, rotation_deg)
    return RecordingInfo(
        path=Path("a.mp4"), kind="video", width=width, height=height, stored_width=12, stored_height=8, codec="h264",
        pixel_format="yuv444p", frame_count=None, duration_s=None, rotation_deg=rotation_deg, sample_aspect=aspect,
        full_range=True, matrix="bt601", mirrored=mirrored,
    )  # fmt: skip


@pytest.mark.parametrize("mirrored", [False, True])
@pytest.mark.parametrize("rotation_deg", [0, 90, 180, 270])
def test_coordinates_follow_the_displayed_picture(rotation_deg: int, mirrored: bool) -> None:
    """One bright pixel: where it is in the displayed picture is where its coordinates are sent."""
    info = facts(rotation_deg, mirrored)
    gray = np.full((8, 12), 128, np.uint8)
    for x, y in [(0, 0), (11, 0), (0, 7), (3, 5)]:
        luma = np.zeros((8, 12), np.uint8)
        luma[y, x] = 255
        picture = display_bgr(Planes(luma, gray, gray, (1, 1), (0.0, 0.0), True, "bt601"), info)
        assert picture.shape == (info.height, info.width, 3)
        row, column = np.argwhere(picture[..., 0] > 200)[0]
        shown = info.to_display(np.array([float(x), float(y)]))
        assert np.allclose(shown, [column, row])
        assert np.allclose(info.from_display(shown), [x, y])


def test_clockwise_quarter_turn() -> None:
    """The stored top-left corner is shown at the top right after a clockwise quarter turn."""
    info = facts(90, False)
    assert info.to_display(np.array([[0.0, 0.0], [11.0, 7.0]])).tolist() == [[7.0, 0.0], [0.0, 11.0]]


def test_mirror_comes_before_the_turn() -> None:
    """EXIF orientation 7: mirrored left to right, then turned clockwise, is a transpose about the other diagonal."""
    info = facts(90, True)
    assert info.to_display(np.array([0.0, 0.0])).tolist() == [7.0, 11.0]
    assert info.to_display(np.array([11.0, 7.0])).tolist() == [0.0, 0.0]


@pytest.mark.parametrize("aspect", [Fraction(2), Fraction(4, 3), Fraction(8, 9)])
def test_sample_aspect_stretches_x_about_pixel_edges(aspect: Fraction) -> None:
    info = facts(0, False, aspect)
    shown = info.to_display(np.array([[-0.5, -0.5], [11.5, 7.5]]))
    assert np.allclose(shown, [[-0.5, -0.5], [12 * float(aspect) - 0.5, 7.5]])
    assert info.width == round(12 * aspect)


@pytest.mark.parametrize("rotation_deg", [0, 90, 180, 270])
def test_a_circle_is_round_when_displayed(rotation_deg: int) -> None:
    info = facts(rotation_deg, True, Fraction(2))
    angle = np.linspace(0, 6, 50)
    stored = np.column_stack([5 + 2 * np.cos(angle), 4 + 4 * np.sin(angle)])
    shown = info.to_display(stored)
    centre = info.to_display(np.array([5.0, 4.0]))
    assert np.allclose(np.hypot(*(shown - centre).T), 4)
    assert np.allclose(info.from_display(shown), stored)
