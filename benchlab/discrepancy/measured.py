"""What was measured: runs of samples of designs, or a table of means."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

from benchlab.units import FloatArray

QUANTITIES = {"angle_deg": "°", "force_N": "N", "volume_mL": "mL", "flex_V": "V"}
"""What can be compared, with the unit as it is printed."""


@dataclass(frozen=True)
class Run:
    """One execution on one sample; arrays are (N,), in the order of time, NaN where nothing was measured.

    pressure_MPa: as recorded at the regulator. command_MPa: as asked for. values: by names of QUANTITIES (or of columns named by
    the user). sd: standard deviation of a value, where it is known, by the same names. cycle: from 1, None where it is not told.
    run_index: order of the run on its sample, None where it is not known. start_s: when it began, of the session.
    orientation_deg: of the mounting: 0 hangs down, 90 level and bending upwards, 180 stands. against: further columns named by the user.
    """

    design: str
    sample: str
    run: str
    time_s: FloatArray
    pressure_MPa: FloatArray
    values: Mapping[str, FloatArray]
    command_MPa: FloatArray | None = None
    cycle: FloatArray | None = None
    sd: Mapping[str, FloatArray] = field(default_factory=dict)
    run_index: float | None = None
    start_s: float | None = None
    orientation_deg: float | None = None
    temperature_C: FloatArray | None = None
    against: Mapping[str, FloatArray | str] = field(default_factory=dict)


@dataclass(frozen=True)
class Measured:
    """Runs, sorted by design, sample, run_index and name. source: in words. simulated: whether they came from a twin or were drawn."""

    runs: tuple[Run, ...]
    source: str
    simulated: bool = False
    warnings: tuple[str, ...] = ()

    @property
    def designs(self) -> tuple[str, ...]:
        return tuple(sorted({run.design for run in self.runs}))


@dataclass(frozen=True)
class Summary:
    """A table of means, (N,) each: design, pressure_MPa, mean of `quantity`, sd between samples, number of samples."""

    design: tuple[str, ...]
    pressure_MPa: FloatArray
    mean: FloatArray
    sd: FloatArray
    n: FloatArray
    quantity: str
    source: str
    warnings: tuple[str, ...] = ()
