"""Levels, gauge readings, and that nothing goes up that is foreseen to cross the limit."""

import numpy as np
import pytest

from benchlab.bench import Bench, Line
from benchlab.errors import BenchError, InputError
from benchlab.io.gauge_readings import GaugeReading
from benchlab.workflows import bench_readings
from benchlab.workflows.bench_calibrate import CalibrationSettings, calibrate
from benchlab.workflows.bench_hold import VirtualHold
from benchlab.workflows.bench_readings import Level, levels_MPa, take_readings
from tests.unit.workflows.small_bench import SmallBench

NEW = Bench("new")


def read(device: SmallBench, supply_V: float = 4.9, points: int = 8, gauge=None):
    told: list[str] = []
    with VirtualHold(device) as hold:
        ask = gauge or (lambda level: device.pressure_MPa)
        readings = take_readings(hold, levels_MPa(NEW.ceiling_MPa, points), NEW, supply_V, ask, 0.1, told.append)
    return readings, told


def test_the_true_regulator_and_monitor_are_found(tmp_path) -> None:
    device = SmallBench(NEW, Line(0.0965, -0.001), 4.9)
    readings, told = read(device)
    assert len(readings) == 15 and not told
    assert [r.rising for r in readings] == [True] * 8 + [False] * 7
    found = calibrate(
        readings, CalibrationSettings("left", "Keller LEO 2", 4.9, 0.35, "2026-05-31"), tmp_path / "bench.yaml"
    )
    assert found["regulator"]["gain_MPa_per_V"]["value"] == pytest.approx(0.0965, rel=1e-5)
    assert found["regulator"]["offset_MPa"]["value"] == pytest.approx(-0.001, abs=1e-6)
    assert found["monitor"]["gain_MPa_per_V"]["value"] == pytest.approx(0.12, rel=1e-5)
    assert found["ceiling_code"] == int((0.35 + 0.001) / 0.0965 / 4.9 * 4096)


def test_a_mistake_is_read_again_and_the_level_is_then_reached_from_above() -> None:
    device, asked = SmallBench(NEW), []

    def gauge(level: Level) -> float | None:
        asked.append(level.number)
        if asked == [1, 2, 3, 4]:
            return None
        return 0.1 if asked == [1, 2, 3] else device.pressure_MPa

    readings, _ = read(device, points=5, gauge=gauge)
    assert asked == [1, 2, 3, 4, 3, 4, 5, 6, 7, 8, 9]
    assert len(readings) == 9 and [r.rising for r in readings] == [True, True, False, True, True] + [False] * 4
    assert readings[2].pressure_MPa == pytest.approx(device.true.of(readings[2].volts), abs=1e-6)


def test_readings_in_another_unit_end_it_at_the_second_level() -> None:
    """psi typed as kPa: a seventh; the bench would be asked for seven times its limit."""
    device = SmallBench(NEW)
    levels = []

    def psi_as_kPa(level: Level) -> float:
        levels.append(level.number)
        return device.pressure_MPa / 0.00689476 / 1000

    with pytest.raises(BenchError, match="label") as ended:
        read(device, gauge=psi_as_kPa)
    assert levels == [1, 2] and not device.armed and "unit" in str(ended.value)
    assert device.highest_code <= NEW.code(NEW.ceiling_MPa / 4)


def test_a_wrong_supply_scales_the_volts_and_leaves_pressure_per_code(tmp_path) -> None:
    """The file's gain and supply belong together: codes, which are what the bench is given, come out the same."""
    codes = []
    for supply_V in (4.9, 4.8):
        readings, _ = read(SmallBench(NEW), supply_V)
        out = tmp_path / f"{supply_V}.yaml"
        codes.append(
            calibrate(readings, CalibrationSettings("b", "g", supply_V, 0.35, "2026-05-31"), out)["ceiling_code"]
        )
    assert codes[0] == codes[1]


def test_a_limit_far_above_the_readings_is_told(tmp_path) -> None:
    readings, _ = read(SmallBench(NEW), points=16)
    low = [r for r in readings if r.pressure_MPa < 0.3]
    settings = CalibrationSettings("b", "g", 4.9, 0.35, "2026-05-31")
    assert not calibrate(readings, settings, tmp_path / "whole.yaml")["warnings"]
    assert "extrapolated" in calibrate(low, settings, tmp_path / "low.yaml")["warnings"][0]


def test_a_limit_beyond_what_was_read_is_refused(tmp_path) -> None:
    readings, _ = read(SmallBench(NEW))
    settings = CalibrationSettings("b", "g", 4.9, 0.4, "2026-05-31", full_scale_MPa=0.5, limit_reason="a test")
    low = [r for r in readings if r.pressure_MPa < 0.2]
    with pytest.raises(InputError, match="beyond"):
        calibrate(readings, settings, tmp_path / "b.yaml")
    with pytest.raises(InputError, match="25 % beyond"):
        calibrate(low, CalibrationSettings("b", "g", 4.9, 0.35, "2026-05-31"), tmp_path / "b.yaml")
    assert not list(tmp_path.iterdir())


def test_a_regulator_below_its_label_is_not_given_much_more_volts_than_the_label_says(tmp_path) -> None:
    """A gauge that shows 9 % too little would else have the bench at 0.385 MPa."""
    device = SmallBench(NEW, Line(0.096, 0.0), 5.0)
    readings, _ = read(device, 5.0, gauge=lambda level: 0.91 * device.pressure_MPa)
    found = calibrate(readings, CalibrationSettings("b", "g", 5.0, 0.35, "2026-05-31"), tmp_path / "b.yaml")
    assert 0.355 < device.true.of(5.0 * found["ceiling_code"] / 4096) <= 1.03 * 0.35
    assert "9 % less than its label" in found["warnings"][0]
    with pytest.raises(InputError, match="label"):
        low = [GaugeReading(r.volts, 0.86 / 0.91 * r.pressure_MPa) for r in readings]
        calibrate(low, CalibrationSettings("b", "g", 5.0, 0.3, "2026-05-31"), tmp_path / "c.yaml")


def test_a_stronger_regulator_is_not_driven_across_the_limit(monkeypatch) -> None:
    monkeypatch.setattr(bench_readings, "_check_label", lambda *_: None)  # behind that, another hold
    device = SmallBench(NEW, Line(0.18, 0.0), 5.0)  # 0.9 MPa at 5 V: the nominal top level would be 0.6 MPa
    readings, told = read(device, 5.0)
    assert device.true.of(5.0 * device.highest_code / 4096) <= 0.35
    assert max(r.pressure_MPa for r in readings) <= 0.35
    assert len(told) == 1 and "foresee" in told[0]
    assert [r.rising for r in readings] == [True, True, True, True, False, False, False]


@pytest.mark.parametrize("gain", np.linspace(0.02, 0.5, 13))
def test_no_regulator_is_driven_across_the_limit_once_its_first_level_is_read(gain: float, monkeypatch) -> None:
    monkeypatch.setattr(bench_readings, "_check_label", lambda *_: None)
    device = SmallBench(NEW, Line(gain, 0.0), 5.25)
    first = device.true.of(5.25 * NEW.code(NEW.ceiling_MPa / 8) / 4096)
    if first > 0.35:
        with pytest.raises(BenchError, match="above the limit"):
            read(device, 5.25)
    else:
        read(device, 5.25)
        assert device.true.of(5.25 * device.highest_code / 4096) <= 0.35 + 1e-6
    assert not device.armed


def test_a_reading_above_the_limit_vents_and_says_what_to_look_for() -> None:
    device = SmallBench(NEW)

    def gauge(level: Level) -> float:
        return 0.36 if level.number == 4 else device.pressure_MPa

    with pytest.raises(BenchError, match=r"above the limit of 0\.35 MPa; vented"):
        read(device, gauge=gauge)
    assert not device.armed and device.code == 0


def test_a_file_that_is_replaced_leaves_its_flex_sensor(tmp_path) -> None:
    from dataclasses import replace

    from benchlab.io.bench_file import read_bench_file, write_bench_file

    out = tmp_path / "bench.yaml"
    readings, _ = read(SmallBench(NEW))
    settings = CalibrationSettings("b", "g", 4.9, 0.35, "2026-05-31")
    calibrate(readings, settings, out)
    old = read_bench_file(out)
    assert old.readings == tuple(readings)
    write_bench_file(out, replace(old, bench=replace(old.bench, flex=Line(40.0, -60.0, 0.5)), flex_from="run 3"))
    found = calibrate(readings, settings, out)
    assert read_bench_file(out).bench.flex == Line(40.0, -60.0, 0.5) and read_bench_file(out).flex_from == "run 3"
    assert any("kept" in w for w in found["warnings"])
