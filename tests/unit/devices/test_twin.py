"""The twin as a device: strict, told, and the same again."""

from __future__ import annotations

import json
import math
from dataclasses import replace

import numpy as np
import pytest

from benchlab.bench import Bench, LimitError, Line
from benchlab.devices.interface import Status
from benchlab.devices.twin.bench import twin_bench
from benchlab.devices.twin.twin import Twin
from benchlab.errors import BenchError
from benchlab.io.twin_file import read_twin
from benchlab.twin.curve import ResponseCurve
from benchlab.twin.effects.catalogue import EFFECTS

SETTINGS = read_twin(None)
STEP_MPA = 0.48 / 4096


def armed(bench: Bench | None = None, **changes) -> Twin:
    twin = Twin(replace(SETTINGS, **changes), bench or twin_bench())
    twin.arm()
    return twin


def drive(twin: Twin) -> list:
    times = np.cumsum(np.random.default_rng(5).uniform(0.002, 0.03, 200))
    return [twin.exchange(t, 0.3 * math.sin(t) ** 2, trigger=i == 7) for i, t in enumerate(times.tolist())]


def test_same_seed_same_readings_to_the_last_bit() -> None:
    one, other, third = armed(seed=4), armed(seed=4), armed(seed=5)
    assert drive(one) == drive(other)
    assert all(np.array_equal(a, b) for a, b in zip(vars(one.truth).values(), vars(other.truth).values()))
    again = drive(armed(seed=4))
    for name in ("pressure_MPa", "flex_V"):
        assert [getattr(r, name) for r in drive(armed(seed=5))] != [getattr(r, name) for r in again]
    assert drive(third) != again and np.array_equal(third.truth.angle_deg, one.truth.angle_deg)


def test_a_reading_is_of_the_moment_before_its_command() -> None:
    twin = armed(effects={})
    assert twin.exchange(0.0, 0.2).pressure_MPa == 0.0
    reading = twin.exchange(0.01, 0.1)
    assert reading.pressure_MPa == pytest.approx(0.2, abs=1e-12)
    assert reading.code == twin_bench().code(0.1) and reading.status == Status.ARMED and reading.device_time_s == 0.01
    assert twin_bench().flex.of(reading.flex_V) == pytest.approx(
        np.interp(0.2, SETTINGS.curve.pressure_MPa, SETTINGS.curve.angle_deg)
    )
    assert twin_bench().monitor.of(reading.monitor_V) == reading.pressure_MPa


def test_pressure_comes_in_steps_of_the_dac() -> None:
    twin = armed(effects={"dac_steps": EFFECTS["dac_steps"]()})
    for i in range(400):
        twin.exchange(i * 0.01, i * 1e-5)
    found = twin.truth.setpoint_MPa
    assert (
        np.unique(np.diff(found).round(12)).tolist() == pytest.approx([0, STEP_MPA])
        and pytest.approx(0.1172e-3, abs=1e-7) == STEP_MPA
    )
    below = twin.truth.command_MPa[:-1] - found[1:]
    assert below.min() >= -1e-12 and below.max() < STEP_MPA


def test_disarmed_it_refuses_and_vented_it_empties() -> None:
    twin = Twin(SETTINGS, twin_bench())
    with pytest.raises(BenchError, match="not armed"):
        twin.exchange(0.0, 0.1)
    assert twin.exchange(0.0, 0.0).status == Status(0)
    twin.arm()
    for i in range(100):
        twin.exchange(0.01 * i, 0.3)
    for _ in range(2):
        twin.vent()
    with pytest.raises(BenchError, match="not armed"):
        twin.exchange(1.0, 0.1)
    twin.exchange(3.0, 0.0)
    assert twin.truth.pressure_MPa[-2] > 0.29 and twin.truth.pressure_MPa[-1] < 1e-9
    twin.close()
    twin.close()
    assert twin.faults() == []


@pytest.mark.parametrize("pressure", [0.36, -0.01, math.nan, math.inf])
def test_impossible_pressures(pressure: float) -> None:
    twin = armed()
    with pytest.raises(LimitError):
        twin.exchange(0.0, pressure)
    assert not len(twin.truth.time_s)


def test_beyond_the_curve_is_refused_and_never_extrapolated() -> None:
    known = SETTINGS.curve.pressure_MPa <= 0.2
    curve = SETTINGS.curve
    short = ResponseCurve(
        curve.pressure_MPa[known], curve.angle_deg[known], curve.volume_mL[known], curve.axial_stretch[known], "short"
    )
    twin = armed(curve=short)
    twin.exchange(0.0, 0.2)
    with pytest.raises(LimitError, match=r"beyond 0\.2 MPa, where the twin's response curve ends"):
        twin.exchange(0.01, 0.201)
    assert twin.about()["ceiling_MPa"] == 0.2 == twin_bench(replace(SETTINGS, curve=short)).ceiling_MPa


def test_time_does_not_go_back() -> None:
    twin = armed()
    twin.exchange(1.0, 0.1)
    twin.exchange(1.0, 0.1)
    for wrong in (0.99, math.nan):
        with pytest.raises(BenchError, match="time"):
            twin.exchange(wrong, 0.1)


def test_a_wrong_calibration_is_seen_in_the_readings_and_not_in_the_truth() -> None:
    wrong = replace(twin_bench(), regulator=Line(0.1, 0.0), monitor=Line(0.13, -0.13), flex=None)
    twin = armed(wrong, effects={})
    twin.exchange(0.0, 0.3)
    reading = twin.exchange(1.0, 0.3)
    assert twin.truth.pressure_MPa[-1] == pytest.approx(0.3 * 0.96)
    assert reading.pressure_MPa == pytest.approx(0.3 * 0.96 * 0.13 / 0.12)
    no_monitor = armed(replace(twin_bench(), monitor=None))
    assert math.isnan(no_monitor.exchange(0.0, 0.1).pressure_MPa)


def test_faults_of_the_sensor() -> None:
    for name, expected in (("stuck_sensor", None), ("sensor_out_of_range", 5.0)):
        twin = armed(effects={**SETTINGS.effects, name: EFFECTS[name](at_s=1.0)})
        volts = [twin.exchange(i / 100, 0.003 * i).flex_V for i in range(110)]
        assert len(set(volts[:100])) > 50 and len(set(volts[101:])) == 1
        assert volts[-1] == (volts[101] if expected is None else expected)


def test_what_it_says_of_itself_is_json_and_complete() -> None:
    about = json.loads(json.dumps(armed().about()))
    assert about["simulated"] is True and about["seed"] == 1
    assert about["effects"]["friction"]["half_width_deg_per_MPa"] == 4 and "softening" not in about["effects"]
    assert about["curve"]["pressure_MPa"][-1] == 0.35 and "simulated" in about["curve"]["source"]


def test_triggers_are_kept() -> None:
    twin = armed()
    drive(twin)
    assert twin.truth.triggers_s == (twin.truth.time_s[7],)
