"""The digital twin: a simulated bench that answers as a real one does."""

from __future__ import annotations

import math
from array import array
from typing import Any

import numpy as np

from benchlab.bench import DAC_CODES, Bench, LimitError
from benchlab.devices.interface import Fault, Reading, Status
from benchlab.errors import BenchError
from benchlab.twin.effects.dac_steps import DacSteps
from benchlab.twin.lines import FLEX, MONITOR, REGULATOR, SUPPLY_V
from benchlab.twin.plant import Plant
from benchlab.twin.settings import TwinSettings
from benchlab.twin.truth import COLUMNS, Truth

_IDLE, _ARMED = Status(0), Status.ARMED


class Twin:
    """A simulated bench. Its time is that of the exchanges: it goes as fast as it is asked, and the first exchange finds it at rest.

    A reading is of the moment of its exchange, before the new command has done anything. The same settings and the same
    exchanges give the same readings to the last bit. bench: the calibration by which pressures become codes and volts
    become readings; the twin's own regulator and sensors (benchlab/twin/lines.py) do not depend on it.
    """

    kind = "twin"

    def __init__(self, settings: TwinSettings, bench: Bench) -> None:
        self.settings = settings
        self.bench = bench
        self._plant = Plant(settings)
        self._steps = settings.effect(DacSteps) is not None
        self._armed = False
        self._begun = False
        self._rows = array("d")
        self._triggers: list[float] = []

    @property
    def truth(self) -> Truth:
        """What was really there at each exchange so far."""
        table = np.frombuffer(self._rows, dtype=float).reshape(-1, len(COLUMNS)).copy()
        return Truth(**dict(zip(COLUMNS, table.T)), triggers_s=tuple(self._triggers))

    def about(self) -> dict[str, Any]:
        return {"kind": self.kind, "simulated": True, "ceiling_MPa": self._ceiling_MPa, **self.settings.as_json()}

    def arm(self) -> None:
        self._armed = True

    def exchange(self, time_s: float, pressure_MPa: float, trigger: bool = False) -> Reading:
        code = self._code_of(pressure_MPa)
        plant = self._plant
        if not self._begun:
            self._begun = True
            plant.now.time_s = time_s
        if not time_s >= plant.now.time_s:
            raise BenchError(
                f"time went back from {plant.now.time_s:g} to {time_s:g} s", hint="a run's time only grows"
            )
        plant.advance(time_s)
        if trigger:
            self._triggers.append(time_s)
        reading = self._reading(time_s, pressure_MPa, code)
        self._ask(pressure_MPa, code)
        return reading

    def vent(self) -> None:
        self._ask(0.0, self.bench.code(0.0))
        self._armed = False

    def faults(self) -> list[Fault]:
        return []

    def close(self) -> None:
        self.vent()

    @property
    def _ceiling_MPa(self) -> float:
        return min(self.bench.ceiling_MPa, self.settings.curve.last_MPa)

    def _code_of(self, pressure_MPa: float) -> int:
        """The code for a pressure that may be asked for now."""
        if pressure_MPa > 0 and not self._armed:
            raise BenchError("the twin is vented and not armed", hint="arm it before a pressure is asked for")
        if pressure_MPa > self.settings.curve.last_MPa:
            raise LimitError(
                f"{pressure_MPa:g} MPa is beyond {self.settings.curve.last_MPa:g} MPa, where the twin's response curve ends",
                hint="ask for less, or give a curve that goes further",
            )
        return self.bench.code(pressure_MPa)

    def _ask(self, pressure_MPa: float, code: int) -> None:
        if self._steps:
            volts = SUPPLY_V * code / DAC_CODES
        else:
            volts = self.bench.regulator.inverse(pressure_MPa) * SUPPLY_V / self.bench.supply_V if pressure_MPa else 0.0
        setpoint = max(0.0, REGULATOR.of(volts))
        if setpoint != self._plant.setpoint_MPa:
            self._plant.ask(setpoint)

    def _reading(self, time_s: float, pressure_MPa: float, code: int) -> Reading:
        plant, bench = self._plant, self.bench
        camera_deg = plant.seen("camera", plant.angle_deg)
        monitor_V = plant.seen("monitor_V", MONITOR.inverse(plant.seen("monitor", plant.regulator_MPa)))
        flex_V = plant.seen("flex_V", FLEX.inverse(plant.felt_deg))
        self._rows.extend(
            (
                time_s,
                pressure_MPa,
                plant.setpoint_MPa,
                plant.regulator_MPa,
                plant.pressure_MPa,
                plant.curve_deg,
                plant.angle_deg,
                camera_deg,
            )
        )
        measured = math.nan if bench.monitor is None else bench.monitor.of(monitor_V)
        return Reading(measured, flex_V, code, time_s, _ARMED if self._armed else _IDLE, monitor_V)
