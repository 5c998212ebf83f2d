"""What may be opened, and what is refused in one line."""

from __future__ import annotations

import os
import resource
import struct
import time
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

from benchlab.errors import BenchlabError, InputError, UsageError
from benchlab.io.film import Film
from benchlab.io.recording import open_recording
from benchlab.io.stills import Stills
from tests.pace import slowness

Clip = Callable[..., Path]


def refused(path: Path, kind: type[BenchlabError], *words: str, **options: object) -> str:
    """Opens and reads a recording that must be refused; its one line, which holds the words and names the file."""
    started = time.process_time()
    with pytest.raises(kind) as caught, open_recording(path, **options) as recording:  # type: ignore[arg-type]
        for _ in recording:
            pass
    line = str(caught.value)
    took_s = time.process_time() - started
    assert took_s < 5 or took_s < 5 * slowness()
    assert type(caught.value) is kind
    assert "\n" not in line
    assert caught.value.file is not None
    for word in words:
        assert word in line
    return line


@pytest.mark.parametrize(
    "name", ["none.mp4", "http://127.0.0.1:9/a.mp4", "rtsp://127.0.0.1/a", "-", "concat:a.mp4|a.mp4"]
)
def test_what_is_no_file_never_reaches_ffmpeg(name: str) -> None:
    refused(Path(name), UsageError, "no such file")


def test_protocol_prefix_before_a_real_file_is_no_file(make_clip: Clip) -> None:
    clip = make_clip("a.mp4", frames=2)
    refused(Path(f"file:{clip}"), UsageError, "no such file")


def test_dangling_link(tmp_path: Path) -> None:
    link = tmp_path / "a.mp4"
    link.symlink_to(tmp_path / "gone.mp4")
    refused(link, UsageError, "no such file")


def test_folder_named_like_a_film(tmp_path: Path) -> None:
    (tmp_path / "x.mp4").mkdir()
    refused(tmp_path / "x.mp4", InputError, "no pictures in this folder")


def test_fifo_is_refused_before_it_is_opened(tmp_path: Path) -> None:
    os.mkfifo(tmp_path / "x.mp4")
    refused(tmp_path / "x.mp4", InputError, "not a regular file")


def test_device() -> None:
    refused(Path("/dev/zero"), InputError, "not a regular file")


TEXT = b"time_s,force_N\n" + b"0.1,2.5\n" * 50


@pytest.mark.parametrize(
    ("content", "words"),
    [
        (b"", "empty file (0 bytes)"),
        (np.random.default_rng(1).bytes(200_000), "not a video benchlab can read"),
        (bytes(200_000), "only zero bytes"),
        (TEXT, "looks like text"),
        (TEXT.decode().encode("utf-16"), "looks like text"),
        ("Kraft in N: größer als 3 °C\n".encode("latin-1") * 9, "looks like text"),
        (b"ffconcat version 1.0\nfile a.mp4\n", "a playlist"),
        (b"#EXTM3U\n#EXTINF:10,\na.ts\n", "a playlist"),
        (b"\x1aE\xdf\xa3" + bytes(range(256)), "damaged or truncated"),
    ],
)
def test_what_is_no_film(tmp_path: Path, content: bytes, words: str) -> None:
    path = tmp_path / "x.mp4"
    path.write_bytes(content)
    refused(path, InputError, words)


def test_playlist_does_not_lead_to_the_film_it_names(make_clip: Clip, tmp_path: Path) -> None:
    make_clip("a.mp4", frames=2)
    for number, text in enumerate(
        (b"\n\n ffconcat version 1.0\nfile a.mp4\n", b"\xef\xbb\xbfffconcat version 1.0\nfile a.mp4\n")
    ):
        path = tmp_path / f"list{number}.mp4"
        path.write_bytes(text)
        refused(path, InputError, "playlist")


def test_header_only_and_cut_before_the_index(make_clip: Clip, tmp_path: Path) -> None:
    data = make_clip("a.mp4").read_bytes()
    for size in (100, len(data) // 2):
        path = tmp_path / f"cut{size}.mp4"
        path.write_bytes(data[:size])
        refused(path, InputError, "truncated: index (moov) missing")


@pytest.mark.parametrize("seed", range(12))
def test_damaged_index(make_clip: Clip, tmp_path: Path, seed: int) -> None:
    """Whatever the flipped bytes hit: refused with exit code 3, or read without an exception that is not ours."""
    data = bytearray(make_clip("a.mp4", frames=10).read_bytes())
    rng = np.random.default_rng(seed)
    for at in rng.integers(data.find(b"moov") + 8, len(data), 60):
        data[at] ^= int(rng.integers(1, 256))
    path = tmp_path / "x.mp4"
    path.write_bytes(data)
    try:
        with open_recording(path) as recording:
            assert all(frame.index >= 0 for frame in recording)
    except BenchlabError as error:
        assert error.exit_code in {2, 3}
        assert str(path) in str(error)


def test_absurd_sample_count(make_clip: Clip, tmp_path: Path) -> None:
    data = bytearray(make_clip("a.mp4", frames=10).read_bytes())
    at = data.find(b"stsz") + 12
    data[at : at + 4] = b"\x7f\xff\xff\xff"
    path = tmp_path / "x.mp4"
    path.write_bytes(data)
    refused(path, InputError, "damaged index (moov)")


def test_metadata_that_is_no_utf8_is_no_damage(make_clip: Clip, tmp_path: Path) -> None:
    data = make_clip("a.mp4", frames=3).read_bytes()
    assert b"Lavf" in data
    path = tmp_path / "latin.mp4"
    path.write_bytes(data.replace(b"Lavf", b"\xb0\xe9\xff\xfe"))
    with open_recording(path) as recording:
        assert len(list(recording)) == 3


def test_audio_only(make_clip: Clip) -> None:
    refused(make_clip("a.mp4", streams=0, frames=0, audio=True), InputError, "no video stream (audio only)")


def test_sound_beside_the_film_is_ignored(make_clip: Clip) -> None:
    with open_recording(make_clip("a.mp4", audio=True, frames=5)) as recording:
        assert len(list(recording)) == 5
    assert recording.warnings == []


def test_two_video_streams(make_clip: Clip) -> None:
    clip = make_clip("a.mp4", streams=2, frames=5)
    with open_recording(clip, stream=1) as recording:
        assert len(list(recording)) == 5
    assert recording.warnings == ["2 video streams: stream 1 is read (--stream chooses)"]
    refused(clip, UsageError, "no video stream 2: there are 2", "--stream", stream=2)


def test_no_frames(tmp_path: Path, make_clip: Clip) -> None:
    refused(make_clip("a.avi", frames=0), InputError, "no frames decoded")


def test_dimensions_are_checked_from_the_header(make_clip: Clip, tmp_path: Path) -> None:
    """A header that claims 16000 × 16000 is refused at once and without the memory for it."""
    data = make_clip("a.mov", codec="png", pixel_format="rgb24", frames=2).read_bytes()
    for form in (">HH", ">II"):
        data = data.replace(struct.pack(form, 96, 64), struct.pack(form, 16_000, 16_000))
    path = tmp_path / "big.mov"
    path.write_bytes(data)
    before = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    refused(path, InputError, "256 Mpx > limit 64 Mpx", "--max-pixels")
    assert resource.getrusage(resource.RUSAGE_SELF).ru_maxrss - before < 100_000


def test_limit_on_pixels(make_clip: Clip) -> None:
    clip = make_clip("a.mp4", frames=2)
    refused(clip, InputError, "96×64 = 0 Mpx > limit 0.006143 Mpx", max_pixels=96 * 64 - 1)
    with open_recording(clip, max_pixels=96 * 64) as recording:
        assert len(list(recording)) == 2


@pytest.mark.parametrize(
    "name",
    [
        "a.csv",
        "a.jpg",
        "no suffix",
        "Ünïcode ⚙.mp4",
        'it\'s "quoted".mp4',
        "line\nbreak.mp4",
        "-y.mp4",
        "%03d.mp4",
        "frame%03d.jpg",
        "a:b|c.mp4",
        "<img src=x onerror=alert(1)>.mp4",
    ],
)
def test_names_mean_nothing(make_clip: Clip, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, name: str) -> None:
    """Type by content; no name is read as an option, a pattern or an address."""
    make_clip("whole.mp4", frames=3).rename(tmp_path / name)
    monkeypatch.chdir(tmp_path)
    with open_recording(Path(name)) as recording:
        assert len(list(recording)) == 3


def test_line_break_in_a_name_is_shown_escaped(tmp_path: Path) -> None:
    path = tmp_path / "line\nbreak.mp4"
    path.write_bytes(TEXT)
    assert r"line\nbreak.mp4" in refused(path, InputError)


def test_no_permission(make_clip: Clip, monkeypatch: pytest.MonkeyPatch) -> None:
    clip = make_clip("a.mp4", frames=2)
    monkeypatch.setattr(os, "access", lambda *_: False)
    refused(clip, InputError, "permission denied")


@pytest.mark.parametrize("rate", [0.0, -1.0, float("nan"), float("inf"), 2e6])
def test_rates_out_of_range(make_clip: Clip, rate: float) -> None:
    clip = make_clip("a.mp4", frames=2)
    for options in ({"fps": rate}, {"capture_fps": rate}):
        with pytest.raises(UsageError, match="out of range"):
            open_recording(clip, **options)
    with pytest.raises(UsageError, match="exclude"):
        open_recording(clip, fps=30, capture_fps=240)


def test_kind_by_content(make_clip: Clip, tmp_path: Path) -> None:
    with open_recording(make_clip("a.mp4", frames=2)) as film:
        assert isinstance(film, Film)
        assert film.info.kind == "video"
    make_clip("b.png", codec="png", pixel_format="rgb24", frames=1, container_format="image2").rename(
        tmp_path / "b.mp4"
    )
    with open_recording(tmp_path / "b.mp4") as still:
        assert isinstance(still, Stills)
        assert [frame.name for frame in still] == ["b.mp4"]
