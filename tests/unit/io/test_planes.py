"""Planes, their description, and colours against the closed forms of BT.601, BT.709 and BT.2020."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import av
import numpy as np
import pytest

from benchlab.errors import InputError
from benchlab.io.film import Film
from benchlab.io.planes import (
    BY_STEP,
    SITING,
    ColourTags,
    PlaneReader,
    bgr_transform,
    plane_view,
    planes_to_bgr,
    read_tags,
)
from benchlab.vision.picture import Planes

FILE = Path("a.mp4")
WEIGHTS = {"bt601": (0.299, 0.114), "bt709": (0.2126, 0.0722), "bt2020": (0.2627, 0.0593)}


def frame_of(pixel_format: str, size: tuple[int, int] = (64, 48), colorspace: int = 2, color_range: int = 0) -> Any:
    picture = np.random.default_rng(0).integers(0, 256, (size[1], size[0], 3), dtype=np.uint8)
    frame = av.VideoFrame.from_ndarray(picture, format="rgb24")
    if pixel_format != "rgb24":
        frame = frame.reformat(format=pixel_format)
        frame.colorspace, frame.color_range = colorspace, color_range
    return frame


def ycbcr(rgb: np.ndarray, matrix: str, full_range: bool) -> np.ndarray:
    """(..., 3) Y', Cb, Cr of R'G'B' 0–255, written from the definitions."""
    k_r, k_b = WEIGHTS[matrix]
    r, g, b = (rgb[..., i] / 255 for i in range(3))
    y = k_r * r + (1 - k_r - k_b) * g + k_b * b
    cb, cr = (b - y) / (2 * (1 - k_b)), (r - y) / (2 * (1 - k_r))
    if full_range:
        return np.stack([255 * y, 255 * cb + 128, 255 * cr + 128], axis=-1)
    return np.stack([219 * y + 16, 224 * cb + 128, 224 * cr + 128], axis=-1)


@pytest.mark.parametrize("full_range", [False, True])
@pytest.mark.parametrize("matrix", WEIGHTS)
def test_back_to_bgr(matrix: str, full_range: bool) -> None:
    rgb = np.random.default_rng(1).uniform(0, 255, (500, 3))
    planes = ycbcr(rgb, matrix, full_range)
    back = np.column_stack([planes, np.ones(500)]) @ bgr_transform(matrix, full_range).T
    assert np.allclose(back[:, ::-1], rgb)


def test_rgb_becomes_full_range_bt601_to_the_nearest_level() -> None:
    frame = frame_of("rgb24")
    tags = read_tags(frame, "left", FILE)
    planes = PlaneReader(tags)(frame)
    assert (planes.full_range, planes.matrix, planes.chroma_step, planes.chroma_offset) == (
        True,
        "bt601",
        (1, 1),
        (0, 0),
    )
    truth = ycbcr(frame.to_ndarray().astype(float), "bt601", True)
    assert np.abs(planes.luma - truth[..., 0]).max() < 1
    assert np.abs(planes.cb - truth[..., 1]).max() < 1.5
    assert np.abs(planes.cr - truth[..., 2]).max() < 1.5


@pytest.mark.parametrize(
    ("pixel_format", "step"),
    [
        ("yuv420p", (2, 2)),
        ("yuvj420p", (2, 2)),
        ("yuv422p", (2, 1)),
        ("yuv444p", (1, 1)),
        ("nv12", (2, 2)),
        ("yuv420p10le", (2, 2)),
        ("yuv422p10le", (2, 1)),
        ("yuv444p12le", (1, 1)),
        ("yuv411p", (1, 1)),
        ("yuyv422", (2, 1)),
        ("yuva420p", (2, 2)),
    ],
)
def test_formats(pixel_format: str, step: tuple[int, int]) -> None:
    """Whatever the format, planes have the size that their step says, and the range and matrix are kept."""
    frame = frame_of(pixel_format, (65, 49) if pixel_format != "yuyv422" else (64, 48), colorspace=1)
    planes = PlaneReader(read_tags(frame, "left", FILE))(frame)
    assert planes.chroma_step == step
    assert planes.luma.shape == (frame.height, frame.width)
    assert planes.cb.shape == planes.cr.shape == (-(-frame.height // step[1]), -(-frame.width // step[0]))
    assert (planes.matrix, planes.full_range) == ("bt709", pixel_format == "yuvj420p")
    assert planes.luma.std() > 20


@pytest.mark.parametrize("full", [False, True])
def test_ten_bits_keep_their_levels(full: bool) -> None:
    """A 10-bit level 4n becomes n, in limited and in full range alike."""
    frame = av.VideoFrame(64, 48, "yuv420p10le")
    for plane, level in zip(frame.planes, (400, 600, 300), strict=True):
        np.frombuffer(plane, np.uint16)[:] = level
    frame.color_range, frame.colorspace = (2 if full else 1), 1
    planes = PlaneReader(read_tags(frame, "left", FILE))(frame)
    for values, level in ((planes.luma, 100), (planes.cb, 150), (planes.cr, 75)):
        assert np.abs(values.astype(int) - level).max() <= 1


class StoredPlane(bytes):
    """As PyAV's plane: its memory from the lowest address on, the size of the picture, bytes from row to row."""

    width, height, line_size = 3, 2, 4


def test_padding_is_cropped_and_rows_that_run_upwards_are_turned() -> None:
    memory: Any = StoredPlane(bytes([1, 2, 3, 99, 4, 5, 6, 99]))
    assert plane_view(memory).tolist() == [[1, 2, 3], [4, 5, 6]]
    memory.line_size = -4
    assert plane_view(memory).tolist() == [[4, 5, 6], [1, 2, 3]]


@pytest.mark.parametrize(
    ("size", "colorspace", "color_range", "expected"),
    [
        ((1280, 720), 2, 0, ("bt709", False)),
        ((720, 1280), 2, 0, ("bt709", False)),
        ((720, 576), 2, 0, ("bt601", False)),
        ((64, 48), 1, 0, ("bt709", False)),
        ((1280, 720), 5, 2, ("bt601", True)),
        ((1280, 720), 6, 1, ("bt601", False)),
        ((1280, 720), 9, 1, ("bt2020", False)),
    ],
)
def test_tags_and_defaults(
    size: tuple[int, int], colorspace: int, color_range: int, expected: tuple[str, bool]
) -> None:
    tags = read_tags(frame_of("yuv420p", size, colorspace, color_range), "left", FILE)
    assert (tags.matrix, tags.full_range) == expected


def test_untagged_stills_are_full_range_bt601() -> None:
    tags = read_tags(frame_of("yuv420p", (1280, 720)), "center", FILE, still=True)
    assert tags == ColourTags(True, "bt601", "center")


def test_unknown_matrix_is_refused() -> None:
    with pytest.raises(InputError, match="colour matrix 8 is none of"):
        read_tags(frame_of("yuv420p", colorspace=8), "left", FILE)


@pytest.mark.parametrize("pixel_format", ["gray", "gray16le", "ya8", "monow"])
def test_gray_is_refused(pixel_format: str) -> None:
    with pytest.raises(InputError, match="no colour"):
        read_tags(av.VideoFrame(64, 48, pixel_format), "left", FILE)


@pytest.mark.parametrize(("siting", "offset"), SITING.items())
def test_siting_of_420(siting: str, offset: tuple[float, float]) -> None:
    frame = frame_of("yuv420p", colorspace=1)
    assert PlaneReader(read_tags(frame, siting, FILE))(frame).chroma_offset == offset
    frame = frame_of("yuv422p", colorspace=1)
    assert PlaneReader(read_tags(frame, siting, FILE))(frame).chroma_offset == (offset[0], 0.0)


@pytest.mark.parametrize(
    ("codec", "form", "options", "offset"),
    [
        ("libx264", "yuv420p", {}, (0.0, 0.5)),
        ("libx264", "yuv420p", {"x264-params": "chromaloc=1"}, (0.5, 0.5)),
        ("libx264", "yuv420p", {"x264-params": "chromaloc=2"}, (0.0, 0.0)),
        ("mjpeg", "yuvj420p", {}, (0.5, 0.5)),
    ],
)
def test_siting_is_read_from_the_stream(
    make_clip: Callable[..., Path], codec: str, form: str, options: dict[str, str], offset: tuple[float, float]
) -> None:
    with Film(make_clip("a.mov", codec=codec, pixel_format=form, options=options, frames=1)) as film:
        planes = next(iter(film)).planes
        assert planes is not None
        assert planes.chroma_offset == offset


@pytest.mark.parametrize("step", BY_STEP)
@pytest.mark.parametrize("siting", ["left", "center"])
def test_chroma_is_interpolated_from_where_it_sits(step: tuple[int, int], siting: str) -> None:
    """A colour ramp along x and y is linear, so that interpolation from the right places gives it back exactly."""
    x0, y0 = SITING[siting]
    x0, y0 = (x0 if step[0] == 2 else 0.0), (y0 if step[1] == 2 else 0.0)
    height, width = 40, 60
    columns, rows = np.meshgrid(np.arange(width // step[0]) * step[0] + x0, np.arange(height // step[1]) * step[1] + y0)
    cr = np.rint(96 + 0.5 * (columns - x0) + 0.5 * (rows - y0)).astype(np.uint8)
    luma, cb = np.full((height, width), 128, np.uint8), np.full_like(cr, 128)
    picture = planes_to_bgr(Planes(luma, cb, cr, step, (x0, y0), True, "bt601"))
    x, y = np.meshgrid(np.arange(width), np.arange(height))
    truth = 128 + 1.402 * (96 + 0.5 * (x - x0) + 0.5 * (y - y0) - 128)
    inner = (slice(2, -2), slice(2, -2))
    assert np.abs(picture[..., 2].astype(float) - truth)[inner].mean() < 0.7
    assert abs((picture[..., 2].astype(float) - truth)[inner].mean()) < 0.15
