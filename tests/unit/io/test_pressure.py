"""Pressure records: every way a logger may write one, and every way a file may fail to be one."""

import os

import h5py
import numpy as np
import pytest

import benchlab.io.pressure
from benchlab.errors import BenchlabError, InputError, UsageError
from benchlab.io.pressure import PressureRecord, Ramp, ramp, read_pressure
from tests.pace import cpu_s, slowness

TIME = [0.0, 0.5, 1.0, 1.5]
PRESSURE = [0.0, 0.0345, 0.07, 0.35]


def write(path, text, encoding="utf-8"):
    path.write_bytes(text if isinstance(text, bytes) else text.encode(encoding))
    return path


def refusal(path):
    with pytest.raises(BenchlabError) as caught:
        read_pressure(path)
    assert caught.value.exit_code in (2, 3)
    line = str(caught.value)
    assert line.startswith(str(path)), line
    assert "\n" not in line
    return line


@pytest.mark.parametrize(
    ("text", "encoding"),
    [
        ("time_s,pressure_MPa\n0,0\n0.5,0.0345\n1,0.07\n1.5,0.35\n", "utf-8"),
        ("time_s,pressure_kPa\n0,0\n0.5,34.5\n1,70\n1.5,350", "utf-8-sig"),
        ("Time (ms);Pressure (kPa)\n0;0\n500;34,5\n1000;70\n1500;350,0\n", "utf-16"),
        ("t [s]\tp [bar]\n0\t0\n0.5\t.345\n1\t0.7\n1.5\t3.5e0\n", "utf-16-le"),
        ("Time,Temp °C,p_bar\ns,°C,bar\n0,21,0\n0.5,21,0.345\n1,21,0.7\n1.5,21,3.5\n", "latin-1"),
        ('"Time";"Pressure"\n"(s)";"(kPa)"\n0;0\n0,5;34,5\n1;70\n1,5;350\n', "utf-8"),
        ("time_s,pressure_kPa\r0,0\r0.5,34.5\r1,70\r1.5,350\r", "utf-8"),
        ("# made by a logger\n\nsep=;\ntime_s;pressure_mbar\r\n0;0\r\n\r\n0.5;345\r\n1;700\r\n1.5;3500\r\n", "utf-8"),
        ("frame,time_s,angle_deg,pressure_MPa,flag\n0,0,1,0,\n1,.5,1,.0345,\n2,1,1,.07,x\n3,1.5,1,.35,\n", "utf-8"),
        ("t/min,psi\n0,0\n0.00833333333333333,5.00380195\n0.016666666666666666,10.15264\n0.025,50.7632\n", "utf-8"),
        ("p_kPa,Time\n0,0\n34.5,0.5\n70,1\n350,1.5\n", "utf-8"),
    ],
)
def test_one_record_written_in_many_ways(tmp_path, text, encoding):
    record = read_pressure(write(tmp_path / "log.csv", text, encoding))
    assert record.time_s == pytest.approx(TIME, abs=1e-9)
    assert record.pressure_MPa == pytest.approx(PRESSURE, abs=1e-6)
    assert record.source == str(tmp_path / "log.csv")


def test_a_clean_file_has_no_warnings_and_a_time_without_a_unit_has_one(tmp_path):
    clean = read_pressure(write(tmp_path / "a.csv", "time_s,pressure_kPa\n0,0\n1,10\n"))
    bare = read_pressure(write(tmp_path / "b.csv", "time,pressure_kPa\n0,0\n1,10\n"))
    assert clean.warnings == ()
    assert bare.warnings == ("column 'time' has no unit and was read as s; name it time_s",)


@pytest.mark.parametrize(
    ("text", "says"),
    [
        ("", "empty file (0 bytes)"),
        ("\n\n  \n", "no data rows"),
        ("time_s,pressure_kPa\n", "no data rows"),
        ("time_s,pressure_kPa\n0,1\n", "fewer than two pressures"),
        ("0,0\n1,10\n", "line 1: no header"),
        ("time_s\n0\n1\n", "only one column"),
        ("time_s,force_N\n0,0\n1,1\n", "no pressure column among 'time_s', 'force_N'; put the unit in the header"),
        ("time_s,pressure\n0,0\n1,1\n", "no unit in 'pressure'; put the unit in the header, e.g. pressure_kPa"),
        ("time_s,inlet pressure\n0,0\n1,1\n", "no unit in 'inlet pressure'"),
        ("time_s,pressure (mmHg)\n0,0\n1,1\n", "unit 'mmHg' of column 'pressure (mmHg)' is not one of pressure"),
        ("time_s,pressure_mPa\n0,0\n1,1\n", "no unit in 'pressure_mPa'"),
        ("pressure_kPa,valve_V\n0,0\n1,1\n", "no time column"),
        ("time_s,p_kPa,p_bar\n0,0,0\n1,1,1\n", "2 pressure columns: 'p_kPa' and 'p_bar'"),
        ("time_s,pressure_kPa,pressure_kPa\n0,0,0\n", "2 pressure columns: 'pressure_kPa' and 'pressure_kPa'"),
        ("time_s,Time (ms),p_bar\n0,0,0\n1,1,1\n", "2 time columns: 'time_s' and 'Time (ms)'"),
        ("time_s,p_kPa\ns,bar\n0,0\n1,1\n", "line 2: column 'p' is in kPa by its name and in bar"),
        ("time_s,p_kPa\n0,1,5,2\n0,2,5,3\n", "line 2: row has 4 fields, header 2; a decimal comma"),
        ("time_s,p_kPa\n0,1\n1,2,\n2,3\n", "line 3: row has 3 fields, header 2"),
        ("time_s,p_kPa\n0,1\n1\n2,3\n", "line 3: row has 1 fields, header 2"),
        ('time_s,p_kPa\n0,1\n1,"2\n2,3\n', "line 3: not a table row"),
        ('time_s,p_kPa\n0,1\n1,"1,234.5"\n', "line 3: '1,234.5' has thousands separators"),
        ('time_s,p_kPa\n0,1\n1,"1,234"\n', "line 3: comma in a number: '1,234'"),
        ("time_s;p_kPa\n0;1.5\n1;2,5\n", "line 3: decimal points (line 2) and decimal commas (line 3)"),
        ("time_s,p_kPa\n0,1 kPa\n1,2 kPa\n", "line 2: unit in a cell: '1 kPa'"),
        ("time_s,p_kPa\n0,1\n1,Overload\n2,----\n", "line 3: 2 of 6 cells without a number, the first 'Overload'"),
        ("time_s,p_kPa\n0,1\n1," + "9" * 4400 + "\n", "line 3: cell of 4400 characters"),
        ("time_s,p_kPa\n0,1\n2,2\n1,3\n", "line 4: time goes back, from 2 s to 1 s"),
        (
            "time_s,p_MPa\n0,0\n1,350\n",
            "line 3: pressure of 350 MPa, outside -0.11 to 10 MPa; is the unit in the header",
        ),
        ("time_s,p_bar\n0,0\n1,-3\n", "line 3: pressure of -0.3 MPa, outside"),
        (b"time_s,p_kPa\n0,1\n1,2\x00\n", "line 3: binary data"),
        (b"\x00" * 5000, "binary data"),
        (b"PK\x03\x04" + b"x" * 100, "this is an Excel file or a zip archive"),
        (b"\x1f\x8b\x08" + b"x" * 100, "compressed (gzip), not a text table; unpack it first"),
        (b"\x00\x00\x00\x20ftypisom" + b"x" * 100, "this is a video"),
        ("\ufeff<!DOCTYPE html><html><body>login</body></html>", "this is a web page"),
        ("time_s," * 1001 + "\n" + "1," * 1001 + "\n", "1002 columns, more than the limit of 1000"),
        ("time_s,p_kPa\n" + "1" * 100_100, "line 2: line longer than 100000 characters"),
    ],
)
def test_what_is_not_a_record_is_refused_in_one_line(tmp_path, text, says):
    assert says in refusal(write(tmp_path / "log.csv", text))


def test_control_characters_of_the_file_do_not_reach_the_terminal(tmp_path):
    line = refusal(write(tmp_path / "log.csv", "time_s,\x1b[31mforce\n0,0\n1,1\n"))
    assert "\x1b" not in line
    assert "\\x1b" in line


def test_paths_that_are_no_files(tmp_path):
    assert "no such file" in refusal(tmp_path / "none.csv")
    assert "is a folder" in refusal(tmp_path)
    os.mkfifo(tmp_path / "pipe.csv")
    assert "not a regular file" in refusal(tmp_path / "pipe.csv")


def test_a_file_over_the_size_limit_is_refused_before_it_is_read(tmp_path):
    with (tmp_path / "big.csv").open("wb") as file:
        file.truncate(201_000_000)
    assert "201 MB, more than the limit of 200 MB" in refusal(tmp_path / "big.csv")


def test_forty_thousand_columns_are_refused_within_a_second(tmp_path):
    path = write(tmp_path / "log.csv", ",".join(["p"] * 40_000) + "\n")
    said = []
    assert cpu_s(lambda: said.append(refusal(path))) < slowness()
    assert "columns" in said[0]


def test_a_last_row_cut_while_writing_is_left_out_and_counted(tmp_path):
    record = read_pressure(write(tmp_path / "log.csv", "time_s,p_kPa\n0,0\n1,10\n2,20\n3"))
    assert record.time_s.tolist() == [0, 1, 2]
    assert record.warnings == ("the last row (line 5) is cut and was left out",)


def test_empty_cells_leave_a_hole_that_is_not_bridged(tmp_path):
    record = read_pressure(write(tmp_path / "log.csv", "time_s,p_kPa\n0,0\n1,\n2,20\n,30\n3,30\n"))
    assert record.time_s.tolist() == [0, 1, 2, 3]
    assert record.warnings == (
        "1 row without a time left out",
        "1 row without a pressure: no pressure beside it",
    )
    np.testing.assert_allclose(record.at([0, 0.5, 1.5, 2, 2.5]), [0, np.nan, np.nan, 0.02, 0.025])


def test_a_few_unreadable_cells_are_counted_and_named(tmp_path):
    rows = "".join(f"{i},{'Overload' if i == 7 else '1e999' if i == 9 else i}\n" for i in range(50))
    record = read_pressure(write(tmp_path / "log.csv", "time_s,p_kPa\n" + rows))
    assert "2 of 100 cells without a number, the first 'Overload' in line 9" in record.warnings
    assert np.isnan(record.pressure_MPa[[7, 9]]).all()
    assert np.isfinite(record.pressure_MPa).sum() == 48


def test_repeated_times_and_doubtful_commas_are_said(tmp_path):
    record = read_pressure(write(tmp_path / "log.csv", "time_s;p_Pa\n0;1,234\n1;2,345\n1;2,345\n"))
    assert record.pressure_MPa[0] == pytest.approx(1.234e-6)
    assert record.warnings == (
        "every comma has three digits behind it: read as decimal commas",
        "1 row repeats the time of the row before",
    )


def test_latin_1_is_noted(tmp_path):
    record = read_pressure(write(tmp_path / "log.csv", "Zeit (s);Druck (kPa);T (°C)\n0;0;20\n1;10;20\n", "latin-1"))
    assert record.pressure_MPa.tolist() == [0, 0.01]
    assert record.warnings == ("not UTF-8: read as Latin-1",)


def test_at_is_linear_within_the_record_and_nan_outside():
    times = np.linspace(0, 10, 101)
    record = PressureRecord(times, 0.035 * times, "log")
    asked = np.array([0.0, 0.123, 5.0, 9.999, 10.0])
    np.testing.assert_allclose(record.at(asked), 0.035 * asked, rtol=1e-12)
    np.testing.assert_allclose(record.at(asked, offset_s=-0.1)[1:], 0.035 * (asked[1:] - 0.1), rtol=1e-12)
    assert np.isnan(record.at([-1e-9, 10.001, np.nan])).all()
    assert np.isnan(record.at([0.0], offset_s=-0.1)).all()


def test_a_ramp_starts_rises_and_holds():
    made = ramp("0.01:0.35:2.5")
    assert made == Ramp(0.01, 0.35, 2.5)
    np.testing.assert_allclose(made.at([-5, 0, 1.25, 2.5, 100, np.nan]), [0.01, 0.01, 0.18, 0.35, 0.35, np.nan])
    np.testing.assert_allclose(made.at([0.0], offset_s=1.25), [0.18])


@pytest.mark.parametrize(
    ("text", "says"),
    [
        ("", "not a pressure ramp"),
        ("0:0.35", "not a pressure ramp"),
        ("0:0.35:2.5:1", "not a pressure ramp"),
        ("0:a:2", "not a pressure ramp"),
        ("0:nan:2", "not finite"),
        ("0:0.35:inf", "not finite"),
        ("0:0.35:-2", "ramp of -2 s"),
        ("0:0.35:0", "ramp of 0 s"),
        (
            "0:350:2.5",
            "pressure of 350 MPa in the ramp, outside -0.11 to 10 MPa; ramps are in MPa; 350 kPa would be 0.35",
        ),
        ("-1:0.35:2", "pressure of -1 MPa"),
    ],
)
def test_ramps_that_make_no_sense(text, says):
    with pytest.raises(UsageError) as caught:
        ramp(text)
    assert says in str(caught.value)
    assert caught.value.exit_code == 2


def hdf5(path, **groups):
    with h5py.File(path, "w") as file:
        for name, (times, pressures) in groups.items():
            group = file.require_group(name)
            group["time_s"] = times
            group["pressure_MPa"] = pressures
    return path


def test_a_record_in_an_hdf5_group(tmp_path):
    record = read_pressure(hdf5(tmp_path / "bench.h5", **{"a/b": (TIME, PRESSURE)}))
    assert record.time_s.tolist() == TIME
    assert record.pressure_MPa.tolist() == PRESSURE


def test_hdf5_files_without_a_single_record(tmp_path):
    assert "no pressure in this HDF5 file" in refusal(hdf5(tmp_path / "none.h5"))
    two = hdf5(tmp_path / "two.h5", a=(TIME, PRESSURE), b=(TIME, PRESSURE))
    assert "2 pressure records: /a and /b" in refusal(two)
    assert "not numbers of shape (4,)" in refusal(hdf5(tmp_path / "shape.h5", a=(TIME, PRESSURE[:3])))
    assert "row 2: pressure of 350 MPa" in refusal(hdf5(tmp_path / "kpa.h5", a=([0.0, 1.0], [0.0, 350.0])))


def test_links_out_of_the_file_are_not_followed(tmp_path):
    hdf5(tmp_path / "other.h5", a=(TIME, PRESSURE))
    with h5py.File(tmp_path / "link.h5", "w") as file:
        file["a"] = h5py.ExternalLink("other.h5", "/a")
        file["b"] = h5py.SoftLink("/b")
    assert "no pressure in this HDF5 file" in refusal(tmp_path / "link.h5")


def test_no_cell_of_a_good_file_is_invented_when_it_is_cut_anywhere(tmp_path):
    whole = "time_s,pressure_kPa\n" + "".join(f"{i},{10 * i}\n" for i in range(10))
    refused = 0
    for cut in range(1, len(whole)):
        path = write(tmp_path / "cut.csv", whole[:cut])
        try:
            record = read_pressure(path)
        except InputError:
            refused += 1
            continue
        n = len(record.time_s) - 1
        np.testing.assert_allclose(record.pressure_MPa[:n], 0.01 * record.time_s[:n])
    assert 0 < refused < 40


def test_reading_is_quick(tmp_path):
    n = 50_000
    text = "time_s,pressure_kPa\n" + "".join(f"{i / 100:.2f},{i % 350}.5\n" for i in range(n))
    path, found = write(tmp_path / "log.csv", text), []
    assert cpu_s(lambda: found.append(read_pressure(path))) < 3 * slowness()
    assert len(found[0].time_s) == n


def test_the_examples_in_the_docstrings_hold():
    import doctest

    result = doctest.testmod(benchlab.io.pressure)
    assert (result.attempted, result.failed) == (4, 0)
