"""One design of many, simulated: what a sweep and an inverse design hand to their workers."""

from __future__ import annotations

import functools
import hashlib
import json
from dataclasses import asdict, dataclass
from importlib.resources import files
from importlib.resources.abc import Traversable
from typing import Any

import numpy as np
from threadpoolctl import threadpool_limits

import benchlab
from benchlab.actuator import ShellDesign
from benchlab.errors import InputError
from benchlab.io.layup_file import layup_document
from benchlab.simulation.actuator_response import Fixture, actuator_response
from benchlab.simulation.film_strain import peak_film_strain
from benchlab.simulation.layup import Layup
from benchlab.simulation.response import check_pressures


@dataclass(frozen=True)
class Conditions:
    """What is the same for all designs. blocked: they are also held straight. Raises UsageError for impossible pressures."""

    layup: Layup
    pressures_MPa: tuple[float, ...]
    fixture: Fixture
    cap_mm: float = 0.0
    blocked: bool = True

    def __post_init__(self) -> None:
        check_pressures(self.pressures_MPa)

    def as_json(self) -> dict[str, Any]:
        return {
            "material": layup_document(self.layup),
            "pressures_MPa": list(self.pressures_MPa),
            "fixture": asdict(self.fixture),
            "cap_mm": self.cap_mm,
            "blocked": self.blocked,
        }

    def key(self, design: ShellDesign) -> str:
        """One number for all that the result follows from: design, conditions, and the code that computes it."""
        whole = json.dumps([asdict(design), self.as_json(), code_digest()], sort_keys=True)
        return hashlib.sha256(whole.encode()).hexdigest()


def simulate_design(design: ShellDesign, conditions: Conditions) -> dict[str, Any]:
    """Response of a design, in this process or in a worker, on one thread.

    `columns`: (P,) arrays under the names of files, NaN where there is no stable state; `limit_pressure_MPa`; `seconds`.
    Raises InputError where no pressure has a stable state.
    """
    with threadpool_limits(1):
        found = actuator_response(
            design,
            conditions.layup,
            conditions.pressures_MPa,
            conditions.fixture,
            conditions.cap_mm,
            blocked=conditions.blocked,
        )
        strain = np.array([peak_film_strain(found.cell, point.state) for point in found.free.points])
    if not len(found.pressure_MPa):
        raise InputError(
            f"{design.name} has no stable state at {conditions.pressures_MPa[0]:g} MPa",
            hint="begin --pressure-MPa lower, take a stiffer --material, or check dimensions and thicknesses",
        )
    columns = {**found.columns(), "peak_film_strain": strain}
    missing = len(conditions.pressures_MPa) - len(strain)
    return {
        "columns": {name: np.append(values, np.full(missing, np.nan)) for name, values in columns.items()},
        "limit_pressure_MPa": found.limit_pressure_MPa,
        "seconds": found.seconds,
    }


@functools.cache
def code_digest() -> str:
    """SHA-256 of the simulation's own source, so that a result of other code is not taken for one of this."""
    digest = hashlib.sha256(benchlab.__version__.encode())
    for name, content in sorted(_sources(files("benchlab") / "simulation")):
        digest.update(f"{name}\0".encode() + content)
    return digest.hexdigest()


def _sources(folder: Traversable) -> list[tuple[str, bytes]]:
    found = []
    for item in folder.iterdir():
        if item.is_dir():
            found += _sources(item)
        elif item.name.endswith(".py"):
            found.append((item.name, item.read_bytes()))
    return found
