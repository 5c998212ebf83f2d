"""Bench files: a bench's calibration as YAML, with the readings that it was fitted to.

name, date, gauge, supply_V, reference_counts, limit_MPa, regulator {gain_MPa_per_V, offset_MPa, sd_MPa}, monitor (the same),
flex {gain_deg_per_V, offset_deg, sd_deg, from}, readings [{volts, pressure_MPa, monitor_V, rising}].
"""

from __future__ import annotations

import datetime
import math
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from pydantic import Field

from benchlab.bench import Bench, Line
from benchlab.errors import InputError
from benchlab.io.yaml_file import Document, read_document, write_document

OLDEST_DAYS = 365
"""A calibration that is older is told with every run."""

SIMULATED = "simulated"
"""A gauge with this word in its name is none: the pressures were made by a twin or an emulated bench."""

_EDITED_SDS, _EDITED_MPA = 3.0, 0.0005
"""Readings may lie off the file's line by this many of its sd, root mean square, and by this much more."""


@dataclass(frozen=True)
class GaugeReading:
    """One pressure read off the gauge. volts: at the regulator's input. monitor_V: NaN where it is not wired. rising: whether
    the level was reached from below; None where nobody knows."""

    volts: float
    pressure_MPa: float
    monitor_V: float = math.nan
    rising: bool | None = None


@dataclass(frozen=True)
class BenchFile:
    """A bench and where its numbers are from. flex_from: the run, or the words, that the flex sensor's line is from."""

    bench: Bench
    readings: tuple[GaugeReading, ...] = ()
    flex_from: str = ""


class _Pressure(Document):
    gain_MPa_per_V: float
    offset_MPa: float
    sd_MPa: float | None = Field(default=None, ge=0)


class _Flex(Document):
    gain_deg_per_V: float
    offset_deg: float
    sd_deg: float | None = Field(default=None, ge=0)
    source: str = Field(alias="from", min_length=1)


class _Reading(Document):
    volts: float = Field(ge=0, le=5.5)
    pressure_MPa: float
    monitor_V: float | None = None
    rising: bool | None = None


class _BenchDocument(Document):
    name: str = Field(min_length=1)
    date: str
    gauge: str = Field(min_length=1)
    supply_V: float
    reference_counts: float | None = None
    limit_MPa: float = Bench("").limit_MPa
    regulator: _Pressure
    monitor: _Pressure | None = None
    flex: _Flex | None = None
    readings: tuple[_Reading, ...] = ()


def read_bench(path: Path | None) -> Bench:
    """The bench in a file; None is a bench that nobody calibrated, with the paper's regulator and less than its limit.

    Raises UsageError and InputError as `read_bench_file`.

    >>> read_bench(None).calibrated
    False
    """
    return Bench("not calibrated") if path is None else read_bench_file(path).bench


def read_bench_file(path: Path) -> BenchFile:
    """The bench in a file, with its readings.

    Raises UsageError for a missing file, InputError for numbers that no bench has, a date that is none, and a regulator's or
    monitor's line that does not go through the readings beside it.
    """
    found = read_document(path, _BenchDocument)
    flex = found.flex
    try:
        bench = Bench(
            name=found.name,
            regulator=_line(found.regulator),
            monitor=None if found.monitor is None else _line(found.monitor),
            flex=None if flex is None else Line(flex.gain_deg_per_V, flex.offset_deg, _or_nan(flex.sd_deg)),
            limit_MPa=found.limit_MPa,
            supply_V=found.supply_V,
            reference_counts=found.reference_counts,
            gauge=found.gauge,
            date=_date(found.date).isoformat(),
            calibrated=True,
        )
    except InputError as error:
        raise InputError(error.what, file=path, where=error.where, hint=error.hint) from error
    readings = tuple(GaugeReading(r.volts, r.pressure_MPa, _or_nan(r.monitor_V), r.rising) for r in found.readings)
    _check_line(path, "regulator", bench.regulator, [(r.volts, r.pressure_MPa) for r in readings])
    if bench.monitor is not None:
        watched = [(r.monitor_V, r.pressure_MPa) for r in readings if math.isfinite(r.monitor_V)]
        _check_line(path, "monitor", bench.monitor, watched)
    return BenchFile(bench, readings, flex.source if flex else "")


def write_bench(path: Path, bench: Bench) -> None:
    """Write a calibrated bench without readings. ValueError for one that is not calibrated; else as `write_bench_file`."""
    write_bench_file(path, BenchFile(bench, flex_from="not told" if bench.flex else ""))


def write_bench_file(path: Path, file: BenchFile, comment: str = "") -> None:
    """Write a bench whole, so that `read_bench_file` gives the same again. InputError where the disk refuses."""
    bench = file.bench
    if not bench.calibrated:
        raise ValueError("a bench without a calibration has no file")
    document: dict[str, Any] = {
        "name": bench.name,
        "date": bench.date,
        "gauge": bench.gauge,
        "supply_V": float(bench.supply_V),
        **({} if bench.reference_counts is None else {"reference_counts": float(bench.reference_counts)}),
        "limit_MPa": float(bench.limit_MPa),
        "regulator": _pressure(bench.regulator),
    }
    if bench.monitor is not None:
        document["monitor"] = _pressure(bench.monitor)
    if bench.flex is not None:
        document["flex"] = {
            "gain_deg_per_V": float(bench.flex.gain),
            "offset_deg": float(bench.flex.offset),
            **({"sd_deg": float(bench.flex.sd)} if math.isfinite(bench.flex.sd) else {}),
            "from": file.flex_from,
        }
    if file.readings:
        document["readings"] = [_reading(one) for one in file.readings]
    write_document(path, document, comment)


def calibration_warnings(bench: Bench, today: datetime.date) -> list[str]:
    """What whoever runs on this calibration must be told.

    >>> calibration_warnings(Bench("a", date="2024-05-01", gauge="Keller LEO 2", calibrated=True), datetime.date(2026, 5, 1))
    ['bench a was calibrated 730 days ago, on 2024-05-01; calibrate it at least once a year']
    """
    if not bench.calibrated:
        return [
            f"bench {bench.name}: no calibration, at most {bench.ceiling_MPa:.3f} MPa; see `benchlab bench calibrate`"
        ]
    warnings = []
    age = (today - _date(bench.date)).days if bench.date else None
    if age is None:
        warnings.append(f"bench {bench.name} does not say when it was calibrated")
    elif age < 0:
        warnings.append(f"bench {bench.name} was calibrated in the future, on {bench.date}; check the computer's clock")
    elif age > OLDEST_DAYS:
        warnings.append(
            f"bench {bench.name} was calibrated {age} days ago, on {bench.date}; calibrate it at least once a year"
        )
    return warnings


def is_simulated(bench: Bench) -> bool:
    """Whether the calibration was made on a twin: no gauge ever saw these pressures.

    >>> is_simulated(Bench("a", gauge="simulated gauge of the twin"))
    True
    """
    return SIMULATED in bench.gauge.lower()


def _date(text: str) -> datetime.date:
    try:
        return datetime.date.fromisoformat(text)
    except ValueError:
        raise InputError(f"date is {text!r}", hint="write it as '2026-05-31', year first, in quotes") from None


def _line(part: _Pressure) -> Line:
    return Line(part.gain_MPa_per_V, part.offset_MPa, _or_nan(part.sd_MPa))


def _or_nan(value: float | None) -> float:
    return math.nan if value is None else value


def _pressure(line: Line) -> dict[str, float]:
    sd = {"sd_MPa": float(line.sd)} if math.isfinite(line.sd) else {}
    return {"gain_MPa_per_V": float(line.gain), "offset_MPa": float(line.offset), **sd}


def _reading(one: GaugeReading) -> dict[str, Any]:
    monitor = {"monitor_V": float(one.monitor_V)} if math.isfinite(one.monitor_V) else {}
    rising = {} if one.rising is None else {"rising": bool(one.rising)}
    return {"volts": float(one.volts), "pressure_MPa": float(one.pressure_MPa), **monitor, **rising}


def _check_line(path: Path, what: str, line: Line, readings: list[tuple[float, float]]) -> None:
    """readings: volts and pressure, which the line should go through."""
    if not readings:
        return
    off = math.sqrt(sum((line.of(volts) - pressure) ** 2 for volts, pressure in readings) / len(readings))
    most = _EDITED_SDS * (0.0 if math.isnan(line.sd) else line.sd) + _EDITED_MPA
    if off > most:
        raise InputError(
            f"the {what}'s line lies {off:.4f} MPa off the readings in this file, more than {most:.4f} MPa",
            file=path,
            where=what,
            hint="was it edited by hand? calibrate again, or take the readings out",
        )
