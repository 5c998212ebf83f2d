"""Bench files: a bench's calibration as YAML, with the readings that it was fitted to.

name, date, gauge, supply_V, reference_counts, limit_MPa, limit_reason, full_scale_MPa, regulator {gain_MPa_per_V, offset_MPa, sd_MPa},
monitor (the same), flex {gain_deg_per_V, offset_deg, sd_deg, from}, readings [{volts, code, pressure_MPa, monitor_V, rising}]; in place of
gauge and readings `source`, where the regulator's line was never measured on this bench: it then counts as not calibrated.
"""

from __future__ import annotations

import datetime
import math
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from pydantic import Field

from benchlab.bench import DAC_CODES, PAPER_LIMIT_MPA, Bench, Line
from benchlab.errors import InputError
from benchlab.io.gauge_readings import GaugeReading, check_readings
from benchlab.io.yaml_commas import Place
from benchlab.io.yaml_file import Document, read_document_with_lines, write_document

OLDEST_DAYS = 365
"""A calibration that is older is told with every run."""

SIMULATED = "simulated"
"""A gauge with this word in its name is none: the pressures were made by a twin or an emulated bench."""

WORST_SD_MPA = 0.005
"""No calibration is worse: its R² would be below what is refused."""


@dataclass(frozen=True)
class BenchFile:
    """A bench and where its numbers are from. flex_from: the run, or the words, that the flex sensor's line is from."""

    bench: Bench
    readings: tuple[GaugeReading, ...] = ()
    flex_from: str = ""


class _Pressure(Document):
    gain_MPa_per_V: float
    offset_MPa: float
    sd_MPa: float | None = Field(default=None, ge=0, le=WORST_SD_MPA)


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
    code: int | None = Field(default=None, ge=0, lt=DAC_CODES)


class _BenchDocument(Document):
    name: str = Field(min_length=1)
    date: str
    gauge: str | None = Field(default=None, min_length=1)
    source: str | None = Field(default=None, min_length=1)
    supply_V: float
    reference_counts: float | None = None
    limit_MPa: float = Bench("").limit_MPa
    limit_reason: str = ""
    full_scale_MPa: float = Field(default=Bench("").full_scale_MPa, gt=0)
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

    Raises UsageError for a missing file, InputError for numbers that no bench has, a date that is none, readings that are missing or
    that pressure should not rest on (`fit_regulator`), and a line or a supply that is not the one of the readings beside it.
    """
    found, lines = read_document_with_lines(path, _BenchDocument)
    flex = found.flex
    readings = tuple(
        GaugeReading(r.volts, r.pressure_MPa, _or_nan(r.monitor_V), r.rising, r.code) for r in found.readings
    )
    try:
        _check_origin(found)
        bench = Bench(
            name=found.name,
            regulator=_line(found.regulator),
            monitor=None if found.monitor is None else _line(found.monitor),
            flex=None if flex is None else Line(flex.gain_deg_per_V, flex.offset_deg, _or_nan(flex.sd_deg)),
            limit_MPa=found.limit_MPa,
            limit_reason=found.limit_reason,
            full_scale_MPa=found.full_scale_MPa,
            supply_V=found.supply_V,
            reference_counts=found.reference_counts,
            gauge=found.gauge or "",
            date=_date(found.date).isoformat(),
            source=found.source or "",
            calibrated=found.source is None,
        )
        if bench.calibrated:
            check_readings(bench, readings)
    except InputError as error:
        raise InputError(error.what, file=path, where=_place(error, lines), hint=error.hint) from error
    return BenchFile(bench, readings, flex.source if flex else "")


def write_bench_file(path: Path, file: BenchFile, comment: str = "") -> None:
    """Write a bench whole, so that `read_bench_file` gives the same again. InputError where the disk refuses; ValueError for a bench
    without readings and without a source of its line, which could not be read again."""
    bench = file.bench
    if not (bench.source or (bench.calibrated and file.readings)):
        raise ValueError("a bench without readings has no file")
    document: dict[str, Any] = {
        "name": bench.name,
        "date": bench.date,
        **({"source": bench.source} if bench.source else {"gauge": bench.gauge}),
        "supply_V": float(bench.supply_V),
        **({} if bench.reference_counts is None else {"reference_counts": float(bench.reference_counts)}),
        "limit_MPa": float(bench.limit_MPa),
        **({"limit_reason": bench.limit_reason} if bench.limit_reason else {}),
        "full_scale_MPa": float(bench.full_scale_MPa),
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
    warnings = limit_notes(bench)
    if not bench.calibrated:
        why = f"its line is from {bench.source!r}, not measured" if bench.source else "no calibration"
        label = f"; for a regulator of {bench.full_scale_MPa:g} MPa at 5 V and no other"
        return [
            *warnings,
            f"bench {bench.name}: {why}, at most {bench.ceiling_MPa:.3f} MPa{label}; see `benchlab bench calibrate`",
        ]
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


def limit_notes(bench: Bench) -> list[str]:
    """That a limit is above the paper's, and why.

    >>> limit_notes(Bench("a", limit_MPa=0.4, limit_reason="three layers", calibrated=True))
    ["LIMIT 0.4 MPa, above the paper's 0.35 MPa: 'three layers'"]
    """
    if bench.limit_MPa <= PAPER_LIMIT_MPA:
        return []
    return [f"LIMIT {bench.limit_MPa:g} MPa, above the paper's {PAPER_LIMIT_MPA:g} MPa: {bench.limit_reason!r}"]


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
    code = {} if one.code is None else {"code": int(one.code)}
    monitor = {"monitor_V": float(one.monitor_V)} if math.isfinite(one.monitor_V) else {}
    rising = {} if one.rising is None else {"rising": bool(one.rising)}
    return {"volts": float(one.volts), **code, "pressure_MPa": float(one.pressure_MPa), **monitor, **rising}


def _place(error: InputError, lines: dict[Place, int]) -> str | None:
    """The line of the key that the error names first, before what it says of its place itself."""
    told = error.what
    named = [
        (told.find(str(place[0])), line) for place, line in lines.items() if len(place) == 1 and str(place[0]) in told
    ]
    line = f"line {min(named)[1]}" if named else None
    return ", ".join(filter(None, (line, error.where))) or None


def _check_origin(found: _BenchDocument) -> None:
    """Either a gauge and its readings, or the words where the line is from."""
    if found.source is not None:
        if found.gauge is not None or found.readings:
            raise InputError(
                "says both `source` and `gauge` or `readings`", hint="`source` is for a line that was not measured"
            )
        return
    for key, value in (("gauge", found.gauge), ("readings", found.readings)):
        if not value:
            raise InputError(
                f"has no `{key}`: nothing says what its line rests on",
                hint="calibrate it with `benchlab bench calibrate`; a line from elsewhere has `source: where it is from` in place of gauge "
                "and readings, and counts as not calibrated",
            )
