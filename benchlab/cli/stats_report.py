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

MOST_ROWS = 40


def print_report(found: StatsFound) -> None:
    """To standard output. Wide tables are not broken where nobody looks at a terminal."""
    from rich.console import Console

    comparison, columns = found.comparison, found.document["columns"]
    console = Console(highlight=False, emoji=False)
    console.width = max(console.width if console.is_terminal else 160, 100)
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


def _print(console: Console, table: Table, rows: tuple[tuple[Cell, ...], ...]) -> None:
    from rich.table import Table as RichTable
    from rich.text import Text

    shown: list[tuple[int, Column]] = [(i, column) for i, column in enumerate(table.columns) if column.head]
    drawn = RichTable(
        box=None, pad_edge=False, padding=(0, 2, 0, 0), title=Text(table.caption, "bold"), title_justify="left"
    )
    for _, column in shown:
        drawn.add_column(column.head, justify="right" if column.number else "left", no_wrap=column.number)
    for row in rows[:MOST_ROWS]:
        drawn.add_row(*(Text(row[i].text) for i, _ in shown))
    console.print()
    console.print(drawn)
    if len(rows) > MOST_ROWS:
        click.echo(f"… and {len(rows) - MOST_ROWS} more: --out or --json gives all")
    if table.note:
        click.echo(table.note)
