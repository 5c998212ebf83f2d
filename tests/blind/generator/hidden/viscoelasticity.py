"""The material creeps: two or three Prony terms, or a power law in time, on the pressure or on the angle."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar, Self

import numpy as np
from scipy.signal import fftconvolve, lfilter

from tests.blind.generator.hidden.hidden import Hidden
from tests.blind.generator.station import FloatArray, Station


@dataclass(frozen=True)
class Viscoelasticity(Hidden):
    """form: prony on the pressure or on the angle, or power (creep in proportion to t^exponent, on the angle).

    size: sum of the Prony shares, or creep after 1 s over the immediate answer. slow: the simulated curve is what is reached in the end;
    otherwise it is the immediate answer. times_s, shares: of the Prony terms, shares summing to 1.
    """

    form: str
    slow: bool
    times_s: tuple[float, ...]
    shares: tuple[float, ...]
    exponent: float
    name: ClassVar[str] = "viscoelasticity"
    bounds: ClassVar[tuple[float, float]] = (1e-4, 0.8)
    typical: ClassVar[float] = 0.08

    @classmethod
    def draw(cls, rng: np.random.Generator) -> Self:
        terms = int(rng.integers(2, 4))
        times = np.sort(np.exp(rng.uniform(np.log(0.5), np.log(40), terms)))
        shares = rng.dirichlet(np.full(terms, 3.0))
        form = str(rng.choice(["prony-pressure", "prony-angle", "power"]))
        return cls(
            cls.typical, form, bool(rng.integers(2)), tuple(times), tuple(shares), exponent=rng.uniform(0.15, 0.35)
        )

    def effective(self, inside: FloatArray, at: Station) -> FloatArray:
        return self._prony(inside, at) if self.form == "prony-pressure" else inside

    def bent(self, angle: FloatArray, effective: FloatArray, at: Station) -> FloatArray:
        if self.form == "prony-angle":
            return self._prony(angle, at)
        if self.form == "power":
            steps = np.diff(angle, axis=0, prepend=angle[:1])
            creep = (at.time_s - at.time_s[0]) ** self.exponent
            grown = fftconvolve(steps, creep[:, None], axes=0)[: len(angle)]
            # At the end of half a minute the curve is reached, or it is the immediate answer.
            immediate = 1 - self.size * 30.0**self.exponent if self.slow else 1.0
            return immediate * angle + self.size * grown
        return angle

    def _prony(self, x: FloatArray, at: Station) -> FloatArray:
        step = at.time_s[1] - at.time_s[0]
        late = np.zeros_like(x)
        for time, share in zip(self.times_s, self.shares):
            keep = np.exp(-step / time)
            late += share * lfilter([(1 - keep) / 2, (1 - keep) / 2], [1, -keep], x, axis=0)
        return x + self.size * (late - x) if self.slow else x + self.size * late
