"""sensor_noise: both sensors are noisy, and are read by the microcontroller's 10-bit converter, n times, averaged.

    V_read = (1/n)·Σ (S/1024)·(½ + ⌊1024/S·(V + σ·g_i)⌋),   clipped to the converter's range, g_i standard normal

σ `flex_sd_V`, `monitor_sd_V`: of one conversion, chosen 6 mV and 5 mV, about one step of the converter (S/1024 = 4.9 mV); not measured.
n `samples`: chosen 16. With noise of about a step, the mean of many conversions is finer than a step (dither); with none it is not.
S: supply, 5 V. The ½ puts a code in the middle of its step. Source of the converter: ATmega328P datasheet.
Numbers come from numpy's PCG64 by the twin's seed, the same for the same order of exchanges.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from benchlab.twin.effects.effect import Effect, Kit, Now, Stage, number
from benchlab.twin.lines import SUPPLY_V

CODES = 1024
_BLOCK = 4096


@dataclass(frozen=True)
class SensorNoise(Effect):
    """White noise, quantised and averaged. Without it both sensors are read exactly."""

    name = "sensor_noise"
    flex_sd_V: float = number(0.006, "V", 0, 1, "σ of one conversion at the flex sensor's divider")
    monitor_sd_V: float = number(0.005, "V", 0, 1, "σ of one conversion at the regulator's monitor output")
    samples: float = number(16, "", 1, 256, "conversions averaged, rounded to a whole number")

    def stages(self, kit: Kit) -> dict[str, Stage]:
        count = round(self.samples)
        return {
            "monitor_V": _Converter(self.monitor_sd_V, count, np.random.default_rng([kit.seed, 1])),
            "flex_V": _Converter(self.flex_sd_V, count, np.random.default_rng([kit.seed, 2])),
        }


class _Converter:
    def __init__(self, sd_V: float, samples: int, rng: np.random.Generator) -> None:
        self.samples = samples
        self.noise = _numbers(rng, sd_V * CODES / SUPPLY_V)

    def __call__(self, value: float, now: Now) -> float:
        level = value * CODES / SUPPLY_V
        noise, total = self.noise, 0
        for _ in range(self.samples):
            code = int(level + next(noise))
            total += 0 if code < 0 else CODES - 1 if code >= CODES else code
        return (total / self.samples + 0.5) * SUPPLY_V / CODES


def _numbers(rng: np.random.Generator, sd: float) -> Iterator[float]:
    while True:
        yield from (sd * rng.standard_normal(_BLOCK)).tolist()
