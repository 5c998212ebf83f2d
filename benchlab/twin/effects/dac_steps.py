"""dac_steps: the pressure asked for is rounded down to a step of the 12-bit DAC.

    u = S·⌊4096·V(p)/S⌋/4096

S: supply of the microcontroller, 5 V. V(p): volts for the pressure p, by the bench's calibration; the code is the one that the bench
computes, so that it is the true one. At 0.096 MPa/V a step is 5/4096·0.096 MPa = 0.117 kPa. It has no parameter.
Source: MCP4725 datasheet, section 3.1 (output = supply · code / 4096).
"""

from __future__ import annotations

from dataclasses import dataclass

from benchlab.twin.effects.effect import Effect


@dataclass(frozen=True)
class DacSteps(Effect):
    """Asked for by name where a command becomes volts (devices/twin)."""

    name = "dac_steps"
