"""All effects and faults by name, in the order in which a value passes them."""

from __future__ import annotations

from benchlab.twin.effects.dac_steps import DacSteps
from benchlab.twin.effects.effect import Effect
from benchlab.twin.effects.regulator_lag import RegulatorLag
from benchlab.twin.effects.sensor_noise import SensorNoise

EFFECTS: dict[str, type[Effect]] = {each.name: each for each in (DacSteps, RegulatorLag, SensorNoise)}
"""Physics and imperfections, by their names in the vocabulary of discrepancies where they have one."""

DEFAULT = ("dac_steps", "regulator_lag", "line_resistance", "viscoelasticity", "friction", "sensor_noise")
"""Effects that are on in the twin that comes with benchlab."""
