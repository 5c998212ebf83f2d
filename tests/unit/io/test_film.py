"""Films: times, sizes, turns, damage."""

from __future__ import annotations

import os
import tracemalloc
from collections.abc import Callable, Iterator
from fractions import Fraction
from pathlib import Path
from typing import Any

import av
import numpy as np
import pytest

from benchlab.errors import InputError, UsageError
from benchlab.io.decoder import PENDING_LIMIT, Decoder
from benchlab.io.film import Film
from benchlab.io.film_checks import AFTER_DAMAGE, DAMAGED, NOT_ADVANCING
from benchlab.vision.picture import Frame

Clip = Callable[..., Path]


def read(path: Path, **options: Any) -> tuple[list[Frame], Film]:
    """All frames with their planes copied, and the recording."""
    with Film(path, **options) as film:
        frames = list(film)
    return frames, film


def times(frames: list[Frame]) -> list[float]:
    return [frame.time_s for frame in frames]


@pytest.mark.parametrize(
    ("name", "options"),
    [
        ("a.mp4", {}),
        ("a.mov", {"codec": "prores_ks", "pixel_format": "yuv422p10le"}),
        ("a.mkv", {}),
        ("a.avi", {"codec": "mjpeg", "pixel_format": "yuvj420p"}),
        ("a.avi", {"codec": "mpeg4"}),
        ("a.ts", {}),
        ("a.mpg", {"codec": "mpeg2video"}),
        ("a.webm", {"codec": "libvpx-vp9"}),
        ("a.webm", {"codec": "libvpx"}),
        ("a.mp4", {"codec": "libsvtav1"}),
        ("a.mp4", {"codec": "libx265", "options": {"x265-params": "log-level=none"}}),
        ("a.gif", {"codec": "gif", "pixel_format": "rgb8", "fps": 25}),
        ("a.mov", {"codec": "png", "pixel_format": "rgba"}),
        ("a.mp4", {"pixel_format": "yuv444p", "size": (97, 65)}),
        ("a.mkv", {"codec": "ffv1", "size": (97, 65)}),
        ("a.mkv", {"codec": "rawvideo", "pixel_format": "nv12"}),
    ],
)
def test_containers_and_codecs(make_clip: Clip, name: str, options: dict[str, Any]) -> None:
    frames, film = read(make_clip(name, frames=20, **options))
    fps = options.get("fps", 30)
    assert [frame.index for frame in frames] == list(range(20))
    assert np.allclose(times(frames), np.arange(20) / fps, atol=0.0011)
    width, height = options.get("size", (96, 64))
    assert (film.info.width, film.info.height) == (width, height)
    assert all(f.planes is not None and f.planes.luma.shape == (height, width) and not f.reason for f in frames)
    assert [w for w in film.warnings if "-bit pictures" not in w] == []


def test_planes_are_views_into_the_decoder(make_clip: Clip) -> None:
    with Film(make_clip("a.mp4", frames=2)) as film:
        planes = next(iter(film)).planes
        assert planes is not None
        assert not planes.luma.flags.owndata
        assert planes.luma.strides[0] > planes.luma.shape[1]
        assert planes.cb.shape == planes.cr.shape == (32, 48)


def test_luma_is_what_was_drawn(make_clip: Clip) -> None:
    """Lossless: a red square on gray, limited-range BT.601, Y = 16 + 219·(0.299 R + 0.587 G + 0.114 B)/255."""

    def draw(_: int) -> np.ndarray:
        picture = np.full((64, 96, 3), 128, np.uint8)
        picture[16:32, 32:64] = (255, 0, 0)
        return picture

    frames, film = read(make_clip("a.mkv", codec="ffv1", frames=1, draw=draw))
    planes = frames[0].planes
    assert planes is not None
    assert abs(int(planes.luma[20, 40]) - (16 + 219 * 0.299)) < 1.5
    assert abs(int(planes.luma[2, 2]) - (16 + 219 * 128 / 255)) < 1.5
    assert abs(int(planes.cr[10, 20]) - 240) < 1.5
    assert (film.info.full_range, film.info.matrix) == (False, "bt601")


def test_can_be_read_again(make_clip: Clip) -> None:
    with Film(make_clip("a.mp4", frames=5)) as film:
        first, second = times(list(film)), times(list(film))
    assert first == second
    assert len(first) == 5


def test_hevc_of_ten_bits_has_the_luma_of_its_eight_bit_twin(make_clip: Clip) -> None:
    eight, _ = read(make_clip("a.mkv", codec="ffv1", frames=1))
    ten, film = read(make_clip("b.mkv", codec="ffv1", frames=1, pixel_format="yuv420p10le"))
    assert eight[0].planes is not None
    assert ten[0].planes is not None
    for name in ("luma", "cb", "cr"):
        difference = getattr(eight[0].planes, name).astype(int) - getattr(ten[0].planes, name)
        assert np.abs(difference).max() <= 1
    assert film.warnings == ["10-bit pictures are read as 8-bit"]


@pytest.mark.parametrize("pixel_format", ["gray", "gray16le", "ya8"])
def test_gray(make_clip: Clip, pixel_format: str) -> None:
    name, codec = ("a.mov", "png") if pixel_format == "ya8" else ("a.mkv", "ffv1")
    with pytest.raises(InputError, match="the picture has no colour"):
        Film(make_clip(name, codec=codec, pixel_format=pixel_format, frames=1))


def test_interlaced(make_clip: Clip) -> None:
    clip = make_clip("a.mp4", field_order="tt", options={"x264-params": "interlaced=1:tff=1", "crf": "1"}, frames=4)
    frames, film = read(clip)
    plain, _ = read(make_clip("b.mp4", options={"crf": "1"}, frames=4))
    assert any(w.startswith("interlaced") for w in film.warnings)
    for one, other in zip(frames, plain, strict=True):
        assert one.planes is not None
        assert other.planes is not None
        assert np.abs(one.planes.luma.astype(int) - other.planes.luma).mean() < 3


def test_one_frame(make_clip: Clip) -> None:
    frames, film = read(make_clip("a.mp4", frames=1))
    assert times(frames) == [0.0]
    assert film.warnings == []


# -- time ---------------------------------------------------------------------------------------------------------


def test_variable_frame_rate(make_clip: Clip) -> None:
    stamps = [*range(30), *(29 + 3 * i for i in range(1, 16))]
    frames, film = read(make_clip("a.mp4", frames=45, pts=stamps))
    assert np.allclose(times(frames), np.array(stamps) / 30)
    assert film.warnings == ["variable frame rate, 33–100 ms"]


def test_ntsc_rate_does_not_drift(make_clip: Clip) -> None:
    frames, _ = read(
        make_clip("a.mkv", codec="mjpeg", pixel_format="yuvj420p", frames=600, fps=30_000 / 1001, size=(32, 32))
    )
    assert np.abs(np.array(times(frames)) - np.arange(600) * 1001 / 30_000).max() < 1e-3


def test_slow_motion(make_clip: Clip) -> None:
    frames, film = read(make_clip("a.mp4", frames=25), capture_fps=240)
    assert np.allclose(times(frames), np.arange(25) / 240)
    assert film.info.duration_s == pytest.approx(25 / 240)
    assert film.warnings == ["slow motion: tagged 30 fps, captured at 240 fps; time is rescaled"]


def test_start_offset(make_clip: Clip) -> None:
    frames, film = read(make_clip("a.mp4", frames=10, pts=range(150, 160)))
    assert times(frames) == pytest.approx(np.arange(10) / 30)
    assert film.info.start_s == pytest.approx(5.0)
    frames, film = read(make_clip("a.ts", frames=10))
    assert frames[0].time_s == 0
    assert film.info.start_s > 0


def test_edit_list_is_no_damage(make_clip: Clip) -> None:
    frames, film = read(make_clip("a.mp4", frames=90, pts=range(-15, 75)))
    assert film.info.frame_count == 90
    assert len(frames) == 75
    assert film.warnings == []


def repeated(make_clip: Clip, tmp_path: Path) -> Path:
    """A film whose frame 6 has the stamp of frame 5."""
    path = tmp_path / "repeated.mkv"
    clip = make_clip("a.avi", codec="mjpeg", pixel_format="yuvj420p", frames=12)
    with av.open(str(clip)) as source, av.open(str(path), "w") as target:
        stream = target.add_stream_from_template(source.streams.video[0])
        for number, packet in enumerate(p for p in source.demux(video=0) if p.size):
            packet.stream = stream
            packet.pts = packet.dts = number - (number > 5)
            target.mux(packet)
    return path


def test_repeated_stamps(make_clip: Clip, tmp_path: Path) -> None:
    frames, film = read(repeated(make_clip, tmp_path))
    assert [f.index for f in frames if f.planes is None] == [6]
    assert frames[6].reason == NOT_ADVANCING
    assert film.warnings == ["1 of 12 frames have time stamps that do not advance; they are not measured"]


def test_stamps_that_go_back(make_clip: Clip, tmp_path: Path) -> None:
    data = make_clip("a.ts", frames=10).read_bytes()
    path = tmp_path / "twice.ts"
    path.write_bytes(data + data)
    frames, film = read(path, allow_partial=True)
    assert len(frames) == 20
    assert all(f.planes is None for f in frames[10:])
    assert any("do not advance" in warning for warning in film.warnings)


@pytest.mark.parametrize(
    ("name", "codec", "form"), [("a.h264", "libx264", "yuv420p"), ("a.mjpeg", "mjpeg", "yuvj420p")]
)
def test_raw_streams_need_a_rate(make_clip: Clip, name: str, codec: str, form: str) -> None:
    clip = make_clip(name, codec=codec, pixel_format=form, frames=10)
    with pytest.raises(UsageError, match="has no time stamps; give its frame rate with --fps"):
        Film(clip)
    frames, film = read(clip, fps=50)
    assert times(frames) == pytest.approx(np.arange(10) / 50)
    assert film.warnings == []


def test_avi_with_reordered_frames_needs_a_rate(make_clip: Clip) -> None:
    clip = make_clip("a.avi", frames=20, options={"bf": "2"})
    with pytest.raises(UsageError, match="--fps"):
        Film(clip)
    frames, _ = read(clip, fps=30)
    assert len(frames) == 20


def test_given_rate_replaces_stamps_and_says_so(make_clip: Clip) -> None:
    frames, film = read(make_clip("a.mp4", frames=4), fps=10)
    assert times(frames) == pytest.approx([0, 0.1, 0.2, 0.3])
    assert film.warnings == ["time from --fps 10; the stamps of the file are not used"]


# -- shape --------------------------------------------------------------------------------------------------------


def test_size_that_changes(make_clip: Clip, tmp_path: Path) -> None:
    one, other = make_clip("a.h264", frames=30), make_clip("b.h264", frames=5, size=(64, 48))
    path = tmp_path / "c.h264"
    path.write_bytes(one.read_bytes() + other.read_bytes())
    with pytest.raises(InputError, match="frame size changes at frame 30, from 96×64 to 64×48"):
        read(path, fps=30)


@pytest.mark.parametrize(("tag_ccw_deg", "turn_deg"), [(-90, 90), (90, 270), (180, 180), (0, 0)])
def test_rotation(make_clip: Clip, tag_ccw_deg: int, turn_deg: int) -> None:
    _, film = read(make_clip("a.mp4", frames=1, rotation_ccw_deg=tag_ccw_deg))
    assert film.info.rotation_deg == turn_deg
    assert (film.info.stored_width, film.info.stored_height) == (96, 64)
    assert (film.info.width, film.info.height) == ((64, 96) if turn_deg in {90, 270} else (96, 64))


def test_oblique_rotation_is_refused(make_clip: Clip) -> None:
    with pytest.raises(InputError, match="no multiple of 90 degrees"):
        Film(make_clip("a.mp4", frames=1, rotation_ccw_deg=30))


def test_sample_aspect(make_clip: Clip) -> None:
    _, film = read(make_clip("a.mp4", frames=1, aspect=Fraction(2)))
    assert film.info.sample_aspect == 2
    assert (film.info.width, film.info.height) == (192, 64)


# -- damage -------------------------------------------------------------------------------------------------------

FASTSTART = {"container_options": {"movflags": "faststart"}, "frames": 60}


def damaged(path: Path, data: bytes | bytearray) -> Path:
    path.write_bytes(data)
    return path


def test_cut_with_the_index_in_front(make_clip: Clip, tmp_path: Path) -> None:
    data = make_clip("a.mp4", **FASTSTART).read_bytes()
    path = damaged(tmp_path / "cut.mp4", data[: len(data) // 2])
    with pytest.raises(InputError, match=r"truncated: decoded \d+ of 60 frames; .*--allow-partial"):
        read(path)
    frames, film = read(path, allow_partial=True)
    good = [f for f in frames if f.planes is not None]
    assert 20 < len(good) < 40
    assert film.warnings[0].startswith(f"truncated: decoded {len(good)} of 60 frames (missing from ")


def test_hole(make_clip: Clip, tmp_path: Path) -> None:
    data = bytearray(make_clip("a.mp4", **FASTSTART).read_bytes())
    middle, hole = len(data) // 2, len(data) // 10
    data[middle : middle + hole] = bytes(hole)
    path = damaged(tmp_path / "hole.mp4", data)
    with pytest.raises(InputError, match=r"between \d\.\d\d and \d\.\d\d s: \d+ of 60 frames damaged"):
        read(path)
    frames, film = read(path, allow_partial=True)
    assert len(frames) == 60
    lost = [f for f in frames if f.planes is None]
    assert 0 < len(lost) < 30
    assert all(f.reason == DAMAGED for f in lost)
    assert times(frames) == pytest.approx(np.arange(60) / 30)
    assert any(f"{len(lost)} of 60 frames damaged" in warning for warning in film.warnings)


def test_flipped_bytes(make_clip: Clip, tmp_path: Path) -> None:
    data = bytearray(make_clip("a.mp4", **FASTSTART, size=(160, 120)).read_bytes())
    rng = np.random.default_rng(3)
    for at in rng.integers(data.find(b"mdat") + 100, len(data), 100):
        data[at] ^= int(rng.integers(1, 256))
    path = damaged(tmp_path / "flip.mp4", data)
    with pytest.raises(InputError, match=r"\d+ of \d+ frames damaged"):
        read(path)
    runs = []
    for _ in range(2):
        with Film(path, allow_partial=True) as film:
            runs.append([(f.reason, None if f.planes is None else int(f.planes.luma.astype(int).sum())) for f in film])
    assert runs[0] == runs[1]
    assert {AFTER_DAMAGE, DAMAGED} <= {reason for reason, _ in runs[0]}
    assert all(total is None for reason, total in runs[0] if reason == DAMAGED)
    assert any("predicted from them" in warning for warning in film.warnings)


def test_what_the_decoder_flags_is_damaged(make_clip: Clip, tmp_path: Path) -> None:
    """Frames that FFmpeg hands out with its errors concealed: none of them is given on."""
    data = bytearray(make_clip("a.mp4", **FASTSTART, size=(160, 120)).read_bytes())
    rng = np.random.default_rng(4)
    for at in rng.integers(data.find(b"mdat") + 100, len(data), 100):
        data[at] ^= int(rng.integers(1, 256))
    path = damaged(tmp_path / "flip.mp4", data)
    with av.open(str(path)) as container:
        stream = container.streams.video[0]
        flagged = {float(f.pts * stream.time_base) for p in container.demux(stream) for f in decoded(p) if f.is_corrupt}
    frames, _ = read(path, allow_partial=True)
    assert len(flagged) > 3
    assert flagged <= {f.time_s for f in frames if f.planes is None}


def decoded(packet: Any) -> list[Any]:
    try:
        return list(packet.decode())
    except av.error.InvalidDataError:
        return []


@pytest.mark.parametrize(("name", "codec"), [("a.mkv", "libx264"), ("a.webm", "libvpx-vp9"), ("a.avi", "mpeg4")])
def test_cut_where_the_container_ends_silently(make_clip: Clip, tmp_path: Path, name: str, codec: str) -> None:
    data = make_clip(name, codec=codec, frames=60).read_bytes()
    path = damaged(tmp_path / f"cut{name}", data[: len(data) * 2 // 3])
    with pytest.raises(InputError, match=r"truncated: decoded \d+"):
        read(path)
    frames, film = read(path, allow_partial=True)
    assert 0 < len(frames) < 60
    assert film.warnings[0].startswith("truncated")


def test_file_that_changes_while_it_is_read(make_clip: Clip) -> None:
    clip = make_clip("a.mp4")
    with Film(clip) as film, pytest.raises(InputError, match="file changed while reading"):
        for frame in film:
            if frame.index == 3:
                with clip.open("ab") as file:
                    file.write(b"more")


def test_touched_file_counts_as_changed(make_clip: Clip) -> None:
    clip = make_clip("a.mp4")
    with Film(clip) as film, pytest.raises(InputError, match="file changed while reading"):
        for frame in film:
            if frame.index == 3:
                os.utime(clip, (1, 1))


class DyingShare:
    """A container on a share that goes away after some packets."""

    def __init__(self, container: Any, packets: int) -> None:
        self.container, self.packets = container, packets

    def demux(self, stream: Any) -> Iterator[Any]:
        for number, packet in enumerate(self.container.demux(stream)):
            if number == self.packets:
                raise OSError(5, "Input/output error")
            yield packet


def test_share_that_dies(make_clip: Clip) -> None:
    with Film(make_clip("a.mp4")) as film:
        decoder = film._frames
        decoder.container = DyingShare(decoder.container, 10)  # type: ignore[assignment]
        film._first = None
        decoder._pending.clear()
        with pytest.raises(InputError, match="reading failed: input/output error"):
            list(film)


def test_memory_is_constant(make_clip: Clip) -> None:
    """The account of a film does not grow with its frames."""
    peaks = []
    for frames in (100, 1000):
        clip = make_clip(f"{frames}.avi", codec="mjpeg", pixel_format="yuvj420p", frames=frames, size=(32, 32))
        with Film(clip) as film:
            tracemalloc.start()
            for frame in film:
                assert frame.planes is not None
            peaks.append(tracemalloc.get_traced_memory()[1])
            tracemalloc.stop()
            decoder: Decoder = film._frames
            assert len(decoder._pending) <= PENDING_LIMIT
    assert peaks[1] < 1.2 * peaks[0] + 20_000


def test_fast_leaves_out_deblocking_only(make_clip: Clip) -> None:
    clip = make_clip("a.mp4", options={"crf": "35"}, frames=10)
    exact, _ = read(clip)
    fast, _ = read(clip, fast=True)
    assert times(exact) == times(fast)
    assert exact[5].planes is not None
    assert fast[5].planes is not None
    difference = np.abs(exact[5].planes.luma.astype(int) - fast[5].planes.luma)
    assert 0 < difference.mean() < 10


def test_real_camera_is_full_range_bt601(real_folder: Path) -> None:
    frames, film = read(real_folder / "video" / "nikon_full_range_bt601.MOV")
    assert (film.info.full_range, film.info.matrix) == (True, "bt601")
    assert len(frames) == film.info.frame_count == 30
    assert film.warnings == []
