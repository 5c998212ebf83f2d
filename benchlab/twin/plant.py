"""The simulated bench between two exchanges: from the pressure asked for to the true bending angle."""

from __future__ import annotations

from benchlab.cubic import Cubic
from benchlab.twin.effects.catalogue import EFFECTS
from benchlab.twin.effects.effect import PLACES, Kit, Now, Stage
from benchlab.twin.settings import TwinSettings

LONGEST_STEP_S = 0.005
"""Of the integration; a tick at 100 Hz is two of them."""

GROWTH = 0.02
"""While nothing new is asked for, steps grow to this share of the time since: transients have died by then."""


class Plant:
    """State of the simulated bench. Begins at rest, vented, at the time of the first advance.

    regulator_MPa: that the regulator gives. pressure_MPa: inside. curve_deg: of the response curve at that pressure, at rest.
    angle_deg: the true bending angle. felt_deg: by the flex sensor.
    """

    def __init__(self, settings: TwinSettings) -> None:
        kit = Kit(settings.curve, settings.length_mm, settings.seed)
        self.places: dict[str, list[Stage]] = {place: [] for place in PLACES}
        for name in EFFECTS:
            if name in settings.effects:
                for place, stage in settings.effects[name].stages(kit).items():
                    self.places[place].append(stage)
        self.now = Now()
        self._angle = Cubic(settings.curve.pressure_MPa, settings.curve.angle_deg)
        self.setpoint_MPa = self.regulator_MPa = self.pressure_MPa = 0.0
        self.curve_deg = self.angle_deg = self.felt_deg = self._angle.value(0.0)
        self.ask(0.0)

    def ask(self, setpoint_MPa: float) -> None:
        """From now on this pressure is asked for."""
        self.setpoint_MPa = setpoint_MPa
        self._step(0.0)  # stages see the new value at the start of a step, so that a jump is no ramp

    def advance(self, time_s: float) -> None:
        """Let time go on to time_s."""
        start = self.now.time_s
        while (left := time_s - self.now.time_s) > 0:
            longest = max(LONGEST_STEP_S, GROWTH * (self.now.time_s - start))
            if left <= longest * 1.0001:
                self._step(left)
                self.now.time_s = time_s
            else:
                self._step(min(longest, left / 2) if left < 2 * longest else longest)

    def seen(self, place: str, value: float) -> float:
        """A value through the stages of a place that are passed once an exchange, not once a step."""
        for stage in self.places[place]:
            value = stage(value, self.now)
        return value

    def _step(self, dt_s: float) -> None:
        now, places = self.now, self.places
        now.dt_s = dt_s
        now.time_s += dt_s
        now.since_s += dt_s
        pressure = self.setpoint_MPa
        for stage in places["supply"]:
            pressure = stage(pressure, now)
        self.regulator_MPa = pressure
        for stage in places["line"]:
            pressure = stage(pressure, now)
        self.pressure_MPa = now.pressure_MPa = pressure
        for stage in places["bend"]:
            pressure = stage(pressure, now)
        self.curve_deg = angle = self._angle.value(pressure)
        for stage in places["angle"]:
            angle = stage(angle, now)
        self.angle_deg = angle
        for stage in places["flex"]:
            angle = stage(angle, now)
        self.felt_deg = angle
