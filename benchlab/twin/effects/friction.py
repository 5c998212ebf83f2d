"""friction: the bladder rubs on the shell, so that the angle stays behind whichever way it goes, at any rate.

    θ = (1/3)·Σ_j P_j(u)          P_j: backlash (play) of half width r_j(p) = h(p)·j/2, j = 1, 2, 3          h(p) = h0 + h1·p

A Prandtl–Ishlinskii operator of three plays (Kuhnen 2003; Visintin, Differential Models of Hysteresis, 1994). Going up steadily, the
angle lies h(p) below u, going down h(p) above: the loop is 2·h(p) wide, and grows with the pressure that presses bladder and shell
together (Coulomb). After a turn the angle follows in three parts, the first after h(p), the last after 3·h(p). No rate, no time: exact.
h0 `half_width_deg`: chosen 0.1°. h1 `half_width_deg_per_MPa`: chosen 4 °/MPa, 1.5° at 0.35 MPa. Neither was measured.
"""

from __future__ import annotations

from dataclasses import dataclass

from benchlab.twin.effects.effect import Effect, Kit, Now, Stage, number, play


@dataclass(frozen=True)
class Friction(Effect):
    """A loop that does not depend on the rate and grows with pressure."""

    name = "friction"
    half_width_deg: float = number(0.1, "deg", 0, 20, "half the width of the loop at 0 MPa, h0")
    half_width_deg_per_MPa: float = number(4, "deg/MPa", 0, 100, "growth of it with pressure, h1")

    def stages(self, kit: Kit) -> dict[str, Stage]:
        return {"angle": _Plays(self, float(kit.curve.angle_deg[0]))}


class _Plays:
    def __init__(self, effect: Friction, rest_deg: float) -> None:
        self.base, self.growth = effect.half_width_deg, effect.half_width_deg_per_MPa
        self.one = self.two = self.three = rest_deg

    def __call__(self, value: float, now: Now) -> float:
        half = self.base + self.growth * now.pressure_MPa
        self.one = play(self.one, value, 0.5 * half)
        self.two = play(self.two, value, half)
        self.three = play(self.three, value, 1.5 * half)
        return (self.one + self.two + self.three) / 3
