"""The reader of plain numbers and the strict one: the same of every file, bit by bit, or the same refusal."""

from pathlib import Path

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from benchlab.errors import BenchlabError
from benchlab.io import export_fast, export_text
from benchlab.io.export_fast import read_plain
from benchlab.io.export_table import Export, read_export
from benchlab.io.export_text import read_text

SETTINGS = settings(
    max_examples=60,
    deadline=None,
    derandomize=True,
    suppress_health_check=[HealthCheck.function_scoped_fixture, HealthCheck.too_slow],
)


@pytest.fixture
def of_any_size(monkeypatch: pytest.MonkeyPatch) -> None:
    """Small files are read as long ones are, and in several parts."""
    monkeypatch.setattr(export_fast, "MIN_BYTES", 0)
    monkeypatch.setattr(export_fast, "_CHUNK", 150)


def outcome(path: Path, strict: bool, decimal: str | None = None) -> object:
    """All that a reader tells of a file, or its refusal."""
    try:
        export = read_export(path, decimal=decimal, strict=strict)
        return told(export)
    except BenchlabError as error:
        return type(error), str(error)


def told(export: Export) -> object:
    tables = []
    for t in export.tables:
        columns = []
        for index in range(t.width):
            try:
                column, notes = t.column(index)
                columns.append((column.values.tobytes(), column.unreadable, notes))
            except BenchlabError as error:
                columns.append(str(error))
        tables.append((t.names, t.units, t.label, t.header, list(t.lines), t.width, columns))
    return export.encoding, export.separator, export.signs, export.preamble, export.notes, tables


def same(path: Path, decimal: str | None = None) -> None:
    assert outcome(path, False, decimal) == outcome(path, True, decimal)


NUMBERS = st.one_of(
    st.floats(-1e6, 1e6).map(lambda x: f"{x:.4f}"),
    st.floats(-1e3, 1e3).map(lambda x: f"{x:.3f}"),
    st.floats(allow_nan=False, allow_infinity=False).map(repr),
    st.integers(-(10**7), 10**7).map(str),
    st.sampled_from(["0", "-0.0", "1.", ".5", "+2.5", "007", "1e-3", "1E5", "1e999", "1.2.3", "-", "", " 1.5", "1.250", "12.3456e2"]),
    st.sampled_from(["1,234.5", "1,234", "nan", "inf", "Overload", "1_0", "0x1A", "1 5", "e5", ".", "1 N", "−1.5"]),
)  # fmt: skip
FORMS = ("{:.4f}", "{:.16e}", "{:.3E}", "{:+.12f}", "{:.1f}")
PLAIN = st.tuples(st.sampled_from(FORMS), st.floats(-1e9, 1e9)).map(lambda made: made[0].format(made[1]))


@pytest.mark.parametrize("separator", [",", ";", "\t", " "])
@SETTINGS
@given(data=st.data())
def test_any_cells_are_read_alike(tmp_path: Path, of_any_size: None, separator: str, data: st.DataObject) -> None:
    good = [[f"{i / 8:.3f}", f"{i * 0.37:.3f}", f"{i * 1.01:.3f}"] for i in range(30)]
    for _ in range(data.draw(st.integers(0, 3))):
        good[data.draw(st.integers(0, 29))][data.draw(st.integers(0, 2))] = data.draw(NUMBERS)
    quote = data.draw(st.sampled_from(["", '"']))
    comma = data.draw(st.booleans())
    end = data.draw(st.sampled_from(["\n", "\r\n"]))
    cell = (lambda t: quote + t.replace(".", ",") + quote) if comma else (lambda t: quote + t + quote)
    header = data.draw(
        st.sampled_from(["", f"Time{separator}Load{separator}Extension", f"a;b{end}{end}Time{separator}x{separator}y"])
    )
    lines = [header] * bool(header) + [separator.join(map(cell, row)) for row in good]
    text = end.join(lines) + data.draw(st.sampled_from(["", end, end * 3]))
    path = tmp_path / "a.csv"
    path.write_bytes(text[: len(text) - data.draw(st.integers(0, 4))].encode())
    same(path, data.draw(st.sampled_from([None, None, ".", ","])))


@SETTINGS
@given(rows=st.lists(st.lists(PLAIN, min_size=2, max_size=2), min_size=8, max_size=40))
def test_any_number_is_rounded_alike(tmp_path: Path, of_any_size: None, rows: list[list[str]]) -> None:
    path = tmp_path / "a.csv"
    path.write_text("\n".join(map(",".join, rows)) + "\n")
    assert read_plain(read_text(path)) is not None
    same(path)


def lines_of(rows: int, base: str = "marked") -> list[str]:
    """A table with its header. base: every number with a decimal sign; whole numbers in the first column; or all cells quoted."""
    force = np.random.default_rng(1).normal(0, 50, rows)
    lines = []
    for i in range(rows):
        cells = (str(i) if base == "whole" else f"{i / 1000:.3f}", f"{force[i]:.5f}", f"{force[i] * 1.1:.3f}")
        lines.append(",".join(f'"{cell}"' if base == "quoted" else cell for cell in cells))
    return ["Operator,x", "Time,Load,Extension", "(s),(N),(mm)", *lines]


@pytest.mark.parametrize("line_end", ["\n", "\r\n"])
@pytest.mark.parametrize("base", ["marked", "whole", "quoted"])
@pytest.mark.parametrize(("separator", "comma"), [(",", False), (";", True), ("\t", True), (";", False)])
def test_long_files_of_plain_numbers_are_read_so(
    tmp_path: Path, line_end: str, base: str, separator: str, comma: bool
) -> None:
    path = tmp_path / "a.csv"
    text = line_end.join(lines_of(15_000, base)).replace(",", separator) + line_end
    path.write_bytes((text.replace(".", ",") if comma else text).encode())
    plain = read_plain(read_text(path))
    assert plain is not None and len(plain.columns[0].values) == 15_000 and plain.lines == range(4, 15_004)
    if base == "marked":
        same(path)


ROW = 250
IN_ROW = {
    "a quoted thousand": '4.500,"1,234.50000",1.1',
    "a decimal comma": "4.500,1,50000,1.1",
    "lost decimals": "4.500,4000000,1.1",
    "two decimal signs": "4.500,1.2.3,1.1",
    "a bare decimal sign": "250,7.,1.1",
    "a zero before": "250,07,1.1",
    "an exponent": "4.500,1.5e1,1.1",
    "a whole exponent": "250,15e1,1.1",
    "a blank within": "4.500,1 5.5,1.1",
    "a blank behind": "4.500,15 ,1.1",
    "a text": "4.500,Overload,1.1",
    "an empty cell": "4.500,,1.1",
    "a blank line": "",
    "infinity": "4.500,1.5e999,1.1",
    "a long number": "4.500," + "9" * 70 + ".0,1.1",
    "a quotation mark": '4.500,"1.5,1.1',
    "a row of quotes": '"4.500","1.5","1.1"',
    "quotes within": '4"."500,1.5,1.1',
    "a carriage return": "4.500,1.5,1.1\r",
    "a carriage return within": "4.500,1.5\r,1.1",
}
AT_END = {
    "a cut row": "\n6.000,1.2\n",
    "a row without its end": "\n6.000,1.25000,1.1",
    "a row cut in a number": "\n6.000,1.25000,",
    "a second table": "\n\nTime,Load,Extension\n(s),(N),(mm)\n0.1,2,3\n",
}


@pytest.mark.parametrize("base", ["marked", "whole", "quoted"])
@pytest.mark.parametrize("damage", [*IN_ROW, *AT_END])
def test_damage_far_behind_is_told_alike(
    tmp_path: Path, of_any_size: None, monkeypatch: pytest.MonkeyPatch, base: str, damage: str
) -> None:
    monkeypatch.setattr(export_fast, "HEAD", 2000)
    monkeypatch.setattr(export_text, "HEAD", 2000)
    lines = lines_of(400, base)
    if damage in IN_ROW:
        lines[ROW] = IN_ROW[damage]
    path = tmp_path / "b.csv"
    path.write_bytes(("\n".join(lines) + AT_END.get(damage, "\n")).encode())
    same(path)


@pytest.mark.parametrize(
    "first", ['Film,5" wide', 'Note,"a\nb"', "", "\n\n", "sep=,", "\ufeffOperator,Łukasz", "Müller"]
)
@pytest.mark.parametrize("encoding", ["utf-8", "utf-16", "cp1250"])
def test_what_stands_above_shifts_nothing(tmp_path: Path, of_any_size: None, first: str, encoding: str) -> None:
    path = tmp_path / "a.csv"
    path.write_bytes((first + "\n" + "\n".join(lines_of(300)) + "\n").encode(encoding, "ignore"))
    same(path)
    (table,) = read_export(path).tables
    column, _ = table.column(0)
    assert column.values.tolist() == [i / 1000 for i in range(300)]


@pytest.mark.parametrize("late", ["{i};{n}.234;5", "{i};{n},234;5", "{i};{i}.5;5", "{i};{i},5;5", "{i};{i};5"])
def test_the_sign_of_decimals_may_show_late(tmp_path: Path, late: str) -> None:
    early = [f"{i};{i};5" for i in range(15_000)]
    path = tmp_path / "a.csv"
    path.write_text("\n".join([*early, *(late.format(i=i, n=i % 7 + 1) for i in range(15_000, 30_000))]) + "\n")
    assert path.stat().st_size > export_fast.MIN_BYTES
    same(path)
