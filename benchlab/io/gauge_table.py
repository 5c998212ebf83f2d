"""Gauge readings as a table: volts at the regulator's input, the pressure that the gauge showed, and volts of the monitor."""

from __future__ import annotations

import math
from pathlib import Path

from benchlab.errors import InputError
from benchlab.io.delimited import Table, open_table
from benchlab.io.gauge_readings import GaugeReading
from benchlab.io.numbers import NumberReader
from benchlab.units import parse_column, to_MPa

_VOLTS = {"volts", "volts_v", "volts [v]", "volts (v)", "voltage_v", "voltage (v)", "voltage [v]", "spannung [v]"}
_MONITOR = {"monitor_v", "monitor (v)", "monitor [v]"}

COLUMNS = "`volts`, `pressure_kPa` (or MPa, bar, psi) and, where it is wired, `monitor_V`"


def read_gauge_table(path: Path) -> tuple[GaugeReading, ...]:
    """The readings in the order in which they were taken; rising where the volts are above those of the row before.

    Raises UsageError and InputError with the line: a column missing, unknown or twice, a pressure without its unit, an empty cell
    of volts or pressure, a number that is none.
    """
    with open_table(path) as table:
        volts, pressure, monitor, unit = _columns(table)
        reader = NumberReader(path, table.delimiter)
        readings: list[GaugeReading] = []
        for line, cells in table.rows:
            x, y = reader.read(cells[volts], line), reader.read(cells[pressure], line)
            z = math.nan if monitor is None else reader.read(cells[monitor], line)
            if reader.unreadable:
                raise InputError(f"not a number: {reader.unreadable[0][1]!r}", file=path, where=f"line {line}")
            if math.isnan(x) or math.isnan(y):
                raise InputError("volts or pressure is empty", file=path, where=f"line {line}", hint="take the row out")
            if not 0 <= x <= 5.5:
                raise InputError(f"{x:g} V", file=path, where=f"line {line}", hint="volts go from 0 to 5.5")
            readings.append(GaugeReading(x, float(to_MPa(y, unit)), z, not readings or x > readings[-1].volts))
        if table.warnings:
            raise InputError(table.warnings[0], file=path, hint="was the copy finished?")
    return tuple(readings)


def _columns(table: Table) -> tuple[int, int, int | None, str]:
    """Index of volts, of pressure and of the monitor, and the pressure's unit."""
    found: dict[str, int] = {}
    unit = ""
    for index, header in enumerate(table.header):
        name, written = parse_column(header)
        if header.lower() in _VOLTS:
            kind = "volts"
        elif header.lower() in _MONITOR:
            kind = "monitor"
        elif name.lower() in ("pressure", "p", "gauge", "druck", ""):
            kind, unit = "pressure", written or ""
        else:
            raise _refused(table, f"column {header!r} is unknown", f"the columns are {COLUMNS}")
        if kind in found:
            raise _refused(table, f"two columns of {kind}", "take one out")
        found[kind] = index
    missing = [kind for kind in ("volts", "pressure") if kind not in found]
    if missing:
        raise _refused(table, f"no column of {' and '.join(missing)}", f"the columns are {COLUMNS}")
    if not unit:
        raise _refused(table, "the pressure has no unit", "name the column pressure_kPa, pressure_MPa, ...")
    return found["volts"], found["pressure"], found.get("monitor"), unit


def _refused(table: Table, what: str, hint: str) -> InputError:
    return InputError(what, file=table.path, where=f"line {table.header_line}", hint=hint)
