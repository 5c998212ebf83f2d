"""A camera's lens: found from chessboards, and undone in coordinates so that straight lines are straight.

The model is Brown's (see `distortion`), the calibration Zhang's (2000, "A flexible new technique for camera
calibration", IEEE Trans. PAMI 22, 1330–1334).
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, fields, replace

import cv2
import numpy as np

from benchlab.errors import InputError, UsageError, printable
from benchlab.vision.distortion import bent, straightened
from benchlab.vision.picture import FloatArray, UInt8Array

SCHEMA = "benchlab-lens"
VERSION = 1
FEWEST_BOARDS = 3
BOARDS_FOR_THIRD_RADIAL = 8
LARGEST_RMS_PX = 1.0
SMALLEST_COVER = 0.5
LEAST_TILT_DEG = 15.0
SAME_ASPECT = 0.005
LARGEST_COUNT = 100_000
LARGEST_NUMBER = 1e9


@dataclass(frozen=True)
class Lens:
    """matrix: (3, 3) focal lengths and principal point in px. distortion: (5,) k1, k2, p1, p2, k3. width, height: px.

    rms_px: root mean square distance of the boards' corners from the model. pictures_used: how many boards it rests on.
    warnings: what is doubtful about the calibration, one sentence each.
    """

    matrix: FloatArray
    distortion: FloatArray
    width: int
    height: int
    rms_px: float
    pictures_used: int
    warnings: tuple[str, ...] = ()

    def distort(self, xy: FloatArray) -> FloatArray:
        """Where points (..., 2) px of the straight picture lie in the picture that the camera took."""
        return self._to_px(bent(self._to_plane(xy), self.distortion)[0])

    def undistort(self, xy: FloatArray) -> FloatArray:
        """Where points (..., 2) px of the camera's picture lie in a straight one with the same matrix.

        The inverse of `distort` to rounding; NaN where no point is mapped, which a sound lens has only far outside.
        """
        return self._to_px(straightened(self._to_plane(xy), self.distortion))

    def for_size(self, width: int, height: int) -> Lens:
        """This lens for pictures of another size but the same shape. Raises InputError for another shape (a crop)."""
        if (width, height) == (self.width, self.height):
            return self
        across, down = width / self.width, height / self.height
        if abs(across / down - 1) > SAME_ASPECT:
            raise InputError(
                f"the lens was calibrated on {self.width}×{self.height} pictures, not {width}×{height}, "
                "which has another shape",
                hint="calibrate with pictures taken in the same mode of the camera",
            )
        # pixel centres are whole numbers, so that the picture begins at −0.5
        factor = np.array([[across, 0, (across - 1) / 2], [0, down, (down - 1) / 2], [0, 0, 1]])
        rms = self.rms_px * math.sqrt(across * down)
        return replace(self, matrix=factor @ self.matrix, width=width, height=height, rms_px=rms)

    def as_json(self) -> dict[str, object]:
        """The lens as plain data, as a lens file holds it."""
        return {
            "schema": SCHEMA,
            "version": VERSION,
            "matrix": self.matrix.tolist(),
            "distortion": self.distortion.tolist(),
            "width": self.width,
            "height": self.height,
            "rms_px": self.rms_px,
            "pictures_used": self.pictures_used,
            "warnings": list(self.warnings),
        }

    @classmethod
    def from_json(cls, data: object) -> Lens:
        """The lens in plain data. Raises InputError naming the key that is missing, unknown, or out of range."""
        return _lens_from(data)

    def _to_plane(self, xy: FloatArray) -> FloatArray:
        return (np.asarray(xy, dtype=float) - self.matrix[:2, 2]) / self.matrix[[0, 1], [0, 1]]

    def _to_px(self, plane: FloatArray) -> FloatArray:
        return plane * self.matrix[[0, 1], [0, 1]] + self.matrix[:2, 2]


def find_chessboard(picture: UInt8Array, inner_corners: tuple[int, int] = (9, 6)) -> FloatArray | None:
    """(columns·rows, 2) px, the inner corners of a chessboard in a grey picture, row by row; None if it is not whole.

    OpenCV's sector-based finder, and where that finds nothing its older one with sub-pixel corners. The sector-based
    one runs without its ACCURACY flag: on drawn boards that makes corners several times worse, single ones by 4 px.
    """
    found, corners = cv2.findChessboardCornersSB(picture, inner_corners, flags=0)
    if not found:
        flags = cv2.CALIB_CB_ADAPTIVE_THRESH | cv2.CALIB_CB_NORMALIZE_IMAGE | cv2.CALIB_CB_FAST_CHECK
        found, corners = cv2.findChessboardCorners(picture, inner_corners, flags=flags)
        if not found:
            return None
        stop = (cv2.TERM_CRITERIA_EPS + cv2.TERM_CRITERIA_MAX_ITER, 50, 1e-4)
        half = int(np.clip(_closest(np.asarray(corners, dtype=float).reshape(-1, 2)) / 3, 2, 11))
        corners = cv2.cornerSubPix(picture, corners, (half, half), (-1, -1), stop)
    return np.asarray(corners, dtype=float).reshape(-1, 2)


def calibrate(
    corner_sets: Sequence[FloatArray | None],
    inner_corners: tuple[int, int],
    square_mm: float,
    picture_size: tuple[int, int],
) -> Lens:
    """A lens from what `find_chessboard` found in several pictures of one size (width, height).

    Raises UsageError for a board of fewer than 3 × 3 inner corners or a square that is not positive, InputError with
    fewer than three boards, or where they determine no lens. With fewer than 8 boards the third radial coefficient
    is 0.
    """
    columns, rows = inner_corners
    if min(columns, rows) < 3:
        raise UsageError(
            f"a board of {columns}×{rows} inner corners is too small", hint="use 3×3 at least; 9×6 is common"
        )
    if not (math.isfinite(square_mm) and square_mm > 0):
        raise UsageError(f"the side of a square is {square_mm:g} mm, not a positive number", hint="measure one square")
    boards = [np.asarray(c, dtype=np.float32) for c in corner_sets if c is not None]
    boards = [b for b in boards if b.shape == (columns * rows, 2) and np.isfinite(b).all()]
    if len(boards) < FEWEST_BOARDS:
        raise InputError(
            f"a {columns}×{rows} chessboard is whole in {len(boards)} of {len(corner_sets)} pictures, "
            f"{FEWEST_BOARDS} are needed",
            hint="take ten pictures, at many angles and out to the corners; count the inner corners of the board",
        )
    grid = np.zeros((columns * rows, 3), np.float32)
    grid[:, :2] = square_mm * np.mgrid[0:columns, 0:rows].T.reshape(-1, 2)
    flags = cv2.CALIB_FIX_K3 if len(boards) < BOARDS_FOR_THIRD_RADIAL else 0
    start = np.eye(3), np.zeros(5)
    try:
        found = cv2.calibrateCamera([grid] * len(boards), boards, picture_size, *start, flags=flags)
    except cv2.error as error:
        raise InputError("the boards do not determine a lens", hint="hold the board at different angles") from error
    matrix, distortion = np.asarray(found[1], dtype=float), np.ravel(found[2])[:5].astype(float)
    lens = Lens(matrix, distortion, *picture_size, rms_px=float(found[0]), pictures_used=len(boards))
    if not np.isfinite(lens.undistort(_picture_grid(*picture_size))).all():
        raise InputError(
            "the distortion that fits the boards folds the picture over inside its edges",
            hint="add pictures in which the board reaches into the corners",
        )
    return replace(lens, warnings=_doubts(lens, boards, _largest_tilt(np.array(found[3], dtype=float).reshape(-1, 3))))


def _doubts(lens: Lens, boards: list[np.ndarray], tilt: float) -> tuple[str, ...]:
    doubts = []
    if lens.rms_px > LARGEST_RMS_PX:
        doubts.append(
            f"the boards fit to {lens.rms_px:.2f} px only (above {LARGEST_RMS_PX:g}): is the board flat and sharp?"
        )
    cover = _cover(np.concatenate(boards), lens.width, lens.height)
    if cover < SMALLEST_COVER:
        doubts.append(
            f"the boards cover {cover:.0%} of the picture (below {SMALLEST_COVER:.0%}): reach into its corners"
        )
    if tilt < LEAST_TILT_DEG:
        doubts.append(
            f"the boards are tilted by at most {tilt:.0f}° to each other (below {LEAST_TILT_DEG:g}°): tilt more"
        )
    return tuple(doubts)


def _cover(corners: FloatArray, width: int, height: int) -> float:
    """Share of the cells of an 8 × 6 grid over the picture in which a corner was seen."""
    counts, _, _ = np.histogram2d(corners[:, 0], corners[:, 1], bins=(8, 6), range=((0, width), (0, height)))
    return float((counts > 0).mean())


def _largest_tilt(turns: FloatArray) -> float:
    """Degrees between the two boards tilted most to each other: parallel boards leave the focal length open."""
    normals = np.array([cv2.Rodrigues(turn)[0][:, 2] for turn in turns])
    return float(np.degrees(np.arccos(np.clip(normals @ normals.T, -1, 1))).max())


def _closest(corners: FloatArray) -> float:
    return float(np.min(np.hypot(*np.diff(corners, axis=0).T)))


def _picture_grid(width: int, height: int) -> FloatArray:
    x, y = np.meshgrid(np.linspace(-0.5, width - 0.5, 33), np.linspace(-0.5, height - 0.5, 33))
    return np.stack([x, y], axis=-1)


def _lens_from(data: object) -> Lens:
    if not isinstance(data, Mapping) or data.get("schema") != SCHEMA:
        raise InputError(f"not a lens file: no schema {SCHEMA!r}", hint="make one with `benchlab calibrate camera`")
    if data.get("version") != VERSION or isinstance(data.get("version"), bool):
        raise InputError(
            f"lens version {printable(data.get('version'))[:40]}, this benchlab reads {VERSION}", where="version"
        )
    expected = {"schema", "version", *(f.name for f in fields(Lens))}
    for key in sorted(expected ^ set(data), key=str):
        raise InputError(f"key {key!r} is {'missing' if key in expected else 'unknown'}", where=str(key))
    matrix = _numbers(data["matrix"], "matrix", (3, 3))
    if min(matrix[0, 0], matrix[1, 1]) <= 0 or not np.array_equal(
        matrix[[0, 1, 2, 2, 2], [1, 0, 0, 1, 2]], [0, 0, 0, 0, 1]
    ):
        raise InputError("not of the form fx 0 cx, 0 fy cy, 0 0 1 with positive fx and fy", where="matrix")
    texts = data["warnings"]
    if not isinstance(texts, list) or not all(isinstance(text, str) for text in texts):
        raise InputError("not a list of texts", where="warnings")
    rms = float(_numbers(data["rms_px"], "rms_px", ()))
    if rms < 0:
        raise InputError(f"{rms:g} px is negative", where="rms_px")
    return Lens(
        matrix=matrix,
        distortion=_numbers(data["distortion"], "distortion", (5,)),
        width=_count(data["width"], "width", 1),
        height=_count(data["height"], "height", 1),
        rms_px=rms,
        pictures_used=_count(data["pictures_used"], "pictures_used", FEWEST_BOARDS),
        warnings=tuple(texts),
    )


def _numbers(value: object, key: str, shape: tuple[int, ...]) -> FloatArray:
    """Nested lists of numbers as an array of this shape; texts, truth values, holes and infinities are refused."""
    try:
        leaves = np.array(value, dtype=object)
    except ValueError:
        leaves = np.array(None, dtype=object).reshape(1)
    if leaves.shape != shape:
        raise InputError(f"not {'×'.join(map(str, shape)) or 'one'} number(s)", where=key)
    for leaf in leaves.flat:
        if isinstance(leaf, bool) or not isinstance(leaf, int | float) or not abs(leaf) <= LARGEST_NUMBER:
            raise InputError(f"{printable(leaf)[:40]!r} is not a number within ±{LARGEST_NUMBER:g}", where=key)
    return leaves.astype(float)


def _count(value: object, key: str, least: int) -> int:
    if isinstance(value, bool) or not isinstance(value, int) or not least <= value <= LARGEST_COUNT:
        raise InputError(f"{printable(value)[:40]} is not a whole number from {least} to {LARGEST_COUNT}", where=key)
    return value
