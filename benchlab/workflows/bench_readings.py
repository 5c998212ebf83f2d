"""The levels of a calibration, up and down, and the gauge readings at them. Nothing goes up that is foreseen to cross the limit."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from benchlab.bench import DAC_CODES, LABEL_SHARE, Bench
from benchlab.devices.interface import Device
from benchlab.errors import BenchError
from benchlab.io.gauge_readings import GaugeReading
from benchlab.workflows.bench_hold import Hold

UNLIKE_MPA = 0.005
"""The second reading may differ from the label by this much more than the label's share: a gauge of 1 MPa and class 0.5."""


@dataclass(frozen=True)
class Level:
    """A pressure to be read off the gauge. asked_MPa: by the nominal regulator, not by the gauge. number: of `of`, from 1."""

    number: int
    of: int
    asked_MPa: float
    volts: float
    monitor_V: float
    rising: bool


Gauge = Callable[[Level], float | None]
"""Asks for the gauge's pressure in MPa while a level is held. None: the reading before was a mistake, go back to its level."""


def levels_MPa(top_MPa: float, points: int) -> list[float]:
    """Pressures to ask for: equal steps up to the top, and the same down again without the top.

    >>> [round(level, 3) for level in levels_MPa(0.3, 3)]
    [0.1, 0.2, 0.3, 0.2, 0.1]
    """
    up = [top_MPa * (i + 1) / points for i in range(points)]
    return up + up[-2::-1]


def take_readings(
    hold: Hold,
    levels: Sequence[float],
    bench: Bench,
    supply_V: float,
    gauge: Gauge,
    settle_s: float,
    tell: Callable[[str], None],
) -> list[GaugeReading]:
    """Stand at each level and ask for the gauge's reading. bench: that the device was opened with. supply_V: as measured, which the DAC's
    codes and the ADC's steps are parts of.

    A level above the last is left out, with all above it, where the readings so far foresee more than the limit there. Raises
    BenchError, after which the bench is vented, for a reading above the limit, and at the second for readings that the regulator's label,
    which bench.regulator is, does not explain: in another unit than was said, as a rule.
    A level that is read again on the way up is reached from above, and its reading says so.
    """
    readings: list[GaugeReading] = []
    highest, stands_at = math.inf, 0.0
    read_at: list[int] = []  # index of the level of each reading
    index = -1
    while (index := index + 1) < len(levels):
        asked = levels[index]
        rising = asked > stands_at
        if asked >= highest or (rising and _too_high(readings, levels, index, bench.limit_MPa)):
            if highest == math.inf:
                tell(
                    f"not going up to {asked:.3f} MPa: the gauge's readings foresee more than {bench.limit_MPa:g} MPa there"
                )
            highest = min(highest, asked)
            continue
        if asked == stands_at:
            continue
        recent, stands_at = hold.stand(asked, settle_s), asked
        code = max([r.code for r in recent if r.code >= 0][-3:], default=-1)
        if code < 0:
            raise BenchError("the bench does not say which code its DAC holds; vented", hint="flash the firmware again")
        volts = supply_V * code / DAC_CODES
        monitor = _mean([r.monitor_V for r in recent]) * supply_V / bench.supply_V
        pressure = gauge(Level(index + 1, len(levels), asked, volts, monitor, rising))
        hold.check()
        if pressure is None:
            readings.pop()
            index = read_at.pop() - 1
            continue
        if pressure > bench.limit_MPa:
            raise BenchError(
                f"the gauge shows {pressure:.4g} MPa at {volts:.3f} V, above the limit of {bench.limit_MPa:g} MPa; vented",
                hint="is it the unit? else give --max-MPa less, or find out what regulator this is",
            )
        readings.append(GaugeReading(round(volts, 6), round(pressure, 7), round(monitor, 6), rising, code))
        read_at.append(index)
        if len(readings) == 2:
            _check_label(readings[-1], bench)
    return readings


def foreseen_MPa(readings: Sequence[GaugeReading], volts: float) -> float:
    """The pressure at these volts as the last rising readings have it: the steeper of the line through the last two and the one from 0.

    >>> foreseen_MPa([GaugeReading(0.5, 0.05), GaugeReading(1.0, 0.15)], 1.5)
    0.25
    """
    last = readings[-1]
    steepest = last.pressure_MPa / last.volts if last.volts > 0 else 0.0
    if len(readings) > 1 and last.volts > readings[-2].volts:
        steepest = max(steepest, (last.pressure_MPa - readings[-2].pressure_MPa) / (last.volts - readings[-2].volts))
    return last.pressure_MPa + steepest * (volts - last.volts)


def _too_high(readings: Sequence[GaugeReading], levels: Sequence[float], index: int, limit_MPa: float) -> bool:
    if not readings:
        return False
    # Volts go as the nominal pressures do.
    volts = readings[-1].volts * levels[index] / levels[index - 1]
    return foreseen_MPa(readings, volts) > limit_MPa


def _check_label(reading: GaugeReading, bench: Bench) -> None:
    by_label = bench.regulator.of(reading.volts)
    if abs(reading.pressure_MPa - by_label) > LABEL_SHARE * by_label + UNLIKE_MPA:
        raise BenchError(
            f"the gauge shows {reading.pressure_MPa:.4g} MPa at {reading.volts:.3f} V, and the regulator's label "
            f"({bench.full_scale_MPa:g} MPa at 5 V) {by_label:.4g}; vented before it went higher",
            hint="is it the unit of the gauge? else say with --full-scale-MPa what the label says, or look for a leak",
        )


def _mean(values: list[float]) -> float:
    known = [value for value in values if math.isfinite(value)]
    return float(np.mean(known)) if known else math.nan


def twin_gauge(device: Device) -> Gauge:
    """The simulated gauge of a twin: what is truly at its regulator, without an error of its own. TypeError for other devices."""
    from benchlab.devices.twin.twin import Twin

    if not isinstance(device, Twin):
        raise TypeError("only a twin knows its truth")
    return lambda level: float(device.truth.regulator_MPa[-1])
