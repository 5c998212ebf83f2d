"""Effects with a memory of the way: friction, softening, the flex sensor's loop."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from benchlab.discrepancy.effects.catalogue import built_in
from benchlab.discrepancy.effects.effect import Active
from benchlab.discrepancy.predict import predict
from benchlab.discrepancy.scene import Scene
from tests.unit.discrepancy.scenes import base, scene

EFFECTS = built_in()
FRICTION = EFFECTS["friction"].forms
SOFTENING = EFFECTS["softening"].forms


def angle(name: str, on: Scene, form: str = "plain", **values: float) -> np.ndarray:
    return predict(on, [Active(EFFECTS[name], values, form)])["angle_deg"]


def up_and_down(found: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """The slow run's loading and unloading, (61,) each over the same pressures."""
    return found[:61, 0], found[120:59:-1, 0]


@pytest.mark.parametrize("form", FRICTION)
def test_half_width_is_half_the_loop_in_every_form(form: str) -> None:
    on = scene(("slow",), 1, points=8)
    found = angle("friction", on, form, half_width_deg=2.0, grows=0.0)[::8]
    up, down = up_and_down(found)
    middle = slice(10, 40)  # far from the turns
    np.testing.assert_allclose((down - up)[middle] / 2, 2.0, rtol=0.02)
    bare = predict(on, [])["angle_deg"][::8][:61, 0]
    np.testing.assert_allclose((down + up)[middle] / 2, bare[middle], atol=0.03)


def test_the_loop_grows_with_pressure_as_told() -> None:
    on = scene(("slow",), 1, points=8)
    found = angle("friction", on, half_width_deg=2.0, grows=1.0)[::8]
    up, down = up_and_down(found)
    pressure = on.pressure_MPa[::8][:61, 0]
    middle = slice(10, 40)
    np.testing.assert_allclose((down - up)[middle] / 2, 2.0 * pressure[middle] / 0.35, rtol=0.03)


@pytest.mark.parametrize("form", FRICTION)
def test_friction_knows_no_rate(form: str) -> None:
    on = scene(("slow",), 1)
    fast = replace(on, time_s=on.time_s / 100)
    values = {"half_width_deg": 2.0, "grows": 0.7}
    assert np.array_equal(angle("friction", on, form, **values), angle("friction", fast, form, **values))


@pytest.mark.parametrize("form", FRICTION)
def test_the_angle_stands_still_at_a_turn(form: str) -> None:
    on = scene(("slow",), 1, points=8)
    bare = predict(on, [])["angle_deg"][:, 0]
    found = angle("friction", on, form, half_width_deg=3.0, grows=0.0)[:, 0]
    top = 480
    after = slice(top, top + 12)
    moved, bare_moved = found[after][-1] - found[top], bare[after][-1] - bare[top]
    assert bare_moved < -0.8
    assert abs(moved) < 0.25 * abs(bare_moved)
    assert np.all(np.diff(found[:top]) >= -1e-12), "never goes against the way"


def test_dahl_is_its_closed_form() -> None:
    on = scene(("up",), 1, points=4)
    bare = predict(on, [])["angle_deg"][:, 0]
    found = angle("friction", on, "gradual", half_width_deg=3.0, grows=0.0)[:, 0]
    np.testing.assert_allclose(found, bare - 3.0 * (1 - np.exp(-bare / 6.0)), atol=1e-9)


@pytest.mark.parametrize("form", ["plain", "cycle by cycle"])
def test_the_first_loading_is_the_base_of_a_virgin_film(form: str) -> None:
    on = scene(("fast",), 1)
    bare, found = predict(on, [])["angle_deg"][:, 0], angle("softening", on, form, softer=0.2, cycles=0.5)[:, 0]
    top = 25
    np.testing.assert_allclose(found[: top + 1], bare[: top + 1], rtol=1e-9)
    again = slice(51, 74)
    assert np.all(found[again] > bare[again]), "later loadings are softer"


def test_run_in_is_stiffer_the_first_time_and_the_base_at_last() -> None:
    on = scene(("fast",), 1)
    bare, found = predict(on, [])["angle_deg"][:, 0], angle("softening", on, "run in", softer=0.2, cycles=0.2)[:, 0]
    assert np.all(found[1:26] < bare[1:26])
    assert np.abs(found[-25:] - bare[-25:]).max() < 0.1


def test_softer_is_the_stiffness_that_is_lost() -> None:
    """Far down an unloading, after many cycles, the film has 1 − d of its stiffness in the forms of a virgin film."""
    on = scene(("fast",), 1)
    known = on.curve("angle_deg", on.pressure_MPa, {"film_modulus": 0.9})
    low = slice(45, 48)
    for form in ("plain", "cycle by cycle", "largest so far"):
        found = angle("softening", on, form, softer=0.1, cycles=0.05)
        np.testing.assert_allclose(found[low], known[low], rtol=0.01, err_msg=form)


def test_without_a_knob_it_acts_on_the_angle() -> None:
    bare = base(1, known=False)
    on = scene(("fast",), 1, on=bare)
    plain = predict(on, [])["angle_deg"]
    found = angle("softening", on, "cycle by cycle", softer=0.1, cycles=0.03)
    np.testing.assert_allclose(found[50:], plain[50:] / 0.9, rtol=1e-5)


@pytest.mark.parametrize("form", ["plain", "cycle by cycle", "largest so far"])
def test_a_later_run_remembers_the_largest_strain_where_the_order_is_known(form: str) -> None:
    values = {"softer": 0.2, "cycles": 0.2}
    ordered = angle("softening", scene(("fast", "fast"), 1), form, **values)
    rested = angle("softening", scene(("fast", "fast"), 1, ordered=False), form, **values)
    assert np.array_equal(rested[:, 0], rested[:, 1])
    assert np.array_equal(ordered[:, 0], rested[:, 0])
    assert np.all(ordered[2:20, 1] > ordered[2:20, 0] + 0.05)


def test_cycles_count_on_over_runs() -> None:
    """Three runs of three cycles are nine: the peaks grow by 1 − exp(−N/n) all the way."""
    on = scene(("fast", "fast", "fast"), 1)
    found = angle("softening", on, "cycle by cycle", softer=0.1, cycles=3.0)
    peaks = found[[25, 75, 125], :].T.ravel()  # N = 0, 1, 2 · 3, 4, 5 · 6, 7, 8
    factor = 1 - 0.1 * (1 - np.exp(-np.array([0, 1, 2, 3, 4, 5, 6, 7, 8]) / 3.0))
    expected = on.curve("angle_deg", np.full((9, 9), 0.35)[:, :3], {"film_modulus": np.tile(factor[:, None], 3)})[:, 0]
    np.testing.assert_allclose(peaks, expected, atol=0.15)


def test_noise_of_the_pressure_is_no_cycle() -> None:
    on = scene(("slow",), 1, points=10)
    noisy = replace(on, pressure_MPa=on.pressure_MPa + np.random.default_rng(1).normal(0, 0.001, on.pressure_MPa.shape))
    values = {"softer": 0.1, "cycles": 1.0}
    clean = angle("softening", on, "cycle by cycle", **values) / predict(on, [])["angle_deg"].clip(1)
    rough = angle("softening", noisy, "cycle by cycle", **values) / predict(noisy, [])["angle_deg"].clip(1)
    high = on.pressure_MPa[:, 0] > 0.1
    assert np.abs(clean - rough)[high].max() < 0.1 * 0.1, "a tenth of the effect"


def test_flex_sensor_loops_and_drifts_alone() -> None:
    on = scene(("slow",), 1, points=8)
    actives = [Active(EFFECTS["flex_hysteresis"], {"half_width_deg": 2.0, "drift_deg_per_min": 3.0})]
    found = predict(on, actives, ("angle_deg", "flex_V"))
    bare = predict(on, [])["angle_deg"]
    assert np.array_equal(found["angle_deg"], bare)
    up, down = up_and_down((found["flex_V"] - 3.0 * on.time_s / 60)[::8])
    np.testing.assert_allclose((down - up)[10:40] / 2, 2.0, rtol=1e-3)
