"""Damage and ambiguity in exports: refused or warned of with the line, the value and the remedy; never a wrong number.

Numbers in brackets are rows of the list of bad inputs of a lab: empty files, shifted columns, lost decimals, binary data, limits.
"""

import gzip
import time
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from benchlab.errors import BenchlabError, InputError, UsageError
from benchlab.io.export_damage import lost_decimals
from benchlab.io.export_numbers import NO_NUMBER, PADDED, Column
from benchlab.io.export_text import MAX_COLUMNS, MAX_LINE
from benchlab.io.machine_export import ExportOptions, MachineExport, export_document, read_machine_export
from tests.pace import slowness

HEAD = "Time,Extension,Load\n(s),(mm),(N)\n"
SEMI = HEAD.replace(",", ";")


def table(count: int = 40, separator: str = ",", **cells: str) -> str:
    """Rows of a plain test. cells: what stands in the force of a row instead, as r5="Overload"."""
    rows = [
        f"{i / 100:.2f}{separator}{i / 10:.2f}{separator}{cells.get(f'r{i}', f'{20 + i / 8:.3f}')}"
        for i in range(count)
    ]
    return "\n".join(rows) + "\n"


def read(folder: Path, content: str | bytes, **options: Any) -> MachineExport:
    path = folder / "a.csv"
    path.write_bytes(content if isinstance(content, bytes) else content.encode())
    return read_machine_export(path, ExportOptions(**options))


DASHES = {f"r{i}": "----" for i in range(5)}
LOST = r"line 10: column Load \(N\): '20875' between 20.75 and 21: decimal sign lost, it would be 20.875"
BOTH = r"line 10: decimal points \(line 3\) and decimal commas \(line 10, '20,85'\)"
DUPLICATE = "Time,Force,Force\n(s),(N),(N)\n0.1,1.5,2.5\n0.2,1.6,2.6\n"
REFUSED = {
    "nothing in it (59)": ("", 3, "empty file .0 bytes."),
    "blank lines (59)": ("\n\n  \n", 3, "no data rows"),
    "header only (59)": (HEAD, 3, "no data rows"),
    "no units (62)": ("Time,Load\n" + "0.1,1.5\n" * 3, 2, "line 1: no unit of 'Load'; give --force-unit .N, kN, .* or name the columns"),
    "unknown unit (62)": ("Time (s),Load (foo)\n" + "0.1,1.5\n" * 3, 2, "unit 'foo' of 'Load' is not one of force .N, kN"),
    "decimal commas between commas (64)": (HEAD + "0,1,1,5,10,5\n" * 5, 3, "line 3: row has 6 fields, header 3"),
    "a field more in each row (65)": (HEAD + "0.1,1.5,2.5,9\n" * 5, 3, "line 3: row has 4 fields, header 3"),
    "a field more than names with units (65)": ("Time (s),Load (N)\n" + "0.1,2.5,9\n" * 5, 3, "line 2: row has 3 fields, header 2"),
    "a name more than fields (65)": ("Time (s),Load (N),Extension (mm)\n" + "0.1,2.5\n" * 5, 3, "line 2: row has 2 fields, header 3"),
    "a field more in one row (66)": (HEAD + table(r7="1.5,9"), 3, "line 10: row has 4 fields, the first one .line 3. 3"),
    "a field less in one row": (HEAD + table().replace("0.07,0.70,", "0.07,"), 3, "line 10: row has 2 fields"),
    "zeros of a disk (71)": (HEAD + table(r5="1\x00.5"), 3, "line 8: binary data"),
    "a quotation mark alone (72)": (HEAD + table(r5='"2.5'), 3, "line 8: not a table row; is there a quotation mark"),
    "units in all cells (73)": (HEAD + "0.1 s,1 mm,2 N\n" * 5, 3, "line 3: unit in a cell: '0.1 s'; put the unit in the header"),
    "a unit in a cell (73)": (HEAD + table(r5="2.5 N"), 3, r"line 8: column Load \(N\): unit in a cell: '2.5 N'"),
    "too many failed readings (74)": (HEAD + table(**DASHES), 3, "5 of 40 cells .* hold no number.*at most 10 %"),
    "the same name twice (75)": (DUPLICATE, 2, r"line 1: 2 columns that could be the force: 'Force \(N\)' and .*--columns"),
    "two columns of force (75)": ("A (N),B (N)\n1.5,2.5\n1.6,2.6\n", 2, r"2 columns that could be the force: 'A \(N\)' and 'B \(N\)'"),
    "unknown unit of time": ("Time (foo),Load (N)\n" + "0.1,1.5\n" * 3, 2, "unit 'foo' of 'Time' is not one of time .s, sec, ms"),
    "two units of a column": (
        "Time (s),Load (kN)\n(s),(N)\n0.1,1.5\n0.2,1.6\n", 3,
        "line 1: column 'Load' is in kN by its name and in N by the row of units; remove one",
    ),
    "no force (76)": ("Time (s),Extension (mm)\n0.1,1.5\n0.2,1.6\n", 2, "no column of force among 'Time', 'Extension'"),
    "an Excel file (82)": (b"PK\x03\x04rest", 3, "this is an Excel file or a zip archive"),
    "a web page (82)": ("<!DOCTYPE html><html>1,2\n</html>", 3, "this is a web page"),
    "a compressed file (83)": (gzip.compress((HEAD + table()).encode()), 3, "compressed .gzip., .*; unpack it first"),
    "too many digits (86)": (HEAD + table(r5="9" * 4400), 3, "line 8: .*cell of 4400 characters"),
    "no header": (table(), 2, "3 columns without names or units; name the columns by place, as --columns"),
    "decimals lost in one cell": (HEAD + table(r7="20875"), 3, LOST),
    "two decimal signs": (HEAD + table(r7="20.8.75"), 3, "line 10: .*two decimal signs in '20.8.75'"),
    "three groups": (SEMI + table(separator=";", r7="20.875.125"), 3, "line 10: .*two decimal signs in '20.875.125'"),
    "commas or blanks": ("0,100 200,500\n0,200 201,500\n", 3, "line 1: '0,100 200,500' could be separated by commas or by blanks; export"),
    "points and commas": (SEMI + table(separator=";", r7="20,85"), 3, BOTH),
    "text for a header of numbers": ("a;b\nc;d\ne;f\n", 3, "no data rows: no line with two numbers in it"),
    "an empty cell in most rows": (HEAD + "0.1,1.5,\n" * 9 + "0.2,1.5,2.5\n", 3, "9 of 10 cells .* hold no number, all empty"),
}  # fmt: skip


@pytest.mark.parametrize("what", REFUSED)
def test_refusals_name_the_place_and_the_remedy(tmp_path: Path, what: str) -> None:
    content, code, words = REFUSED[what]
    with pytest.raises(BenchlabError, match=words) as caught:
        read(tmp_path, content)
    assert caught.value.exit_code == code and "\n" not in str(caught.value)
    assert caught.value.hint


AMBIGUOUS = {
    "1,234": (";", 1.234, 1234),
    "1.234": (";", 1.234, 1234),
    "-12,345": ("\t", -12.345, -12345),
}


@pytest.mark.parametrize("cell", AMBIGUOUS)
def test_what_can_be_read_in_two_ways_is_refused_with_both(tmp_path: Path, cell: str) -> None:
    separator, broken, whole = AMBIGUOUS[cell]
    text = SEMI.replace(";", separator) + "".join(f"{i}{separator}{i}{separator}{cell}\n" for i in range(5))
    with pytest.raises(
        InputError, match=f"line 3: '{cell}' could be {broken} or {whole}; say --decimal , or --decimal ."
    ):
        read(tmp_path, text)
    for decimal in ".,":
        force = read(tmp_path, text, decimal=decimal).tests[0].columns["force_N"][0]
        assert force == (broken if decimal in cell else whole)


def test_one_number_settles_the_others(tmp_path: Path) -> None:
    text = SEMI + "1;1;1,234\n2;2;1,25\n3;3;1,5\n"
    assert read(tmp_path, text).tests[0].columns["force_N"].tolist() == [1.234, 1.25, 1.5]
    points = HEAD + "1,1,1.234\n2,2,1.235\n"  # beside commas as separators, points can only be for decimals
    assert read(tmp_path, points).tests[0].columns["force_N"].tolist() == [1.234, 1.235]


@pytest.mark.parametrize("text", ["----", "Overload", "inf", "1e999", "NaN", "#N/A", "***"])
@pytest.mark.parametrize("row", [0, 5, 39])
def test_failed_readings_are_counted_and_missing(tmp_path: Path, text: str, row: int) -> None:
    export = read(tmp_path, HEAD + table(**{f"r{row}": text}))
    force = export.tests[0].columns["force_N"]
    assert np.flatnonzero(np.isnan(force)).tolist() == [row] and export.rows == 40
    assert export.warnings == (f"line {row + 3}: 1 of 40 cells of Load (N) hold no number, the first {text!r}",)
    assert export_document(export)["columns"]["force_N"]["max"] < 25


@pytest.mark.parametrize(
    ("last", "end"),
    [
        ("0.40,4.0", "\n"),
        ("0.40,4.00,2", ""),
        ("0.40,4.00,25.", ""),
        ("0.40,4.00,25.00", ""),
        ("0.", ""),
        ("0.40,4.00,", ""),
        ("0.40,4.00,", "\n"),
    ],
)
def test_a_last_line_that_was_cut_is_left_out_and_named(tmp_path: Path, last: str, end: str) -> None:
    export = read(tmp_path, HEAD + table() + last + end)
    assert export.rows == 40 and export.warnings == ("the last row (line 43) is cut and was left out",)
    assert export.preamble == {}


def test_a_whole_last_line_without_its_end_is_kept(tmp_path: Path) -> None:
    export = read(tmp_path, HEAD + table() + "0.40,4.00,25.000")
    assert export.rows == 41 and not export.warnings


def test_time_that_runs_backwards_is_located_and_sorted_only_when_asked(tmp_path: Path) -> None:
    rows = table(12).splitlines()
    rows[6], rows[7] = rows[7], rows[6]
    text = HEAD + "\n".join(rows) + "\n"
    left = read(tmp_path, text)
    assert left.warnings == (
        "line 10: the time runs backwards from 0.07 to 0.06 s, once; rows are left as they are, --sort-time sorts them",
    )
    assert left.tests[0].columns["time_s"][6] == 0.07
    by_time = read(tmp_path, text, sort_time=True)
    assert by_time.warnings == ("line 10: the time runs backwards from 0.07 to 0.06 s, once; rows were sorted by time",)
    assert np.array_equal(by_time.tests[0].columns["time_s"], np.arange(12) / 100)
    assert np.array_equal(by_time.tests[0].columns["force_N"], 20 + np.arange(12) / 8)
    assert np.asarray(by_time.tests[0].lines).tolist() == [3, 4, 5, 6, 7, 8, 10, 9, 11, 12, 13, 14]


def test_time_that_begins_again_may_be_another_test(tmp_path: Path) -> None:
    text = HEAD + table(12) + table(12)
    (warning,) = read(tmp_path, text).warnings
    assert warning.startswith("line 15: the time begins again, once; if another test begins here, split the file")
    with pytest.raises(InputError, match="line 15: the time begins again: sorting would mix two tests"):
        read(tmp_path, text, sort_time=True)


def test_time_that_stands_still_is_a_warning(tmp_path: Path) -> None:
    export = read(tmp_path, HEAD + table(12).replace("0.05,", "0.04,", 1))
    assert export.warnings == ("line 8: the time stands still, once",)


def test_lost_decimals_are_found_in_a_column_of_any_height() -> None:
    rng = np.random.default_rng(3)
    for scale in (0.5, 5, 50, 5000):
        values = np.round(scale * (2 + np.sin(np.arange(200) / 9)) + rng.normal(0, scale / 100, 200), 3)
        decimals = np.full(200, 3, np.int16)
        assert lost_decimals(Column(values, decimals)) is None
        values[77], decimals[77] = values[77] * 1000, 0
        row, what = lost_decimals(Column(values, decimals)) or (-1, "")
        assert row == 77 and "decimal sign lost" in what


def test_values_cut_to_whole_numbers_are_lost_decimals_and_round_ones_are_not() -> None:
    values = np.round(np.linspace(1, 9, 60), 2)
    decimals = np.full(60, 2, np.int16)
    values[30:], decimals[30:] = np.floor(values[30:]), 0
    assert lost_decimals(Column(values, decimals)) == (30, "'5' has no decimals, the 30 numbers before it have 2")
    single = np.round(np.linspace(5, 6, 150), 2)
    with_one = np.full(150, 2, np.int16)
    single[120], with_one[120] = 5, 0
    assert lost_decimals(Column(single, with_one)) == (120, "'5' has no decimals, the 120 numbers before it have 2")
    # A spreadsheet leaves zeros at the end out: 12.5, 13, 13.5 is no damage; nor are four digits throughout: 524.7, 1152.
    half = np.arange(40) / 2
    assert lost_decimals(Column(half, np.tile([0, 1], 20).astype(np.int16))) is None
    four = Column(np.array([98.21, 524.7, 1152, 1685, 2147]), np.array([2, 1, 0, 0, 0], np.int16))
    assert lost_decimals(four) is None
    padded = Column(np.array([1.25, 12.5, 125, 1.5]), np.array([2, 1, PADDED, 1], np.int16))
    assert (lost_decimals(padded) or (0,))[0] == 2
    missing = Column(np.array([1.25, np.nan, 1.5]), np.array([2, NO_NUMBER, 2], np.int16))
    assert lost_decimals(missing) is None


def test_a_stated_decimal_sign_makes_lost_decimals_a_warning(tmp_path: Path) -> None:
    export = read(tmp_path, HEAD + table(r7="20875"), decimal=".")
    (warning,) = export.warnings
    assert warning.startswith("line 10: column Load (N): '20875' between") and warning.endswith(
        "as --decimal was given"
    )
    assert export.tests[0].columns["force_N"][7] == 20875


def test_outsize_files_end_at_once(tmp_path: Path) -> None:
    wide = ",".join(["Load (N)"] * 100_000) + "\n" + ",".join(["1.5"] * 100_000) + "\n"
    long = "1.5," + "9" * 10_000_000
    started = time.process_time()
    with pytest.raises(InputError, match=f"line 1: more than {MAX_COLUMNS} columns"):
        read(tmp_path, wide)
    with pytest.raises(InputError, match=f"line 1: line longer than {MAX_LINE} characters"):
        read(tmp_path, long)
    assert time.process_time() - started < 5 * slowness()


def test_compression_keeps_its_sign(tmp_path: Path) -> None:
    force = read(tmp_path, HEAD + table().replace(",2", ",-2")).tests[0].columns["force_N"]
    assert force.max() < 0


def test_no_file_and_a_folder_are_usage_errors(tmp_path: Path) -> None:
    for path, words in ((tmp_path / "none.csv", "no such file"), (tmp_path, "is a folder")):
        with pytest.raises(UsageError, match=words):
            read_machine_export(path)


@pytest.mark.parametrize(
    ("columns", "words"),
    [
        ("time_s,force_N", "names 2 columns, the table has 3; name each one"),
        ("time_s,extension_mm,force", "'force' is not a column with its unit; use time_s"),
        ("time_s,force_N,force_N", "names two columns of force"),
        ("time_s,-,-", "names no force"),
        ("time_mm,-,force_N", "'time_mm' is not a column with its unit"),
    ],
)
def test_columns_are_named_with_their_units(tmp_path: Path, columns: str, words: str) -> None:
    with pytest.raises(UsageError, match=words):
        read(tmp_path, table(), columns=columns)
