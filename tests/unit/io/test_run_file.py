"""The run file: written, read back, opened by other tools, damaged, and never wrong without saying so."""

import json
import random
import subprocess
import sys
from dataclasses import fields, replace
from pathlib import Path

import h5py
import numpy as np
import pytest
import xarray

from benchlab.errors import BenchlabError, InputError
from benchlab.io.pressure import read_pressure
from benchlab.io.run_file import read_provenance, read_run_file, write_run_file
from benchlab.vision.series import CurvatureSeries

ABOUT = {
    "settings": {"fit": "taubin", "length_mm": 180.0, "roi": [1, 2, 3, 4], "out": Path("somewhere")},
    "provenance": {"argv": ["benchlab", "analyze", "ß\udc80.mp4"], "sha256": {"a.mp4": "00ff"}, "git": None},
    "recording": {"codec": "h264", "width": np.int64(1920)},
    "scale": {"mm_per_px": np.float64(0.25)},
    "warnings": ["variable frame rate, 33–133 ms"],
    "partial": False,
}


def bend(n_frames=50, n_markers=5, stills=False, pressure=True) -> CurvatureSeries:
    """A body of 180 mm = 720 px that bends from straight to 90° about a circle; frame 7 was not seen."""
    angle = np.radians(np.linspace(0, 90, n_frames))
    kappa = angle / 720
    s = np.linspace(0, 720, n_markers)
    with np.errstate(divide="ignore", invalid="ignore"):
        x = np.where(kappa[:, None] > 0, np.sin(kappa[:, None] * s) / kappa[:, None], s)
        y = np.where(kappa[:, None] > 0, (1 - np.cos(kappa[:, None] * s)) / kappa[:, None], 0)
        radius = np.where(kappa > 0, 1 / kappa, np.nan)
    centre = np.stack([np.full(n_frames, 100.0), 100 + radius], axis=1)
    used = np.ones((n_frames, n_markers), bool)
    arrays = {
        "angle_rad": angle,
        "angle_sd_rad": np.full(n_frames, 0.001),
        "curvature_per_mm": angle / 180,
        "curvature_sd_per_mm": np.full(n_frames, 0.001 / 180),
        "radius_mm": radius / 4,
        "centre_px": centre,
        "radius_px": radius,
        "curvature_per_px": kappa,
        "fit_rms_px": np.linspace(0.02, 0.4, n_frames),
        "centroid_sd_px": np.full(n_frames, 0.05),
        "markers_px": np.stack([100 + x, 100 + y], axis=2),
    }
    flags = [""] * n_frames
    if n_frames > 7:
        used[7] = False
        for values in arrays.values():
            values[7] = np.nan
        flags[7] = "no markers: θ unknown"
    time_s = np.arange(n_frames) / 30
    return CurvatureSeries(
        time_s=np.full(n_frames, np.nan) if stills else time_s,
        used=used,
        flag=tuple(flags),
        names=tuple(f"bild ü{i}.jpg" for i in range(n_frames)) if stills else (),
        pressure_MPa=np.where(time_s < 1.5, 0.2 * time_s, np.nan) if pressure else None,
        **arrays,
    )


@pytest.fixture
def run(tmp_path):
    path = tmp_path / "run.h5"
    write_run_file(path, bend(), **ABOUT)
    return path


def equal(a: CurvatureSeries, b: CurvatureSeries) -> bool:
    for field in fields(CurvatureSeries):
        x, y = getattr(a, field.name), getattr(b, field.name)
        if isinstance(x, np.ndarray) and isinstance(y, np.ndarray):
            same = x.dtype == y.dtype and x.shape == y.shape and np.allclose(x, y, rtol=1e-14, atol=0, equal_nan=True)
        else:
            same = x == y
        if not same:
            return False
    return True


def refusal(path):
    with pytest.raises(InputError) as caught:
        read_run_file(path)
    assert caught.value.exit_code == 3
    assert str(path) in str(caught.value)
    return str(caught.value)


@pytest.mark.parametrize("stills", [False, True])
@pytest.mark.parametrize("pressure", [False, True])
@pytest.mark.parametrize(("n_frames", "n_markers"), [(50, 5), (1, 3), (2000, 10), (9, 0)])
def test_what_is_written_is_read(tmp_path, stills, pressure, n_frames, n_markers):
    series = bend(n_frames, n_markers, stills, pressure)
    write_run_file(tmp_path / "run.h5", series, **{**ABOUT, "partial": stills})
    read = read_run_file(tmp_path / "run.h5")
    assert equal(read.series, series)
    assert read.partial is stills
    assert read.settings == {**ABOUT["settings"], "out": "somewhere"}
    assert read.provenance == ABOUT["provenance"]
    assert read.recording == {"codec": "h264", "width": 1920}
    assert read.scale == {"mm_per_px": 0.25}
    assert read.warnings == ABOUT["warnings"]


def test_xarray_gets_time_as_a_coordinate(run):
    series = bend()
    with xarray.open_dataset(run, engine="h5netcdf", group="entry/curvature") as data:
        assert data["angle_deg"].dims == ("time_s",)
        np.testing.assert_array_equal(data.coords["time_s"], series.time_s)
        np.testing.assert_allclose(data["angle_deg"], np.degrees(series.angle_rad))
        assert data["angle_deg"].attrs["units"] == "deg"
        assert float(data["angle_deg"].sel(time_s=1.0)) == pytest.approx(np.degrees(series.angle_rad[30]))
        assert data["flag"].values[7] == "no markers: θ unknown"
        for name in ("angle_deg_errors", "curvature_per_mm", "radius_mm", "fit_rms_px", "n_markers", "pressure_MPa"):
            assert data[name].dims == ("time_s",)
    with xarray.open_dataset(run, engine="h5netcdf", group="entry/tracks") as data:
        assert data["markers_px"].dims == ("time_s", "marker", "xy")
        assert data["xy"].values.tolist() == ["x", "y"]
        np.testing.assert_array_equal(data["markers_px"], series.markers_px)
        np.testing.assert_array_equal(data["used"].values.astype(bool), series.used)
    with xarray.open_dataset(run, engine="h5netcdf", group="entry/fit") as data:
        assert data["centre_px"].dims == ("time_s", "xy")
    with xarray.open_dataset(run, engine="h5netcdf", group="entry/angle_over_pressure") as data:
        assert set(data.variables) >= {"angle_deg", "pressure_MPa", "time_s"}
        assert data["pressure_MPa"].dims == ("time_s",)


def test_stills_are_over_the_picture_number(tmp_path):
    write_run_file(tmp_path / "run.h5", bend(stills=True, pressure=False), **ABOUT)
    with xarray.open_dataset(tmp_path / "run.h5", engine="h5netcdf", group="entry/curvature") as data:
        assert data["angle_deg"].dims == ("frame",)
        assert data.coords["frame"].values.tolist() == list(range(50))
        assert data["name"].values[3] == "bild ü3.jpg"
        assert "time_s" not in data
        assert "angle_over_pressure" not in h5py.File(tmp_path / "run.h5")["entry"]


def test_nexus_viewers_find_the_default_plot(run):
    with h5py.File(run) as file:
        at = file
        while "default" in at.attrs:
            at = at[at.attrs["default"]]
        assert at.name == "/entry/curvature"
        for name, group in file["entry"].items():
            if not isinstance(group, h5py.Group):
                continue
            assert group.attrs["NX_class"] == "NXdata"
            signal = group[group.attrs["signal"]]
            axes = list(group.attrs["axes"])
            assert len(axes) == signal.ndim, name
            assert [group[a].shape[0] for a in axes] == list(signal.shape)
            for auxiliary in group.attrs.get("auxiliary_signals", []):
                assert group[auxiliary].shape == signal.shape
        assert list(file["entry/angle_over_pressure"].attrs["axes"]) == ["pressure_MPa"]
        assert file["entry/angle_over_pressure/angle_deg"] == file["entry/curvature/angle_deg"]
        assert json.loads(file["entry/settings"].asstr()[()])["fit"] == "taubin"


def test_every_number_has_a_checksum_a_unit_or_none_and_a_long_name(run):
    seen = []

    def look(name, item):
        if isinstance(item, h5py.Dataset):
            seen.append(name)
            assert item.attrs["long_name"]
            assert item.fletcher32 or item.dtype.kind == "O"
            assert item.dtype.kind != "O" or len(item.attrs["sha256"]) == 64
            for unit in ("mm", "px", "deg", "MPa", "s"):
                if name.endswith(f"_{unit}") and "_per_" not in name:
                    assert item.attrs["units"] == unit, name

    with h5py.File(run) as file:
        file.visititems(look)
    assert len(seen) > 20


def test_a_flipped_bit_is_never_silently_different(run, tmp_path):
    """Row 104: each byte has one of its bits flipped once, in steps, and read: the same content, or a refusal."""
    whole = run.read_bytes()
    before = read_run_file(run)
    rng = random.Random(1)
    refused = same = 0
    path = tmp_path / "flipped.h5"
    for _ in range(300):
        at, bit = rng.randrange(len(whole)), rng.randrange(8)
        damaged = bytearray(whole)
        damaged[at] ^= 1 << bit
        path.write_bytes(damaged)
        try:
            after = read_run_file(path)
        except InputError as error:
            assert len(str(error)) < 400
            refused += 1
            continue
        same += 1
        assert equal(after.series, before.series), (at, bit)
        assert replace(after, series=before.series) == before, (at, bit)
    assert refused > 50
    assert same > 0


@pytest.mark.parametrize("name", ["/entry/curvature/angle_deg", "/entry/tracks/markers_px"])
def test_a_checksum_error_names_the_dataset(run, name):
    with h5py.File(run) as file:
        chunk = file[name].id.get_chunk_info(0)
    data = bytearray(run.read_bytes())
    data[chunk.byte_offset + chunk.size // 2] ^= 4
    run.write_bytes(data)
    assert f"checksum error in dataset {name}" in refusal(run)


def test_a_changed_text_is_a_checksum_error(run):
    data = run.read_bytes()
    assert data.count(b"taubin") == 1
    run.write_bytes(data.replace(b"taubin", b"kaasaa"))
    assert "checksum error in dataset /entry/settings" in refusal(run)


def test_a_file_cut_anywhere_is_refused(run, tmp_path):
    """Rows 101 and 105."""
    whole = run.read_bytes()
    path = tmp_path / "cut.h5"
    for size in np.linspace(1, len(whole) - 1, 60).astype(int):
        path.write_bytes(whole[:size])
        assert "truncated" in refusal(path) or size < 100, size
        assert read_provenance(path) is None


@pytest.mark.parametrize(
    "content",
    [b"PK\x03\x04" + b"\0" * 50, b"\x80\x04\x95pickle", b"\x93NUMPY\x01\x00", b"time_s,angle_deg\n", b"\0" * 4096],
)
def test_other_kinds_of_file_are_refused_unopened(tmp_path, content):
    """Row 109: nothing is unpickled."""
    path = tmp_path / "run.h5"
    path.write_bytes(content)
    assert "not a benchlab run file" in refusal(path)


def test_hdf5_of_others_is_not_a_run_file(tmp_path):
    with h5py.File(tmp_path / "a.h5", "w") as file:
        file["x"] = [1.0]
    assert "not a benchlab run file" in refusal(tmp_path / "a.h5")
    assert read_provenance(tmp_path / "a.h5") is None


def test_a_newer_schema_says_so(run):
    with h5py.File(run, "r+") as file:
        file.attrs["schema_version"] = 3
    assert "made by a newer benchlab (schema 3, this one reads 1); update benchlab" in refusal(run)
    with h5py.File(run, "r+") as file:
        file.attrs["schema_version"] = 0
    assert "schema version 0" in refusal(run)


@pytest.mark.parametrize("kind", ["external", "soft", "cycle", "virtual", "raw"])
def test_links_out_of_the_file_are_not_followed(run, tmp_path, kind):
    """Row 107."""
    write_run_file(tmp_path / "other.h5", bend(), **ABOUT)
    with h5py.File(run, "r+") as file:
        group = file["entry/curvature"]
        del group["radius_mm"]
        if kind == "external":
            group["radius_mm"] = h5py.ExternalLink("other.h5", "/entry/curvature/radius_mm")
        elif kind == "soft":
            group["radius_mm"] = h5py.SoftLink("/entry/fit/radius_px")
        elif kind == "cycle":
            group["radius_mm"] = h5py.SoftLink("/entry/curvature/radius_mm")
        elif kind == "virtual":
            layout = h5py.VirtualLayout((50,), float)
            layout[:] = h5py.VirtualSource("other.h5", "/entry/curvature/radius_mm", (50,))
            group.create_virtual_dataset("radius_mm", layout)
        else:
            group.create_dataset("radius_mm", (50,), float, external=[(str(tmp_path / "other.h5"), 0, 400)])
    line = refusal(run)
    assert "/entry/curvature/radius_mm" in line
    assert "is a link" in line or "does not hold its own data" in line


@pytest.mark.parametrize("rows", [10**12, 10**8, 10**5])
def test_a_dataset_that_claims_more_than_it_has_is_refused_before_memory_is_taken(run, rows):
    """Row 108."""
    with h5py.File(run, "r+") as file:
        group = file["entry/curvature"]
        del group["frame"]
        group.create_dataset("frame", (rows,), np.int64, chunks=(1000,), fletcher32=True)
    line = refusal(run)
    assert "more than 2 GB" in line or "bytes and has 0 stored" in line


def test_many_long_texts_in_one_place_are_refused(run, monkeypatch):
    monkeypatch.setattr("benchlab.io.hdf5.MAX_BYTES", 40_000)
    write_run_file(run, replace(bend(), flag=("x" * 2000,) * 50), **ABOUT)
    assert "more than" in refusal(run)


@pytest.mark.parametrize("wrong", ["missing", "shape", "text", "json"])
def test_content_that_is_not_what_a_run_file_holds(run, wrong):
    with h5py.File(run, "r+") as file:
        group = file["entry/curvature"]
        if wrong == "json":
            del file["entry/settings"]
            file["entry/settings"] = 3.0
        else:
            del group["radius_mm"]
            if wrong == "shape":
                group["radius_mm"] = np.zeros(49)
            elif wrong == "text":
                group["radius_mm"] = ["x"] * 50
    line = refusal(run)
    assert "/entry/" in line
    assert "no dataset" in line or "not numbers of shape (50,)" in line or "not texts" in line


def test_provenance_is_read_alone_and_tells_an_unfinished_run(tmp_path):
    path = tmp_path / "run.h5"
    assert read_provenance(path) is None
    write_run_file(path, bend(), **ABOUT)
    assert read_provenance(path) == {**ABOUT["provenance"], "partial": False}
    write_run_file(path, bend(), **{**ABOUT, "partial": True})
    assert read_provenance(path) == {**ABOUT["provenance"], "partial": True}
    assert read_run_file(path).partial


def test_a_value_that_is_not_finite_is_none_in_json(tmp_path):
    scale = {"mm_per_px": float("nan"), "all": [1.0, np.inf, (np.float32("nan"), 2)], "size": np.arange(2)}
    write_run_file(tmp_path / "run.h5", bend(), **{**ABOUT, "scale": scale})
    assert read_run_file(tmp_path / "run.h5").scale == {
        "mm_per_px": None,
        "all": [1.0, None, [None, 2]],
        "size": [0, 1],
    }


def test_a_full_disk_leaves_the_old_result(run):
    """Row 113: a limit on the file size stands for the disk."""
    before = run.read_bytes()
    code = """
import resource, signal, sys
from pathlib import Path
sys.path.insert(0, sys.argv[2])
import test_run_file as t
from benchlab.errors import BenchlabError
series = t.bend(5000)
signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
resource.setrlimit(resource.RLIMIT_FSIZE, (20_000, 20_000))
try:
    t.write_run_file(Path(sys.argv[1]), series, **t.ABOUT)
except BenchlabError as error:
    print(error)
    sys.exit(error.exit_code)
"""
    command = [sys.executable, "-B", "-c", code, str(run), str(Path(__file__).parent)]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    assert done.returncode == 3, done.stderr
    assert "could not be written: file too large" in done.stdout
    assert done.stderr == ""
    assert run.read_bytes() == before
    assert [p.name for p in run.parent.iterdir()] == ["run.h5"]


def test_the_pressure_of_a_run_can_be_used_again(run):
    record = read_pressure(run)
    np.testing.assert_allclose(record.at([0.5, 1.0]), [0.1, 0.2])
    assert record.warnings == ("5 rows without a pressure: no pressure beside them",)
    write_run_file(run, bend(pressure=False), **ABOUT)
    with pytest.raises(BenchlabError, match="no pressure in this HDF5 file"):
        read_pressure(run)
