"""`benchlab sweep` from the command line: grid, files, resuming, failures, published points."""

import csv
import subprocess
import sys

import h5py
import numpy as np
import pytest

from benchlab.actuator import ShellDesign
from benchlab.io.layup_file import DEFAULT_LAYUP, read_layup
from benchlab.io.sweep_file import read_sweep_file
from benchlab.simulation.actuator_response import actuator_response
from tests.system.models import beam_model
from tests.system.patience import interrupted_at

FAST = ("--pressure-MPa", "0.1,0.2", "--no-blocked", "--jobs", "1")


def rows(path):
    with path.open(encoding="utf-8") as file:
        return list(csv.DictReader(file))


def test_every_combination_is_the_design_s_own_simulation(benchlab, tmp_path):
    done = benchlab(
        "sweep",
        "--slw-mm",
        "8,10",
        "--tw-mm",
        "3:5:2",
        "--pressure-MPa",
        "0.1,0.2",
        "--jobs",
        1,
        "--out",
        tmp_path,
        "--json",
    )
    assert done.code == 0, done.err
    table = rows(tmp_path / "sweep_tw3-5_slw8-10.csv")
    assert [(r["tw_mm"], r["slw_mm"], r["pressure_MPa"]) for r in table[:4]] == [
        ("3", "8", "0.1"), ("3", "8", "0.2"), ("3", "10", "0.1"), ("3", "10", "0.2"),
    ]  # fmt: skip
    truth = actuator_response(ShellDesign(10, 5), read_layup(DEFAULT_LAYUP), [0.1, 0.2])
    for name, values in truth.columns().items():
        assert [float(r[name]) for r in table[-2:]] == pytest.approx(values, rel=1e-6)
    assert float(table[-1]["tpu_area_mm2"]) == pytest.approx(truth.design.tpu_area_mm2)
    assert done.json["designs"] == 4 and not done.json["failed"] and len(done.json["points"]) == 4
    with h5py.File(tmp_path / "sweep_tw3-5_slw8-10.h5") as file:
        group = file["entry/sweep"]
        assert list(group.attrs["axes"]) == ["tw_mm", "slw_mm", "pressure_MPa"] and group.attrs["signal"] == "angle_deg"
        np.testing.assert_allclose(group["angle_deg"][1, 1], truth.angle_deg, rtol=1e-9)
        assert group["angle_deg"].dims[1][0][:].tolist() == [8, 10] and group["angle_deg"].attrs["units"] == "deg"
    assert (tmp_path / "sweep_tw3-5_slw8-10.png").stat().st_size > 20_000


def test_opens_in_xarray_with_its_coordinates(benchlab, tmp_path):
    import xarray

    assert benchlab("sweep", "--slw-mm", "8,10", *FAST, "--out", tmp_path).code == 0
    with xarray.open_dataset(
        tmp_path / "sweep_tw3_slw8-10.h5", group="entry/sweep", engine="h5netcdf", phony_dims="sort"
    ) as data:
        assert data.angle_deg.dims == ("slw_mm", "pressure_MPa")
        assert float(data.angle_deg.sel(slw_mm=10, pressure_MPa=0.2)) > 60


def test_a_second_run_simulates_nothing_and_another_pressure_all(benchlab, tmp_path):
    first = benchlab("sweep", "--slw-mm", "8,10", *FAST, "--out", tmp_path, "--json").json
    again = benchlab("sweep", "--slw-mm", "8,10", *FAST, "--out", tmp_path, "--json").json
    assert (first["reused"], again["reused"]) == (0, 2) and first["points"] == again["points"]
    other = benchlab(
        "sweep", "--slw-mm", "8,10", "--pressure-MPa", "0.1", "--no-blocked", "--jobs", 1, "--out", tmp_path, "--json"
    )
    assert other.json["reused"] == 0
    anew = benchlab(
        "sweep",
        "--slw-mm",
        "8,10",
        "--pressure-MPa",
        "0.1",
        "--no-blocked",
        "--jobs",
        1,
        "--out",
        tmp_path,
        "--json",
        "--overwrite",
    )
    assert anew.json["reused"] == 0


def test_a_design_that_cannot_be_made_is_a_row_with_its_reason(benchlab, tmp_path):
    done = benchlab("sweep", "--slw-mm", "10,50", *FAST, "--out", tmp_path, "--json")
    assert done.code == 4 and "slw) is 50" in done.err
    table = rows(tmp_path / "sweep_tw3_slw10-50.csv")
    assert [bool(r["angle_deg"]) for r in table] == [True, True, False, False]
    assert "leaves no window" in table[2]["reason"] and not table[0]["reason"]
    assert done.json["failed"][0]["code"] == 2


def test_a_design_that_bursts_keeps_what_it_reached(benchlab, tmp_path):
    soft = tmp_path / "soft.yaml"
    soft.write_text("name: soft\norigin: made up, to burst\nfilm: {law: neo-hooke, coefficients_MPa: {C10: 1.0}}\n")
    done = benchlab("sweep", "--tw-mm", "15", "--slw-mm", "10", "--pressure-MPa", "0.05,0.35", "--no-blocked", "--jobs", 1,
                    "--material", soft, "--out", tmp_path, "--json")  # fmt: skip
    assert done.code == 0, done.err
    (burst,) = done.json["bursting"]
    assert 0.05 <= burst["limit_pressure_MPa"] < 0.35 and "bursts" in done.err
    table = rows(tmp_path / "sweep_tw15_slw10.csv")
    assert table[0]["angle_deg"] and not table[1]["angle_deg"] and "it bursts" in table[1]["reason"]


@pytest.mark.parametrize(
    ("option", "value", "what"),
    [
        ("--slw-mm", "30:1", "does not grow"),
        ("--slw-mm", "1:30:0", "in steps above 0"),
        ("--slw-mm", "1,1", "twice"),
        ("--slw-mm", "nan", "not a number"),
        ("--slw-mm", "1:2:3:4", "is not START:END"),
        ("--slw-mm", "0:1:0.0000001", "more than 10000 values"),
        ("--slw-mm", "50,60", "leaves no window"),
        ("--pressure-MPa", "-0.1,0.1", "a pressure is -0.1 MPa"),
        ("--material", "unobtainium", "no material is called"),
        ("--cap-mm", "90", "leave nothing"),
        ("--lever-arm-mm", "0", "lever_arm_mm is 0"),
    ],
)
def test_what_cannot_be_is_refused_and_leaves_nothing(benchlab, tmp_path, option, value, what):
    done = benchlab("sweep", option, value, "--jobs", 1, "--out", tmp_path)
    assert done.code == 2 and what in done.err, done.err
    assert not list(tmp_path.iterdir())


def test_files_of_others_are_not_replaced(benchlab, tmp_path):
    (tmp_path / "sweep_tw3_slw8.csv").write_text("mine")
    done = benchlab("sweep", "--slw-mm", "8", *FAST, "--out", tmp_path)
    assert done.code == 2 and (tmp_path / "sweep_tw3_slw8.csv").read_text() == "mine"


@pytest.mark.skipif(sys.platform == "win32", reason="signals")
def test_interrupted_it_keeps_what_is_done_and_goes_on_from_there(benchlab, tmp_path):
    command = ("sweep", "--slw-mm", "4:10", *FAST, "--out", str(tmp_path))
    process = subprocess.run([*interrupted_at(3), *command], capture_output=True, text=True, check=False)
    said = process.stderr
    assert process.returncode == 130 and "marked partial" in said, said
    path = tmp_path / "sweep_tw3_slw4-10.h5"
    part = read_sweep_file(path)
    kept = sum(map(bool, part.key))
    assert part.partial and kept == 3 and part.reason.count("not simulated yet") == 7 - kept
    done = benchlab(*command, "--json")
    assert done.code == 0 and done.json["reused"] == kept
    assert not read_sweep_file(path).partial and not list(tmp_path.glob(".*"))


def test_the_scheduler_option_says_what_is_wrong(benchlab, tmp_path):
    done = benchlab("sweep", "--jobs", 1, "--scheduler", "tcp://127.0.0.1:1", "--out", tmp_path)
    assert done.code == 2 and "give one of them" in done.err


def test_a_model_is_swept_over_designs_and_is_not_taken_for_another(benchlab, tmp_path, monkeypatch):
    monkeypatch.setenv("BENCHLAB_CACHE", str(tmp_path / "kept"))
    model = beam_model(tmp_path / "found.yaml", end_caps={"cap_mm": 9.0})
    call = ("sweep", "--tw-mm", "3,5", "--slw-mm", 10, *FAST, "--model", model, "--out", tmp_path / "out", "--json")
    done = benchlab(*call)
    assert done.code == 0, done.err
    swept = read_sweep_file(tmp_path / "out" / "sweep_tw3-5_slw10.h5")
    one = benchlab("simulate", "--tw-mm", 5, "--slw-mm", 10, "--pressure-MPa", "0.1,0.2", "--model", model, "--out", tmp_path / "one",
                   "--json")  # fmt: skip
    assert swept.curves["angle_deg"][1] == pytest.approx([point["angle_deg"] for point in one.json["points"]], rel=1e-9)
    assert np.isnan(swept.curves["peak_film_strain"]).all()
    assert swept.settings["model"]["effects"][0]["name"] == "end_caps"
    assert benchlab(*call).json["reused"] == 2
    beam_model(tmp_path / "found.yaml", end_caps={"cap_mm": 18.0})
    again = benchlab(*call)
    assert again.json["reused"] == 0
    angles = read_sweep_file(tmp_path / "out" / "sweep_tw3-5_slw10.h5").curves["angle_deg"]
    assert angles == pytest.approx(8 / 9 * swept.curves["angle_deg"], rel=1e-6)
