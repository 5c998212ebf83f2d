"""Tables of a report: what the page shows and what the CSV file holds."""

import csv
from pathlib import Path

from benchlab.report.document import NONE, Cell, Column, Table, write_table
from benchlab.report.rounding import number, words

COLUMNS = (
    Column("set"),
    Column("name", "name", False),
    Column("value_deg", "value (°)"),
    Column("", "shown only"),
    Column("note", "note", False),
)


def table(*rows: tuple[str, str, float | None], most: int = 60) -> Table:
    cells = tuple((words(a), words(b), number(c, 1), Cell(None, "x"), words("")) for a, b, c in rows)
    return Table("values", "Values.", COLUMNS, cells, "A note.", by="set", most=most)


def test_the_page_has_columns_with_a_head_and_something_in_them() -> None:
    made = table(("s", "a", 1.25), ("s", "b", None))
    assert [column.head for column in made.heads] == ["name", "value (°)", "shown only"]
    assert made.shown == (("a", "1.2", "x"), ("b", NONE, "x"))


def test_a_table_without_rows_keeps_its_heads() -> None:
    assert [column.head for column in table().heads] == ["name", "value (°)", "shown only", "note"]


def test_a_line_stands_over_rows_that_share_it() -> None:
    assert table(("s", "a", 1), ("s", "b", 2), ("t", "c", 3), ("s", "d", 4)).lines == ("s", "", "t", "s")


def test_the_page_says_what_it_leaves_off() -> None:
    made = table(*(("s", str(i), i) for i in range(5)), most=3)
    assert len(made.shown) == len(made.lines) == 3
    assert made.notes == ("The first 3 of 5 rows; all are in values.csv.", "A note.")


def test_csv_has_every_digit_every_row_and_no_formula(tmp_path: Path) -> None:
    made = table(("s", "=cmd|calc", 1 / 3), ("s", "a\nb", None), ("s", "x" * 5000, 2), most=1)
    write_table(tmp_path / "a.csv", made)
    with (tmp_path / "a.csv").open(encoding="utf-8", newline="") as file:
        head, *rows = csv.reader(file)
    assert head == ["set", "name", "value_deg", "note"]
    assert [row[1] for row in rows] == ["'=cmd|calc", "a\\nb", "x" * 5000]
    assert float(rows[0][2]) == 1 / 3 and rows[1][2] == ""
