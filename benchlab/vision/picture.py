"""One decoded picture as the camera stored it: a luma plane and two chroma planes, with where their samples sit.

Pixel coordinates everywhere in this room: x to the right, y down, the centre of the first luma sample at (0, 0).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

UInt8Array = NDArray[np.uint8]
FloatArray = NDArray[np.float64]


@dataclass(frozen=True)
class Planes:
    """8-bit Y'CbCr planes, valid only until the next frame is decoded (they may be views into the decoder's memory).

    luma: (height, width). cb, cr: (height/step_y, width/step_x), rounded up.
    chroma_step: luma pixels from one chroma sample to the next, (x, y): (2, 2) for 4:2:0, (2, 1) for 4:2:2, (1, 1) for 4:4:4.
    chroma_offset: luma coordinates (x, y) of the first chroma sample: (0, 0.5) for MPEG's left siting,
        (0.5, 0.5) for JPEG's centre siting, (0, 0) for 4:4:4.
    full_range: 0–255 (JPEG, Nikon) rather than 16–235.
    matrix: "bt601", "bt709" or "bt2020": how red, green and blue were turned into these planes (ITU-R BT.601, 709, 2020).
    """

    luma: UInt8Array
    cb: UInt8Array
    cr: UInt8Array
    chroma_step: tuple[int, int] = (2, 2)
    chroma_offset: tuple[float, float] = (0.0, 0.5)
    full_range: bool = False
    matrix: str = "bt709"


@dataclass(frozen=True)
class Frame:
    """One frame of a recording, in order. `planes` is None where it could not be decoded, and `reason` says why."""

    index: int
    time_s: float
    planes: Planes | None
    reason: str = ""
    name: str = ""
