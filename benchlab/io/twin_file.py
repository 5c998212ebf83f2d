"""Twin files: curve, effects, seed and camera of a simulated bench as strict YAML; and the twin that comes with benchlab."""

from __future__ import annotations

from importlib.resources import as_file, files
from pathlib import Path

import numpy as np

from benchlab.errors import UsageError
from benchlab.io.response_file import read_response_curves
from benchlab.twin.curve import ResponseCurve
from benchlab.twin.settings import TwinSettings

SHIPPED_CURVE = "tw3_slw10"


def read_twin(path: Path | None) -> TwinSettings:
    """The twin of a file, or where None the one that comes with benchlab: tw 3 mm, slw 10 mm, typical effects, seed 1.

    >>> sorted(read_twin(None).effects)[:2]
    ['dac_steps', 'regulator_lag']
    """
    if path is None:
        return TwinSettings(shipped_curve(), design=SHIPPED_CURVE)
    raise UsageError("twin files are not read yet", file=path)


def shipped_curve() -> ResponseCurve:
    """The curve of tw 3 mm, slw 10 mm in benchlab/curves: simulated, not measured."""
    with as_file(files("benchlab") / "curves" / f"{SHIPPED_CURVE}.csv") as file:
        return read_curve(file, f"{SHIPPED_CURVE}, simulated (benchlab/curves)")


def read_curve(path: Path, source: str = "") -> ResponseCurve:
    """A file of `benchlab simulate`, HDF5 or table. Rows without an angle are left out. UsageError or InputError."""
    curves = read_response_curves(path)
    known = np.isfinite(curves.angle_deg)
    pressure, angle = curves.pressure_MPa[known], curves.angle_deg[known]
    volume, stretch = curves.volume_mL[known], curves.axial_stretch[known]
    return ResponseCurve(pressure, angle, volume, stretch, source or str(path))
