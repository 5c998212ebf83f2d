"""All effects and faults by name, in the order in which a value passes them."""

from __future__ import annotations

from benchlab.twin.effects.camera_scale import CameraScale
from benchlab.twin.effects.clock_offset import ClockOffset
from benchlab.twin.effects.dac_steps import DacSteps
from benchlab.twin.effects.dead_pressure import DeadPressure
from benchlab.twin.effects.effect import Effect
from benchlab.twin.effects.end_caps import EndCaps
from benchlab.twin.effects.faults import Burst, SensorOutOfRange, StuckSensor, SupplyShut, TubeOff
from benchlab.twin.effects.flex_hysteresis import FlexHysteresis
from benchlab.twin.effects.friction import Friction
from benchlab.twin.effects.gravity import Gravity
from benchlab.twin.effects.leakage import Leakage
from benchlab.twin.effects.line_resistance import LineResistance
from benchlab.twin.effects.marker_offset import MarkerOffset
from benchlab.twin.effects.pressure_gain import PressureGain
from benchlab.twin.effects.pressure_offset import PressureOffset
from benchlab.twin.effects.regulator_lag import RegulatorLag
from benchlab.twin.effects.sensor_noise import SensorNoise
from benchlab.twin.effects.softening import Softening
from benchlab.twin.effects.temperature import Temperature
from benchlab.twin.effects.viscoelasticity import Viscoelasticity

EFFECTS: dict[str, type[Effect]] = {
    each.name: each
    for each in (
        *(DacSteps, RegulatorLag),
        *(LineResistance, SupplyShut, Leakage, Burst, TubeOff),
        DeadPressure,
        *(Viscoelasticity, Friction, Softening, Temperature, EndCaps, Gravity),
        *(PressureGain, PressureOffset),
        *(FlexHysteresis, SensorNoise, StuckSensor, SensorOutOfRange),
        *(MarkerOffset, CameraScale, ClockOffset),
    )
}
"""Physics, imperfections and faults, by their names in the vocabulary of discrepancies where they have one."""

FAULTS = ("burst", "tube_off", "supply_shut", "stuck_sensor", "sensor_out_of_range")
"""Those that break something at a time of the run."""

DEFAULT = ("dac_steps", "regulator_lag", "line_resistance", "viscoelasticity", "friction", "sensor_noise")
"""Effects that are on in the twin that comes with benchlab."""
