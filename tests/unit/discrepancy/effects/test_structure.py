"""Effects through knobs of the base, temperature, and why data cannot show an effect."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from benchlab.discrepancy.effects.catalogue import built_in
from benchlab.discrepancy.effects.effect import Active
from benchlab.discrepancy.predict import predict
from benchlab.discrepancy.scene import Scene
from tests.unit.discrepancy.scenes import KNOBS, SHAPES, base, knob, scene

EFFECTS = built_in()
BY_KNOB = {
    "seam_margin": ("seam_margin_mm", "margin_mm", 0.6),
    "bladder_stiffness": ("bladder_N_per_mm", "stiffness_N_per_mm", 2.0),
    "fabric_compliance": ("fabric_modulus", "factor", 0.5),
    "window_ballooning": ("ballooning", "share", 0.75),
}


def angle(name: str, on: Scene, form: str = "plain", **values: float) -> np.ndarray:
    return predict(on, [Active(EFFECTS[name], values, form)])["angle_deg"]


@pytest.mark.parametrize("name", BY_KNOB)
def test_a_structural_effect_is_the_base_solved_with_the_knob(name: str) -> None:
    which, parameter, value = BY_KNOB[name]
    on = scene(("slow",), 5, on=base(5, kind="beam"))
    found = angle(name, on, **{parameter: value}) / predict(on, [])["angle_deg"].clip(1e-9)
    row = list(KNOBS[which]).index(value)
    for run, (tw, slw) in enumerate(SHAPES):
        expected = knob(which, on.pressure_MPa[1:120, run], slw, tw).factor["angle_deg"][row]
        np.testing.assert_allclose(found[1:120, run], expected, rtol=2e-3)


def test_moduli_of_two_effects_multiply() -> None:
    on = scene(("fast",), 1, temperature_C=33.0)
    soft = Active(EFFECTS["softening"], {"softer": 0.1, "cycles": 0.05}, "cycle by cycle")
    warm = Active(EFFECTS["temperature"], {"softer_per_K": 0.01, "warming_s": 900.0})
    both = predict(on, [soft, warm])["angle_deg"][60:]
    expected = on.curve("angle_deg", on.pressure_MPa, {"film_modulus": 0.9 * 0.9})[60:]
    np.testing.assert_allclose(both, expected, rtol=1e-4)


def test_a_warm_film_is_softer_by_kelvins_told() -> None:
    on = scene(("slow",), 2, temperature_C=43.0)
    found = angle("temperature", on, softer_per_K=0.01, warming_s=900.0)
    np.testing.assert_allclose(found, on.curve("angle_deg", on.pressure_MPa, {"film_modulus": 0.8}))
    np.testing.assert_allclose(
        angle("temperature", on, "on the angle", softer_per_K=0.01, warming_s=900.0), predict(on, [])["angle_deg"] / 0.8
    )


def test_without_a_thermometer_the_session_warms() -> None:
    on = scene(("still",) * 40, 1, start_s=0.0)
    for form, share in (("plain", 1 - np.exp(-np.arange(40) / 5)), ("steady", np.minimum(np.arange(40) / 10, 1.0))):
        found = angle("temperature", on, form, softer_per_K=0.02, warming_s=500.0)
        modulus = 1 - 0.02 * 10 * share
        expected = np.array([on.curve("angle_deg", on.pressure_MPa, {"film_modulus": m})[0, 0] for m in modulus])
        np.testing.assert_allclose(found[0], expected, rtol=1e-9)


def test_the_order_of_runs_is_a_clock_where_there_is_no_other() -> None:
    on = scene(("slow", "slow"), 1)
    late = predict(on, [])["angle_deg"][:, 1] / 1  # second run begins when the first has ended, after 60 s
    found = angle("temperature", on, "on the angle", softer_per_K=0.02, warming_s=60.0)[:, 1]
    warmer = 10 * (1 - np.exp(-(60 + on.time_s[:, 1]) / 60))
    np.testing.assert_allclose(found, late / (1 - 0.02 * warmer))


def unknown_designs(protocol: tuple[str, ...] = ("slow", "fast", "hold")) -> Scene:
    return scene(protocol, 2, on=base(2, known=False))


@pytest.mark.parametrize("name", ["seam_margin", "bladder_stiffness", "fabric_compliance"])
def test_structure_of_unknown_designs_cannot_be_shown(name: str) -> None:
    assert "dimensions are not known" in EFFECTS[name].cannot_show(unknown_designs())


@pytest.mark.parametrize("name", ["end_caps", "marker_offset"])
def test_unknown_lengths_cannot_show_what_goes_with_length(name: str) -> None:
    assert "length is not known" in EFFECTS[name].cannot_show(unknown_designs())


def test_the_shell_cell_has_its_ballooning() -> None:
    assert "shell cell has it" in EFFECTS["window_ballooning"].cannot_show(scene())


TIMED = ["viscoelasticity", "regulator_lag", "line_resistance", "clock_offset"]
LOOPS = ["friction", "softening"]
STATIC = [
    *(
        "end_caps",
        "dead_pressure",
        "gravity",
        "leakage",
        "pressure_gain",
        "pressure_offset",
        "camera_scale",
        "camera_tilt",
    ),
    *("marker_offset", "seam_margin", "bladder_stiffness", "fabric_compliance", "frame_compliance"),
]


@pytest.mark.parametrize("name", [*TIMED, *LOOPS, "flex_hysteresis"])
def test_a_table_of_one_pressure_shows_nothing_in_time(name: str) -> None:
    assert EFFECTS[name].cannot_show(scene(("still",), 5))


@pytest.mark.parametrize("name", STATIC)
def test_a_table_of_one_pressure_shows_what_is_static(name: str) -> None:
    assert EFFECTS[name].cannot_show(scene(("still",), 5, orientation_deg=0.0)) == ""


@pytest.mark.parametrize("name", [*TIMED, *LOOPS])
def test_one_loading_at_one_rate_shows_no_lag_and_no_loop(name: str) -> None:
    assert EFFECTS[name].cannot_show(scene(("up",), 5))


@pytest.mark.parametrize("name", TIMED)
@pytest.mark.parametrize("protocol", [("slow",), ("hold",), ("up", "fast")])
def test_a_way_back_a_hold_or_a_second_rate_shows_lags(name: str, protocol: tuple[str, ...]) -> None:
    assert EFFECTS[name].cannot_show(scene(protocol, 2)) == ""


def test_a_second_loading_in_a_known_order_shows_softening() -> None:
    assert EFFECTS["softening"].cannot_show(scene(("up", "up"), 1)) == ""
    assert EFFECTS["softening"].cannot_show(scene(("up", "up"), 1, ordered=False))


def test_temperature_wants_a_thermometer_a_clock_or_an_order() -> None:
    temperature = EFFECTS["temperature"]
    unordered = scene(("slow", "fast"), 1, ordered=False)
    assert "neither" in temperature.cannot_show(unordered)
    assert temperature.cannot_show(replace(unordered, start_s=np.array([0.0, 100.0]))) == ""
    assert temperature.cannot_show(scene(("slow", "fast"), 1)) == ""
    constant = scene(("slow", "fast"), 1, temperature_C=25.0)
    assert "same throughout" in temperature.cannot_show(constant)
    rising = replace(constant, temperature_C=constant.temperature_C + np.array([0.0, 5.0]))
    assert temperature.cannot_show(rising) == ""


def test_no_force_no_frame() -> None:
    on = base(1)
    bare = {
        name: replace(d, curves={q: c for q, c in d.curves.items() if q == "angle_deg"})
        for name, d in on.designs.items()
    }
    without = scene(("slow",), 1, on=replace(on, designs=bare))
    assert "force" in EFFECTS["frame_compliance"].cannot_show(without)
    assert "volume" in EFFECTS["line_resistance"].cannot_show(without)
