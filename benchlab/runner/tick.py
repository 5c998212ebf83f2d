"""What is known of one tick once it was answered: what guards and the screen look at."""

from __future__ import annotations

from dataclasses import dataclass

from benchlab.devices.interface import Reading


@dataclass(slots=True)
class Tick:
    """index: of the plan. time_s: of the command, of the run. late_s: after its deadline. angle_deg: NaN where the flex sensor is not
    calibrated. faults: that the device told of since the tick before; fault: the cause of the last. held: in a pause, in which the
    plan stands still, or after the vent at its end."""

    index: int
    time_s: float
    late_s: float
    command_MPa: float
    reading: Reading
    status: int
    angle_deg: float = float("nan")
    reference_deg: float = float("nan")
    faults: int = 0
    fault: str = ""
    held: bool = False
