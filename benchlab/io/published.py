"""What the paper published of its actuators' angles, as a table that comes with benchlab."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass
from importlib.resources import as_file, files
from pathlib import Path

from benchlab.actuator import ShellDesign
from benchlab.errors import InputError
from benchlab.io.delimited import Table, open_table
from benchlab.io.numbers import NumberReader

COLUMNS = (
    "tw_mm",
    "slw_mm",
    "pressure_MPa",
    "fem_angle_deg",
    "measured_angle_deg",
    "measured_sd_deg",
    "samples",
)


@dataclass(frozen=True)
class PublishedForce:
    """Blocked force of one design of the paper: mean and standard deviation over `actuators`."""

    tw_mm: float
    slw_mm: float
    pressure_MPa: float
    mean_N: float
    sd_N: float
    actuators: int

    @property
    def design(self) -> ShellDesign:
        """The design with the rib, perimeter and length that all of the paper's have."""
        return ShellDesign(strip_width_mm=self.slw_mm, window_width_mm=self.tw_mm)


BLOCKED_FORCE = PublishedForce(3.0, 10.0, 0.35, 37.72, 1.56, 3)
"""The only blocked force that the paper gives (section III-B), of the ten pressures in its Fig. 3b; linear in pressure, it says."""

_ALWAYS = COLUMNS[:3]


@dataclass(frozen=True)
class PublishedAngle:
    """One design of the paper: bending angle by its finite elements, and mean and standard deviation over `samples`
    actuators measured. None is not published."""

    tw_mm: float
    slw_mm: float
    pressure_MPa: float
    fem_angle_deg: float | None
    measured_angle_deg: float | None
    measured_sd_deg: float | None
    samples: int | None

    @property
    def design(self) -> ShellDesign:
        """The design with the rib, perimeter and length that all of the paper's have."""
        return ShellDesign(strip_width_mm=self.slw_mm, window_width_mm=self.tw_mm)


def published_angles(path: Path | None = None) -> tuple[PublishedAngle, ...]:
    """The published angles in the order of the table; `path` instead of the shipped one: a table of the same columns.

    Raises InputError for other columns, for text where a number should stand, or for a design without its pressure.

    >>> [(p.tw_mm, p.slw_mm) for p in published_angles() if p.measured_angle_deg is not None]
    [(3.0, 5.0), (3.0, 10.0), (3.0, 20.0), (9.0, 10.0), (15.0, 10.0)]
    """
    if path is not None:
        return _read(path)
    with as_file(files("benchlab") / "published" / "paper_angles.csv") as shipped:
        return _read(shipped)


def _read(path: Path) -> tuple[PublishedAngle, ...]:
    with open_table(path) as table:
        if table.header != COLUMNS:
            raise InputError("is not a table of published angles", file=path, hint=f"columns are {', '.join(COLUMNS)}")
        found = tuple(_rows(table))
        if table.warnings:
            raise InputError(table.warnings[0], file=path)
    return found


def _rows(table: Table) -> Iterator[PublishedAngle]:
    reader = NumberReader(table.path, table.delimiter)
    for line, cells in table.rows:
        values = {
            name: None if math.isnan(value := reader.read(cell, line)) else value for name, cell in zip(COLUMNS, cells)
        }
        if reader.unreadable:
            raise InputError(f"not a number: {reader.unreadable[0][1]!r}", file=table.path, where=f"line {line}")
        tw_mm, slw_mm, pressure_MPa = (values.pop(name) for name in _ALWAYS)
        samples = values.pop("samples")
        if tw_mm is None or slw_mm is None or pressure_MPa is None:
            raise InputError(f"one of {', '.join(_ALWAYS)} is empty", file=table.path, where=f"line {line}")
        if samples is not None and not (samples.is_integer() and samples > 0):
            raise InputError(f"samples is {samples:g}, not a count", file=table.path, where=f"line {line}")
        yield PublishedAngle(tw_mm, slw_mm, pressure_MPa, samples=None if samples is None else int(samples), **values)
