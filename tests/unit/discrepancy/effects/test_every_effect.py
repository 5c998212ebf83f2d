"""What holds for every effect and every form of it."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from functools import cache
from pathlib import Path

import numpy as np
import pytest

from benchlab.discrepancy.base import KNOBS
from benchlab.discrepancy.effects import effect as module
from benchlab.discrepancy.effects.catalogue import built_in, faults
from benchlab.discrepancy.effects.effect import Active, Effect
from benchlab.discrepancy.predict import predict
from benchlab.discrepancy.scene import Scene
from tests.unit.discrepancy.scenes import base, scene

QUANTITIES = ("angle_deg", "volume_mL", "force_N", "flex_V")
VOCABULARY = [
    "viscoelasticity",
    "softening",
    "friction",
    "seam_margin",
    "bladder_stiffness",
    "fabric_compliance",
    "end_caps",
    "dead_pressure",
    "gravity",
    "leakage",
    "regulator_lag",
    "line_resistance",
    "pressure_gain",
    "pressure_offset",
    "camera_scale",
    "camera_tilt",
    "marker_offset",
    "clock_offset",
    "frame_compliance",
    "flex_hysteresis",
    "temperature",
    "window_ballooning",
]

EVERY = list(built_in().values())
EVERY_FORM = [pytest.param(effect, form, id=f"{effect.name}-{form}") for effect in EVERY for form in effect.forms]


def typical(effect: Effect) -> dict[str, float]:
    return {parameter.name: parameter.typical for parameter in effect.parameters}


def neutral(effect: Effect) -> dict[str, float]:
    return {p.name: p.typical if p.neutral is None else p.neutral for p in effect.parameters}


def scene_for(effect: Effect, points: int = 1) -> Scene:
    """Where every effect can show: ordered runs 100 s apart, and a beam for the one that needs it."""
    return _scene("beam" if effect.name == "window_ballooning" else "cell", points)


@cache
def _scene(kind: str, points: int) -> Scene:
    return scene(designs=3, samples=1, on=base(3, kind=kind), start_s=0.0, points=points, orientation_deg=30.0)


def given(effect: Effect, form: str, on: Scene, values: Mapping[str, float]) -> dict[str, np.ndarray]:
    return predict(on, [Active(effect, values, form)], QUANTITIES)


def test_the_catalogue_is_the_vocabulary_in_its_order() -> None:
    assert list(built_in()) == VOCABULARY


def test_each_stands_in_a_file_of_its_name() -> None:
    folder = Path(module.__file__).parent
    files = {path.stem for path in folder.glob("*.py")} - {"__init__", "effect", "catalogue", "foreign"}
    assert files == set(VOCABULARY)
    for effect in EVERY:
        assert type(effect).__module__.rsplit(".", 1)[1] == effect.name


@pytest.mark.parametrize("effect", EVERY, ids=lambda effect: effect.name)
def test_is_complete_and_within_its_bounds(effect: Effect) -> None:
    assert faults(effect) == ""
    assert effect.forms[0] == "plain"
    assert len(set(effect.forms)) == len(effect.forms)
    for parameter in effect.parameters:
        starts = np.array(parameter.starts)
        assert 2 <= len(starts) <= 6
        assert np.all(np.diff(starts) > 0)
        if parameter.neutral is not None and parameter.low < parameter.neutral < parameter.high:
            assert starts[0] < parameter.neutral < starts[-1], "both signs, where both may be"


@pytest.mark.parametrize(("effect", "form"), EVERY_FORM)
def test_at_its_neutral_values_nothing_changes(effect: Effect, form: str) -> None:
    on = scene_for(effect)
    bare = predict(on, [], QUANTITIES)
    for quantity, values in given(effect, form, on, neutral(effect)).items():
        assert np.array_equal(values, bare[quantity]), quantity


@pytest.mark.parametrize(("effect", "form"), EVERY_FORM)
def test_typical_values_change_what_it_says_and_nothing_else(effect: Effect, form: str) -> None:
    on = scene_for(effect)
    bare, changed = predict(on, [], QUANTITIES), given(effect, form, on, typical(effect))
    assert effect.cannot_show(on) == ""
    moved = {q: float(np.abs(changed[q] - bare[q])[on.real].max()) for q in QUANTITIES}
    shown = {q for q in QUANTITIES if moved[q] > 0.002 * float(np.abs(bare[q]).max())}
    assert shown
    if (effect.name, form) != ("temperature", "on the angle"):
        assert {q for q in QUANTITIES if moved[q] > 0} == set(effect.seen_in)


@pytest.mark.parametrize(("effect", "form"), EVERY_FORM)
def test_bounds_give_numbers(effect: Effect, form: str) -> None:
    on = scene_for(effect)
    for end in ("low", "high"):
        values = {p.name: getattr(p, end) for p in effect.parameters}
        assert all(np.isfinite(found).all() for found in given(effect, form, on, values).values()), end


@pytest.mark.parametrize(("effect", "form"), EVERY_FORM)
def test_small_steps_of_a_parameter_change_little(effect: Effect, form: str) -> None:
    """From neutral and from typical: a step of a thousandth of the range moves by no more than 5 % of the largest values."""
    on = scene_for(effect)
    size = {q: float(np.abs(v).max()) for q, v in predict(on, [], QUANTITIES).items()}
    for centre in (neutral(effect), typical(effect)):
        before = given(effect, form, on, centre)
        for p in effect.parameters:
            step = 1e-3 * (p.high - p.low)
            value = centre[p.name] + (step if centre[p.name] + step <= p.high else -step)
            after = given(effect, form, on, {**centre, p.name: value})
            for quantity in QUANTITIES:
                assert np.abs(after[quantity] - before[quantity]).max() <= 0.05 * size[quantity], (p.name, quantity)


@pytest.mark.parametrize(("effect", "form"), EVERY_FORM)
def test_points_behind_the_end_of_a_run_do_nothing(effect: Effect, form: str) -> None:
    on = scene_for(effect)
    longer = {
        name: np.concatenate([getattr(on, name), np.repeat(getattr(on, name)[-1:], 17, axis=0)])
        for name in ("time_s", "pressure_MPa", "command_MPa", "temperature_C")
    }
    padded = replace(on, **longer, real=np.concatenate([on.real, np.zeros((17, on.real.shape[1]), bool)]))
    short, long = given(effect, form, on, typical(effect)), given(effect, form, padded, typical(effect))
    for quantity in QUANTITIES:
        assert np.array_equal(short[quantity][on.real], long[quantity][: len(on.real)][on.real]), quantity
        still = long[quantity][-17:] == long[quantity][-18]
        assert still.all(), quantity


@pytest.mark.parametrize(("effect", "form"), EVERY_FORM)
def test_cutting_the_steps_of_time_changes_nothing(effect: Effect, form: str) -> None:
    """Steps cut in four: within 0.1 % of the largest values (the curve of the base bends within a step)."""
    coarse, fine = scene_for(effect), scene_for(effect, points=4)
    one, four = given(effect, form, coarse, typical(effect)), given(effect, form, fine, typical(effect))
    last = coarse.real.sum(axis=0) - 1
    for run, end in enumerate(last):
        for quantity in QUANTITIES:
            a, b = one[quantity][: end + 1, run], four[quantity][: 4 * end + 1 : 4, run]
            tolerance = 1e-3 * np.abs(one[quantity]).max()
            if effect.name == "softening":
                tolerance *= 4  # ways smaller than SMALLEST_MOVE begin to count a step earlier or later
            assert np.abs(a - b).max() <= tolerance, (quantity, run)


@pytest.mark.parametrize(("effect", "form"), EVERY_FORM)
def test_the_order_of_columns_does_not_matter(effect: Effect, form: str) -> None:
    on = scene_for(effect)
    turn = np.random.default_rng(0).permutation(len(on.design))
    columns = ("time_s", "pressure_MPa", "command_MPa", "temperature_C", "real")
    rows = ("design", "sample", "order", "start_s", "orientation_deg")
    turned = replace(
        on, **{name: getattr(on, name)[:, turn] for name in columns}, **{name: getattr(on, name)[turn] for name in rows}
    )
    straight, other = given(effect, form, on, typical(effect)), given(effect, form, turned, typical(effect))
    for quantity in QUANTITIES:
        np.testing.assert_allclose(other[quantity], straight[quantity][:, turn], rtol=1e-12, atol=1e-12)


@pytest.mark.parametrize("effect", EVERY, ids=lambda effect: effect.name)
def test_knobs_are_known(effect: Effect) -> None:
    on = scene_for(effect)
    at = module.At(on, typical(effect), "plain", on.pressure_MPa, on.pressure_MPa)
    assert set(effect.knobs(at)) <= set(KNOBS)
