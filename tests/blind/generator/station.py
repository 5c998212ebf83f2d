"""Who stands at the bench during a run, and when."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

FloatArray = NDArray[np.float64]


@dataclass(frozen=True)
class Sample:
    """One made actuator. design: its name in the tables."""

    design: str
    sample: str
    tw_mm: float
    slw_mm: float
    length_mm: float


@dataclass
class Station:
    """A run of all S samples, T times.

    time_s (T,) from the start of the run; start_s (S,) in the session; orientation_deg (S,); ordinal (S,): which run of the sample it is,
    from 1, or 1 always where the order is not known. shut (T,): the valve between regulator and actuator is closed.
    temperature_C (T, S). memory: what an actuator has been through, under the effect's name; carried from run to run where they are
    ordered.
    """

    time_s: FloatArray
    samples: tuple[Sample, ...]
    start_s: FloatArray
    orientation_deg: FloatArray
    ordinal: int
    shut: NDArray[np.bool_]
    temperature_C: FloatArray
    memory: dict[str, FloatArray] = field(default_factory=dict)

    @property
    def shape(self) -> tuple[int, int]:
        return len(self.time_s), len(self.samples)

    @property
    def step_s(self) -> FloatArray:
        """(T,), the first 0."""
        return np.diff(self.time_s, prepend=self.time_s[0])

    @property
    def length_mm(self) -> FloatArray:
        return np.array([sample.length_mm for sample in self.samples])

    @property
    def session_s(self) -> FloatArray:
        """(T, S)"""
        return self.time_s[:, None] + self.start_s

    def designs(self) -> dict[tuple[float, float, float], NDArray[np.int64]]:
        """Columns of each (tw, slw, length)."""
        found: dict[tuple[float, float, float], list[int]] = {}
        for column, one in enumerate(self.samples):
            found.setdefault((one.tw_mm, one.slw_mm, one.length_mm), []).append(column)
        return {key: np.array(columns) for key, columns in found.items()}
