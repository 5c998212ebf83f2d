"""Sensor noise as it arrives in the planes: white in red, green and blue, then through matrix and chroma filter."""

from __future__ import annotations

import numpy as np

from benchlab.vision.synthetic.encode import Float32Array, rgb_to_ycc, subsample, ycc_matrix
from benchlab.vision.synthetic.scene import Scene

MARGIN = 128
"""How much wider and higher than the picture a field is, when there are several; even."""


class NoisePool:
    """A few fields of noise, made once; every frame gets a cut at a random place of one of them."""

    def __init__(self, scene: Scene, rng: np.random.Generator, fields: int) -> None:
        self._size = (scene.height, scene.width)
        self._margin = MARGIN if fields > 1 else 0
        shape = (scene.height + self._margin, scene.width + self._margin, 3)
        matrix = np.ascontiguousarray(ycc_matrix(scene.matrix, scene.full_range)[:, :3])
        self._fields = []
        for _ in range(fields):
            ycc = rgb_to_ycc(rng.standard_normal(shape, dtype=np.float32) * np.float32(scene.noise_sd), matrix)
            chroma = [subsample(ycc[..., k], scene.chroma_siting) for k in (1, 2)]
            self._fields.append((np.ascontiguousarray(ycc[..., 0]), chroma[0], chroma[1]))

    def cut(self, rng: np.random.Generator) -> tuple[Float32Array, Float32Array, Float32Array]:
        """Noise of one frame for luma, Cb and Cr."""
        luma, cb, cr = self._fields[rng.integers(len(self._fields))]
        y, x = 2 * rng.integers(0, self._margin // 2 + 1, 2)
        height, width = self._size
        part = np.s_[y // 2 : y // 2 + -(-height // 2), x // 2 : x // 2 + -(-width // 2)]
        return luma[y : y + height, x : x + width], cb[part], cr[part]
