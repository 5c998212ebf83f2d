"""`benchlab calibrate camera`: pictures of a chessboard in, a lens file out."""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from benchlab.errors import InputError, UsageError
from benchlab.io.files import check_new_file, sha256
from benchlab.io.lens_file import write_lens
from benchlab.io.recording import RecordingInfo, open_recording
from benchlab.vision.lens import calibrate, find_chessboard
from benchlab.vision.picture import FloatArray, UInt8Array

PICTURES_OF_A_FILM = 40


def calibrate_camera(
    sources: Sequence[Path], square_mm: float, corners: str, out: Path, overwrite: bool = False
) -> dict[str, Any]:
    """Find the board in every picture, fit the lens, write it; returns what was found, as `--json` shows it.

    sources: pictures, folders of pictures, or films. corners: "9x6", the inner corners of the board.
    Raises UsageError and InputError; then nothing has been written.
    """
    columns_rows = _board(corners)
    check_new_file(out, overwrite)
    sets: list[FloatArray | None] = []
    size = (0, 0)
    for source in sources:
        for luma, info in _pictures(source):
            if sets and size != (info.width, info.height):
                raise InputError(
                    f"is {info.width}x{info.height}, the pictures before it {size[0]}x{size[1]}",
                    file=source,
                    hint="take all pictures in the mode that the bench is filmed in",
                )
            size = info.width, info.height
            found = find_chessboard(luma, columns_rows)
            sets.append(None if found is None else info.to_display(found))
    lens = calibrate(sets, columns_rows, square_mm, size)
    files = [p for s in sources for p in (sorted(s.iterdir()) if s.is_dir() else [s]) if p.is_file()]
    write_lens(out, lens, {"square_mm": square_mm, "corners": corners, "sha256": {p.name: sha256(p) for p in files}})
    return {
        "lens": str(out),
        "pictures": len(sets),
        "pictures_used": lens.pictures_used,
        "rms_px": lens.rms_px,
        "width": lens.width,
        "height": lens.height,
        "matrix": lens.matrix.tolist(),
        "distortion": lens.distortion.tolist(),
        "warnings": list(lens.warnings),
    }


def _board(corners: str) -> tuple[int, int]:
    match = re.fullmatch(r"(\d+)\s*[xX×,]\s*(\d+)", corners.strip())
    if not match:
        raise UsageError(
            f"--corners {corners!r} is not COLUMNSxROWS", hint="count the inner corners of the board, as 9x6"
        )
    return int(match[1]), int(match[2])


def _pictures(source: Path) -> Iterator[tuple[UInt8Array, RecordingInfo]]:
    """The luma planes of a source: every still, or some forty pictures spread over a film."""
    with open_recording(source) as recording:
        info = recording.info
        every = max(1, (info.frame_count or 0) // PICTURES_OF_A_FILM) if info.kind == "video" else 1
        for frame in recording:
            if frame.planes is not None and frame.index % every == 0:
                yield np.ascontiguousarray(frame.planes.luma), info
