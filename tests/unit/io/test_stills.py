"""Folders of stills and single pictures."""

from __future__ import annotations

import math
import struct
from pathlib import Path

import cv2
import numpy as np
import pytest

from benchlab.errors import InputError
from benchlab.io.recording import open_recording
from benchlab.io.stills import natural_key


def picture(seed: int = 0, size: tuple[int, int] = (48, 32)) -> np.ndarray:
    """(height, width, 3) BGR: smooth colours, so that JPEG keeps them."""
    rng = np.random.default_rng(seed)
    return np.asarray(cv2.resize(rng.integers(0, 256, (4, 6, 3), dtype=np.uint8), size), dtype=np.uint8)


def save(path: Path, image: np.ndarray) -> Path:
    assert cv2.imwrite(str(path), image)
    return path


def with_exif(path: Path, orientation: int) -> Path:
    """Puts an EXIF orientation into a JPEG."""
    data = path.read_bytes()
    exif = b"Exif\0\0MM\x00*" + struct.pack(">IHHHIHHI", 8, 1, 0x112, 3, 1, orientation, 0, 0)
    path.write_bytes(data[:2] + b"\xff\xe1" + struct.pack(">H", len(exif) + 2) + exif + data[2:])
    return path


def test_natural_order_and_names(tmp_path: Path) -> None:
    names = ["img10.png", "img2.png", "IMG1.png", "img02b.png"]
    for name in names:
        save(tmp_path / name, picture())
    with open_recording(tmp_path) as recording:
        frames = list(recording)
    assert [frame.name for frame in frames] == ["IMG1.png", "img2.png", "img02b.png", "img10.png"]
    assert [frame.index for frame in frames] == [0, 1, 2, 3]
    assert all(math.isnan(frame.time_s) for frame in frames)
    assert (recording.info.kind, recording.info.frame_count, recording.warnings) == ("stills", 4, [])


def test_natural_key_tells_all_names_apart() -> None:
    names = ["a1", "a01", "A1", "1", "10", "²", "a-1", "", "1a"]
    keys = [natural_key(name) for name in names]
    assert len({tuple(key) for key in keys}) == len(names)
    assert sorted(keys)


def test_time_from_the_rate(tmp_path: Path) -> None:
    for number in range(3):
        save(tmp_path / f"{number}.png", picture())
    with open_recording(tmp_path, fps=4) as recording:
        assert [frame.time_s for frame in recording] == [0, 0.25, 0.5]
        assert recording.info.duration_s == 0.75


@pytest.mark.parametrize("suffix", ["png", "jpg", "tif"])
@pytest.mark.parametrize("depth", [8, 16])
def test_colours(tmp_path: Path, suffix: str, depth: int) -> None:
    if suffix == "jpg" and depth == 16:
        pytest.skip("JPEG has 8 bits")
    image = picture(3)
    save(tmp_path / f"a.{suffix}", image if depth == 8 else image.astype(np.uint16) * 257)
    with open_recording(tmp_path) as recording:
        (frame,) = list(recording)
    planes = frame.planes
    assert planes is not None
    assert (planes.full_range, planes.matrix) == (True, "bt601")
    luma = image @ np.array([0.114, 0.587, 0.299])
    assert np.abs(planes.luma - luma).mean() < (3 if suffix == "jpg" else 0.6)
    assert recording.warnings == (["16-bit pictures are read as 8-bit"] if depth == 16 else [])


def test_jpeg_chroma_sits_in_the_centre(tmp_path: Path) -> None:
    save(tmp_path / "a.jpg", picture())
    with open_recording(tmp_path / "a.jpg") as recording:
        (frame,) = list(recording)
    assert frame.planes is not None
    assert (frame.planes.chroma_step, frame.planes.chroma_offset) == ((2, 2), (0.5, 0.5))


@pytest.mark.parametrize("orientation", range(1, 9))
def test_exif_orientation_as_opencv_applies_it(tmp_path: Path, orientation: int) -> None:
    """OpenCV turns the picture by its tag; the brightest pixel of ours is sent to the same place."""
    image = np.zeros((32, 48, 3), np.uint8)
    cv2.circle(image, (12, 8), 3, (255, 255, 255), -1)
    path = with_exif(save(tmp_path / "a.jpg", image), orientation)
    with open_recording(path) as recording:
        (frame,) = list(recording)
    shown = np.asarray(cv2.imread(str(path)))[..., 1].astype(float)
    assert (recording.info.height, recording.info.width) == shown.shape
    rows, columns = np.nonzero(shown > 128)
    assert np.allclose(recording.info.to_display(np.array([12.0, 8.0])), [columns.mean(), rows.mean()], atol=0.3)
    assert frame.planes is not None
    assert frame.planes.luma.shape == (32, 48)


def test_sizes_that_differ(tmp_path: Path) -> None:
    save(tmp_path / "1.png", picture())
    save(tmp_path / "2.png", picture(size=(50, 32)))
    with open_recording(tmp_path) as recording, pytest.raises(InputError, match=r"2\.png: is 50×32, the first .*48×32"):
        list(recording)


def test_turns_that_differ(tmp_path: Path) -> None:
    save(tmp_path / "1.jpg", picture())
    with_exif(save(tmp_path / "2.jpg", picture()), 3)
    with open_recording(tmp_path) as recording, pytest.raises(InputError, match=r"2\.jpg: is turned differently"):
        list(recording)


def test_unreadable_still_is_a_frame_with_a_reason(tmp_path: Path) -> None:
    for number in range(6):
        save(tmp_path / f"{number}.jpg", picture(number, (200, 150)))
    whole = (tmp_path / "1.jpg").read_bytes()
    (tmp_path / "0.jpg").write_bytes(b"no picture")
    (tmp_path / "1.jpg").write_bytes(whole[: len(whole) // 2])
    (tmp_path / "2.jpg").write_bytes(b"")
    (tmp_path / "3.jpg").unlink()
    (tmp_path / "3.jpg").symlink_to(tmp_path / "gone.jpg")
    with open_recording(tmp_path) as recording:
        frames = list(recording)
    assert [frame.planes is None for frame in frames] == [True, True, True, True, False, False]
    assert [frame.reason for frame in frames] == [
        "not a JPEG, PNG or TIFF picture",
        "damaged picture",
        "empty file (0 bytes)",
        "no such file",
        "",
        "",
    ]
    assert recording.warnings == ["4 of 6 pictures could not be read"]


def test_nothing_readable(tmp_path: Path) -> None:
    (tmp_path / "a.jpg").write_bytes(b"no picture")
    (tmp_path / "b.jpg").write_bytes(b"no picture either")
    with pytest.raises(InputError, match=r"a\.jpg: not a JPEG"):
        open_recording(tmp_path)


def test_other_files_are_ignored_and_counted(tmp_path: Path) -> None:
    save(tmp_path / "a.png", picture())
    (tmp_path / "notes.txt").write_text("x")
    (tmp_path / "._a.png").write_bytes(b"x")
    (tmp_path / "more").mkdir()
    with open_recording(tmp_path) as recording:
        assert [frame.name for frame in recording] == ["a.png"]
    assert recording.warnings == ["2 other files in the folder are ignored"]


def test_empty_folder(tmp_path: Path) -> None:
    with pytest.raises(InputError, match="no pictures in this folder; JPEG, PNG and TIFF are read"):
        open_recording(tmp_path)


@pytest.mark.parametrize("suffix", ["png", "jpg", "tif"])
def test_single_picture(tmp_path: Path, suffix: str) -> None:
    with open_recording(save(tmp_path / f"%03d.{suffix}", picture())) as recording:
        (frame,) = list(recording)
        assert len(list(recording)) == 1
    assert frame.planes is not None
    assert (frame.name, recording.info.frame_count) == (f"%03d.{suffix}", 1)


@pytest.mark.parametrize("suffix", ["png", "jpg", "tif"])
def test_gray_still(tmp_path: Path, suffix: str) -> None:
    path = save(tmp_path / f"a.{suffix}", picture()[..., 0])
    with pytest.raises(InputError, match="the picture has no colour"):
        open_recording(path)


@pytest.mark.parametrize("suffix", ["png", "jpg", "tif"])
def test_limit_on_pixels(tmp_path: Path, suffix: str) -> None:
    path = save(tmp_path / f"a.{suffix}", picture())
    with pytest.raises(InputError, match=r"48×32 = 0 Mpx > limit 0\.001 Mpx; .*--max-pixels"):
        open_recording(path, max_pixels=1000)


def test_real_stills(real_folder: Path) -> None:
    with open_recording(real_folder / "video" / "red_pins") as recording:
        names = [frame.name for frame in recording if frame.planes is not None]
    assert names == ["00.jpg", "10.jpg", "20.jpg", "30.jpg", "40.jpg", "50.jpg", "60.jpg"]
    assert (recording.info.width, recording.info.height) == (1080, 1920)
