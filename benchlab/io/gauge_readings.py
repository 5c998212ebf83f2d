"""Gauge readings, the lines that they give, and whether a bench is the one of its readings."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from benchlab.bench import DAC_CODES, Bench, Line
from benchlab.control.regulator_line import RegulatorFit, fit_regulator
from benchlab.errors import InputError

FEWEST_MONITOR = 4
"""Readings with monitor volts that its line is fitted to."""

EDITED_MPA = 0.0005
"""The file's line may differ by so much, from 0 to 5 V, from the one that its readings give."""

EDITED_SUPPLY_SHARE = 0.001
"""The supply may differ by so much from what volts and codes of the readings say."""

REMEDY = "was it edited by hand? calibrate again with `benchlab bench calibrate`"


@dataclass(frozen=True)
class GaugeReading:
    """One pressure read off the gauge. volts: at the regulator's input. monitor_V: NaN where it is not wired. rising: whether
    the level was reached from below; None where nobody knows. code: that the DAC held, None where the volts were measured."""

    volts: float
    pressure_MPa: float
    monitor_V: float = math.nan
    rising: bool | None = None
    code: int | None = None


def fitted(readings: Sequence[GaugeReading]) -> tuple[RegulatorFit, RegulatorFit | None]:
    """The regulator's line and the monitor's, None where its volts are fewer than a line needs. InputError as `fit_regulator`."""
    volts, pressure, monitor = (
        np.array([getattr(r, name) for r in readings], dtype=float) for name in ("volts", "pressure_MPa", "monitor_V")
    )
    rising = np.array([bool(r.rising) for r in readings], dtype=bool)
    regulator, wired = fit_regulator(volts, pressure, rising, "regulator"), np.isfinite(monitor)
    if wired.sum() < FEWEST_MONITOR:
        return regulator, None
    return regulator, fit_regulator(monitor[wired], pressure[wired], rising[wired], "monitor")


def check_readings(bench: Bench, readings: tuple[GaugeReading, ...]) -> None:
    """InputError where the bench is not the one that its readings give: the bound is of the readings, whatever the file says of itself."""
    regulator, monitor = fitted(readings)
    _check_line("regulator", bench.regulator, regulator)
    if bench.monitor is not None:
        if monitor is None:
            raise InputError("a `monitor` without monitor_V in its readings", where="monitor", hint=REMEDY)
        _check_line("monitor", bench.monitor, monitor)
    for number, one in enumerate(readings, 1):
        if (
            one.code is not None
            and abs(one.volts - bench.volts(one.code)) > EDITED_SUPPLY_SHARE * bench.volts(one.code) + 2e-6
        ):
            raise InputError(
                f"supply_V is {bench.supply_V:g}, and reading {number} has code {one.code} at {one.volts:g} V: "
                f"{one.volts * DAC_CODES / max(one.code, 1):.3f} V of supply",
                where="supply_V",
                hint=REMEDY,
            )


def _check_line(what: str, line: Line, fit: RegulatorFit) -> None:
    volts = np.array([0.0, 5.0])
    off = float(np.abs(fit.line.of(volts) - [line.of(v) for v in volts]).max())
    if off > EDITED_MPA:
        raise InputError(
            f"the {what}'s line lies {off:.4f} MPa off that of the readings in this file, more than {EDITED_MPA:.4f} MPa",
            where=what,
            hint=REMEDY,
        )
