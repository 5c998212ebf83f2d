"""The table of a series: what a script reads is what was measured, and nothing in it runs."""

import csv
import doctest
import subprocess
import sys
from dataclasses import replace

import numpy as np
import pandas
import pytest

import benchlab.io.table
from benchlab.errors import BenchlabError
from benchlab.io.table import read_series_csv, write_series_csv
from benchlab.vision.series import CurvatureSeries

HEADER = [
    "frame",
    "time_s",
    "curvature_per_mm",
    "curvature_sd_per_mm",
    "angle_deg",
    "angle_sd_deg",
    "radius_mm",
    "fit_rms_px",
    "n_markers",
    "flag",
]


def bend(n=40, stills=False, pressure=False) -> CurvatureSeries:
    """From −10° to 110° on 180 mm; frame 3 was not seen, frame 5 has its radius left open."""
    angle = np.radians(np.linspace(-10, 110, n))
    sd = np.full(n, np.radians(0.0251))
    used = np.ones((n, 5), bool)
    radius = 180 / np.abs(angle)
    rms = np.linspace(0.01, 3, n)
    flag = [""] * n
    if n > 5:
        angle[3] = sd[3] = radius[3] = rms[3] = radius[5] = np.nan
        used[3] = False
        flag[3] = "markers missing; θ unknown, not guessed"
    time_s = np.arange(n) * 1001 / 30000
    return CurvatureSeries(
        time_s=np.full(n, np.nan) if stills else time_s,
        markers_px=np.zeros((n, 5, 2)),
        used=used,
        angle_rad=angle,
        angle_sd_rad=sd,
        curvature_per_mm=angle / 180,
        curvature_sd_per_mm=sd / 180,
        radius_mm=radius,
        centre_px=np.zeros((n, 2)),
        radius_px=np.ones(n),
        curvature_per_px=angle / 720,
        fit_rms_px=rms,
        centroid_sd_px=np.ones(n),
        flag=tuple(flag),
        names=tuple(f"{i}.jpg" for i in range(n)) if stills else (),
        pressure_MPa=np.where(time_s < 1, 0.35 * time_s, np.nan) if pressure else None,
    )


@pytest.mark.parametrize("stills", [False, True])
@pytest.mark.parametrize("pressure", [False, True])
@pytest.mark.parametrize("n", [1, 40])
def test_what_is_written_is_read_well_within_the_uncertainty(tmp_path, n, stills, pressure):
    series = bend(n, stills, pressure)
    write_series_csv(tmp_path / "a.csv", series)
    table = read_series_csv(tmp_path / "a.csv")
    expected = {
        "time_s": series.time_s,
        "curvature_per_mm": series.curvature_per_mm,
        "angle_deg": np.degrees(series.angle_rad),
        "radius_mm": series.radius_mm,
        "fit_rms_px": series.fit_rms_px,
    }
    tolerance = {"time_s": 5.1e-7, "angle_deg": 5.1e-5}
    if series.pressure_MPa is not None:
        expected["pressure_MPa"] = series.pressure_MPa
    for name, values in expected.items():
        np.testing.assert_allclose(table[name], values, rtol=1e-4, atol=tolerance.get(name, 1e-7), err_msg=name)
    np.testing.assert_allclose(table["angle_sd_deg"], np.degrees(series.angle_sd_rad), rtol=1e-3)
    np.testing.assert_allclose(table["curvature_sd_per_mm"], series.curvature_sd_per_mm, rtol=1e-3)
    assert table["frame"].tolist() == list(range(n))
    assert table["n_markers"].tolist() == series.n_markers.tolist()
    assert table["flag"].tolist() == list(series.flag)
    assert ("name" in table) == stills
    assert table["frame"].dtype == table["n_markers"].dtype == np.int64


def test_the_columns_and_their_order(tmp_path):
    write_series_csv(tmp_path / "a.csv", bend())
    write_series_csv(tmp_path / "b.csv", bend(stills=True, pressure=True))
    with (tmp_path / "a.csv").open(encoding="utf-8") as a, (tmp_path / "b.csv").open(encoding="utf-8") as b:
        assert next(csv.reader(a)) == HEADER
        assert next(csv.reader(b)) == [HEADER[0], "name", *HEADER[1:-1], "pressure_MPa", "flag"]


def test_a_plain_reader_gets_the_same_numbers(tmp_path):
    write_series_csv(tmp_path / "a.csv", bend())
    strict, plain = read_series_csv(tmp_path / "a.csv"), pandas.read_csv(tmp_path / "a.csv")
    for name in HEADER[:-1]:
        np.testing.assert_array_equal(strict[name], plain[name])


def test_what_is_not_known_is_an_empty_cell(tmp_path):
    write_series_csv(tmp_path / "a.csv", bend(pressure=True))
    text = (tmp_path / "a.csv").read_text(encoding="utf-8")
    assert "nan" not in text.lower().replace("unknown", "")
    assert "inf" not in text
    row = next(csv.DictReader([text.splitlines()[0], text.splitlines()[4]]))
    assert [row[name] for name in ("angle_deg", "angle_sd_deg", "curvature_per_mm", "radius_mm")] == [""] * 4
    assert row["n_markers"] == "0"
    assert row["flag"] == "markers missing; θ unknown, not guessed"


def test_zero_has_no_sign(tmp_path):
    tiny = np.full(3, -1e-9)
    write_series_csv(tmp_path / "a.csv", replace(bend(3), angle_rad=tiny, curvature_per_mm=np.zeros(3) * -1.0))
    row = next(csv.DictReader((tmp_path / "a.csv").read_text(encoding="utf-8").splitlines()))
    assert row["angle_deg"] == "0.0000"
    assert row["curvature_per_mm"] == "0"


@pytest.mark.parametrize(
    "name", ["=cmd|calc", "+1", "-x", "@SUM(A1)", "\t=1", "'=1", "''a", "'a", 'a,"b"', "ü é;", " a ", ""]
)
def test_formulas_are_disarmed_and_read_back_the_same(tmp_path, name):
    series = replace(bend(2, stills=True), names=(name, "b"), flag=("", name))
    write_series_csv(tmp_path / "a.csv", series)
    with (tmp_path / "a.csv").open(encoding="utf-8", newline="") as file:
        for row in csv.DictReader(file):
            assert not row["name"].startswith(("=", "+", "-", "@", "\t"))
            assert not row["flag"].startswith(("=", "+", "-", "@", "\t"))
    table = read_series_csv(tmp_path / "a.csv")
    assert table["name"].tolist() == [name, "b"]
    assert table["flag"].tolist() == ["", name]


def test_odd_file_names_keep_the_table_whole(tmp_path):
    series = replace(bend(2, stills=True), names=("a\nb\r.jpg", "bad\udc80.jpg"))
    write_series_csv(tmp_path / "a.csv", series)
    assert len((tmp_path / "a.csv").read_bytes().decode("utf-8").splitlines()) == 3
    assert read_series_csv(tmp_path / "a.csv")["name"].tolist() == ["a\\nb\\r.jpg", "bad\\udc80.jpg"]


def test_a_decimal_point_whatever_the_locale(tmp_path):
    code = (
        "import locale, sys\nfrom pathlib import Path\n"
        "for name in ('de_DE.UTF-8', 'de_DE', 'C'):\n"
        "    try: locale.setlocale(locale.LC_ALL, name); break\n"
        "    except locale.Error: pass\n"
        "from benchlab.io.table import _cells\nimport numpy as np\n"
        "print(_cells(np.array([1234.5, np.nan]), '%.4f'))\n"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True, cwd=tmp_path)
    assert done.stdout.strip() == "['1234.5000', '']"


GOOD = ",".join(HEADER) + "\n0,0,1,1,1,1,1,1,5,\n1,0.1,1,1,1,1,1,1,5,\n"


@pytest.mark.parametrize(
    ("text", "says"),
    [
        (GOOD.replace("angle_deg", "angle"), "line 1: not a table of benchlab analyze, without angle_deg"),
        (GOOD.replace(",flag", ",flag,more"), "line 1: not a table of benchlab analyze"),
        (GOOD.replace("1,0.1,1", "1,0.1,1,1"), "line 3: row has 11 fields, header 10"),
        (GOOD.replace("1,0.1,1,", "1,0.1,"), "the last row (line 3) is cut"),
        (GOOD.replace("0.1", "abc"), "line 3: not a number: 'abc'"),
        (GOOD.replace("0.1", "1e999"), "line 3: not a number"),
        (GOOD.replace("1,0.1", "1.5,0.1"), "line 3: frame is not a whole number"),
        (GOOD.replace("1,0.1", ",0.1"), "line 3: frame is not a whole number"),
        (GOOD.replace(",", ";"), "line 1: not a table of benchlab analyze"),
        (GOOD.replace("0.1", '"0,1"'), "line 3: comma in a number"),
    ],
)
def test_tables_that_are_not_ours_are_refused(tmp_path, text, says):
    (tmp_path / "a.csv").write_text(text)
    with pytest.raises(BenchlabError) as caught:
        read_series_csv(tmp_path / "a.csv")
    assert says in str(caught.value)
    assert caught.value.exit_code == 3


def test_a_folder_that_is_not_there_is_refused(tmp_path):
    with pytest.raises(BenchlabError, match="cannot write here"):
        write_series_csv(tmp_path / "none" / "of" / "a.csv", bend())


def test_the_examples_in_the_docstrings_hold():
    result = doctest.testmod(benchlab.io.table)
    assert (result.attempted, result.failed) == (1, 0)
