"""Curves of the shell cell as it is, and with something about it changed: solved once, kept in solved.csv beside this file.

`python -m tests.blind.generator.solved` solves them all anew (some minutes on two cores). Columns: what is changed, its value, the design,
pressure, angle per length, volume per length and straight-held moment (blank where it was not asked for).
"""

from __future__ import annotations

import functools
import sys
from collections.abc import Iterator
from concurrent.futures import ProcessPoolExecutor
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
from scipy.interpolate import CubicSpline, PchipInterpolator

from benchlab.actuator import ShellDesign
from benchlab.io.layup_file import read_layup
from benchlab.simulation.actuator_response import actuator_response
from benchlab.simulation.laws import Polynomial

FILE = Path(__file__).with_name("solved.csv")
FILM = "from-measured-angles"
DESIGNS = ((3.0, 5.0), (3.0, 10.0), (3.0, 20.0), (9.0, 10.0), (15.0, 10.0))
"""The published (tw, slw), mm."""
PRESSURES_MPa = np.round(np.r_[0.006, 0.0125, np.arange(0.025, 0.4501, 0.025)], 4)
LENGTH_MM = 180.0

GRIDS: dict[str, tuple[float, ...]] = {
    "film_modulus_scale": (0.75, 0.85, 0.93, 1.0, 1.08, 1.18),
    "seam_even_mm": (0.0, 0.08, 0.16, 0.3, 0.5),
    "seam_around_mm": (0.0, 0.08, 0.16, 0.3, 0.5),
    "seam_along_mm": (0.0, 0.08, 0.16, 0.3, 0.5),
    "bladder_film_MPa": (0.0, 0.15, 0.4, 0.8, 1.4),
    "bladder_spring_Nmm2": (0.0, 700.0, 2000.0, 4500.0, 9000.0),
    "fabric_modulus_MPa": (150.0, 220.0, 320.0, 498.0, 700.0, 1000.0, 1500.0),
}
"""Values at which each change is solved; between them a cubic in the value (of the modulus: in its logarithm)."""
NEUTRAL = {"film_modulus_scale": 1.0, "fabric_modulus_MPa": 498.0}
UNEVEN = 1.8
"""seam_around: the margin around is so much the one along; seam_along: the other way round."""


@dataclass(frozen=True)
class Family:
    """Curves of one design under one change. angle_rad_per_mm (V, P) and volume_mm2 (V, P) over values (V,) and pressures (P,)."""

    values: np.ndarray
    pressure_MPa: np.ndarray
    angle_rad_per_mm: np.ndarray
    volume_mm2: np.ndarray
    moment_Nmm: np.ndarray
    logarithmic: bool

    def at(self, value: float) -> np.ndarray:
        """Angle per length (P,), rad/mm."""
        x = np.log(self.values) if self.logarithmic else self.values
        v = np.log(value) if self.logarithmic else value
        if not x[0] - 1e-9 <= v <= x[-1] + 1e-9:
            raise ValueError(f"{value:g} lies outside of {self.values[0]:g} to {self.values[-1]:g}")
        return np.asarray(CubicSpline(x, self.angle_rad_per_mm, axis=0)(v))


@functools.cache
def family(change: str, tw_mm: float, slw_mm: float) -> Family:
    rows = _table().loc[(change, tw_mm, slw_mm)]
    values = np.unique(rows["value"])
    block = {
        name: rows.pivot(index="value", columns="pressure_MPa", values=name).to_numpy(float)
        for name in ("angle_rad_per_mm", "volume_mm2", "moment_Nmm")
    }
    pressures = np.unique(rows["pressure_MPa"])
    here = np.isfinite(block["angle_rad_per_mm"]).all(axis=0)
    return Family(
        values, pressures[here], *(b[:, here] for b in block.values()), logarithmic=change == "fabric_modulus_MPa"
    )


@functools.cache
def base(tw_mm: float, slw_mm: float) -> Family:
    """The cell as it is, with the straight-held moment: one value."""
    found = family("film_modulus_scale", tw_mm, slw_mm)
    one = found.values == 1.0
    return Family(
        found.values[one],
        found.pressure_MPa,
        found.angle_rad_per_mm[one],
        found.volume_mm2[one],
        found.moment_Nmm[one],
        False,
    )


def curve_deg(pressure_MPa: np.ndarray, angle_rad_per_mm: np.ndarray, length_mm: float) -> PchipInterpolator:
    """Angle in degrees over pressure, 0 at 0, straight on beyond the last pressure."""
    p = np.r_[0.0, pressure_MPa]
    a = np.degrees(np.r_[0.0, angle_rad_per_mm]) * length_mm
    ends = p[-1] + np.array([0.1, 0.2])
    slope = (a[-1] - a[-2]) / (p[-1] - p[-2])
    return PchipInterpolator(np.r_[-0.1, p, ends], np.r_[-0.1 * a[1] / p[1], a, a[-1] + slope * (ends - p[-1])])


@functools.cache
def _table() -> pd.DataFrame:
    return pd.read_csv(FILE).set_index(["change", "tw_mm", "slw_mm"]).sort_index()


def _changed(change: str, value: float, tw: float, slw: float) -> dict[str, Any]:
    """Arguments of actuator_response."""
    layup, design, terms = read_layup(FILM), ShellDesign(slw, tw, length_mm=LENGTH_MM), ()
    film = layup.film
    assert isinstance(film, Polynomial)
    if change == "film_modulus_scale":
        layup = replace(layup, film=Polynomial(**{name: value * c for name, c in vars(film).items()}))
    elif change.startswith("seam"):
        along = value * (UNEVEN if change == "seam_along_mm" else 1)
        around = value * (UNEVEN if change == "seam_around_mm" else 1)
        design = replace(
            design, strip_width_mm=slw + 2 * around, window_width_mm=tw - 2 * along, rib_width_mm=2 + 2 * along
        )
    elif change == "bladder_film_MPa":
        layup = replace(layup, film=replace(film, C10=film.C10 + value))
    elif change == "fabric_modulus_MPa":
        layup = replace(layup, fabric=replace(layup.fabric, youngs_modulus_MPa=value))
    elif value:
        half = (tw + 2) / 2

        def spring(k: float, lam: float) -> tuple[float, np.ndarray, np.ndarray]:
            stiff = value * half / 2  # ½ B k² over the cell, a quarter of it
            return stiff * k * k / 2, np.array([stiff * k, 0.0]), np.array([[stiff, 0.0], [0.0, 0.0]])

        terms = (spring,)
    return {"design": design, "layup": layup, "terms": terms}


def _solve(job: tuple[str, float, float, float]) -> pd.DataFrame:
    change, value, tw, slw = job
    asked = _changed(change, value, tw, slw)
    blocked = change == "film_modulus_scale" and value == 1.0
    found = actuator_response(asked["design"], asked["layup"], PRESSURES_MPa, blocked=blocked, terms=asked["terms"])
    print(*job, len(found.pressure_MPa), f"{found.seconds:.1f} s", file=sys.stderr)
    return pd.DataFrame(
        {
            "change": change,
            "value": value,
            "tw_mm": tw,
            "slw_mm": slw,
            "pressure_MPa": found.pressure_MPa,
            "angle_rad_per_mm": found.angle_rad / LENGTH_MM,
            "volume_mm2": found.volume_mm3 / LENGTH_MM,
            "moment_Nmm": found.moment_Nmm,
        }
    )


def _jobs() -> Iterator[tuple[str, float, float, float]]:
    for change, values in GRIDS.items():
        for value in values:
            if value == NEUTRAL.get(change, 0.0) and change != "film_modulus_scale":
                continue  # the same cell: copied below
            for tw, slw in DESIGNS:
                yield change, value, tw, slw


def solve_all(processes: int = 2) -> pd.DataFrame:
    with ProcessPoolExecutor(processes) as pool:
        rows = pd.concat(pool.map(_solve, _jobs()))
    as_it_is = rows[(rows.change == "film_modulus_scale") & (rows.value == 1.0)]
    copies = [
        as_it_is.assign(change=change, value=NEUTRAL.get(change, 0.0), moment_Nmm=np.nan)
        for change in GRIDS
        if change != "film_modulus_scale"
    ]
    return pd.concat([rows, *copies]).sort_values(["change", "value", "tw_mm", "slw_mm", "pressure_MPa"])


if __name__ == "__main__":
    solve_all().to_csv(FILE, index=False, float_format="%.7g")
