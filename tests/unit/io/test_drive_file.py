"""The drive file and its table: what the journal held, opened by other tools, damaged, and never wrong without saying so."""

import csv
import json
import random

import h5py
import numpy as np
import pytest
import xarray

from benchlab.errors import BenchlabError, InputError
from benchlab.io.drive_file import cycles_of, origin, read_drive_file, trigger_times_s, write_drive_file
from benchlab.io.drive_table import write_drive_csv
from benchlab.io.journal import SAMPLE, UNITS, read_journal
from benchlab.io.run_file import read_run_file
from tests.unit.io.journals import header_of, samples_of, write_journal

EVENTS = {
    5: [{"kind": "trigger", "tick": 5, "time_s": 0.11, "text": ""}],
    100: [{"kind": "mark", "tick": 100, "time_s": 2.0, "text": "=top\n"}],
}
CUT = {"reason": "not following", "words": "leak", "vented": True, "time_s": 7.0}


def journal_of(tmp_path, samples=None, header=None, **options):
    path = tmp_path / "a.journal"
    path.unlink(missing_ok=True)
    return read_journal(write_journal(path, samples, header, **{"events": EVENTS, **options}))


@pytest.fixture
def journal(tmp_path):
    return journal_of(tmp_path)


@pytest.fixture
def drive(tmp_path, journal):
    path = tmp_path / "a.h5"
    write_drive_file(path, journal, {"file": "a.journal", "sha256": "00ff"})
    return path


def without(*names):
    samples = samples_of()
    for name in names:
        samples[name] = np.nan
    return samples


def test_what_the_journal_held_is_read(drive, journal):
    read = read_drive_file(drive)
    assert read.samples.tobytes() == journal.samples.tobytes()
    assert read.header == journal.header
    assert read.events == journal.events
    assert read.complete and read.losses == ()


def test_losses_and_a_missing_end_are_kept(tmp_path, journal):
    path = tmp_path / "a.journal"
    path.write_bytes(path.read_bytes()[:-200])
    cut = read_journal(path)
    write_drive_file(tmp_path / "b.h5", cut)
    read = read_drive_file(tmp_path / "b.h5")
    assert not read.complete and read.losses == cut.losses and read.lost_bytes > 0
    with h5py.File(tmp_path / "b.h5") as file:
        assert bool(file.attrs["partial"])


@pytest.mark.parametrize(("stop", "partial"), [({"reason": "completed"}, False), (CUT, True), (None, True)])
def test_a_run_that_was_not_completed_is_partial(tmp_path, stop, partial):
    write_drive_file(tmp_path / "a.h5", journal_of(tmp_path, stop=stop))
    with h5py.File(tmp_path / "a.h5") as file:
        assert bool(file.attrs["partial"]) is partial


def test_xarray_gets_time_as_a_coordinate_and_units(drive):
    samples = samples_of()
    with xarray.open_dataset(drive, engine="h5netcdf", group="entry/drive") as data:
        assert data["angle_deg"].dims == ("time_s",)
        np.testing.assert_array_equal(data.coords["time_s"], samples["time_s"])
        for name in SAMPLE.names:
            np.testing.assert_array_equal(data[name], samples[name])
            assert data[name].attrs.get("units", "") == UNITS[name]
        assert float(data["pressure_MPa"].sel(time_s=2.0)) == pytest.approx(0.19)
        assert set(np.unique(data["cycle"])) == {1, 2}
        np.testing.assert_allclose(data["angle_deg_errors"], 0.8)
        np.testing.assert_allclose(data["pressure_MPa_errors"], 0.0005)


@pytest.mark.parametrize(
    ("missing", "signal"),
    [((), "angle_deg"), (("angle_deg",), "pressure_MPa"), (("angle_deg", "pressure_MPa"), "command_MPa")],
)
def test_nexus_viewers_draw_what_was_measured(tmp_path, missing, signal):
    write_drive_file(tmp_path / "a.h5", journal_of(tmp_path, without(*missing)))
    with h5py.File(tmp_path / "a.h5") as file:
        at = file
        while "default" in at.attrs:
            at = at[at.attrs["default"]]
        assert at.name == "/entry/drive" and at.attrs["NX_class"] == "NXdata"
        assert at.attrs["signal"] == signal and list(at.attrs["axes"]) == ["time_s"]
        assert at[signal].dims[0][0].name == "/entry/drive/time_s"
        assert file["entry"].attrs["NX_class"] == "NXentry"
        assert ("angle_deg_errors" in at) is ("angle_deg" not in missing)


def test_head_events_and_steps_are_texts_of_json(drive):
    with h5py.File(drive) as file:
        texts = {name: json.loads(file[f"entry/{name}"][()]) for name in file["entry"] if name != "drive"}
    assert texts["protocol"]["text"].startswith("title:")
    assert texts["plan"]["steps"][0] == header_of(samples_of())["plan"]["steps"][0]
    assert texts["head"]["title"] == "Two triangles"
    assert [event["kind"] for event in texts["events"]] == ["trigger", "mark", "stop"]
    assert texts["journal"] == {"file": "a.journal", "sha256": "00ff", "complete": True, "losses": []}
    assert {"bench", "device", "provenance"} <= set(texts)


def test_a_file_of_a_twin_says_so_in_its_title(tmp_path):
    write_drive_file(tmp_path / "a.h5", journal_of(tmp_path, header=header_of(samples_of(), "twin")))
    with h5py.File(tmp_path / "a.h5") as file:
        assert file["entry/drive/title"][()].decode() == "Two triangles, simulated (twin)"
    twin_replayed = {"bench_kind": "replay", "device": {"kind": "replay", "replayed": "twin"}}
    assert origin(twin_replayed) == "replay of a run, simulated (twin)"
    assert origin({"bench_kind": "replay", "device": {"replayed": "serial"}}) == "replay of a run"


def test_a_run_without_a_sample_and_with_a_bare_head(tmp_path):
    journal = journal_of(tmp_path, samples_of()[:0], {"title": "x"}, events={})
    write_drive_file(tmp_path / "a.h5", journal)
    read = read_drive_file(tmp_path / "a.h5")
    assert len(read.samples) == 0 and read.header == {"title": "x"}


def test_cycles_follow_the_counts_and_triggers_the_commands(journal):
    cycle = cycles_of(journal)
    assert cycle[:200].tolist() == [1] * 200 and cycle[200:].tolist() == [2] * 200
    assert trigger_times_s(journal).tolist() == [0.1]  # of the command, not of the event


def test_the_disk_refuses_and_nothing_is_there(tmp_path, journal):
    with pytest.raises(InputError):
        write_drive_file(tmp_path / "none" / "of" / "a.h5", journal)


def test_a_file_of_another_kind_and_a_newer_one_are_refused(tmp_path, drive):
    with pytest.raises(InputError, match="not a benchlab run file"):
        read_run_file(drive)
    with h5py.File(drive, "r+") as file:
        file.attrs["schema_version"] = 9
    with pytest.raises(InputError, match="made by a newer benchlab"):
        read_drive_file(drive)
    with h5py.File(drive, "r+") as file:
        file.attrs["schema_version"] = 1
        time_s = file["entry/drive/command_MPa"]
        del file["entry/drive/command_MPa"]
        assert time_s is not None
        file["entry/drive/command_MPa"] = h5py.ExternalLink("/etc/passwd", "/")
    with pytest.raises(InputError, match="is a link"):
        read_drive_file(drive)


def test_an_outsize_claim_is_refused_before_memory_is_taken(tmp_path, drive):
    with h5py.File(drive, "r+") as file:
        del file["entry/drive/time_s"]
        file["entry/drive"].create_dataset("time_s", shape=(10**12,), dtype="f8", chunks=(10**6,))
    with pytest.raises(InputError, match=r"GB|claims"):
        read_drive_file(drive)


def test_flips_and_cuts_end_in_a_refusal_or_in_the_same_numbers(tmp_path, drive):
    clean = drive.read_bytes()
    true = read_drive_file(drive)
    rng = random.Random(5)
    refused = 0
    for turn in range(120):
        data = bytearray(clean)
        if turn % 4 == 0:
            data = data[: rng.randrange(len(data))]
        else:
            bit = rng.randrange(8 * len(data))
            data[bit // 8] ^= 1 << bit % 8
        drive.write_bytes(data)
        try:
            read = read_drive_file(drive)
        except BenchlabError as error:
            refused += 1
            assert str(drive) in str(error)
            continue
        assert read.samples.tobytes() == true.samples.tobytes()
        assert read.header == true.header and read.events == true.events
    assert refused > 60


def test_the_table_has_a_row_a_sample_and_empty_cells_for_what_is_not_known(tmp_path):
    samples = without("reference_deg", "pressure_MPa")
    samples["code"][3] = -1
    write_drive_csv(tmp_path / "a.csv", journal_of(tmp_path, samples, header_of(samples, "twin")))
    with (tmp_path / "a.csv").open(newline="") as file:
        rows = list(csv.DictReader(file))
    assert len(rows) == 400
    wanted = [
        "time_s",
        "command_MPa",
        "pressure_MPa",
        "angle_deg",
        "flex_V",
        "reference_deg",
        "cycle",
        "step",
        "step_label",
    ]
    assert list(rows[0])[:9] == wanted
    assert rows[150]["step_label"] == "ramp down µ=1" and rows[150]["cycle"] == "1" and rows[150]["step"] == "1"
    assert float(rows[150]["command_MPa"]) == pytest.approx(0.1) and float(rows[150]["time_s"]) == 3.0
    assert rows[150]["pressure_MPa"] == rows[150]["reference_deg"] == ""
    assert rows[3]["code"] == "" and rows[4]["code"] != ""
    assert {row["origin"] for row in rows} == {"simulated (twin)"}
    told = {index: row["event"] for index, row in enumerate(rows) if row["event"]}
    assert told == {5: "trigger", 100: "mark: =top\\n", 399: "stop: completed"}
