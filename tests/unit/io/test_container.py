"""What a file is by its bytes."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest

from benchlab.io.container import film_format, missing_bytes, mp4_boxes, read_head

Clip = Callable[..., Path]


@pytest.mark.parametrize(
    ("name", "codec", "form"),
    [
        ("a.mp4", "libx264", "mov"),
        ("a.mov", "libx264", "mov"),
        ("a.mkv", "libx264", "matroska"),
        ("a.webm", "libvpx", "matroska"),
        ("a.avi", "mpeg4", "avi"),
        ("a.ts", "libx264", "mpegts"),
        ("a.flv", "flv", "flv"),
        ("a.mpg", "mpeg2video", "mpeg"),
        ("a.h264", "libx264", None),
    ],
)
def test_film_format(make_clip: Clip, name: str, codec: str, form: str | None) -> None:
    assert film_format(read_head(make_clip(name, codec=codec, frames=3))) == form


@pytest.mark.parametrize(("name", "codec"), [("a.mp4", "libx264"), ("a.mkv", "libx264"), ("a.avi", "mpeg4")])
def test_missing_bytes(make_clip: Clip, tmp_path: Path, name: str, codec: str) -> None:
    """Exactly as many as were cut off, none in a whole file."""
    options = {"movflags": "faststart"} if name == "a.mp4" else {}
    clip = make_clip(name, codec=codec, frames=10, container_options=options)
    data = clip.read_bytes()
    assert missing_bytes(clip, read_head(clip)) == 0
    for lost in (1, 1000):
        path = tmp_path / f"cut{lost}"
        path.write_bytes(data[:-lost])
        assert missing_bytes(path, read_head(path)) == lost


def test_live_matroska_has_no_size(make_clip: Clip) -> None:
    clip = make_clip("a.mkv", frames=10, container_options={"live": "1"})
    assert missing_bytes(clip, read_head(clip)) == 0


def test_boxes(make_clip: Clip, tmp_path: Path) -> None:
    boxes, missing = mp4_boxes(make_clip("a.mp4", frames=2))
    assert boxes[0] == b"ftyp"
    assert {b"mdat", b"moov"} <= set(boxes)
    assert missing == 0
    other = tmp_path / "other"
    other.write_bytes(b"\x00\x00\x00\x08none" * 3)
    assert mp4_boxes(other) == ([], 0)
