"""The twin's chain as a whole: it converges, does not mind uneven steps, and stays physical at its extremes."""

from __future__ import annotations

from dataclasses import fields

import numpy as np
import pytest

from benchlab.errors import InputError
from benchlab.io.twin_file import shipped_curve
from benchlab.twin import plant as plant_module
from benchlab.twin.curve import ResponseCurve
from benchlab.twin.effects.catalogue import EFFECTS, FAULTS
from benchlab.twin.plant import Plant
from benchlab.twin.settings import TwinSettings, default_effects

CURVE = shipped_curve()


def driven(settings: TwinSettings, times: np.ndarray, asked: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Pressure inside and angle at each time."""
    plant, rows = Plant(settings), []
    for t, p in zip(times.tolist(), asked.tolist()):
        plant.advance(t)
        rows.append((plant.pressure_MPa, plant.angle_deg))
        plant.ask(p)
    pressure, angle = np.array(rows).T
    return pressure, angle


def ramp(times: np.ndarray) -> np.ndarray:
    """Up in 2.5 s, held, down in 1 s."""
    return np.interp(times, [0, 2.5, 3.5, 4.5, 6], [0, 0.35, 0.35, 0, 0])


def test_smaller_steps_give_the_same_and_the_error_falls_with_their_square(monkeypatch: pytest.MonkeyPatch) -> None:
    times = np.arange(0, 6, 0.04)
    found = {}
    for step in (0.02, 0.01, 0.005, 0.0002):
        monkeypatch.setattr(plant_module, "LONGEST_STEP_S", step)
        monkeypatch.setattr(plant_module, "GROWTH", 0.0)
        found[step] = driven(TwinSettings(CURVE), times, ramp(times))[1]
    errors = {step: np.abs(angle - found[0.0002]).max() for step, angle in found.items()}
    assert errors[0.005] < 0.01
    assert errors[0.02] / errors[0.01] > 3 and errors[0.01] / errors[0.005] > 3


def test_uneven_exchanges_do_not_matter() -> None:
    even = np.arange(0, 6, 0.01)
    more = np.unique(np.concatenate([even, np.random.default_rng(1).uniform(0, 5.99, 2000)]))
    held = ramp(even)[np.searchsorted(even, more, side="right") - 1]
    one = driven(TwinSettings(CURVE), even, ramp(even))[1]
    other = driven(TwinSettings(CURVE), more, held)[1]
    assert np.abs(other[np.searchsorted(more, even)] - one).max() < 0.01


def test_a_long_silence_is_followed_in_few_steps_and_rightly(monkeypatch: pytest.MonkeyPatch) -> None:
    def after(gap_s: float) -> float:
        plant = Plant(TwinSettings(CURVE))
        plant.ask(0.3)
        plant.advance(gap_s)
        return plant.angle_deg

    grown = [after(gap) for gap in (1.0, 10.0, 100.0)]
    monkeypatch.setattr(plant_module, "GROWTH", 0.0)
    assert grown == pytest.approx([after(gap) for gap in (1.0, 10.0, 100.0)], abs=2e-3)
    monkeypatch.undo()
    steps = []
    step = Plant._step
    monkeypatch.setattr(Plant, "_step", lambda self, dt: (steps.append(dt), step(self, dt))[1])
    after(86_400.0)
    assert len(steps) < 2000 and sum(steps) == pytest.approx(86_400)


def test_nothing_jumps_and_no_pressure_is_negative_or_beyond_at_any_parameters() -> None:
    """All effects at once, at their bounds or anywhere between: the angle goes along a slow ramp without a step in it."""
    rng = np.random.default_rng(11)
    times = np.arange(0, 8, 0.002)
    asked = np.interp(times, [0, 2, 3, 4, 6, 8], [0, 0.35, 0.1, 0.3, 0, 0])
    for trial in range(12):
        effects = {}
        for name, kind in EFFECTS.items():
            if name in FAULTS or name == "sensor_noise":
                continue
            values = {}
            for each in fields(kind):
                low, high = each.metadata["low"], each.metadata["high"]
                share = rng.choice([0.0, 1.0, rng.uniform()])
                values[each.name] = min(
                    low + share * (high - low), {"share_1": 0.5, "share_2": 0.5, "cap_mm": 80}.get(each.name, high)
                )
            effects[name] = kind(**values)
        effects.pop("gravity") if trial % 2 else None
        pressure, angle = driven(TwinSettings(CURVE, effects), times, asked)
        assert np.isfinite(angle).all() and pressure.min() >= 0 and pressure.max() <= 0.35 + 1e-12, trial
        # 0.5 MPa/s · 430 deg/MPa · 0.002 s is 0.43°; the regulator's vent and strong effects may make a few times of it.
        assert np.abs(np.diff(angle)).max() < 3.0, (trial, effects)


@pytest.mark.parametrize("name", [name for name in EFFECTS if name not in FAULTS])
def test_each_effect_alone_is_a_change_and_stays_small(name: str) -> None:
    times = np.arange(0, 6, 0.01)
    base = Plant(TwinSettings(CURVE, {}))
    one = TwinSettings(CURVE, {name: EFFECTS[name]()})
    plain = driven(TwinSettings(CURVE, {}), times, ramp(times))[1]
    changed = driven(one, times, ramp(times))[1]
    elsewhere = {
        "dac_steps",
        "sensor_noise",
        "pressure_gain",
        "pressure_offset",
        "marker_offset",
        "camera_scale",
        "clock_offset",
        "flex_hysteresis",
    }
    if name in elsewhere:
        assert np.array_equal(plain, changed)
    else:
        assert 0.005 < np.abs(changed - plain).max() < 25
    assert base.angle_deg == pytest.approx(0, abs=1e-4)


def test_burst_and_tube_off_empty_the_actuator_whatever_is_asked_for() -> None:
    times = np.arange(0, 3, 0.01)
    for name in ("burst", "tube_off"):
        effects = {**default_effects(), name: EFFECTS[name](at_s=1.0)}
        plant = Plant(TwinSettings(CURVE, effects))
        for t in times.tolist():
            plant.advance(t)
            if 0.5 < t < 1:
                assert plant.pressure_MPa == pytest.approx(0.2, abs=0.001) and plant.seen("monitor", 0.2) == 0.2
            plant.ask(0.2)
        assert plant.pressure_MPa < 1e-6 and plant.seen("monitor", 0.2) <= 0.1 and plant.angle_deg < 5


@pytest.mark.parametrize(
    ("change", "words"),
    [
        ({"pressure_MPa": np.array([0.01, 0.2, 0.3])}, "begin at 0"),
        ({"pressure_MPa": np.array([0.0, 0.2, 0.2])}, "grow"),
        ({"angle_deg": np.array([0.0, np.nan, 2.0])}, "finite"),
        ({"volume_mL": np.array([20.0, 19.0, 22.0])}, "does not fall"),
        ({"axial_stretch": np.ones(2)}, "as many"),
    ],
)
def test_curves_that_no_twin_can_follow(change: dict[str, np.ndarray], words: str) -> None:
    columns = {
        "pressure_MPa": np.array([0.0, 0.2, 0.3]),
        "angle_deg": np.array([0.0, 1.0, 2.0]),
        "volume_mL": np.array([20.0, 21.0, 22.0]),
    }
    with pytest.raises(InputError, match=words):
        ResponseCurve(**{**columns, "axial_stretch": np.ones(3), **change}, source="a")
