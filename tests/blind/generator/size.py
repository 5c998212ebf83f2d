"""How strong: an effect's RMS shift of the mean against the noise floor, and the size at which it has a wanted one."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from tests.blind.generator.bench import angles, forces, plain_curve, pressures
from tests.blind.generator.hidden.hidden import Hidden
from tests.blind.generator.runs import Run
from tests.blind.generator.scatter import People, Scatter
from tests.blind.generator.setting import Setting
from tests.blind.generator.station import FloatArray

CLOSE = 0.01
"""Part of the target within which the search ends."""


def clean(setting: Setting, hidden: Sequence[Hidden], substeps: int = 1) -> list[tuple[Run, FloatArray]]:
    """What would be read of samples that are all as designed, without noise: (T, S) for each run."""
    everyone = People.alike(len(setting.samples))
    memory: dict[str, FloatArray] = {}
    found = []
    for run, at in setting.stations(substeps):
        at.memory = memory if setting.layout.ordered else {}
        _, p = pressures(run.command_MPa(at.time_s), hidden, at)
        read = forces if run.blocked else angles
        found.append((run, read(p, everyone, hidden, at)))
    return found


def noise_floor(setting: Setting, scatter: Scatter, quantity: str = "angle_deg") -> float:
    """RMS, over the points of the runs and designs, of the SD of the mean over the samples of a design where nothing is hidden.

    Runs count alike, whatever the number of their readings.
    """
    setting, samples = setting.thinned(), setting.layout.samples
    parts = []
    for (run, read), (_, at) in zip(clean(setting, ()), setting.stations(1)):
        p = run.command_MPa(at.time_s)
        if run.blocked and quantity == "force_N":
            parts += [scatter.variance_N2(read[:, c[0]]).mean() for c in at.designs().values()]
        if not run.blocked and quantity == "angle_deg":
            for design, columns in at.designs().items():
                slope = plain_curve(*design).derivative()(p)
                parts.append(scatter.variance_deg2(p, read[:, columns[0]], slope).mean())
    return float(np.sqrt(np.mean(parts) / samples))


def shift(setting: Setting, one: Hidden) -> float:
    """RMS over runs, points and designs of what an effect changes in the mean of a design's samples."""
    return _Shifts(setting, one).of(one)


class _Shifts:
    """Shifts of an effect of different sizes; what is read without it is worked out once."""

    def __init__(self, setting: Setting, one: Hidden) -> None:
        self.setting = setting if one.by_sample else setting.thinned()
        self.blocked = one.quantity == "force_N"
        self.without = clean(self.setting, ())
        self.designs = list(self.setting.stations(1)[0][1].designs().values())

    def of(self, one: Hidden) -> float:
        squares = [
            np.mean((with_it - without)[:, columns].mean(axis=1) ** 2)
            for (run, with_it), (_, without) in zip(clean(self.setting, [one]), self.without)
            for columns in self.designs
            if run.blocked == self.blocked
        ]
        return max(float(np.sqrt(np.mean(squares))), 1e-9)


def sized(one: Hidden, setting: Setting, target: float) -> tuple[Hidden, float]:
    """The effect at the size at which its shift is the target, or at its bound where that is less; and its shift.

    Regula falsi on the logarithms, kept within a bracket.
    """
    low, high = one.bounds
    shifts = _Shifts(setting, one)
    tries = {low: shifts.of(one.sized(low))}
    size = one.typical
    for _ in range(14):
        tries[size] = shifts.of(one.sized(size))
        if abs(tries[size] / target - 1) < CLOSE or (size == high and tries[size] < target):
            break
        below = max((s for s, found in tries.items() if found < target), default=low)
        above = min((s for s, found in tries.items() if found >= target and s > below), default=None)
        if above is None:
            size = min(high, size * min(8.0, 1.15 * target / tries[size]))
            continue
        slope = np.log(tries[above] / tries[below]) / np.log(above / below)
        inner = below * (target / tries[below]) ** (1 / max(slope, 0.05))
        size = float(np.clip(inner, below * (above / below) ** 0.05, above * (below / above) ** 0.05))
    best = min(tries, key=lambda s: abs(np.log(tries[s] / target)))
    return one.sized(best), tries[best]
