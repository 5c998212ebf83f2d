"""ArUco markers in a grey picture: found by their code, then measured by their edges.

A corner is found where two edges would meet. Blur rounds corners off, so that looking for the corner itself puts it
about 0.2 px inside; the mid-grey line along a straight edge does not move.
"""

from __future__ import annotations

import cv2
import numpy as np
from numpy.typing import NDArray

from benchlab.errors import InputError, UsageError
from benchlab.vision.picture import FloatArray, UInt8Array

STEP_PX = 0.25
PASSES = 2


def find_aruco(picture: UInt8Array, dictionary: str = "4x4_50") -> tuple[NDArray[np.int64], FloatArray]:
    """Identities (M,) and corners (M, 4, 2) px, in order round each, of the ArUco markers in a grey picture (H, W).

    dictionary: name of the predefined set, "4x4_50", "6x6_250", … (Garrido-Jurado et al. 2014, Pattern Recognition 47,
    2280–2292). Raises UsageError for a set OpenCV does not have; InputError when no marker of it is in view, saying
    what is, and for one without clear edges.
    """
    detector = cv2.aruco.ArucoDetector(_dictionary(dictionary), cv2.aruco.DetectorParameters())
    picture = np.ascontiguousarray(picture)
    corners, identities, rejected = detector.detectMarkers(picture)
    if identities is None or len(identities) == 0:
        height, width = picture.shape
        seen = f"{len(rejected)} four-sided shapes carry no code of this set" if rejected else "no dark square"
        raise InputError(
            f"no {dictionary} ArUco marker in the {width}×{height} picture: {seen}",
            hint="show the whole marker with its white edge, 30 px wide or more, or name its set: --aruco-dictionary",
        )
    names = np.ravel(identities).astype(np.int64)
    found = [refine_square(picture, np.asarray(c, dtype=float).reshape(4, 2)) for c in corners]
    for name, square in zip(names, found, strict=True):
        if not np.isfinite(square).all():
            raise InputError(f"the edges of ArUco marker {name} are not clear", hint="focus, or light it evenly")
    return names, np.array(found)


def refine_square(picture: UInt8Array, corners: FloatArray) -> FloatArray:
    """(4, 2) px where the mid-grey lines along a dark square's edges meet, from corners good to 1 px; else NaN."""
    for _ in range(PASSES):
        lines = [_edge(picture, corners[i], corners[(i + 1) % 4]) for i in range(4)]
        corners = np.array([_crossing(lines[i - 1], lines[i]) for i in range(4)])
    return corners


def _edge(picture: UInt8Array, a: FloatArray, b: FloatArray) -> FloatArray:
    """Two points (2, 2) px on the line through the edge near a–b."""
    length = float(np.hypot(*(b - a)))
    if not length > 0:
        return np.full((2, 2), np.nan)
    along = (b - a) / length
    normal = np.array([along[1], -along[0]])
    # profiles across the edge, half as far as the black border is wide in a set of 4×4 cells
    reach = np.arange(-1, 1 + 1e-9, STEP_PX / max(length / 12, 2.0)) * max(length / 12, 2.0)
    places = np.linspace(0.08, 0.92, int(np.clip(length, 10, 400)))
    at = a + places[:, None, None] * (b - a) + reach[None, :, None] * normal
    profile = cv2.remap(picture, at[..., 0].astype(np.float32), at[..., 1].astype(np.float32), cv2.INTER_LINEAR)
    offset = _mid_grey(profile.astype(float), reach)
    good = np.isfinite(offset)
    if good.sum() < len(places) / 2:
        return np.full((2, 2), np.nan)
    good &= np.abs(offset - np.nanmedian(offset)) < 1.5
    slope, shift = np.polyfit(places[good], offset[good], 1)
    return np.stack([a + shift * normal, b + (shift + slope) * normal])


def _mid_grey(profile: FloatArray, reach: FloatArray) -> FloatArray:
    """(M,) where each profile (M, K) passes midway between its ends, nearest the middle; NaN without contrast."""
    ends = max(len(reach) // 6, 1)
    inner, outer = profile[:, :ends].mean(axis=1), profile[:, -ends:].mean(axis=1)
    above = profile - ((inner + outer) / 2)[:, None]
    crosses = (above[:, :-1] < 0) != (above[:, 1:] < 0)
    centre = np.abs(reach[:-1] + reach[1:])
    index = np.argmin(np.where(crosses, centre, np.inf), axis=1)
    rows = np.arange(len(profile))
    before, after = above[rows, index], above[rows, index + 1]
    clear = crosses.any(axis=1) & (np.abs(outer - inner) > 20)
    share = before / np.where(clear, before - after, 1.0)
    return np.where(clear, reach[index] + share * (reach[1] - reach[0]), np.nan)


def _crossing(first: FloatArray, second: FloatArray) -> FloatArray:
    """(2,) where the lines through two pairs of points meet."""
    p, q = first[1] - first[0], second[1] - second[0]
    cross = p[0] * q[1] - p[1] * q[0]
    if not abs(cross) > 0:
        return np.full(2, np.nan)
    gap = second[0] - first[0]
    return first[0] + p * (gap[0] * q[1] - gap[1] * q[0]) / cross


def _dictionary(name: str) -> cv2.aruco.Dictionary:
    known = {n.removeprefix("DICT_").lower(): getattr(cv2.aruco, n) for n in dir(cv2.aruco) if n.startswith("DICT_")}
    if name.lower() not in known:
        raise UsageError(f"no ArUco set is called {name!r}", hint=f"choose one of {', '.join(sorted(known))}")
    return cv2.aruco.getPredefinedDictionary(known[name.lower()])
