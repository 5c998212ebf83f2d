"""What a twin made of a model does on a cycle is what the model predicts, effect by effect."""

from __future__ import annotations

import numpy as np
import pytest

from benchlab.actuator import ShellDesign
from benchlab.discrepancy.base import Base, DesignBase, Knob
from benchlab.discrepancy.effects.catalogue import effects
from benchlab.discrepancy.effects.effect import Active
from benchlab.discrepancy.predict import predict
from benchlab.discrepancy.scene import Scene
from benchlab.twin.curve import ResponseCurve
from benchlab.twin.plant import Plant
from benchlab.twin.settings import TwinSettings
from benchlab.workflows.model_curves import NOT_AT_REST, modelled
from benchlab.workflows.model_twin import ModelTwin, at_rest, twin_effects

P = np.linspace(0, 0.35, 141)
ANGLE = 420 * P / (1 + P)


def base(film_knob: bool = True) -> Base:
    """A design in closed form: θ = 420°·p/(1 + p), softer films bending farther by 0.8 of a percent a percent."""
    values = np.array([0.5, 0.7, 1.0, 1.3, 1.6])
    factor = np.repeat(values[:, None] ** -0.8, len(P), axis=1)
    knobs = (
        {"film_modulus": Knob(values, {"angle_deg": factor, "volume_mL": np.ones_like(factor)})} if film_knob else {}
    )
    curves = {"angle_deg": ANGLE, "volume_mL": 20 + 16 * P - 14 * P**2, "stiffness_Nmm2": 1e4 + 0 * P}
    design = DesignBase("one", P, curves, ShellDesign(10, 3), knobs)
    return Base({"one": design}, "cell", "in closed form")


def active(name: str, form: str = "plain", **values: float) -> Active:
    typical = {p.name: p.typical for p in effects()[name].parameters}
    assert set(values) <= set(typical)
    return Active(effects()[name], {**typical, **values}, form)


TIMES = np.arange(0, 40.001, 0.02)
ASKED = np.interp(TIMES, [0, 1, 6, 11, 12, 17, 22, 25, 28, 40], [0, 0, 0.35, 0, 0, 0.35, 0.05, 0.3, 0, 0])
"""Up and down, up again, a smaller loop, and a wait: MPa over seconds."""


def predicted(actives: list[Active], on: Base) -> np.ndarray:
    one = TIMES[:, None]
    scene = Scene(
        on, ("one",), np.zeros(1, int), np.zeros(1, int), np.full(1, np.nan), one, ASKED[:, None], ASKED[:, None],
        np.full_like(one, np.nan), np.ones(one.shape, bool), np.full(1, 0.0), np.full(1, np.nan),
    )  # fmt: skip
    return predict(scene, actives)["angle_deg"][:, 0]


def twin(actives: list[Active], on: Base) -> tuple[np.ndarray, np.ndarray]:
    """True angle and camera's angle of the twin, without electronics, and pressures as its monitor tells them."""
    found = modelled(on, "one", [each for each in actives if at_rest(each)], P)
    curve = ResponseCurve(P, found.curves["angle_deg"], found.curves["volume_mL"], np.ones_like(P), "one")
    kept = {
        name: each
        for name, each in twin_effects(actives, on, "one")[0].items()
        if name not in ("dac_steps", "sensor_noise")
    }
    plant, rows = Plant(TwinSettings(curve, kept, length_mm=180)), []
    fine = np.arange(0, TIMES[-1] + 0.001, 0.005)
    for time, asked in zip(fine, np.interp(fine + 0.0025, TIMES, ASKED)):  # of the middle of each step
        plant.advance(time)
        rows.append((plant.seen("camera", plant.angle_deg), plant.seen("monitor", plant.regulator_MPa)))
        plant.ask(float(asked))
    camera, monitor = np.array(rows).T
    return np.interp(TIMES, fine, camera), np.interp(TIMES, fine, monitor)


EXACT = [
    active("viscoelasticity"),
    active("viscoelasticity", "two times"),
    active("viscoelasticity", "creep on top"),
    active("friction", "spread"),
    active("regulator_lag", lag_s=0.3),
    active("line_resistance", resistance_MPa_s_per_mL=0.02),
    active("leakage", share=0.06, fall_per_min=0.0),
    active("leakage", "orifice", share=0.06, fall_per_min=0.0),
    active("marker_offset", distance_mm=6.0),
    active("end_caps"),
    active("dead_pressure"),
    active("gravity"),
]


@pytest.mark.parametrize("one", EXACT, ids=lambda each: f"{each.name}-{each.form}")
def test_the_same_on_a_cycle_within_0_15_degrees(one: Active) -> None:
    """Of 109° in all: what is left is the twin's step of 5 ms, and straight lines between points."""
    on = base()
    there, here = predicted([one], on), twin([one], on)[0]
    assert np.abs(there - here).max() < 0.15
    assert np.abs(there - predicted([], on)).max() > 0.6, "the effect is seen at all"


FORMS = [
    (active("friction", half_width_deg=2.0), 0.1),
    (active("softening", "cycle by cycle", softer=0.1), 0.2),
    (active("softening", softer=0.1, cycles=0.1), 0.5),
    (active("softening", "largest so far", softer=0.1), 0.15),
    (active("softening", "run in", softer=0.1), 0.15),
    (active("viscoelasticity", "log time"), 0.35),
    (active("regulator_lag", "second order", lag_s=0.2), 0.25),
    (active("line_resistance", "with air", resistance_MPa_s_per_mL=0.01), 0.4),
    (active("temperature", softer_per_K=0.01, warming_s=20.0), 0.2),
]


@pytest.mark.parametrize(("one", "tolerance_deg"), FORMS, ids=lambda each: getattr(each, "form", None))
def test_forms_that_the_twin_has_not_are_close_by_the_root_mean_square(one: Active, tolerance_deg: float) -> None:
    """And closer than a twin without the effect, by half at least."""
    on = base()
    there, here, without = predicted([one], on), twin([one], on)[0], predicted([], on)
    off = np.sqrt(np.mean((there - here) ** 2))
    assert off < tolerance_deg
    assert off < 0.5 * np.sqrt(np.mean((there - without) ** 2))


def test_sensors_of_the_twin_are_wrong_as_the_model_has_it() -> None:
    """The model takes the recorded pressure for what it is worth; the twin's monitor records it wrong."""
    on, actives = base(), [active("pressure_gain", gain=1.05), active("pressure_offset", offset_MPa=0.004)]
    camera, monitor = twin(actives, on)
    asked = ASKED * 1.05 + 0.004
    assert monitor == pytest.approx(asked, abs=4e-4)
    late = 10
    scene_angle = np.interp((monitor / 1.05 - 0.004), P, ANGLE)
    assert np.abs(scene_angle - camera)[late:].max() < 0.3


def test_all_effects_have_a_place_in_the_twin_or_a_note() -> None:
    on = base()
    for name in effects():
        one = active(name)
        kept, notes = twin_effects([one], on, "one")
        in_curve, in_effects = at_rest(one) and name not in NOT_AT_REST, name in kept
        assert in_curve or in_effects or name in notes, name


def test_other_forms_are_told_where_the_twin_has_them() -> None:
    on = base()
    kept, notes = twin_effects([active("friction"), active("camera_tilt"), active("viscoelasticity")], on, "one")
    assert set(notes) == {"friction", "camera_tilt"} and "three plays" in notes["friction"]
    curve = ResponseCurve(P, ANGLE, 20 + P, np.ones_like(P), "one")
    made = ModelTwin(TwinSettings(curve, kept), notes, {})
    assert len(made.notes_for(made.settings)) == 2 and made.notes_for(None) == ()
    off = {name: effect for name, effect in kept.items() if name != "friction"}
    assert made.notes_for(TwinSettings(curve, off)) == (notes["camera_tilt"],)


def test_a_base_without_the_films_knob_bends_as_one_over_the_modulus() -> None:
    for on, farther in ((base(False), 1 / 0.9), (base(), 0.9**-0.8)):
        effect = twin_effects([active("softening", "cycle by cycle", softer=0.1)], on, "one")[0]["softening"]
        assert effect.growth == pytest.approx(farther - 1, rel=0.02)  # type: ignore[attr-defined]
