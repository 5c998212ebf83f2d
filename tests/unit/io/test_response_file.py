"""Response files: what was written is read, by our reader and by others; damage and foreign files are refused."""

from __future__ import annotations

import json
from pathlib import Path

import h5py
import numpy as np
import pandas
import pytest
import xarray

from benchlab.actuator import ShellDesign
from benchlab.errors import InputError
from benchlab.io.response_file import (
    CURVES,
    read_response_curves,
    read_response_file,
    read_response_provenance,
    write_response_csv,
    write_response_file,
)
from benchlab.simulation.actuator_response import ActuatorResponse, actuator_response
from benchlab.simulation.laws import Polynomial
from benchlab.simulation.layup import Layup


@pytest.fixture(scope="module")
def response() -> ActuatorResponse:
    found = actuator_response(ShellDesign(10, 9), Layup("t", "guessed", film=Polynomial(C10=1.5, C20=3.0)), [0.05, 0.1])
    found.moment_Nmm[1] = np.nan  # as where the held state is not found
    return found


@pytest.fixture
def written(response: ActuatorResponse, tmp_path: Path) -> Path:
    path = tmp_path / "a.h5"
    write_response_file(
        path,
        response,
        extras={"max_film_stretch": np.array([1.1, 1.2])},
        design={"name": "tw9_slw10"},
        material={"name": "t", "unknown": np.nan},
        simulation={"simulated": True, "cap_mm": 0.0},
        provenance={"argv": ["benchlab"]},
        warnings=["one"],
    )
    return path


def test_a_file_gives_back_what_was_written(response, written):
    found = read_response_file(written)
    for name, values in response.columns().items():
        assert getattr(found.curves, name) == pytest.approx(values, nan_ok=True, rel=1e-15)
    assert found.extras["max_film_stretch"].tolist() == [1.1, 1.2]
    assert found.curves.about["material"] == {"name": "t", "unknown": None}
    assert found.curves.about["warnings"] == ["one"]
    assert read_response_provenance(written) == {"argv": ["benchlab"], "partial": False}
    for state, point in zip(found.states, response.free.points, strict=True):
        assert response.cell.volume_mm3(state) == response.cell.volume_mm3(point.state)
    assert np.array_equal(found.nodes_mm, response.cell.mesh.nodes_mm)
    assert np.array_equal(found.elements, response.cell.mesh.elements)


def test_other_programs_read_it(response, written):
    with h5py.File(written) as file:
        entry = file[file.attrs["default"]]
        group = entry[entry.attrs["default"]]
        assert [x.attrs["NX_class"] for x in (file, entry, group)] == ["NXroot", "NXentry", "NXdata"]
        assert group.attrs["signal"] == "angle_deg" and list(group.attrs["axes"]) == ["pressure_MPa"]
        assert {name: group[name].attrs.get("units", "") for name in CURVES} == {n: u for n, (u, _) in CURVES.items()}
        assert all(group[name].fletcher32 for name in CURVES)
        assert json.loads(entry["simulation"].asstr()[()])["simulated"] is True
    with xarray.open_dataset(written, group="entry/response", engine="h5netcdf") as data:
        assert data["angle_deg"].dims == ("pressure_MPa",)
        assert data["angle_deg"].values == pytest.approx(response.angle_deg)


def test_the_table_has_exactly_the_columns(response, tmp_path):
    path = tmp_path / "a.csv"
    write_response_csv(path, response)
    head = path.read_text().splitlines()[0]
    assert head == "pressure_MPa,angle_deg,curvature_per_mm,axial_stretch,volume_mL,moment_Nmm,blocked_force_N"
    frame = pandas.read_csv(path)
    found = read_response_curves(path)
    for name, values in response.columns().items():
        assert getattr(found, name) == pytest.approx(values, nan_ok=True, rel=1e-8)
        assert frame[name].to_numpy() == pytest.approx(values, nan_ok=True, rel=1e-8)
    assert found.about == {}


def test_curves_are_read_from_either(response, written):
    assert read_response_curves(written).angle_deg == pytest.approx(response.angle_deg)


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("pressure_MPa,angle_deg\n0,1\n", "without curvature_per_mm"),
        (",".join(CURVES) + "\n", "row"),
        (",".join(CURVES) + "\n0,1,2,3,4,x,6\n", "not a number: 'x'"),
        (",".join(CURVES) + "\n0,1,2,3,4,5,6\n0,1,2\n", "line 3"),
    ],
)
def test_a_table_that_is_none_is_refused_with_its_line(text, words, tmp_path):
    path = tmp_path / "a.csv"
    path.write_text(text)
    with pytest.raises(InputError) as error:
        read_response_curves(path)
    assert words in str(error.value) and "a.csv" in str(error.value)


def test_damaged_and_foreign_files_are_refused(written, tmp_path):
    data = bytearray(written.read_bytes())
    other = tmp_path / "other.h5"
    with h5py.File(other, "w") as file:
        file.attrs["schema"] = "benchlab-run"
    with pytest.raises(InputError, match="not a benchlab response file"):
        read_response_file(other)
    assert read_response_provenance(other) is None
    cut = tmp_path / "cut.h5"
    cut.write_bytes(data[: len(data) // 2])
    with pytest.raises(InputError):
        read_response_file(cut)
    rng = np.random.default_rng(1)
    for _ in range(25):
        bad = data.copy()
        bad[int(rng.integers(len(bad)))] ^= 1 << int(rng.integers(8))
        cut.write_bytes(bad)
        try:
            found = read_response_file(cut)
        except InputError:
            continue
        assert found.curves.angle_deg == pytest.approx(read_response_file(written).curves.angle_deg)
