"""Where things are in an export: specimens, results, headers, cycles, columns by place; layouts of many makers."""

from pathlib import Path

import pytest

from benchlab.errors import UsageError
from benchlab.io.machine_export import ExportOptions, export_document
from tests.unit.io.exports import EXTENSION_MM, FORCE_N, TIME_S, check, read

HEAD = "Time,Extension,Load\n(s),(mm),(N)\n"


def rows(force: float, start: float = 0.0, count: int = 12) -> str:
    return "".join(f"{start + i / 100:.2f},{i / 10:.1f},{force + i / 1000:.3f}\n" for i in range(count))


def test_thousands_that_appear_late(tmp_path: Path) -> None:
    text = HEAD + "".join(
        f'"{i / 10:.1f}","{i}.5","{v}"\n' for i, v in enumerate(["998.25", "999.75", "1,001.25", "12,345.5"])
    )
    export = read(tmp_path / "a.csv", text)
    assert export.tests[0].columns["force_N"].tolist() == [998.25, 999.75, 1001.25, 12345.5]
    assert export.inferred["thousands"] == "comma"
    german = "Zeit;Weg;Last\n(s);(mm);(N)\n0,1;1,0;999,5\n0,2;1,1;1.001,5\n0,3;1,2;1234,5\n"
    assert read(tmp_path / "b.csv", german).tests[0].columns["force_N"].tolist() == [999.5, 1001.5, 1234.5]
    swiss = "Zeit;Last (N)\n0.1;999.5\n0.2;1'001.5\n0.3;1 002.5\n0.4;1\u202f003.5\n"
    assert read(tmp_path / "c.csv", swiss).tests[0].columns["force_N"].tolist() == [999.5, 1001.5, 1002.5, 1003.5]


def test_specimens_by_title_by_number_and_by_column(tmp_path: Path) -> None:
    titled = "".join(f"Specimen {k}\n{HEAD}{rows(k)}\n" for k in (1, 2, 3))
    labelled = "".join(f'Specimen label,"{k}"\n{HEAD}{rows(1)}\n' for k in ("A1", "B2"))
    bare = "".join(f"{HEAD}{rows(k)}\n" for k in (1, 2))
    column = "Specimen ID,Time (s),Load (N)\n" + "".join(f"S{i // 6},{i % 6 / 10},{i}.5\n" for i in range(12))
    mixed = "Specimen,Time (s),Load (N)\n" + "".join(f"{i % 2},{i // 2 / 10},{i}.5\n" for i in range(12))
    for text, names in (
        (titled, ["Specimen 1", "Specimen 2", "Specimen 3"]),
        (labelled, ["A1", "B2"]),
        (bare, ["1", "2"]),
        (column, ["S0", "S1"]),
        (mixed, ["0", "1"]),
    ):
        export = read(tmp_path / "a.csv", text)
        assert [test.specimen for test in export.tests] == names
        assert not export.warnings
        assert export.inferred["specimens"].startswith(str(len(names)))
    assert export.tests[1].columns["force_N"].tolist() == [1.5, 3.5, 5.5, 7.5, 9.5, 11.5]
    assert export.tests[1].lines.tolist() == [3, 5, 7, 9, 11, 13]
    assert export_document(export)["specimens"] == ["0", "1"] and export.rows == 12


def test_numbers_of_specimens_are_names(tmp_path: Path) -> None:
    names = ["1", "01", "1234567", "2.50", "A-1", "1.2.3", "12 A"]
    text = "Specimen,Time (s),Load (N)\n" + "".join(f"{name},{i}.0,{i}.5\n" for name in names for i in range(3))
    assert [test.specimen for test in read(tmp_path / "a.csv", text).tests] == ["1", "01", "1234567", "2.5", *names[4:]]


def test_results_beside_the_raw_data_are_left_out(tmp_path: Path) -> None:
    results = "Results Table 1\n,Width,Maximum Force\n,(mm),(N)\n1,9.5,31.25\n2,9.75,30.5\n\n"
    footer = "\nMean,9.6,30.9\nStandard deviation,0.1,0.4\nCoefficient,0.01,0.01\n"
    for text, said in ((results + HEAD + rows(1), ("the table in line 4 (Width, Maximum Force) holds no raw data and was left out",)),
                       (HEAD + rows(1) + footer, ())):  # fmt: skip
        export = read(tmp_path / "a.csv", text)
        assert export.warnings == said
        assert export.rows == 12 and len(export.tests) == 1
    assert export.preamble["Mean"] == "9.6 30.9"


def test_cycles_segments_and_pressure(tmp_path: Path) -> None:
    head = (
        "Total Time (s),Elapsed Time (s),Pressure (kPa),Load(8800 (0,1):Load) (kN),Total Cycles,Elapsed Cycles,Step\n"
    )
    quoted = head.replace("Load(8800 (0,1):Load) (kN)", '"Load(8800 (0,1):Load) (kN)"')
    text = quoted + "".join(
        f"{i / 10},{i % 3 / 10},{35 * (i % 2)}.0,0.0{i}1,{i // 4},{i % 4},{i // 6 + 1}\n" for i in range(12)
    )
    (test,) = read(tmp_path / "a.csv", text).tests
    assert tuple(test.columns) == ("time_s", "force_N", "pressure_MPa", "cycle", "segment")
    assert test.columns["pressure_MPa"].max() == 0.035 and test.columns["force_N"][3] == pytest.approx(31)
    assert test.columns["cycle"].tolist() == [i // 4 for i in range(12)]
    assert test.columns["segment"].tolist() == [i // 6 + 1 for i in range(12)]


def test_a_header_in_two_rows_and_units_of_no_brackets(tmp_path: Path) -> None:
    text = "Time,Crosshead,Load\ntotal,position,cell\ns,mm,N\n" + rows(1)
    export = read(tmp_path / "a.csv", text)
    assert tuple(export.tests[0].columns) == ("time_s", "extension_mm", "force_N")
    assert export.inferred["header"] == "names in line 1 and 2, units in line 3"


RESULTS = "Results\n,Max,Ext\n,(N),(mm)\n1,3.5,2.5\n\n"
LAYOUTS = {  # as other makers of machines and loggers write
    "testXpert": ("Prüfzeit;Standardkraft;Standardweg\ns;N;mm\n", "{t};{f};{x}\n", True),
    "testXpert in brackets": ("Prüfzeit [s];Standardkraft [N];Standardweg [mm]\n", "{t};{f};{x}\n", True),
    "Trapezium": ('"Name","1 _ 1"\n"Time","Force","Stroke"\n"sec","N","mm"\n', '"{t}","{f}","{x}"\n', False),
    "MESUR": ("Reading,Load [N],Travel [mm],Time [sec.]\n", "7,{f},{x},{t}\n", False),
    "TestSuite": ("Time\tCrosshead \tLoad \nsec\tmm\tN\n", "{t}\t{x}\t{f}\n", False),
    "Nexygen": ("Load (N),Machine Extension from Preload (mm),Elapsed (s)\n", "{f},{x},{t}\n", False),
    "Bluehill Universal": (RESULTS + "Raw\n,Time,Displacement,Force\n,(s),(mm),(N)\n", ',"{t}","{x}","{f}"\n', False),
    "a logger": ("# v2\n#time_ms,force_mN,position_um\n", "{t}e3,{f}e3,{x}e3\n", False),
    "capitals": ("TIME (S),LOAD (N),EXTENSION (MM)\n", "{t},{f},{x}\n", False),
    "trailing separators": ("Zeit (s);Weg (mm);Kraft (N);\n", "{t};{x};{f};\n", True),
    "sep=": ("sep=;\nTime (s);Force (N);Position (mm)\n", "{t};{f};{x}\n", True),
}  # fmt: skip


@pytest.mark.parametrize("maker", LAYOUTS)
def test_layouts_of_other_makers(tmp_path: Path, maker: str) -> None:
    head, row, comma = LAYOUTS[maker]
    made = (row.format(t=f"{t:.6f}", x=f"{x:.6f}", f=f"{f:.6f}") for t, x, f in zip(TIME_S, EXTENSION_MM, FORCE_N))
    rows = "".join(made)
    export = read(tmp_path / "a.txt", head + (rows.replace(".", ",") if comma else rows))
    check(export)
    assert not any(key.startswith("sep") for key in export.preamble)


def test_p_is_a_load_or_a_pressure_by_its_unit_and_words_of_phases_are_left_out(tmp_path: Path) -> None:
    text = "Time (s),P (N),Phase\n" + "".join(f"{i / 10},{i}.5,{'up' if i < 6 else 'down'}\n" for i in range(12))
    export = read(tmp_path / "a.csv", text)
    assert list(export.tests[0].columns) == ["time_s", "force_N"]
    assert export.warnings == ("column 'Phase' holds no numbers and was left out",)
    both = read(tmp_path / "b.csv", "P (kPa),Load (N)\n" + "35.0,1.5\n36.0,2.5\n")
    assert both.tests[0].columns["pressure_MPa"].tolist() == [0.035, 0.036]


def test_forces_without_time_beside_results(tmp_path: Path) -> None:
    export = read(tmp_path / "a.csv", RESULTS + "Load (N),Cycle\n1.5,1\n2.5,1\n3.5,2\n")
    assert export.tests[0].columns["force_N"].tolist() == [1.5, 2.5, 3.5] and len(export.tests) == 1
    assert export.warnings == ("the table in line 4 (Max, Ext) holds no raw data and was left out",)


def test_a_preamble_is_no_header(tmp_path: Path) -> None:
    text = "Load cell,2 kN\nSpeed,5 mm/min\n1.5,0.1\n2.5,0.2\n3.5,0.3\n"
    export = read(tmp_path / "a.csv", text, ExportOptions(columns="force_N,time_s"))
    assert export.preamble == {"Load cell": "2 kN", "Speed": "5 mm/min"} and export.rows == 3
    with pytest.raises(UsageError, match="2 columns without names or units"):
        read(tmp_path / "a.csv", text)


def test_lengths_without_a_name_are_an_extension_only_if_there_is_one(tmp_path: Path) -> None:
    one = read(tmp_path / "a.csv", "Time (s),Laser (mm),Load (N)\n0.1,1.5,2.5\n0.2,1.6,2.6\n")
    assert one.tests[0].columns["extension_mm"].tolist() == [1.5, 1.6]
    two = read(tmp_path / "b.csv", "Time (s),Laser (mm),Width (mm),Load (N)\n0.1,1.5,9.5,2.5\n0.2,1.6,9.5,2.6\n")
    assert list(two.tests[0].columns) == ["time_s", "force_N"]
    assert two.inferred["not used"] == "'Laser (mm)', 'Width (mm)'"


def test_empty_columns_need_no_name(tmp_path: Path) -> None:
    (test,) = read(tmp_path / "a.csv", "1,5;0,1;\n2,5;0,2;\n", ExportOptions(columns="force_N,time_s")).tests
    assert test.columns["force_N"].tolist() == [1.5, 2.5]


def test_columns_by_place_whatever_the_order(tmp_path: Path) -> None:
    export = read(
        tmp_path / "a.csv", "1.5,35.0,0.1,1\n2.5,70.0,0.2,1\n", ExportOptions(columns="force_kN,pressure_kPa,time_s,-")
    )
    (test,) = export.tests
    assert {k: v.tolist() for k, v in test.columns.items()} == {
        "time_s": [0.1, 0.2],
        "force_N": [1500.0, 2500.0],
        "pressure_MPa": [0.035, 0.07],
    }
    assert export.inferred["header"] == "none"
    swapped = read(
        tmp_path / "b.csv", "Load (N),Crosshead position (in),Zeit (ms)\n" + "1.5,1.0,100.5\n2.5,2.0,200.5\n"
    )
    assert swapped.tests[0].columns["extension_mm"].tolist() == [25.4, 50.8]
    assert swapped.tests[0].columns["time_s"].tolist() == [0.1005, 0.2005]


def test_no_time_no_rate_and_no_numbers_no_extremes(tmp_path: Path) -> None:
    found = export_document(read(tmp_path / "a.csv", "Load (N),Cycle\n1.5,1\n2.5,1\n"))
    assert found["sample_rate_Hz"] is None and list(found["columns"]) == ["force_N", "cycle"]
    assert found["columns"]["force_N"] == {"min": 1.5, "max": 2.5}
    timed = export_document(read(tmp_path / "b.csv", HEAD + rows(1) + "\n" + HEAD + rows(2)))
    assert timed["sample_rate_Hz"] == pytest.approx(100) and timed["rows"] == 24
    assert (
        timed["time_step_s"] == pytest.approx({"min": 0.01, "median": 0.01, "max": 0.01})
        and found["time_step_s"] is None
    )
