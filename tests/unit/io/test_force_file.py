"""Force files: what is written comes back, viewers find the plot, damage is refused, tables run no formulas."""

import os
from pathlib import Path

import h5py
import numpy as np
import pandas
import pytest

from benchlab.errors import InputError
from benchlab.io.export_tests import MachineTest
from benchlab.io.force_file import (
    read_force_file,
    read_force_provenance,
    write_force_csv,
    write_force_file,
)
from benchlab.io.machine_export import MachineExport, read_machine_export

N = 50
TIME_S = np.arange(N) / 100
FIRST = {
    "time_s": TIME_S,
    "extension_mm": TIME_S / -3,
    "force_N": np.sin(TIME_S) * 100,
    "pressure_MPa": np.full(N, 0.035),
    "cycle": np.repeat([1.0, 2.0], N // 2),
    "segment": np.where(np.arange(N) == 3, np.nan, 22476.0),
}
SECOND = {"force_N": np.where(np.arange(N) == 7, np.nan, 1 / (1 + TIME_S))}
EXPORT = MachineExport(
    Path("raw/Specimen_1.csv"),
    (MachineTest("A1", FIRST, range(9, 9 + N)), MachineTest("=cmd|calc", SECOND, np.arange(100, 100 + N))),
    2 * N,
    {"encoding": "cp1250", "force_N": "column 3, 'Obciążenie (kN)', in kN"},
    {"Próbka": "A1", "=1+1": "x"},
    ("line 12: a doubt",),
)


def same(found: MachineExport, rtol: float = 0.0) -> None:
    assert [t.specimen for t in found.tests] == [t.specimen for t in EXPORT.tests]
    for test, truth in zip(found.tests, EXPORT.tests):
        for name, values in truth.columns.items():
            np.testing.assert_allclose(test.columns[name], values, rtol=rtol)


def test_everything_comes_back_from_hdf5(tmp_path: Path) -> None:
    path = tmp_path / "a.h5"
    write_force_file(path, EXPORT, {"argv": ["benchlab", "force"]})
    found = read_force_file(path)
    same(found)
    assert [list(t.columns) for t in found.tests] == [list(FIRST), list(SECOND)]
    assert [np.asarray(t.lines).tolist() for t in found.tests] == [list(t.lines) for t in EXPORT.tests]
    assert (found.path, found.rows, found.inferred) == (EXPORT.path, EXPORT.rows, EXPORT.inferred)
    assert (found.preamble, found.warnings) == (EXPORT.preamble, EXPORT.warnings)
    assert (read_force_provenance(path) or {})["argv"] == ["benchlab", "force"]


def test_viewers_find_force_over_time_with_units_and_checksums(tmp_path: Path) -> None:
    path = tmp_path / "a.h5"
    write_force_file(path, EXPORT, {})
    with h5py.File(path) as file:
        data = file[file.attrs["default"]][file["entry"].attrs["default"]]
        assert (data.attrs["NX_class"], data.attrs["signal"], list(data.attrs["axes"])) == (
            "NXdata",
            "force_N",
            ["time_s"],
        )
        assert {name: data[name].attrs.get("units") for name in FIRST} == {
            **{"time_s": "s", "extension_mm": "mm", "force_N": "N"},
            **{"pressure_MPa": "MPa", "cycle": None, "segment": None},
        }
        assert all(data[name].fletcher32 for name in FIRST)
        assert data["force_N"].dims[0][0] == data["time_s"]
        assert list(file["entry/specimen_2"].attrs["axes"]) == ["line"]


def test_a_flipped_bit_is_refused(tmp_path: Path) -> None:
    path = tmp_path / "a.h5"
    write_force_file(path, EXPORT, {})
    with h5py.File(path) as file:
        place = file["entry/specimen_1/force_N"].id.get_chunk_info(0)
    content = bytearray(path.read_bytes())
    content[place.byte_offset + place.size // 2] ^= 4
    path.write_bytes(content)
    with pytest.raises(InputError, match="checksum error in dataset /entry/specimen_1/force_N"):
        read_force_file(path)


def test_a_missing_dataset_and_a_foreign_file_are_refused(tmp_path: Path) -> None:
    path = tmp_path / "a.h5"
    write_force_file(path, EXPORT, {})
    with h5py.File(path, "r+") as file:
        del file["entry/specimen_2/force_N"]
    with pytest.raises(InputError, match="no dataset /entry/specimen_2/force_N"):
        read_force_file(path)
    with h5py.File(path, "r+") as file:
        file.attrs["schema"] = "benchlab-run"
    with pytest.raises(InputError, match="not a benchlab force file"):
        read_force_file(path)
    assert read_force_provenance(path) is None


def test_the_table_is_read_back_and_runs_no_formula(tmp_path: Path) -> None:
    path = tmp_path / "a.csv"
    write_force_csv(path, EXPORT)
    table = pandas.read_csv(path)
    assert list(table) == ["specimen", *FIRST]
    assert table["specimen"].tolist() == ["A1"] * N + ["'=cmd|calc"] * N
    lines = path.read_text().splitlines()
    assert lines[1] == "A1,0,0,0,0.035,1,22476" and lines[4].endswith(",0.035,1,") and lines[58] == "'=cmd|calc,,,,,,"
    same_table = MachineExport(path, EXPORT.tests[:1], N, {}, {}, ())
    write_force_csv(path, same_table)
    (test,) = read_machine_export(path).tests
    assert test.specimen == "A1" and list(test.columns) == list(FIRST)
    for name, values in FIRST.items():
        np.testing.assert_allclose(test.columns[name], values, rtol=1e-11)


@pytest.mark.parametrize("name", ["A1", 'a "b", c', "nan", "%d", "Probe ü"])
def test_any_name_of_a_specimen_comes_back(tmp_path: Path, name: str) -> None:
    path = tmp_path / "a.csv"
    write_force_csv(path, MachineExport(path, (MachineTest(name, FIRST, range(N)),), N, {}, {}, ()))
    assert set(pandas.read_csv(path, keep_default_na=False, dtype=str)["specimen"]) == {name}
    (test,) = read_machine_export(path).tests
    assert test.specimen == name


def test_specimens_of_a_table_stay_apart(tmp_path: Path) -> None:
    path = tmp_path / "a.csv"
    both = (EXPORT.tests[0], MachineTest("=B", {**FIRST, "force_N": -FIRST["force_N"]}, range(N)))
    write_force_csv(path, MachineExport(path, both, 2 * N, {}, {}, ()))
    found = read_machine_export(path)
    assert [test.specimen for test in found.tests] == ["A1", "=B"]
    np.testing.assert_allclose(found.tests[1].columns["force_N"], -FIRST["force_N"], rtol=1e-11)
    assert found.inferred["specimens"] == "2, by column 1, 'specimen'"


def test_a_full_disk_leaves_nothing(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def full(*_: object, **__: object) -> None:
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(os, "fsync", full)
    with pytest.raises(InputError, match="no space left on device; free some space"):
        write_force_csv(tmp_path / "a.csv", EXPORT)
    assert list(tmp_path.iterdir()) == []
