"""Fixtures for all tests: small films made on the spot, and the folder of real files where it is there."""

from __future__ import annotations

import os

# Two test processes share the cores: threads of BLAS on top of them would wait by spinning.
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

import signal
from collections.abc import Callable, Sequence
from fractions import Fraction
from pathlib import Path
from typing import Any

import av
import numpy as np
import pytest
from hypothesis import HealthCheck, settings

if signal.getsignal(signal.SIGINT) == signal.SIG_IGN:
    # As a shell starts what runs in the background; processes of the tests would not hear a Ctrl-C either.
    signal.signal(signal.SIGINT, signal.default_int_handler)

# How long an example takes is the computer's affair, and how busy it is.
settings.register_profile("patient", deadline=None, suppress_health_check=[HealthCheck.too_slow])
settings.load_profile("patient")

Drawing = Callable[[int], np.ndarray]


def drawn(index: int, width: int, height: int) -> np.ndarray:
    """(height, width, 3) RGB: fixed fine texture, so that a damaged packet shows, and a red square that moves."""
    rng = np.random.default_rng(7)
    picture = rng.integers(60, 180, (height, width, 1), dtype=np.uint8).repeat(3, axis=2)
    side = max(2, min(width, height) // 8)
    x = (3 * index) % max(1, width - side)
    picture[height // 3 : height // 3 + side, x : x + side] = (220, 20, 20)
    return picture


def write_clip(
    path: Path,
    *,
    codec: str = "libx264",
    frames: int = 30,
    size: tuple[int, int] = (96, 64),
    fps: float = 30,
    pts: Sequence[int] | None = None,
    time_base: Fraction | None = None,
    pixel_format: str = "yuv420p",
    draw: Drawing | None = None,
    options: dict[str, str] | None = None,
    container_options: dict[str, str] | None = None,
    gop: int = 12,
    aspect: Fraction | None = None,
    rotation_ccw_deg: float = 0,
    streams: int = 1,
    audio: bool = False,
    container_format: str | None = None,
    colorspace: int | None = None,
    color_range: int | None = None,
    field_order: str | None = None,
) -> Path:
    """Encode a film with PyAV; returns its path.

    pts: stamps in units of time_base (default 1/fps), for uneven, repeated or late times.
    draw: frame number to (height, width, 3) RGB. streams: how many equal video streams. audio: add a second of silence.
    """
    rate = Fraction(fps).limit_denominator(1001)
    base = time_base or 1 / rate
    width, height = size
    with av.open(str(path), "w", format=container_format, options=container_options or {}) as container:
        outputs: list[Any] = []
        for _ in range(streams):
            stream: Any = container.add_stream(codec, rate=rate, options=options or {})
            stream.width, stream.height, stream.pix_fmt = width, height, pixel_format
            context = stream.codec_context
            context.time_base, context.gop_size, context.thread_count = base, gop, 1
            if aspect is not None:
                context.sample_aspect_ratio = aspect
            if colorspace is not None:
                context.colorspace = colorspace
            if color_range is not None:
                context.color_range = color_range
            if field_order is not None:
                context.flags |= 1 << 18 | 1 << 29  # interlaced DCT and motion
            if rotation_ccw_deg:
                stream.set_display_rotation(rotation_ccw_deg)
            outputs.append(stream)
        sound = write_silence(container) if audio else []
        container.start_encoding()
        for index in range(frames):
            picture = draw(index) if draw else drawn(index, width, height)
            for stream in outputs:
                frame = av.VideoFrame.from_ndarray(picture, format="rgb24").reformat(format=pixel_format)
                frame.pts, frame.time_base = (index if pts is None else pts[index]), base
                container.mux(stream.encode(frame))
        for stream in outputs:
            container.mux(stream.encode(None))
        for packet in sound:
            container.mux(packet)
    return path


def write_silence(container: Any) -> list[Any]:
    """One second of silent sound, encoded; its stream is added to the container."""
    stream = container.add_stream("aac", rate=48_000, layout="mono")
    packets = []
    for index in range(47):
        frame = av.AudioFrame.from_ndarray(np.zeros((1, 1024), np.float32), format="fltp", layout="mono")
        frame.sample_rate, frame.pts = 48_000, 1024 * index
        packets += stream.encode(frame)
    return packets + stream.encode(None)


@pytest.fixture
def make_clip(tmp_path: Path) -> Callable[..., Path]:
    """`make_clip("a.mp4", frames=5, ...)` encodes a small film in the test's folder; see `write_clip` for the options."""

    def make(name: str | Path, **options: Any) -> Path:
        return write_clip(tmp_path / name, **options)

    return make


@pytest.fixture(scope="session")
def real_folder() -> Path:
    """The folder of real files; tests that need it are skipped where it is absent."""
    folder = Path(__file__).resolve().parents[2] / "shared" / "real"
    if not folder.is_dir():
        pytest.skip("the folder of real files is absent")
    return folder
