"""One design of many, simulated: what a sweep and an inverse design hand to their workers."""

from __future__ import annotations

import functools
import hashlib
import json
from dataclasses import asdict, dataclass
from importlib.resources import files
from importlib.resources.abc import Traversable
from typing import TYPE_CHECKING, Any

import numpy as np
from threadpoolctl import threadpool_limits

import benchlab
from benchlab.actuator import ShellDesign
from benchlab.errors import InputError, UsageError
from benchlab.io.layup_file import layup_document
from benchlab.simulation.actuator_response import Fixture, actuator_response
from benchlab.simulation.film_strain import peak_film_strain
from benchlab.simulation.layup import Layup
from benchlab.simulation.response import check_pressures

if TYPE_CHECKING:
    from benchlab.workflows.model_curves import Model


@dataclass(frozen=True)
class Conditions:
    """What is the same for all designs. blocked: they are also held straight. model: whose curves are wanted, instead of the cell's alone;
    its layup is `layup`. Raises UsageError for impossible pressures, and for caps beside a model."""

    layup: Layup
    pressures_MPa: tuple[float, ...]
    fixture: Fixture
    cap_mm: float = 0.0
    blocked: bool = True
    model: Model | None = None

    def __post_init__(self) -> None:
        check_pressures(self.pressures_MPa)
        if self.model is not None and self.cap_mm:
            hint = "put end_caps into the model, or leave --cap-mm out"
            raise UsageError("--cap-mm and --model are both given, and a model has its own ends", hint=hint)

    def as_json(self) -> dict[str, Any]:
        return {
            **({} if self.model is None else {"model": self.model.as_json()}),
            "material": layup_document(self.layup),
            "pressures_MPa": list(self.pressures_MPa),
            "fixture": asdict(self.fixture),
            "cap_mm": self.cap_mm,
            "blocked": self.blocked,
        }

    def key(self, design: ShellDesign) -> str:
        """One number for all that the result follows from: design, conditions, and the code that computes it."""
        rooms = ("simulation",) if self.model is None else ("simulation", "discrepancy")
        whole = json.dumps([asdict(design), self.as_json(), code_digest(*rooms)], sort_keys=True)
        return hashlib.sha256(whole.encode()).hexdigest()


def simulate_design(design: ShellDesign, conditions: Conditions) -> dict[str, Any]:
    """Response of a design, in this process or in a worker, on one thread.

    `columns`: (P,) arrays under the names of files, NaN where there is no stable state; `limit_pressure_MPa`; `seconds`.
    Raises InputError where no pressure has a stable state.
    """
    if conditions.model is not None:
        from benchlab.workflows.simulate_model import model_columns

        return model_columns(design, conditions)
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
def code_digest(*rooms: str) -> str:
    """SHA-256 of the simulation's own source, or that of `rooms`, so that a result of other code is not taken for one of this."""
    digest = hashlib.sha256(benchlab.__version__.encode())
    for room in rooms or ("simulation",):
        for name, content in sorted(_sources(files("benchlab") / room)):
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
