"""line_resistance: air must flow through the tube to fill the actuator, which takes up volume as it inflates.

    R·C(p)·dp/dt = p_reg − p          C(p) = dV/dp + g·V/(p + p_atm)

R `resistance_MPa_s_per_mL`: chosen 0.002, as the laminar flow of air through a bore of 0.8 mm and 1 m length has (Hagen–Poiseuille,
8·µ·L/(π·r⁴) with µ = 18 µPa·s: 0.0018); wide tubes have a hundredth of it. V(p), dV/dp: volume of the response curve and its slope,
so that the lag R·dV/dp depends on design and pressure (tw 3, slw 10: 32 ms at 0 MPa, 18 ms at 0.35 MPa). g `gas_share`: 0 leaves out
what it takes to compress the air that is in there already, 1 has it (ideal gas, isothermal, p_atm = 0.1013 MPa); it is the larger part
at all pressures, and no property of the design but its size. Default 0, so that the effect is what its name says in the list of
discrepancies: a lag in proportion to dV/dp.

Per step the time constant is that of the middle of the step, found from a step with the one at its start; the rest is exact for an
input that goes straight. Unconditionally stable, of second order.
"""

from __future__ import annotations

from dataclasses import dataclass

from benchlab.cubic import Cubic
from benchlab.twin.effects.effect import Effect, Kit, Now, Stage, follow, number

ATMOSPHERE_MPa = 0.1013


@dataclass(frozen=True)
class LineResistance(Effect):
    """Flow in proportion to the pressure difference, into a volume that the pressure makes."""

    name = "line_resistance"
    resistance_MPa_s_per_mL: float = number(0.002, "MPa·s/mL", 0, 1, "resistance R of tube and fittings")
    gas_share: float = number(0, "", 0, 1, "share g of the air's own compression that is taken into account")

    def stages(self, kit: Kit) -> dict[str, Stage]:
        return {"line": _Line(self, Cubic(kit.curve.pressure_MPa, kit.curve.volume_mL))}


class _Line:
    def __init__(self, effect: LineResistance, volume_mL: Cubic) -> None:
        self.resistance, self.gas = effect.resistance_MPa_s_per_mL, effect.gas_share
        self.volume = volume_mL
        self.supplied = self.pressure = 0.0

    def __call__(self, value: float, now: Now) -> float:
        start, before, dt = self.pressure, self.supplied, now.dt_s
        if dt > 0:
            end = follow(start, before, value, dt, self._time_constant_s(start))
            self.pressure = follow(start, before, value, dt, self._time_constant_s((start + end) / 2))
        self.supplied = value
        return self.pressure

    def _time_constant_s(self, pressure_MPa: float) -> float:
        compliance = self.volume.slope(pressure_MPa)
        if self.gas:
            compliance += self.gas * self.volume.value(pressure_MPa) / (pressure_MPa + ATMOSPHERE_MPa)
        return self.resistance * compliance
