"""A replay gives what was recorded, and fails on the first difference."""

import numpy as np
import pytest

from benchlab.devices.interface import Status
from benchlab.devices.replay import Replay
from benchlab.errors import BenchError
from tests.unit.io.journals import samples_of

SAMPLES = samples_of()[:60]


def replay(samples=SAMPLES, triggers=(5,)):
    device = Replay(samples, {"kind": "serial", "firmware": "1.0"}, triggers)
    device.arm()
    return device


def play(device, count, first=0):
    return [device.exchange(i / 100, float(SAMPLES["command_MPa"][i]), i == 5) for i in range(first, count)]


def test_the_readings_come_as_they_were():
    readings = play(replay(), 60)
    for name in ("pressure_MPa", "flex_V", "device_time_s", "monitor_V", "code"):
        np.testing.assert_array_equal([getattr(reading, name) for reading in readings], SAMPLES[name])
    assert {reading.status for reading in readings} == {Status.ARMED}


def test_the_time_of_a_command_is_not_compared():
    device = replay()
    assert device.exchange(3.0, 0.0).device_time_s == 7.0
    assert device.exchange(9.0, 0.002).device_time_s == pytest.approx(7.02)


def test_another_pressure_fails_at_its_tick():
    device = replay()
    play(device, 20)
    with pytest.raises(BenchError, match=r"tick 20 differs .*: command_MPa was 0\.04, 0\.041 is asked for"):
        device.exchange(0.2, 0.041)


def test_nan_is_a_difference():
    with pytest.raises(BenchError, match="nan is asked for"):
        replay().exchange(0.0, float("nan"))


def test_a_trigger_that_is_missing_or_new_fails():
    device = replay()
    play(device, 5)
    with pytest.raises(BenchError, match=r"tick 5 differs .*: trigger was True, False is asked for"):
        device.exchange(0.05, float(SAMPLES["command_MPa"][5]))
    with pytest.raises(BenchError, match="trigger was False, True is asked for"):
        replay().exchange(0.0, 0.0, trigger=True)
    assert replay(triggers=None).exchange(0.0, 0.0, trigger=True).code == 0


def test_more_than_was_recorded_fails():
    device = replay()
    play(device, 60)
    with pytest.raises(BenchError, match=r"the recording ends with tick 59, and 0\.1 MPa are asked for at tick 60"):
        device.exchange(0.6, 0.1)


def test_a_tick_that_the_recording_lacks_fails_there():
    device = replay(np.delete(SAMPLES, [30, 31]))
    play(device, 30)
    with pytest.raises(BenchError, match="the recording lacks tick 30"):
        play(device, 31, first=30)


def test_the_ticks_held_in_a_pause_are_passed_over():
    held = np.repeat(SAMPLES[29:30], 7)
    held["device_time_s"] += np.arange(1, 8)
    readings = play(replay(np.concatenate([SAMPLES[:30], held, SAMPLES[30:]])), 60)
    np.testing.assert_array_equal([reading.device_time_s for reading in readings], SAMPLES["device_time_s"])


def test_a_recording_that_goes_on_is_told_once_after_the_vent():
    device = replay()
    play(device, 40)
    assert device.faults() == []
    device.vent()
    device.vent()
    (fault,) = device.faults()
    assert fault.cause == "the recording goes on from tick 40 to 59, which was not asked for"
    assert device.faults() == []
    whole = replay()
    play(whole, 60)
    whole.close()
    assert whole.faults() == []


def test_disarmed_it_refuses_any_pressure():
    device = Replay(SAMPLES, {})
    assert device.exchange(0.0, 0.0).code == 0
    with pytest.raises(BenchError, match="disarmed"):
        device.exchange(0.0, 0.002)


def test_an_answer_that_was_missing_is_missing_again():
    samples = SAMPLES.copy()
    samples["pressure_MPa"][1], samples["code"][1], samples["status"][1] = np.nan, -1, Status.NO_ANSWER
    reading = play(replay(samples), 2)[1]
    assert np.isnan(reading.pressure_MPa) and reading.code == -1 and reading.status is Status.NO_ANSWER


def test_it_says_what_was_replayed():
    assert replay().about() == {"kind": "replay", "replayed": "serial", "firmware": "1.0"}


def test_what_was_watched_after_the_vent_comes_after_the_vent_of_a_run_that_went_as_far():
    device = Replay(SAMPLES, {}, (5,), watched=10)
    device.arm()
    play(device, 50)
    device.vent()
    again = [device.exchange(0.5 + i / 100, 0.0).pressure_MPa for i in range(10)]
    np.testing.assert_array_equal(again, SAMPLES["pressure_MPa"][50:])
    with pytest.raises(BenchError, match="the recording ends with tick 49"):
        device.exchange(0.7, 0.0)
    assert device.faults() == []


def test_a_replay_that_ends_sooner_makes_up_no_vent():
    device = Replay(SAMPLES, {}, (5,), watched=10)
    device.arm()
    play(device, 20)
    device.vent()
    with pytest.raises(BenchError, match="tick 20 is of an armed bench, and this one was vented"):
        device.exchange(0.2, 0.0)
