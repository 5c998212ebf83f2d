"""The display matrix: how the stored pictures of a film are to be turned."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from av.sidedata.sidedata import SideData
from av.video.frame import VideoFrame
from numpy.typing import NDArray

from benchlab.errors import InputError


def orientation(display_matrix: NDArray[np.int32]) -> tuple[int, bool] | None:
    """(clockwise degrees, mirrored) of a 3×3 display matrix (ISO/IEC 14496-12, 16.16 fixed point).

    None where it is no quarter turn.

    >>> orientation(np.array([0, 65536, 0, -65536, 0, 0, 0, 0, 1 << 30], dtype=np.int32))
    (90, False)
    """
    a, b, c, d = (float(display_matrix[i]) for i in (0, 1, 3, 4))
    determinant = a * d - b * c
    if determinant == 0:
        return (0, False) if not np.any(display_matrix) else None
    mirrored = determinant < 0
    degrees = float(np.degrees(np.arctan2(-b, -a) if mirrored else np.arctan2(b, a)))
    quarter = round(degrees / 90) * 90
    return (quarter % 360, mirrored) if abs(degrees - quarter) < 0.5 else None


def frame_orientation(frame: VideoFrame, file: Path) -> tuple[int, bool]:
    """(clockwise degrees, mirrored) that the decoder hands on with a frame; (0, False) where there is no tag.

    Raises InputError for a turn that is no multiple of 90 degrees.
    """
    try:
        tag = frame.side_data.get("DISPLAYMATRIX")
    except ValueError:  # PyAV refuses the whole list for one entry of a kind it has no name for
        return -frame.rotation % 360, False
    if not isinstance(tag, SideData):
        return 0, False
    found = orientation(np.frombuffer(bytes(tag), dtype=np.int32)[:9])
    if found is None:
        hint = "remove the tag or turn the pixels"
        raise InputError("its rotation tag is no multiple of 90 degrees", file=file, hint=hint)
    return found
