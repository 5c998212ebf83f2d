"""Measured runs from tidy tables: units, order, what is missing, and what is refused and where."""

import itertools
import os
from pathlib import Path

import numpy as np
import pandas
import pytest

from benchlab.discrepancy.measured import Measured, Run, Summary
from benchlab.errors import BenchlabError, InputError, UsageError
from benchlab.io.measured_columns import columns_of
from benchlab.io.measured_frame import RunName
from benchlab.io.measured_table import measured_of_frame, read_measured


def tidy() -> pandas.DataFrame:
    """Two designs, two samples, two runs of four rows; every number tells where it is from."""
    rows = []
    for place, (design, sample, run) in enumerate(itertools.product(["a", "b"], ["s1", "s2"], ["r1", "r2"])):
        for at in range(4):
            rows.append((design, sample, run, 1 + at // 2, at * 0.5, at * 0.1, place + at * 10.0, int(run[1])))
    names = ["design", "sample", "run", "cycle", "time_s", "pressure_MPa", "angle_deg", "run_index"]
    return pandas.DataFrame(rows, columns=names)


def write(folder: Path, table: pandas.DataFrame | str, name: str = "measured.csv", **how: object) -> Path:
    path = folder / name
    path.write_text(table) if isinstance(table, str) else table.to_csv(path, index=False, **how)
    return path


def read(folder: Path, table: pandas.DataFrame | str, **options: object) -> Measured:
    found = read_measured([write(folder, table)], **options)
    assert isinstance(found, Measured)
    return found


def refusal(folder: Path, table: pandas.DataFrame | str, **options: object) -> BenchlabError:
    with pytest.raises(BenchlabError) as caught:
        read(folder, table, **options)
    return caught.value


def same(left: Measured, right: Measured) -> bool:
    return len(left.runs) == len(right.runs) and all(map(same_run, left.runs, right.runs))


def same_run(left: Run, right: Run) -> bool:
    arrays = [(left.time_s, right.time_s), (left.pressure_MPa, right.pressure_MPa)]
    arrays += [(left.values[name], right.values.get(name, np.empty(0))) for name in left.values]
    words = [(run.design, run.sample, run.run, run.run_index, run.start_s) for run in (left, right)]
    return words[0] == words[1] and all(np.allclose(*pair, rtol=1e-12, equal_nan=True) for pair in arrays)


def test_every_number_arrives_where_it_belongs(tmp_path: Path) -> None:
    found = read(tmp_path, tidy())
    assert [(run.design, run.sample, run.run) for run in found.runs] == list(
        itertools.product(["a", "b"], ["s1", "s2"], ["r1", "r2"])
    )
    assert found.warnings == () and found.designs == ("a", "b") and not found.simulated
    for place, run in enumerate(found.runs):
        assert run.values["angle_deg"].tolist() == [place, place + 10, place + 20, place + 30]
        assert run.time_s.tolist() == [0, 0.5, 1, 1.5] and run.cycle is not None and run.cycle.tolist() == [1, 1, 2, 2]
        assert run.pressure_MPa == pytest.approx([0, 0.1, 0.2, 0.3]) and run.run_index == int(run.run[1])
        assert run.command_MPa is None and run.start_s is None and run.temperature_C is None and not run.sd


def test_neither_the_order_of_rows_nor_of_columns_matters(tmp_path: Path) -> None:
    table, rng = tidy(), np.random.default_rng(1)
    straight = read(tmp_path, table)
    for _ in range(5):
        mixed = table.sample(frac=1, random_state=int(rng.integers(1e9)))[rng.permutation(table.columns)]
        assert same(read(tmp_path, mixed), straight)


@pytest.mark.parametrize(
    "name, factor",
    [("pressure_kPa", 1e3), ("pressure_Pa", 1e6), ("Pressure (bar)", 10), ("pressure_psi", 145.03773773020923)],
)
def test_pressures_in_other_units(tmp_path: Path, name: str, factor: float) -> None:
    table = tidy().rename(columns={"pressure_MPa": name})
    table[name] *= factor
    assert same(read(tmp_path, table), read(tmp_path, tidy()))


def test_other_units_by_names(tmp_path: Path) -> None:
    table = tidy().assign(force_lbf=1.0, volume_L=0.02, flex_mV=1500.0, time_ms=lambda t: t["time_s"] * 1000)
    table = table.assign(
        angle_rad=np.radians(table["angle_deg"]), temperature_K=295.15, start_min=2.0, angle_sd_rad=np.pi
    )
    run = read(tmp_path, table.drop(columns=["time_s", "angle_deg"])).runs[1]
    assert run.values["force_N"] == pytest.approx(4.4482216152605) and run.values["volume_mL"] == pytest.approx(20)
    assert run.values["flex_V"] == pytest.approx(1.5) and run.time_s == pytest.approx([0, 0.5, 1, 1.5])
    assert run.values["angle_deg"] == pytest.approx([1, 11, 21, 31]) and run.start_s == 120
    assert run.temperature_C == pytest.approx(22) and run.sd["angle_deg"] == pytest.approx(180)


def test_other_separators_decimals_and_encodings(tmp_path: Path) -> None:
    table, straight = tidy(), read(tmp_path, tidy())
    for how in ({"sep": ";", "decimal": ","}, {"sep": "\t"}, {"encoding": "utf-8-sig"}, {"encoding": "utf-16"}):
        assert same(read_measured([write(tmp_path, table, **how)]), straight)  # type: ignore[arg-type]
    crlf = write(tmp_path, table, lineterminator="\r\n")
    assert same(read_measured([crlf]), straight)  # type: ignore[arg-type]


@pytest.mark.parametrize("how", [{}, {"sep": ";", "decimal": ","}, {"quoting": 2}, {"encoding": "utf-8-sig"}])
def test_a_long_table_reads_as_its_short_parts(tmp_path: Path, how: dict) -> None:
    rng = np.random.default_rng(2)
    n = 30_000
    table = pandas.DataFrame(
        {"design": rng.choice(["α", "b"], n), "sample": rng.choice([" s1", "s2"], n), "time_s": np.arange(n) / 100}
    )
    table = table.assign(
        pressure_MPa=np.sort(rng.uniform(0, 0.4, n)).round(5),
        angle_deg=np.sort(rng.normal(60, 20, n)),
        command_MPa=0.125,
    )
    table.loc[rng.integers(n, size=50), "angle_deg"] = np.nan
    path = write(tmp_path, table, **how)
    assert path.stat().st_size > 1_000_000
    long = read_measured([path])
    by_frame = measured_of_frame(table.assign(sample=table["sample"].str.strip(), run="measured"), "frame")
    assert isinstance(long, Measured) and isinstance(by_frame, Measured) and same(long, by_frame)
    assert any("missing in" in words and "of 30000 rows" in words for words in long.warnings)


def test_a_long_table_is_refused_where_a_short_one_is(tmp_path: Path) -> None:
    n = 60_000
    table = pandas.DataFrame({"sample": "s1", "time_s": np.arange(n) / 100, "pressure_MPa": 0.1, "angle_deg": 60.25})
    lines = table.to_csv(index=False).splitlines()
    for line, wrong, words in ((50_001, "s1,1,0.1", "row has 3 fields"), (50_002, "s1,1,0.1,5 deg", "unit in a cell")):
        damaged = [*lines[: line - 1], wrong, *lines[line - 1 :]]
        error = refusal(tmp_path, "\n".join(damaged) + "\n")
        assert words in error.what and error.where == f"line {line}"
    kPa = [*lines[:41_000], "s1,9999,350,5", *lines[41_000:]]
    assert refusal(tmp_path, "\n".join(kPa) + "\n").where == "line 41001"


def test_a_frame_reads_as_its_file(tmp_path: Path) -> None:
    assert same(measured_of_frame(tidy(), "frame"), read(tmp_path, tidy()))  # type: ignore[arg-type]


def test_names_of_a_frame_that_are_numbers() -> None:
    numbers = {"sample": np.tile(np.repeat([1.0, 2.5], 8), 2), "run": np.tile(np.repeat([1, 2], 4), 4)}
    found = measured_of_frame(tidy().assign(**numbers), "frame")
    assert {(run.sample, run.run) for run in found.runs} == {("1", "1"), ("2.5", "1"), ("1", "2"), ("2.5", "2")}  # type: ignore[union-attr]


def test_values_that_are_missing_stay_missing(tmp_path: Path) -> None:
    table = tidy()
    table.loc[[2, 5], "angle_deg"] = np.nan
    found = read(tmp_path, table)
    assert np.isnan(found.runs[0].values["angle_deg"]).tolist() == [False, False, True, False]
    assert "angle_deg is missing in 2 of 32 rows, the first line 4" in found.warnings


@pytest.mark.parametrize("column", ["pressure_MPa", "time_s"])
def test_rows_without_pressure_or_time_are_left_out(tmp_path: Path, column: str) -> None:
    table = tidy()
    table.loc[[2, 6], column] = np.nan
    found = read(tmp_path, table)
    assert [len(run.time_s) for run in found.runs] == [3, 3, 4, 4, 4, 4, 4, 4]
    assert f"2 rows without {column} left out, the first in line 4" in found.warnings


def test_commands_may_have_gaps(tmp_path: Path) -> None:
    table = tidy().assign(command_MPa=np.where(np.arange(32) % 2, 0.1, np.nan))
    command = read(tmp_path, table).runs[0].command_MPa
    assert command is not None and np.isnan(command).tolist() == [True, False, True, False]


def test_a_run_without_a_value_is_left_out(tmp_path: Path) -> None:
    table = tidy()
    table.loc[:3, "angle_deg"] = np.nan
    found = read(tmp_path, table)
    assert len(found.runs) == 7 and "1 run without a value left out, the first run r1 of a s1" in found.warnings


def test_time_that_goes_back_is_told(tmp_path: Path) -> None:
    table = pandas.concat([tidy()] + [tidy().assign(run=tidy()["run"] + f"x{i}") for i in range(3)])
    table.iloc[[1, 2]] = table.iloc[[2, 1]]
    (words,) = [words for words in read(tmp_path, table).warnings if "time" in words]
    assert words.startswith("time goes back within a run, from 1 s to 0.5 s in line 4:")


def test_one_time_with_two_values_is_refused(tmp_path: Path) -> None:
    error = refusal(tmp_path, tidy().assign(run="r1"))
    assert "two rows with other values at 0 s, lines 2 and 6" in error.what and error.where == "line 6"


def test_equal_rows_count_once(tmp_path: Path) -> None:
    table = pandas.concat([tidy(), tidy().iloc[[1]]])
    found = read(tmp_path, table)
    assert same(found, read(tmp_path, tidy())) and "equal rows counted once: 1, in run r1 of a s1" in found.warnings


def test_a_clock_may_repeat_a_time(tmp_path: Path) -> None:
    time = np.round(np.arange(100) * 0.011, 2)
    time[50] = time[49]
    table = pandas.DataFrame({"time_s": time, "pressure_MPa": np.arange(100) / 500, "angle_deg": np.arange(100.0)})
    (run,) = read(tmp_path, table).runs
    assert len(run.time_s) == 99 and run.values["angle_deg"][49] == 49.5
    table.loc[50, "angle_deg"] = 80
    assert "two rows with other values" in refusal(tmp_path, table).what


@pytest.mark.parametrize("column", ["run_index", "start_s", "orientation_deg"])
def test_what_belongs_to_a_run_has_one_value(tmp_path: Path, column: str) -> None:
    table = tidy().assign(**{column: 1.0})
    table.loc[3, column] = np.nan
    run = read(tmp_path, table).runs[0]
    assert (run.run_index, run.start_s, run.orientation_deg)[
        ("run_index", "start_s", "orientation_deg").index(column)
    ] == 1
    table.loc[2, column] = 2.0
    error = refusal(tmp_path, table)
    assert f"{column} of run r1 is 2 here and 1 in line 2" in error.what and error.where == "line 4"


@pytest.mark.parametrize(
    "change, words, where",
    [
        ({"pressure_MPa": 350.0}, "pressure of 350 MPa, outside -0.11 to 2 MPa", "line 7"),
        ({"pressure_MPa": -0.2}, "pressure of -0.2 MPa", "line 7"),
        ({"command_MPa": 35.0}, "command of 35 MPa", "line 7"),
        ({"cycle": 1.5}, "cycle 1.5 is not a whole number", "line 7"),
        ({"cycle": -1}, "cycle -1 is not a whole number", "line 7"),
        ({"sd": -0.5}, "standard deviation of -0.5, below 0", "line 7"),
        ({"sample": ""}, "no sample", "line 7"),
    ],
)
def test_what_no_row_may_say(tmp_path: Path, change: dict, words: str, where: str) -> None:
    table = tidy().assign(command_MPa=0.1, sd=1.0).astype({"cycle": float})
    for column, value in change.items():
        table.loc[5, column] = value
    error = refusal(tmp_path, table)
    assert error.exit_code == 3 and words in error.what and error.where == where and error.hint


def test_no_cycle_is_no_cycle(tmp_path: Path) -> None:
    table = tidy()
    table.loc[:1, "cycle"] = 0
    cycle = read(tmp_path, table).runs[0].cycle
    assert cycle is not None and np.isnan(cycle).tolist() == [True, True, False, False]


@pytest.mark.parametrize(
    "names, words, hint",
    [
        ({"angle_deg": "angle"}, "no unit in the name of column 'angle'", "angle_deg"),
        ({"pressure_MPa": "pressure"}, "no unit in the name of column 'pressure'", "pressure_kPa"),
        ({"pressure_MPa": "pressure_bara"}, "no unit that is known in 'pressure_bara'", "kPa"),
        ({"pressure_MPa": "pressure (mm)"}, "unit 'mm' of column 'pressure (mm)' is not one of pressure", "MPa"),
        ({"pressure_MPa": "p"}, "no column of pressure", "--columns"),
        ({"angle_deg": "Theta6"}, "no column of a measured quantity", "--columns"),
        ({"cycle": "pressure_kPa"}, "2 columns of pressure_MPa: 'pressure_kPa' and 'pressure_MPa'", "keep one"),
    ],
)
def test_units_are_not_guessed(tmp_path: Path, names: dict, words: str, hint: str) -> None:
    error = refusal(tmp_path, tidy().rename(columns=names))
    assert words in error.what and error.hint and hint in error.hint and isinstance(error, InputError)


def test_other_columns_are_told(tmp_path: Path) -> None:
    found = read(tmp_path, tidy().assign(altitude=1.0, humidity_pct=40))
    (words,) = found.warnings
    assert words.startswith(
        "columns not read: altitude, humidity_pct; --columns says what is called otherwise, --against"
    )
    assert found.runs[0].against == {}


def test_columns_of_the_user(tmp_path: Path) -> None:
    table = tidy().rename(columns={"design": "Type", "pressure_MPa": "P", "angle_deg": "Theta"})
    columns = {"design": "Type", "pressure_kPa": "P", "angle_deg": "Theta"}
    found = read(tmp_path, table.assign(P=table["P"] * 1000), columns=columns)
    assert same(found, read(tmp_path, tidy()))
    headless = table.assign(Type=table["Type"].map({"a": 1, "b": 2}), P=table["P"] * 1000)
    headless = headless.assign(sample=headless["sample"].str[1:], run=headless["run"].str[1:])
    error = refusal(tmp_path, headless.to_csv(index=False, header=False))
    assert "no header" in error.what and error.hint and "by their places" in error.hint
    by_place = columns_of("design,sample,run,cycle,time_s,pressure_kPa,angle_deg,-")
    found = read(tmp_path, headless.to_csv(index=False, header=False), columns=by_place)
    assert len(found.runs) == 8 and found.runs[7].values["angle_deg"].tolist() == [7, 17, 27, 37]
    assert found.runs[0].pressure_MPa == pytest.approx([0, 0.1, 0.2, 0.3])


def test_columns_that_are_not_there(tmp_path: Path) -> None:
    error = refusal(tmp_path, tidy(), columns={"angle_deg": "angel_deg"})
    assert isinstance(error, UsageError) and error.hint == "did you mean 'angle_deg'?"
    error = refusal(tmp_path, tidy(), columns={"angle": "angle_deg"})
    assert "no unit in the name of column 'angle'" in error.what
    assert "'theta_deg' is not a column" in refusal(tmp_path, tidy(), columns={"theta_deg": "angle_deg"}).what
    assert "no column 'humidity'" in refusal(tmp_path, tidy(), against=["humidity"]).what


def test_further_columns_of_numbers_and_words(tmp_path: Path) -> None:
    table = tidy().assign(humidity=[40.5, np.nan] * 16, room=np.repeat(["north", "south"], 16))
    run = read(tmp_path, table, against=["humidity", "room"]).runs[4]
    assert run.against["room"] == "south"
    assert np.array_equal(run.against["humidity"], [40.5, np.nan, 40.5, np.nan], equal_nan=True)  # type: ignore[arg-type]
    table.loc[2, "room"] = "south"
    error = refusal(tmp_path, table, against=["room"])
    assert "room of run r1 is 'south' here and 'north' elsewhere" in error.what and error.where == "line 4"


def test_another_variable_takes_the_place_of_the_pressure(tmp_path: Path) -> None:
    table = tidy().drop(columns="pressure_MPa").assign(room="north", injected_mL=np.tile([0, 5, 10, 15.5], 8))
    found = read(tmp_path, table, against=["room", "injected_mL"])
    assert found.runs[0].pressure_MPa.tolist() == [0, 5, 10, 15.5]
    assert "no column of pressure: 'injected_mL' takes its place, in its own unit" in found.warnings
    assert "no column of pressure" in refusal(tmp_path, table, against=["room"]).what


def test_a_plain_sd_is_of_the_only_quantity(tmp_path: Path) -> None:
    assert read(tmp_path, tidy().assign(sd=2.5)).runs[0].sd["angle_deg"].tolist() == [2.5] * 4
    error = refusal(tmp_path, tidy().assign(sd=2.5, force_N=1.0))
    assert "of which quantity" in error.what and error.hint == "name it angle_sd_deg, force_sd_N"


def test_what_no_column_tells(tmp_path: Path) -> None:
    table = tidy()[["pressure_MPa", "angle_deg"]].iloc[:4]
    found = read(tmp_path, table.iloc[::-1])
    (run,) = found.runs
    assert (run.design, run.sample, run.run) == ("unnamed", "s1", "measured") and np.isnan(run.time_s).all()
    assert run.values["angle_deg"].tolist() == [0, 10, 20, 30]
    assert [words.split(":")[0] for words in found.warnings] == [
        "no column design",
        "no column sample",
        "no column of time",
        "one sample only of 1 design (unnamed)",
    ]
    path = tmp_path / "measured.csv"
    (run,) = read_measured([path], named={path: RunName("tw3_slw10", "s4", "up")}).runs  # type: ignore[union-attr]
    assert (run.design, run.sample, run.run) == ("tw3_slw10", "s4", "up")


def test_designs_by_their_dimensions(tmp_path: Path) -> None:
    table = tidy().assign(tw_mm=3, slw_cm=np.repeat([0.5, 1], 16)).drop(columns="design")
    assert read(tmp_path, table).designs == ("tw3_slw10", "tw3_slw5")
    error = refusal(tmp_path, table.assign(slw_cm=4))
    assert "leaves no window" in error.what and error.where == "line 2"


def test_several_files(tmp_path: Path) -> None:
    table = tidy()
    parts = [write(tmp_path, table[table["sample"] == name], f"{name}.csv") for name in ("s1", "s2")]
    whole = read(tmp_path, table)
    assert same(read_measured(parts), whole)  # type: ignore[arg-type]
    assert same(read_measured(parts[::-1]), whole)  # type: ignore[arg-type]
    with pytest.raises(InputError, match="run r1 of a s1 stands in two files"):
        read_measured([*parts, write(tmp_path, table, "again.csv")])
    unnamed = [write(tmp_path, part.drop(columns="run").iloc[:4], f"{n}.csv") for n, part in table.groupby("run")]
    assert [run.run for run in read_measured(unnamed).runs] == ["r1", "r2"]  # type: ignore[union-attr]


def test_suspicious_units_are_told_and_left_alone(tmp_path: Path) -> None:
    table = tidy()
    table["pressure_MPa"] += 1e-4
    odd = (table["design"] == "b") & (table["sample"] == "s2") & (table["run"] == "r2")
    for column, factor, words in (("pressure_MPa", 1 / 1000, "kPa for MPa"), ("angle_deg", np.pi / 180, "rad for deg")):
        wrong = table.copy()
        wrong.loc[odd, column] *= factor
        found = read(tmp_path, wrong)
        (told,) = found.warnings
        assert words in told and told.startswith(f"run r2 of b s2 reaches {column}")
        assert np.max((found.runs[7].values | {"pressure_MPa": found.runs[7].pressure_MPa})[column]) < 1


def test_copies_are_told(tmp_path: Path) -> None:
    table = tidy()
    copy = table[(table["design"] == "a") & (table["sample"] == "s1") & (table["run"] == "r1")].assign(sample="s9")
    words = read(tmp_path, pandas.concat([table, copy])).warnings[-1]
    assert words == "run r1 of a s9 has the numbers of run r1 of a s1: a copy is no repetition"


def test_names_that_differ_in_case_are_told(tmp_path: Path) -> None:
    table = tidy()
    table.loc[16:19, "sample"] = "S1"
    assert "samples 'S1' and 's1' are taken as two" in read(tmp_path, table).warnings


def test_doubtful_frames_have_no_value(tmp_path: Path) -> None:
    table = tidy().assign(flag=["", "markers left out", "marker missing", ""] * 8)
    found = read(tmp_path, table)
    assert np.isnan(found.runs[0].values["angle_deg"]).tolist() == [False, False, True, False]
    assert "8 rows with a flag of doubt: no value there" in found.warnings


def test_a_table_of_a_simulated_run_says_so(tmp_path: Path) -> None:
    assert read(tmp_path, tidy().assign(origin="simulated (twin)")).simulated
    assert not read(tmp_path, tidy().assign(origin="bench")).simulated


@pytest.mark.parametrize("content", ["", "design,angle_deg,pressure_MPa\n", "just text\n", "PK\x03\x04"])
def test_files_without_rows(tmp_path: Path, content: str) -> None:
    assert refusal(tmp_path, content).exit_code == 3


def test_what_is_no_file(tmp_path: Path) -> None:
    os.mkfifo(tmp_path / "pipe.csv")
    for path, words in (
        (tmp_path, "is a folder"),
        (tmp_path / "none.csv", "no such file"),
        (tmp_path / "pipe.csv", "not a regular"),
    ):
        with pytest.raises(BenchlabError, match=words):
            read_measured([path])
    with pytest.raises(UsageError, match="no table"):
        read_measured([])


def test_cells_without_numbers(tmp_path: Path) -> None:
    lines = tidy().to_csv(index=False).splitlines()
    lines[3] = lines[3].replace("20.0", "Overload")
    found = read(tmp_path, "\n".join(lines) + "\n")
    assert np.isnan(found.runs[0].values["angle_deg"]).tolist() == [False, False, True, False]
    assert any("'Overload' in line 4" in words for words in found.warnings)
    lines = [lines[0], *(line.replace(",1,", ",one,", 1) for line in lines[1:])]
    assert "cells hold no number" in refusal(tmp_path, "\n".join(lines) + "\n").what


def test_a_row_that_was_cut(tmp_path: Path) -> None:
    found = read(tmp_path, tidy().to_csv(index=False) + "b,s2,r2,2,")
    assert "the last row (line 34) is cut and was left out" in found.warnings and same(found, read(tmp_path, tidy()))


def test_a_table_of_means_beside_runs_is_refused(tmp_path: Path) -> None:
    means = write(tmp_path, "design,pressure_MPa,mean,sd,n\na,0.3,50,1,5\n", "means.csv")
    with pytest.raises(UsageError, match="a table of means beside tables of runs"):
        read_measured([means, write(tmp_path, tidy())])
    assert isinstance(read_measured([means]), Summary)


def test_a_column_called_like_an_effect_says_nothing(tmp_path: Path) -> None:
    table = tidy().assign(friction=0.2, temperature=21.5)
    found = read(tmp_path, table.drop(columns="temperature"))
    assert "column friction is called like an effect, and says nothing of it" in found.warnings
    assert "no unit in the name of column 'temperature'" in refusal(tmp_path, table).what
    run = read(tmp_path, table, against=["friction", "temperature"]).runs[0]
    assert run.against["friction"][0] == 0.2 and run.temperature_C is None  # type: ignore[comparison-overlap]
    assert "'angle_deg' is read anyway" in refusal(tmp_path, table, against=["angle_deg"]).what


def test_many_runs_of_one_doubt_are_told_together(tmp_path: Path) -> None:
    table = tidy()
    found = read(tmp_path, pandas.concat([table, table]))
    assert found.warnings == ("equal rows counted once: 32, in run r1 of a s1 and 7 other runs",)
    copied = pandas.concat([table, *(table.assign(sample=table["sample"] + str(n)) for n in range(2))])
    told = [words for words in read(tmp_path, copied).warnings if "cop" in words or "more" in words]
    assert len(told) == 6 and told[-1] == "and of 11 runs more"


def test_a_frame_whose_columns_are_numbers() -> None:
    frame = pandas.DataFrame({0: [0.0, 0.1], 7: [1.0, 2.0]})
    (run,) = measured_of_frame(frame, "frame", {"pressure_MPa": "0", "angle_deg": "7"}).runs  # type: ignore[union-attr]
    assert run.pressure_MPa.tolist() == [0, 0.1] and run.values["angle_deg"].tolist() == [1, 2]
    with pytest.raises(InputError, match="no data rows"):
        measured_of_frame(pandas.DataFrame(), "frame")
