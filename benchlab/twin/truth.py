"""What was really there while a twin was driven."""

from __future__ import annotations

from dataclasses import dataclass, fields

from benchlab.units import FloatArray


@dataclass(frozen=True)
class Truth:
    """(T,) each, one value an exchange, as things stood just before its command was carried out.

    time_s: of the exchange. command_MPa: asked for by it. setpoint_MPa: what was asked of the regulator until then, in steps of the
    DAC. regulator_MPa: that the regulator gave. pressure_MPa: inside the actuator. curve_deg: of the response curve at that
    pressure, at rest. angle_deg: true bending angle. camera_deg: of the arc that the markers form. triggers_s: when the camera was.
    """

    time_s: FloatArray
    command_MPa: FloatArray
    setpoint_MPa: FloatArray
    regulator_MPa: FloatArray
    pressure_MPa: FloatArray
    curve_deg: FloatArray
    angle_deg: FloatArray
    camera_deg: FloatArray
    triggers_s: tuple[float, ...] = ()


COLUMNS = tuple(field.name for field in fields(Truth) if field.name != "triggers_s")
"""Names of the columns, in order."""
