"""What was inferred in reading an export, in words, and its preamble as keys and values."""

from __future__ import annotations

from collections.abc import Sequence

from benchlab.errors import printable
from benchlab.io.export_columns import KEYS, Chosen, split_name
from benchlab.io.export_table import Export, ExportTable
from benchlab.io.export_text import SEPARATORS

_SIGNS = {".": "point", ",": "comma", "": "none seen"}


def inferred_in_words(
    export: Export, tables: Sequence[ExportTable], chosen: Sequence[Sequence[Chosen]], specimens: int
) -> dict[str, str]:
    """Every inference about a file: encoding, separator, decimal, thousands, header, specimens, each column with what the file
    calls it and its unit, and columns that are not used."""
    how = " (from --decimal)" if export.signs.stated else ""
    found = {
        "encoding": export.encoding,
        "separator": SEPARATORS[export.separator],
        "decimal": _SIGNS[export.signs.decimal] + how,
        "thousands": _SIGNS[export.signs.thousands],
        "header": "; ".join(dict.fromkeys(_header(table) for table in tables)),
        "specimens": _specimens(tables, chosen[0], specimens),
    }
    for quantity, key in KEYS.items():
        columns = [column for of_table in chosen for column in of_table if column.quantity == quantity]
        if columns:
            found[key] = "; ".join(dict.fromkeys(map(_column, columns)))
    used = {column.index for column in chosen[0]}
    table = tables[0]
    others = [i for i in range(table.width) if i not in used and not table.is_empty(i)]
    if others:
        found["not used"] = ", ".join(_label(table, i) for i in others)
    return found


def preamble_of(export: Export) -> dict[str, str]:
    """The rows beside the tables: first cell and the rest of them. A key that stands twice has its line behind it."""
    found: dict[str, str] = {}
    for line, cells in export.preamble:
        key, *values = [cell for cell in cells if cell]
        if not key.lower().startswith("sep="):
            found[f"{key} (line {line})" if key in found else key] = " ".join(values)
    return found


def _header(table: ExportTable) -> str:
    if not table.has_header:
        return "none"
    has_row = any(table.units)
    names = table.header[: len(table.header) - has_row]
    said = [f"names in line {' and '.join(map(str, names))}"] if names else []
    return ", ".join([*said, *([f"units in line {table.header[-1]}"] if has_row else [])])


def _specimens(tables: Sequence[ExportTable], columns: Sequence[Chosen], count: int) -> str:
    column = next((c for c in columns if c.quantity == "specimen"), None)
    if column is not None:
        return f"{count}, by column {column.index + 1}, {printable(column.label)!r}"
    return "one" if count == 1 else f"{count}, a table each, from lines {', '.join(str(t.lines[0]) for t in tables)}"


def _column(column: Chosen) -> str:
    unit = f"in {column.unit}" if column.unit else "a count"
    assumed = ", a unit that the file does not give" if column.assumed else ""
    return f"column {column.index + 1}, {printable(column.label)!r}, {unit}{assumed}"


def _label(table: ExportTable, index: int) -> str:
    name, unit = split_name(table.names[index], table.units[index])
    return repr(printable(f"{name} ({unit})" if unit else name or f"column {index + 1}"))
