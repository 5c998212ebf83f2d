"""PI control of the bending angle in pressure, kept within its limits without winding up (paper, Eqs 4 and 5)."""

from __future__ import annotations

import math

from benchlab.errors import BenchError, InputError

MISSING_S = 0.1
"""How long the last pressure is kept where no angle is measured; longer ends the run."""


class PI:
    """u = kp·e + ki·∫e dt with e = reference − measured, u held between 0 and the ceiling.

    kp in MPa per degree, ki in MPa per degree and second. The integral is by trapezoids, which is exact for errors that are linear
    between samples, whatever the time between them. Anti-windup is by conditional integration: of a step of the integral only so much is
    taken as does not drive u beyond a limit (Åström and Hägglund, Advanced PID Control, 2006, section 3.5); why this and
    not back-calculation stands in docs/decisions/0019. It starts without a bump: the first pressure is the one it is started at.

    limited: calls so far whose pressure, or step of the integral, was cut at a limit. Raises InputError for impossible gains.

    >>> pi = PI(0.001, 0.01, ceiling_MPa=0.35)
    >>> pi.start(0.1)
    >>> [round(pi.pressure_MPa(10.0, 10.0, 0.0, 0.01), 4) for _ in range(3)]
    [0.1, 0.101, 0.102]
    """

    def __init__(
        self,
        kp_MPa_per_deg: float,
        ki_MPa_per_deg_s: float,
        ceiling_MPa: float,
        lead_s: float = 0.0,
        missing_s: float = MISSING_S,
    ) -> None:
        for name, value in (("kp_MPa_per_deg", kp_MPa_per_deg), ("ki_MPa_per_deg_s", ki_MPa_per_deg_s)):
            if not (math.isfinite(value) and value >= 0):
                raise InputError(f"{name} is {value:g}", hint="give a gain of 0 or more: pressure bends the actuator")
        if not 0 < ceiling_MPa < math.inf:
            raise InputError(f"the ceiling is {ceiling_MPa:g} MPa", hint="give a pressure above 0")
        self.kp, self.ki, self.ceiling_MPa = kp_MPa_per_deg, ki_MPa_per_deg_s, ceiling_MPa
        self.lead_s, self.missing_s = lead_s, missing_s
        self.start(0.0)

    def start(self, pressure_MPa: float) -> None:
        """Begin at this pressure, without a bump. Everything before is forgotten."""
        self.limited = 0
        self._given = min(max(pressure_MPa, 0.0), self.ceiling_MPa)
        self._integral = math.nan
        self._error = math.nan
        self._without_s = 0.0

    def pressure_MPa(self, reference_deg: float, ahead_deg: float, angle_deg: float, dt_s: float) -> float:
        """The pressure to ask for now, dt_s after the call before. ahead_deg is not used by a PI.

        Raises BenchError where no angle has been measured for longer than missing_s, ValueError without a reference.
        """
        return self.around(0.0, reference_deg, angle_deg, dt_s)

    def around(self, base_MPa: float, reference_deg: float, angle_deg: float, dt_s: float) -> float:
        """As `pressure_MPa`, as a correction of a pressure that is known beforehand."""
        if not math.isfinite(reference_deg):
            raise ValueError(f"the reference angle is {reference_deg}: a plan has one for each closed-loop tick")
        if not math.isfinite(angle_deg):
            return self._blind(dt_s)
        self._without_s = 0.0
        error = reference_deg - angle_deg
        cut = False
        if math.isnan(self._integral):
            self._integral = self._given - base_MPa - self.kp * error
        else:
            cut = self._integrate(base_MPa + self.kp * error, error, dt_s)
        self._error = error
        wanted = base_MPa + self.kp * error + self._integral
        self._given = min(max(wanted, 0.0), self.ceiling_MPa)
        self.limited += cut or wanted != self._given
        return self._given

    def _integrate(self, rest_MPa: float, error: float, dt_s: float) -> bool:
        """Take a step of the integral, or what the limits leave of it; whether they cut it. rest_MPa: of the pressure without it."""
        before = error if math.isnan(self._error) else self._error
        step = self.ki * dt_s * (before + error) / 2
        wanted = rest_MPa + self._integral
        taken = min(step, max(self.ceiling_MPa - wanted, 0.0)) if step > 0 else max(step, min(-wanted, 0.0))
        self._integral += taken
        return taken != step

    def _blind(self, dt_s: float) -> float:
        """The last pressure again; the integral stands still, and the time without an angle is no time of any error."""
        self._without_s += dt_s
        self._error = math.nan
        if self._without_s > self.missing_s + 1e-9:
            raise BenchError(
                f"no bending angle measured for {self._without_s:.2f} s; {self.missing_s:g} s are allowed",
                hint="look at the flex sensor and its calibration",
            )
        return self._given
