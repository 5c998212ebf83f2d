"""Films written and read back."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest

from benchlab.errors import InputError
from benchlab.io.planes import planes_to_bgr
from benchlab.io.recording import open_recording
from benchlab.io.video_writer import VideoWriter
from benchlab.vision.picture import Planes

COLOURS = np.array([[30, 40, 200], [200, 60, 40], [60, 190, 60], [128, 128, 128]], np.uint8)  # BGR


def patches() -> np.ndarray:
    """(64, 96, 3) BGR: four large patches."""
    return COLOURS[np.arange(4)].reshape(2, 2, 3).repeat(32, axis=0).repeat(48, axis=1)


@pytest.mark.parametrize(
    ("name", "options"),
    [
        ("a.mp4", {"crf": 10}),
        ("a.mp4", {"crf": 10, "full_range": True, "matrix": "bt601"}),
        ("a.mp4", {"codec": "libx265", "crf": 10, "options": {"x265-params": "log-level=none"}}),
        ("a.mkv", {"codec": "ffv1", "matrix": "bt2020"}),
        ("a.webm", {"codec": "libvpx-vp9", "crf": 10, "bitrate_bps": 2_000_000}),
        ("a.mp4", {"codec": "libsvtav1", "crf": 15}),
        ("a.avi", {"codec": "mjpeg", "pixel_format": "yuvj420p", "matrix": "bt601", "options": {"qmax": "2"}}),
    ],
)
def test_colours_and_tags_come_back(tmp_path: Path, name: str, options: dict[str, Any]) -> None:
    with VideoWriter(tmp_path / name, 96, 64, fps=25, **options) as writer:
        for _ in range(3):
            writer.write(patches())
    with open_recording(tmp_path / name) as film:
        frames = list(film)
        assert film.info.full_range == (options.get("full_range", False) or "j" in options.get("pixel_format", ""))
        assert film.info.matrix == options.get("matrix", "bt709")
        with open_recording(tmp_path / name) as again:
            planes = next(iter(again)).planes
            assert planes is not None
            shown = planes_to_bgr(planes)
    assert [f.time_s for f in frames] == pytest.approx([0, 0.04, 0.08], abs=1e-3)
    for row, column in ((16, 24), (16, 72), (48, 24), (48, 72)):
        assert np.abs(shown[row, column].astype(int) - patches()[row, column]).max() <= 6


def test_times_of_their_own(tmp_path: Path) -> None:
    stamps = [0.0, 0.02, 0.1, 0.75]
    with VideoWriter(tmp_path / "a.mp4", 96, 64, preset="ultrafast") as writer:
        for stamp in stamps:
            writer.write(patches(), stamp)
    with open_recording(tmp_path / "a.mp4") as film:
        assert [f.time_s for f in film] == pytest.approx(stamps, abs=1e-4)


def test_planes_are_stored_as_they_are(tmp_path: Path) -> None:
    """Lossless: what is written is read, level by level; views with a stride are taken as well."""
    rng = np.random.default_rng(2)
    wide = rng.integers(16, 236, (64, 128), dtype=np.uint8)
    planes = Planes(wide[:, :96], rng.integers(16, 241, (32, 48), dtype=np.uint8), wide[:32, 5:53], full_range=False)
    with VideoWriter(tmp_path / "a.mkv", 96, 64, codec="ffv1") as writer:
        writer.write(planes)
    with open_recording(tmp_path / "a.mkv") as film:
        back = next(iter(film)).planes
        assert back is not None
        for name in ("luma", "cb", "cr"):
            assert np.array_equal(getattr(back, name), getattr(planes, name))


def test_sizes_are_checked(tmp_path: Path) -> None:
    with pytest.raises(InputError, match="97×64 has an odd side; 4:2:0 needs even sides"):
        VideoWriter(tmp_path / "a.mp4", 97, 64)
    with VideoWriter(tmp_path / "a.mp4", 96, 64) as writer:
        writer.write(patches())
        with pytest.raises(InputError, match="frame 1 is 48×64, the film 96×64"):
            writer.write(patches()[:, :48])


def test_planes_of_another_matrix_are_refused(tmp_path: Path) -> None:
    zeros = np.zeros((64, 96), np.uint8)
    with VideoWriter(tmp_path / "a.mp4", 96, 64) as writer:
        writer.write(patches())
        with pytest.raises(ValueError, match="range and matrix"):
            writer.write(Planes(zeros, zeros[::2, ::2], zeros[::2, ::2], matrix="bt601"))


def test_unknown_codec_and_missing_folder(tmp_path: Path) -> None:
    with pytest.raises(InputError, match="cannot be written with none"):
        VideoWriter(tmp_path / "a.mp4", 96, 64, codec="none")
    with pytest.raises(InputError, match=r"a\.mp4"), VideoWriter(tmp_path / "none" / "a.mp4", 96, 64) as writer:
        writer.write(patches())


def test_without_frames(tmp_path: Path) -> None:
    with pytest.raises(InputError, match="without frames"), VideoWriter(tmp_path / "a.mp4", 96, 64):
        pass
