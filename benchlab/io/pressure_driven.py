"""Time and pressure out of a drive file, and when the camera was triggered."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np

from benchlab.io.drive_file import origin, read_drive_file, trigger_times_s, unfit_words
from benchlab.units import FloatArray


@dataclass(frozen=True)
class DrivenPressure:
    """time_s, pressure_MPa: (T,) of a run. trigger_s: of its camera, the first; None without one. warnings: what it is and is not."""

    time_s: FloatArray
    pressure_MPa: FloatArray
    trigger_s: float | None
    warnings: list[str]


def read_driven_pressure(path: Path) -> DrivenPressure:
    """The pressure measured in a run or, where none was, what was asked for, which a warning says. Raises as `read_drive_file`."""
    run = read_drive_file(path)
    warnings = [f"{path.name}: lost {words}" for words in run.losses_told]
    if words := origin(run.header):
        warnings.append(f"{path.name} is no run on a bench of metal: {words}")
    if words := unfit_words(run):
        warnings.append(f"{path.name}: {words}")
    field = "pressure_MPa"
    if not np.isfinite(run.samples[field]).any():
        field = "command_MPa"
        warnings.append(f"no pressure was measured in {path.name}: the pressure is what was asked for")
    triggers = trigger_times_s(run)
    if len(triggers) > 1:
        warnings.append(f"the camera was triggered {len(triggers)} times in {path.name}: the first trigger counts")
    trigger_s = float(triggers[0]) if len(triggers) else None
    time_s, pressure = (np.asarray(run.samples[name], dtype=float) for name in ("time_s", field))
    later = np.diff(time_s, prepend=-np.inf) > 0  # a vented bench is looked at again at the moment of the last tick
    return DrivenPressure(time_s[later], pressure[later], trigger_s, warnings)
