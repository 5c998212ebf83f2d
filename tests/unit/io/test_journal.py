"""The journal: cut at every byte, flipped, refused by the disk, killed; what is read is what was written, or is not there."""

import errno
import os
import random
import re
import signal
import subprocess
import sys
import threading
import time

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from benchlab.errors import InputError, UsageError
from benchlab.io import journal as journal_module
from benchlab.io import journal_format
from benchlab.io.journal import KINDS, SAMPLE, UNITS, JournalWriter, read_journal, still_written
from benchlab.protocol.survey import MAX_TICKS
from tests.pace import cpu_s, slowness
from tests.unit.io.journals import STOP, header_of, samples_of, write_journal

EVENTS = {
    5: [{"kind": "trigger", "tick": 5, "time_s": 0.1}],
    100: [{"kind": "mark", "text": "ünïcode \udc80"}, {"kind": "fault", "cause": "a CRC did not fit", "count": 3}],
    395: [{"kind": "pause", "tick": 395, "time_s": 7.9}],
    397: [{"kind": "resume", "tick": 398, "time_s": 7.99}],
}


@pytest.fixture
def whole(tmp_path):
    return write_journal(tmp_path / "a.journal", events=EVENTS)


def ends_of(data: bytes) -> list[int]:
    """Where each record ends, by walking the bytes as docs/runs.md lays them out."""
    at = data.index(b"\n") + 1
    ends = [at]
    while at < len(data):
        at += 2 + 4 + 4 + int.from_bytes(data[at + 2 : at + 6], "little") + 4
        ends.append(at)
    return ends


def test_what_is_written_is_read(whole):
    read = read_journal(whole)
    samples = samples_of()
    assert read.samples.dtype == SAMPLE and read.samples.tobytes() == samples.tobytes()
    assert read.header == header_of(samples)
    assert [event["kind"] for event in read.events] == ["trigger", "mark", "fault", "pause", "resume", "stop"]
    assert [event["after_samples"] for event in read.events] == [6, 101, 101, 396, 398, 400]
    assert read.events[1]["text"] == "ünïcode \udc80"
    assert read.complete and read.stop["reason"] == "completed" and read.losses == () and read.lost_bytes == 0


def test_a_sample_has_92_bytes_and_each_field_a_unit():
    assert SAMPLE.itemsize == 92
    assert set(UNITS) == set(SAMPLE.names)
    for name, unit in UNITS.items():
        assert not unit or name.endswith(f"_{unit}"), name


def test_cut_at_every_byte_of_the_last_4_kB_it_is_read_up_to_the_last_whole_record(tmp_path):
    events = {12: EVENTS[100], 70: EVENTS[5]}
    whole = write_journal(tmp_path / "a.journal", samples_of()[:80], header_of(samples_of()), events)
    data = whole.read_bytes()
    ends = ends_of(data)
    everything = read_journal(whole)
    marks = [data[end : end + 2] for end in ends[:-1]]
    for size in range(len(data) - 1, len(data) - 4097, -1):
        os.truncate(whole, size)
        read = read_journal(whole)
        records = sum(end <= size for end in ends) - 1
        count = sum(mark == b"\xf5S" for mark in marks[:records])
        assert read.samples.tobytes() == everything.samples[:count].tobytes()
        assert read.events == everything.events[: records - count]
        assert read.complete is False
        assert read.lost_bytes == size - ends[records]
        assert bool(read.losses) == (size not in ends)
        if read.losses:
            assert read.losses[0].why == "the last record is cut" and read.losses[0].records is None


def test_a_flipped_bit_loses_its_record_and_never_gives_a_wrong_number(whole):
    data = bytearray(whole.read_bytes())
    start = data.index(b"\n") + 1
    everything = read_journal(whole)
    known = {row.tobytes() for row in everything.samples}
    rng = random.Random(3)
    for _ in range(400):
        bit = rng.randrange(8 * start, 8 * len(data))
        data[bit // 8] ^= 1 << bit % 8
        whole.write_bytes(data)
        data[bit // 8] ^= 1 << bit % 8
        read = read_journal(whole)
        assert all(row.tobytes() in known for row in read.samples)
        assert len(read.samples) + len(read.events) == len(everything.samples) + len(everything.events) - 1
        (loss,) = read.losses
        assert loss.at <= bit // 8 < loss.at + loss.bytes
        assert loss.records in (1, None)  # of the last record nobody can know


def test_many_flipped_bits_give_no_wrong_number_either(whole):
    clean = whole.read_bytes()
    start = clean.index(b"\n") + 1
    everything = read_journal(whole)
    by_tick = {int(row["tick"]): row.tobytes() for row in everything.samples}
    rng = random.Random(4)
    for _ in range(60):
        data = bytearray(clean)
        for _ in range(rng.randrange(2, 300)):
            data[rng.randrange(start, len(data))] ^= 1 << rng.randrange(8)
        whole.write_bytes(data)
        read = read_journal(whole)
        ticks = read.samples["tick"].tolist()
        assert ticks == sorted(set(ticks))
        assert all(row.tobytes() == by_tick[int(row["tick"])] for row in read.samples)
        lost = len(everything.samples) + len(everything.events) - len(read.samples) - len(read.events)
        if all(loss.records is not None for loss in read.losses):
            assert sum(loss.records for loss in read.losses) == lost


def test_damage_in_the_middle_is_passed_over_and_told(whole):
    data = bytearray(whole.read_bytes())
    ends = ends_of(data)
    data[ends[50] + 20 : ends[53] - 20] = bytes(ends[53] - ends[50] - 40)
    whole.write_bytes(data)
    read = read_journal(whole)
    assert read.complete
    assert read.losses_told == [f"3 records at byte {ends[50]}, of which {ends[53] - ends[50]} bytes are left: damaged"]
    assert set(range(400)) - set(read.samples["tick"].tolist()) == {49, 50, 51}  # the trigger is a record too


def test_records_that_are_gone_leave_a_gap_that_is_told(whole):
    data = whole.read_bytes()
    ends = ends_of(data)
    whole.write_bytes(data[: ends[50]] + data[ends[53] :])
    read = read_journal(whole)
    assert read.losses_told == [f"3 records at byte {ends[50]}: missing"]
    assert len(read.samples) == 397


def test_a_block_that_is_there_twice_counts_once(whole):
    data = whole.read_bytes()
    ends = ends_of(data)
    whole.write_bytes(data[: ends[60]] + data[ends[50] : ends[60]] + data[ends[60] :])
    read = read_journal(whole)
    assert read.samples.tobytes() == samples_of().tobytes()
    assert read.lost_bytes == ends[60] - ends[50]


def test_zeros_and_blocks_of_another_journal_at_the_end_are_no_records(tmp_path, whole):
    data = whole.read_bytes()
    ends = ends_of(data)
    other = write_journal(tmp_path / "b.journal", header={**header_of(samples_of()), "name": "b"}).read_bytes()
    for tail, why in ((bytes(4096), "zeros"), (other[ends_of(other)[300] :], "damaged")):
        whole.write_bytes(data[: ends[200]] + tail)
        read = read_journal(whole)
        assert len(read.samples) + len(read.events) == 200 and not read.complete
        assert read.lost_bytes == len(tail) and read.losses[0].why.startswith(why)


@pytest.mark.parametrize("at", [0, 5, 40, 60, 200, -2])
def test_a_damaged_head_is_refused(whole, at):
    data = bytearray(whole.read_bytes())
    end = data.index(b"\n") + 1
    data[at if at >= 0 else end + at] ^= 1
    whole.write_bytes(data)
    with pytest.raises(InputError, match=r"head of the journal|not a benchlab journal|benchlab \(journal") as caught:
        read_journal(whole)
    assert caught.value.exit_code == 3


def test_the_line_end_of_the_head_damaged_and_a_cut_head_are_refused(whole):
    data = whole.read_bytes()
    end = data.index(b"\n")
    for damaged in (data[:end] + b"\x0b" + data[end + 1 :], data[: end - 10], data[:end]):
        whole.write_bytes(damaged)
        with pytest.raises(InputError, match=r"head of the journal is (cut|damaged)"):
            read_journal(whole)


def test_a_newer_journal_and_other_files_are_refused(tmp_path, whole):
    whole.write_bytes(whole.read_bytes().replace(b'"schema_version":1', b'"schema_version":2', 1))
    with pytest.raises(InputError, match=r"newer benchlab .*journal 2, this one reads 1.*update"):
        read_journal(whole)
    for name, content in {"a.csv": b"a,b\n1,2\n", "a.h5": b"\x89HDF\r\n\x1a\n", "a.pkl": b"\x80\x04."}.items():
        (tmp_path / name).write_bytes(content)
        with pytest.raises(InputError, match="not a benchlab journal"):
            read_journal(tmp_path / name)
    (tmp_path / "empty").touch()
    with pytest.raises(InputError, match="empty file"):
        read_journal(tmp_path / "empty")
    with pytest.raises(UsageError, match="no such file"):
        read_journal(tmp_path / "none")


def test_a_journal_of_other_fields_is_refused(tmp_path, monkeypatch):
    monkeypatch.setattr(journal_module, "_DESCRIPTOR", [{"field": "tick", "units": "", "dtype": "<u4"}])
    path = write_journal(tmp_path / "a.journal")
    monkeypatch.undo()
    with pytest.raises(InputError, match="other fields"):
        read_journal(path)


def test_a_file_that_is_too_large_is_refused_before_it_is_read(tmp_path):
    path = tmp_path / "a.journal"
    with path.open("wb") as file:
        file.truncate(journal_module.MAX_BYTES + 1)
    with pytest.raises(InputError, match="1000 MB, more than the limit"):
        read_journal(path)


def test_the_longest_plan_makes_a_journal_that_is_read():
    assert MAX_TICKS * (SAMPLE.itemsize + 14) < journal_module.MAX_BYTES / 2


def test_a_file_made_to_be_slow_is_given_up(whole, monkeypatch):
    monkeypatch.setattr(journal_format, "MAX_SEARCH", 20_000_000)
    head = whole.read_bytes()[: ends_of(whole.read_bytes())[0]]
    claim = journal_format.HEAD.pack(b"\xf5E", 900_000, 0)
    whole.write_bytes(head + claim * 400_000)
    found = []
    assert cpu_s(lambda: found.append(read_journal(whole))) < 5 * slowness()
    (read,) = found
    assert len(read.samples) == 0 and "no whole record found within reach" in read.losses[0].why


ROW = st.tuples(*[
    {"u": st.integers(0, 2**32 - 1), "i": st.integers(-(2**31), 2**31 - 1)}.get(
        SAMPLE[name].kind, st.floats(width=8 * SAMPLE[name].itemsize)
    )
    for name in SAMPLE.names
])  # fmt: skip
JSON = st.recursive(
    st.none() | st.booleans() | st.integers(-(2**53), 2**53) | st.floats(allow_nan=False, allow_infinity=False) | st.text(),
    lambda inner: st.lists(inner, max_size=3) | st.dictionaries(st.text(), inner, max_size=3),
    max_leaves=8,
)  # fmt: skip
HEADER = st.dictionaries(st.text(), JSON, max_size=5)
KEYS = st.text().filter(lambda key: key not in ("kind", "self", "after_samples"))
EVENT = st.tuples(st.sampled_from(KINDS), st.dictionaries(KEYS, JSON, max_size=3))


@settings(
    max_examples=60, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture, HealthCheck.too_slow]
)
@given(header=HEADER, records=st.lists(ROW | EVENT, max_size=12))
def test_whatever_is_written_is_read(tmp_path, header, records):
    path = tmp_path / "any.journal"
    path.unlink(missing_ok=True)
    writer = JournalWriter(path, header)
    for record in records:
        if isinstance(record[0], str):
            writer.event(record[0], **record[1])
        else:
            writer.sample(*record)
    writer.close()
    read = read_journal(path)
    rows = [record for record in records if not isinstance(record[0], str)]
    events = [record for record in records if isinstance(record[0], str)]
    assert read.header == header and not read.losses
    assert read.samples.tobytes() == np.array(rows, SAMPLE).tobytes()
    told = [{key: value for key, value in event.items() if key != "after_samples"} for event in read.events]
    assert told == [{"kind": kind, **content} for kind, content in events]
    assert read.complete is any(kind == "stop" for kind, _ in events)


def test_a_number_that_is_not_finite_is_null_in_an_event(tmp_path):
    path = write_journal(tmp_path / "a.journal", events={0: [{"kind": "warning", "value": float("nan")}]})
    assert read_journal(path).events[0]["value"] is None


def test_a_journal_is_never_written_over(whole):
    before = whole.read_bytes()
    with pytest.raises(UsageError, match="exists; a journal is never written over"):
        JournalWriter(whole, {})
    assert whole.read_bytes() == before
    with pytest.raises(InputError, match="cannot be written here: no such file"):
        JournalWriter(whole.parent / "none" / "a.journal", {})


def test_an_unknown_kind_and_an_outsize_event_are_bugs_that_leave_the_journal_whole(tmp_path):
    writer = JournalWriter(tmp_path / "a.journal", {})
    with pytest.raises(ValueError, match="no kind of event"):
        writer.event("end")
    with pytest.raises(ValueError, match="an event of"):
        writer.event("mark", text="x" * 1_000_001)
    writer.event("mark", text="ok")
    writer.close()
    writer.close()
    assert [event["text"] for event in read_journal(writer.path).events] == ["ok"]


def test_a_disk_that_is_full_is_told_at_once_and_what_was_written_is_kept(tmp_path, monkeypatch):
    writer = JournalWriter(tmp_path / "a.journal", {})
    rows = samples_of().tolist()
    writer.sample(*rows[0])
    true_write = os.write
    monkeypatch.setattr(os, "write", lambda file, data: true_write(file, data[:40]))
    with pytest.raises(InputError, match=r"no space left on device; free some space; .*benchlab recover"):
        writer.sample(*rows[1])

    def full(*_):
        raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))

    monkeypatch.setattr(os, "write", full)
    with pytest.raises(InputError, match="no space left"):
        writer.event("stop", **STOP)
    monkeypatch.setattr(os, "write", true_write)
    writer.event("stop", **STOP)
    writer.close()
    read = read_journal(writer.path)
    assert len(read.samples) == 1 and read.complete and read.lost_bytes == 40 and read.losses[0].records == 0


def test_the_file_size_limit_of_the_system_is_told_as_such(tmp_path):
    code = (
        "import resource, signal, sys; sys.path.insert(0, sys.argv[2])\n"
        "from pathlib import Path\n"
        "from benchlab.errors import InputError\n"
        "from benchlab.io.journal import JournalWriter\n"
        "from tests.unit.io.journals import samples_of\n"
        "signal.signal(signal.SIGXFSZ, signal.SIG_IGN)\n"
        "resource.setrlimit(resource.RLIMIT_FSIZE, (10_000, 10_000))\n"
        "writer = JournalWriter(Path(sys.argv[1]), {})\n"
        "try:\n"
        "    [writer.sample(*row) for row in samples_of().tolist()]\n"
        "except InputError as error:\n"
        "    print(error)\n"
    )
    root = next(parent for parent in journal_module.Path(__file__).parents if (parent / "pyproject.toml").exists())
    path = tmp_path / "a.journal"
    done = subprocess.run(
        [sys.executable, "-c", code, str(path), str(root)], capture_output=True, text=True, check=True
    )
    assert re.search(r"a\.journal: the journal could not be written", done.stdout)
    assert (
        len(read_journal(path).samples)
        == (10_000 - ends_of(path.read_bytes()[:3000].split(b"\n")[0] + b"\n")[0]) // 106
    )


def test_what_the_disk_refuses_in_the_thread_is_told_at_the_next_call(tmp_path, monkeypatch):
    monkeypatch.setattr(journal_module, "SYNC_S", 0.01)
    called = []

    def refuse(_):
        called.append(1)
        raise OSError(errno.EIO, os.strerror(errno.EIO))

    monkeypatch.setattr(os, "fdatasync", refuse, raising=False)
    writer = JournalWriter(tmp_path / "a.journal", {})
    row = samples_of().tolist()[0]
    with pytest.raises(InputError, match="input/output error"):
        for _ in range(6000):
            writer.sample(*row)
            time.sleep(0.01)
    assert called


def test_the_disk_is_asked_in_a_thread_of_its_own_and_a_slow_one_holds_nobody_up(tmp_path, monkeypatch):
    monkeypatch.setattr(journal_module, "SYNC_S", 0.01)
    asked, all_written, came = threading.Event(), threading.Event(), []

    def slow(_: int) -> None:
        asked.set()
        came.append(all_written.wait(60))

    monkeypatch.setattr(os, "fdatasync", slow, raising=False)
    writer = JournalWriter(tmp_path / "a.journal", {})
    row = samples_of().tolist()[0]
    writer.sample(*row)
    assert asked.wait(60)
    for _ in range(30):
        writer.sample(*row)
    all_written.set()
    writer.close()
    assert all(came)  # none of the samples waited for the disk
    assert len(read_journal(writer.path).samples) == 31


def test_a_sample_costs_less_than_30_us(tmp_path):
    writer = JournalWriter(tmp_path / "a.journal", {})
    row = samples_of().tolist()[0]
    costs = [cpu_s(lambda: [writer.sample(*row) for _ in range(500)]) / 500 for _ in range(10)]
    writer.close()
    assert min(costs) < 30e-6 * slowness()


def test_a_journal_tells_whether_it_is_still_written_and_is_read_meanwhile(tmp_path):
    writer = JournalWriter(tmp_path / "a.journal", {})
    writer.sample(*samples_of().tolist()[0])
    assert still_written(writer.path)
    assert len(read_journal(writer.path).samples) == 1
    writer.close()
    assert not still_written(writer.path)


def test_a_writer_killed_at_any_time_leaves_whole_records(tmp_path):
    code = (
        "import sys, itertools; sys.path.insert(0, sys.argv[2])\n"
        "from pathlib import Path\n"
        "from benchlab.io.journal import JournalWriter\n"
        "from tests.unit.io.journals import samples_of\n"
        "writer = JournalWriter(Path(sys.argv[1]), {})\n"
        "row = samples_of().tolist()[0]\n"
        "for tick in itertools.count():\n"
        "    writer.sample(tick, *row[1:])\n"
        "    sys.stdout.write(f'{tick}\\n'); sys.stdout.flush()\n"
    )
    root = next(parent for parent in journal_module.Path(__file__).parents if (parent / "pyproject.toml").exists())
    for time_ in (0.0, 0.013, 0.05):
        path = tmp_path / f"{time_}.journal"
        with subprocess.Popen([sys.executable, "-c", code, str(path), str(root)], stdout=subprocess.PIPE) as writer:
            writer.stdout.readline()
            time.sleep(time_)
            writer.send_signal(signal.SIGKILL)
            told = writer.stdout.read().split(b"\n")
        said = [int(line) for line in told[:-1]]
        read = read_journal(path)
        assert read.lost_bytes == 0 and not still_written(path) and not read.complete
        assert read.samples["tick"].tolist() == list(range(len(read.samples)))
        assert len(read.samples) - 1 in {(said or [0])[-1], (said or [0])[-1] + 1}


@pytest.mark.parametrize("how", ["removed", "moved with its folder", "another in its place"])
def test_a_journal_that_is_not_at_its_place_any_more_is_told_in_the_next_sample_and_at_its_end(
    tmp_path, monkeypatch, how
):
    monkeypatch.setattr(journal_module, "SYNC_S", 0.02)
    folder = tmp_path / "out"
    folder.mkdir()
    writer = JournalWriter(folder / "a.journal", {})
    row = samples_of().tolist()[0]
    writer.sample(*row)
    time.sleep(0.1)
    writer.sample(*row)  # all is well so far
    if how.startswith("moved"):
        folder.rename(tmp_path / "elsewhere")
    else:
        writer.path.unlink()
    if how.startswith("another"):
        writer.path.write_text("mine")
    end = time.monotonic() + 60
    while writer._trouble is None and time.monotonic() < end:
        time.sleep(0.01)
    with pytest.raises(InputError, match=r"a\.journal: the journal is not at its place any more") as told:
        writer.sample(*row)
    assert "recover" not in str(told.value) and "no space" not in str(told.value)
    with pytest.raises(InputError, match="not at its place any more"):
        writer.close()


def test_what_comes_after_the_vent_is_not_of_the_plan(tmp_path):
    writer = JournalWriter(tmp_path / "a.journal", {})
    row = samples_of().tolist()[0]
    for kind in ("", "", "vent", "", "stop"):
        writer.event(kind, time_s=1.0) if kind else writer.sample(*row)
    writer.close()
    read = read_journal(tmp_path / "a.journal")
    assert len(read.samples) == 3 and len(read.driven) == 2
