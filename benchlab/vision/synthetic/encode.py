"""Red, green and blue into the planes of a recording: range, matrix and chroma siting chosen, not implied.

Y' = Kr·R + Kg·G + Kb·B, Cb = (B − Y')/(2(1 − Kb)), Cr = (R − Y')/(2(1 − Kr)) (ITU-R BT.601-7, BT.709-6).
"""

from __future__ import annotations

import cv2
import numpy as np
from numpy.typing import NDArray

Float32Array = NDArray[np.float32]

MATRIX = {"bt601": (0.299, 0.114), "bt709": (0.2126, 0.0722)}
"""Kr and Kb."""

SITING = {"left": (0.0, 0.5), "centre": (0.5, 0.5)}
"""Luma coordinates of the first chroma sample of 4:2:0."""


def ycc_matrix(matrix: str, full_range: bool) -> Float32Array:
    """(3, 4): the linear map and the offsets that take 0–255 R, G, B to 8-bit Y', Cb, Cr, not rounded.

    >>> (ycc_matrix("bt709", False) @ [255, 255, 255, 1]).round(3).tolist()
    [235.0, 128.0, 128.0]
    """
    kr, kb = MATRIX[matrix]
    luma = np.array([kr, 1 - kr - kb, kb])
    blue = (np.array([0.0, 0.0, 1.0]) - luma) / (2 * (1 - kb))
    red = (np.array([1.0, 0.0, 0.0]) - luma) / (2 * (1 - kr))
    scale = np.array([1.0, 1.0, 1.0]) if full_range else np.array([219.0, 224.0, 224.0]) / 255
    offset = np.array([0.0 if full_range else 16.0, 128.0, 128.0])
    return np.column_stack([np.stack([luma, blue, red]) * scale[:, None], offset]).astype(np.float32)


def rgb_to_ycc(rgb: Float32Array, matrix: Float32Array) -> Float32Array:
    """R, G, B into Y', Cb, Cr, both (h, w, 3), by a matrix of `ycc_matrix`; without its last column, no offsets."""
    return np.asarray(cv2.transform(rgb, matrix), dtype=np.float32)


def subsample(chroma: Float32Array, siting: str) -> Float32Array:
    """(h, w) at luma resolution to (⌈h/2⌉, ⌈w/2⌉): rows averaged by twos.

    Left siting: [1 2 1]/4 across, centred on even columns. Centre siting: the mean of two columns.
    """
    height, width = chroma.shape
    if height % 2 or width % 2:
        chroma = np.pad(chroma, ((0, height % 2), (0, width % 2)), mode="edge")
    rows = (chroma[0::2] + chroma[1::2]) * np.float32(0.5)
    even, odd = rows[:, 0::2], rows[:, 1::2]
    if siting == "centre":
        return np.asarray((even + odd) * np.float32(0.5))
    before = np.empty_like(odd)
    before[:, 0] = even[:, 0]
    before[:, 1:] = odd[:, :-1]
    return np.asarray(even * np.float32(0.5) + (before + odd) * np.float32(0.25))
