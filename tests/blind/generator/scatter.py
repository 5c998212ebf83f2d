"""How samples, runs and readings differ where nothing is hidden, and the noise floor that follows from it.

A sample has its own gain, its own shift of pressure and its own smooth warp of the pressure axis; a run its own offset; a reading coloured
and white noise. Amplitudes are drawn for a study, so that the SD at 0.35 MPa lies among the published 1.7 to 4.0°.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.signal import lfilter

from tests.blind.generator.station import FloatArray

WAVES = 4
REACH_MPa = 0.42
"""The warp is a sum of sines with half waves of this, a half, a third, a quarter of it."""


@dataclass(frozen=True)
class Scatter:
    """SDs: gain and force_gain of 1, shift and warp and sensor in MPa, angles in degrees, forces in N; colour_s: OU correlation time."""

    gain: float
    shift_MPa: float
    warp_MPa: float
    offset_deg: float
    colour_deg: float
    colour_s: float
    white_deg: float
    sensor_MPa: float
    force_gain: float = 0.03
    force_offset_N: float = 0.2
    force_white_N: float = 0.15

    @classmethod
    def draw(cls, rng: np.random.Generator) -> Scatter:
        return cls(
            gain=rng.uniform(0.02, 0.03),
            shift_MPa=rng.uniform(0.003, 0.006),
            warp_MPa=rng.uniform(0.001, 0.003),
            offset_deg=rng.uniform(0.2, 0.5),
            colour_deg=rng.uniform(0.1, 0.35),
            colour_s=rng.uniform(0.5, 3.0),
            white_deg=rng.uniform(0.1, 0.3),
            sensor_MPa=rng.uniform(0.0005, 0.0015),
        )

    def variance_deg2(self, pressure_MPa: FloatArray, angle_deg: FloatArray, slope_deg_MPa: FloatArray) -> FloatArray:
        """Of the readings of one sample among samples, to first order."""
        shift = (self.shift_MPa * fade(pressure_MPa)) ** 2
        warp = self.warp_MPa**2 * np.sum(waves(pressure_MPa) ** 2, axis=0)
        readings = self.offset_deg**2 + self.colour_deg**2 + self.white_deg**2
        return (self.gain * angle_deg) ** 2 + slope_deg_MPa**2 * (shift + warp) + readings

    def variance_N2(self, force_N: FloatArray) -> FloatArray:
        return (self.force_gain * force_N) ** 2 + self.force_offset_N**2 + self.force_white_N**2


@dataclass(frozen=True)
class People:
    """What is particular to each of S samples. warp (WAVES, S)."""

    gain: FloatArray
    shift_MPa: FloatArray
    warp_MPa: FloatArray
    force_gain: FloatArray

    @classmethod
    def draw(cls, scatter: Scatter, count: int, rng: np.random.Generator) -> People:
        return cls(
            1 + scatter.gain * rng.standard_normal(count),
            scatter.shift_MPa * rng.standard_normal(count),
            scatter.warp_MPa * rng.standard_normal((WAVES, count)),
            1 + scatter.force_gain * rng.standard_normal(count),
        )

    @classmethod
    def alike(cls, count: int) -> People:
        """All as designed."""
        return cls(np.ones(count), np.zeros(count), np.zeros((WAVES, count)), np.ones(count))

    def deviation_MPa(self, pressure_MPa: FloatArray) -> FloatArray:
        """(T, S): by how much a sample acts as if the pressure were another."""
        if not (np.any(self.shift_MPa) or np.any(self.warp_MPa)):
            return np.zeros_like(pressure_MPa)
        return self.shift_MPa * fade(pressure_MPa) + np.einsum("ks,kts->ts", self.warp_MPa, waves(pressure_MPa))


def fade(pressure_MPa: FloatArray) -> FloatArray:
    """A sample without pressure is straight, whatever its shift."""
    return 1 - np.exp(-np.maximum(pressure_MPa, 0) / 0.02)


def waves(pressure_MPa: FloatArray) -> FloatArray:
    k = np.arange(1, WAVES + 1).reshape(-1, *[1] * pressure_MPa.ndim)
    return np.sin(k * np.pi * np.clip(pressure_MPa, 0, REACH_MPa) / REACH_MPa) / k


def coloured(shape: tuple[int, int], step_s: float, time_s: float, rng: np.random.Generator) -> FloatArray:
    """An Ornstein–Uhlenbeck process of variance 1, stationary from the start: (T, S)."""
    keep = np.exp(-step_s / time_s)
    drive = np.sqrt(1 - keep**2) * rng.standard_normal(shape)
    drive[0] = rng.standard_normal(shape[1])
    return np.asarray(lfilter([1.0], [1.0, -keep], drive, axis=0))
