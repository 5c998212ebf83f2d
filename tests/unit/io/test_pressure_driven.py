"""The pressure of a run as a record: measured, else asked for, with the trigger of its camera."""

import numpy as np
import pytest

from benchlab.errors import InputError
from benchlab.io.drive_file import write_drive_file
from benchlab.io.journal import read_journal
from benchlab.io.pressure import read_pressure
from tests.unit.io.journals import header_of, samples_of, write_journal

TRIGGER = {60: [{"kind": "trigger", "tick": 60, "time_s": 1.21}]}


def record(tmp_path, samples=None, header=None, events=TRIGGER, **options):
    journal = read_journal(write_journal(tmp_path / "run.journal", samples, header, events, **options))
    write_drive_file(tmp_path / "run.h5", journal)
    return read_pressure(tmp_path / "run.h5")


def test_the_measured_pressure_is_read_with_the_time_of_the_trigger(tmp_path):
    found = record(tmp_path)
    np.testing.assert_array_equal(found.pressure_MPa, samples_of()["pressure_MPa"])
    np.testing.assert_array_equal(found.time_s, samples_of()["time_s"])
    assert found.trigger_s == 1.2 and found.warnings == ()
    assert found.at([1.0], offset_s=1.0)[0] == pytest.approx(0.19)


def test_where_none_was_measured_it_is_what_was_asked_for_and_says_so(tmp_path):
    samples = samples_of()
    samples["pressure_MPa"] = np.nan
    found = record(tmp_path, samples, events={})
    np.testing.assert_array_equal(found.pressure_MPa, samples["command_MPa"])
    assert found.warnings == ("no pressure was measured in run.h5: the pressure is what was asked for",)
    assert found.trigger_s is None


def test_single_answers_that_are_missing_stay_missing(tmp_path):
    samples = samples_of()
    samples["pressure_MPa"][[50, 51]] = np.nan
    found = record(tmp_path, samples)
    assert np.isnan(found.at([1.0])).all() and "2 rows without a pressure" in found.warnings[0]


def test_a_twin_several_triggers_and_lost_records_are_told(tmp_path):
    events = {10: [{"kind": "trigger", "tick": 10, "time_s": 0.2}], **TRIGGER}
    found = record(tmp_path, header=header_of(samples_of(), "twin"), events=events)
    assert found.trigger_s == 0.2
    assert any("simulated (twin)" in words for words in found.warnings)
    assert any("triggered 2 times" in words for words in found.warnings)
    path = tmp_path / "run.journal"
    path.write_bytes(path.read_bytes()[:-300])
    write_drive_file(tmp_path / "run.h5", read_journal(path))
    assert any("the last record is cut" in words for words in read_pressure(tmp_path / "run.h5").warnings)


def test_a_pressure_that_cannot_be_is_refused_as_in_any_record(tmp_path):
    samples = samples_of()
    samples["pressure_MPa"][7] = 60.0
    with pytest.raises(InputError, match=r"row 8: pressure of 60 MPa, outside"):
        record(tmp_path, samples)


def test_the_vented_bench_seen_again_at_one_moment_is_no_doubt(tmp_path):
    samples = np.append(samples_of(), samples_of()[-1:])
    samples["pressure_MPa"][-1] += 0.01
    found = record(tmp_path, samples)
    assert found.warnings == () and found.at([samples["time_s"][-1]])[0] == pytest.approx(samples["pressure_MPa"][-2])
    (tmp_path / "run.journal").unlink()
    told = record(tmp_path, stop={"reason": "stuck sensor", "words": "", "vented": True}).warnings
    assert told == ("run.h5: the run was not completed: stuck sensor",)
