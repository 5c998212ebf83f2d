"""What a recording is, a film or a folder of stills: its facts, its frames in order, and its doubts as warnings.

Rotation convention: `rotation_deg` is how far the stored picture is turned **clockwise** to be shown upright (0, 90,
180 or 270); where `mirrored`, it is first flipped left to right. The sample aspect stretches x before that. Kernels
work on stored planes; `to_display` takes their coordinates to the picture a person sees, where squares are square.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Iterator
from dataclasses import dataclass
from fractions import Fraction
from pathlib import Path
from types import TracebackType
from typing import Self

import numpy as np

from benchlab.vision.picture import FloatArray, Frame

TURNS: dict[int, tuple[int, int]] = {0: (1, 0), 90: (0, 1), 180: (-1, 0), 270: (0, -1)}  # (cos, sin), clockwise, y down


@dataclass(frozen=True)
class RecordingInfo:
    """The facts of a recording, known once it is open.

    width, height: of the picture as displayed, sample aspect and rotation applied.
    stored_width, stored_height: of the luma plane.
    frame_count, duration_s: as the header claims them, None where it does not; hints for a progress bar, not proof.
    title: what the file says of itself (drawn clips say that they are drawn).
    start_s: the first presentation stamp, which is subtracted from all times.
    fps: the average rate of the header, None where unknown or for stills.

    >>> from fractions import Fraction
    >>> from pathlib import Path
    >>> info = RecordingInfo(Path("a.mov"), "video", 240, 320, 320, 240, "h264", "yuv420p", None, None, 90, Fraction(1))
    >>> info.to_display(np.array([0.0, 0.0])).tolist()  # the stored top-left corner is shown at the top right
    [239.0, 0.0]
    """

    path: Path
    kind: str
    width: int
    height: int
    stored_width: int
    stored_height: int
    codec: str
    pixel_format: str
    frame_count: int | None
    duration_s: float | None
    rotation_deg: int = 0
    sample_aspect: Fraction = Fraction(1)
    full_range: bool = False
    matrix: str = "bt709"
    start_s: float = 0.0
    mirrored: bool = False
    fps: float | None = None
    title: str = ""

    def _affine(self) -> tuple[FloatArray, FloatArray]:
        """(2, 2) matrix A and (2,) shift b with displayed = A · stored + b, for pixel centres."""
        aspect = float(self.sample_aspect)
        cos, sin = TURNS[self.rotation_deg]
        turn = np.array([[cos, -sin], [sin, cos]], dtype=float) @ np.diag([-1.0 if self.mirrored else 1.0, 1.0])
        stretched = np.array([self.stored_width * aspect, float(self.stored_height)])
        matrix = turn @ np.diag([aspect, 1.0])
        corners = np.array([[0.0, 0.0], stretched]) @ turn.T  # edges of the picture, turned about the origin
        half = np.array([0.5, 0.5])
        return matrix, matrix @ half - corners.min(axis=0) - half

    def to_display(self, xy: FloatArray) -> FloatArray:
        """Stored-pixel coordinates, (..., 2) as x and y, to coordinates in the displayed picture."""
        matrix, shift = self._affine()
        return np.asarray(np.asarray(xy, dtype=float) @ matrix.T + shift)

    def from_display(self, xy: FloatArray) -> FloatArray:
        """The inverse of `to_display`."""
        matrix, shift = self._affine()
        return np.asarray((np.asarray(xy, dtype=float) - shift) @ np.linalg.inv(matrix).T)


def displayed_size(width: int, height: int, sample_aspect: Fraction, rotation_deg: int) -> tuple[int, int]:
    """(width, height) of the displayed picture: x stretched by the sample aspect, sides swapped by a quarter turn."""
    wide = max(1, round(width * sample_aspect))
    return (height, wide) if rotation_deg in {90, 270} else (wide, height)


class Recording(ABC):
    """Frames in order. A context manager; it can be iterated more than once, each time from the first frame.

    warnings: what is doubtful, filled while opening and reading, final when an iteration has ended.
    """

    info: RecordingInfo
    warnings: list[str]

    @abstractmethod
    def __iter__(self) -> Iterator[Frame]:
        """The frames; planes are valid until the next frame is asked for."""

    @abstractmethod
    def close(self) -> None:
        """Let go of the file."""

    def warn(self, text: str) -> None:
        """Note a doubt, once."""
        if text not in self.warnings:
            self.warnings.append(text)

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.close()
