"""A comparison on a terminal: the verdict first, then tables."""

from __future__ import annotations

from typing import TYPE_CHECKING

import click

from benchlab.errors import printable
from benchlab.report.document import Cell, Column, Table, cut
from benchlab.stats.comparison import Comparison
from benchlab.stats.names import listed

if TYPE_CHECKING:
    from rich.console import Console

    from benchlab.workflows.stats import StatsFound

MOST_ROWS, FEWEST_COLUMNS = 40, 6
"""Rows shown, and columns that are shown however narrow the terminal."""


def print_report(found: StatsFound) -> None:
    """To standard output. Wide tables are not broken where nobody looks at a terminal."""
    from rich.console import Console

    comparison, columns = found.comparison, found.document["columns"]
    console = Console(highlight=False, emoji=False)
    console.width = max(console.width, 80) if console.is_terminal else 160
    samples = sum(group.n for group in comparison.groups)
    what = cut(columns.get("value") or columns.get("mean"), 60)
    by = " and ".join(cut(name, 40) for name in columns["group"])
    click.echo(
        f"{printable(found.document['file'])}: {what} of {samples} samples in {len(comparison.groups)} groups by {by}\n"
    )
    click.echo(printable(found.document["verdict"]))
    if comparison.tukey:
        click.echo(printable(_pairs_in_words(comparison)))
    for table in found.tables:
        if table.name == "consistency":
            _print_consistency(console, comparison, table)
        else:
            _print(console, table, table.rows)
    click.echo()


def _pairs_in_words(found: Comparison) -> str:
    alpha = found.alpha
    alike = [f"{cut(p.a, 24)} and {cut(p.b, 24)}" for p in found.tukey if p.p is None or p.p >= alpha]
    differ = len(found.tukey) - len(alike)
    head = f"Pairs that differ by Tukey's HSD at {alpha:.3g}: {differ} of {len(found.tukey)}"
    return f"{head}; not shown to differ: {listed([*alike], 4)}." if alike and differ else f"{head}."


def _print_consistency(console: Console, found: Comparison, table: Table) -> None:
    outside = tuple(row for row, cell in zip(table.rows, found.repeatability.cells) if cell.outside)
    if outside:
        _print(console, table, outside)
    elif any(value is not None for cell in found.repeatability.cells for value in (cell.h, cell.k)):
        click.echo("\nNothing is beyond a critical value of h or k (ASTM E691, 0.5 %).")


def _least_width(shown: list[tuple[int, Column]], rows: tuple[tuple[Cell, ...], ...]) -> int:
    """Of a table: numbers are not broken, the first column is not broken into less than 16 letters."""
    widths = [max(len(column.head), *(len(row[i].text) for row in rows[:MOST_ROWS])) for i, column in shown]
    return 16 + sum(2 + width for width in widths[1:])


def _print(console: Console, table: Table, rows: tuple[tuple[Cell, ...], ...]) -> None:
    from rich.table import Table as RichTable
    from rich.text import Text

    shown: list[tuple[int, Column]] = [(i, column) for i, column in enumerate(table.columns) if column.head]
    dropped: list[str] = []
    while len(shown) > FEWEST_COLUMNS and _least_width(shown, rows) > console.width:
        dropped.append(shown.pop()[1].head)
    drawn = RichTable(
        box=None, pad_edge=False, padding=(0, 2, 0, 0), title=Text(table.caption, "bold"), title_justify="left"
    )
    for _, column in shown:
        drawn.add_column(column.head, justify="right" if column.number else "left", no_wrap=column.number)
    for row in rows[:MOST_ROWS]:
        drawn.add_row(*(Text(row[i].text) for i, _ in shown))
    console.print()
    console.print(drawn)
    if dropped:
        click.echo(f"(on a wider terminal, with --json or --out also: {', '.join(reversed(dropped))})")
    if len(rows) > MOST_ROWS:
        click.echo(f"… and {len(rows) - MOST_ROWS} more: --out or --json gives all")
    if table.note:
        click.echo(table.note)
