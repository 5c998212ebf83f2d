"""A few tuning cases, as a user's tables, against the generator's own curves: what is hidden is found, and nothing else."""

from __future__ import annotations

import functools
import itertools
from dataclasses import replace

import numpy as np
import pytest

from benchlab.actuator import ShellDesign
from benchlab.discrepancy.base import Base, DesignBase, Knob
from benchlab.workflows.explain import explain_frame
from tests.blind.cards import FIRST_SEED, Case
from tests.blind.generator.setting import Layout, named
from tests.blind.generator.solved import DESIGNS, LENGTH_MM, NEUTRAL, family
from tests.blind.generator.solved import base as solved
from tests.blind.judge import coverages, outcome, set_returned

KNOBS = {
    "film_modulus": "film_modulus_scale",
    "fabric_modulus": "fabric_modulus_MPa",
    "seam_margin_mm": "seam_even_mm",
}
SMALL = Layout(designs=(0, 1, 3), samples=4)


@functools.cache
def base() -> Base:
    """The solved curves as a simulation, with the knobs that are solved: a bladder of a membrane's stiffness is not among them."""
    found = {}
    for (tw, slw), length in itertools.product(DESIGNS, (LENGTH_MM, 120.0)):
        cell = solved(tw, slw)
        pressure = np.r_[0.0, cell.pressure_MPa]
        angle = np.degrees(np.r_[0.0, cell.angle_rad_per_mm[0]]) * length
        volume = np.r_[np.nan, cell.volume_mm2[0]] * length / 1000
        volume[0] = volume[1] - (volume[2] - volume[1]) / (pressure[2] - pressure[1]) * pressure[1]
        knobs = {name: knob(change, tw, slw, pressure) for name, change in KNOBS.items()}
        name = named(tw, slw, length)
        shape = ShellDesign(slw, tw, length_mm=length)
        found[name] = DesignBase(name, pressure, {"angle_deg": angle, "volume_mL": volume}, shape, knobs)
    return Base(found, "cell", "shell cell, solved for the blind cases")


def knob(change: str, tw_mm: float, slw_mm: float, pressure_MPa: np.ndarray) -> Knob:
    solved_at = family(change, tw_mm, slw_mm)
    neutral = NEUTRAL.get(change, 0.0)
    own = np.interp(pressure_MPa, solved_at.pressure_MPa, solved_at.at(neutral))
    changed = [np.interp(pressure_MPa, solved_at.pressure_MPa, row) for row in solved_at.angle_rad_per_mm]
    factor = np.array(changed) / own
    return Knob(solved_at.values / (neutral or 1.0), {"angle_deg": factor, "volume_mL": np.ones_like(factor)})


def case(number: int, kind: str, names: tuple[str, ...] = (), **more: object) -> Case:
    layout = replace(SMALL, **more.pop("layout", {}))  # type: ignore[arg-type]
    seed = FIRST_SEED["tune"] + 900_000 + number
    return Case(" ".join((kind, *names)), seed, kind, names, (4.0,) * len(names), layout, **more)  # type: ignore[arg-type]


PAIR = {"rival": "end_caps", "forms": (("camera_scale", "longer", True),)}
CASES = [
    (case(1, "null"), "agree"),
    (case(2, "null"), "agree"),
    (case(5, "single", ("viscoelasticity",)), "unique"),
    (case(7, "single", ("dead_pressure",), forms=(("dead_pressure", "form", "kink"),)), "unique"),
    (case(23, "single", ("regulator_lag",), layout={"command": True}), "unique"),
    (case(12, "unknown", ("resonance",)), "unexplained"),
    (case(11, "pair", ("camera_scale",), layout={"runs": ("slow", "fast")}, **PAIR), "in set"),
]


@pytest.mark.parametrize(
    ("hidden", "expected"), CASES, ids=lambda value: value.name if isinstance(value, Case) else value
)
def test_what_is_hidden_is_found_and_nothing_else(hidden: Case, expected: str) -> None:
    study = hidden.study()
    answer = explain_frame(study.frame, study.designs, seed=hidden.seed, base=base(), propose=False)
    assert outcome(hidden, answer) == expected
    if hidden.kind == "pair":
        assert set_returned(hidden, answer)
    if hidden.truth:
        assert answer["gap"]["heldout_after"] < 1.15 * answer["gap"]["noise_floor"] < answer["gap"]["heldout_before"]
        assert all(one.covered for one in coverages(hidden, study.answer, answer))
