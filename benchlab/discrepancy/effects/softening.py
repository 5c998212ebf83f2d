"""softening: the film is stiff the first time and softer ever after, up to the largest strain so far (Mullins).

    E → E·(1 − d·D)          D = (1 − (u/m)²)·G (plain)          G = 1 − exp(−N/n)          N = W/(2m)

d `softer`: share of the film's stiffness that is lost; n `cycles`: number in which it goes; u: angle of the base at
this pressure, the measure of strain; m: the largest so far, on the sample where the order of its runs is known; W:
way gone below it, to and fro (moves under 3 % of m do not count), N: as many cycles to m. The base is a virgin film,
as a tension test to rupture has it. Forms: `plain`: nothing is lost at the largest strain, all of it far below
(pseudo-elastic as Ogden and Roxburgh's, with u² for the energy; the straight line in it is chosen); `cycle by cycle`:
D = G, so that each loading to m goes farther than the last; `largest so far`: D = m/M, M the base's at its highest
pressure, and softens from the first loading on; `run in`: the base is a film that was cycled, D = G − 1, and the
first loading is stiffer. It acts through the knob `film_modulus` where the base has it, else on the angle as θ/(1 −
d·D).
By nature confounded: with friction where each sample is loaded once; with viscoelasticity where there is one rate and
no hold.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import ClassVar

import numpy as np

from benchlab.discrepancy.effects.effect import At, Effect, Parameter
from benchlab.discrepancy.scene import Scene
from benchlab.units import FloatArray

SMALLEST_MOVE = 0.03
"""Of the largest strain so far: what goes to and fro by less is noise. Chosen."""


class Softening(Effect):
    name: ClassVar[str] = "softening"
    acts_on: ClassVar[str] = "material"
    physics: ClassVar[str] = (
        "A filled or segmented rubber that has been stretched is softer than before at all strains below the "
        "largest one it has seen (Mullins, Rubber Chem. Technol. 42, 339, 1969; of polyurethanes Qi and Boyce, "
        "Mech. Mater. 37, 817, 2005), and some cycles pass until it repeats itself. Pseudo-elastic models scale "
        "the stiffness by a factor of the present and the largest strain (Ogden and Roxburgh, Proc. R. Soc. A 455, "
        "2861, 1999)."
    )
    looks_like: ClassVar[str] = (
        "the first loading lies below all others; later loadings follow the unloading; peaks grow from cycle to "
        "cycle, then settle"
    )
    shown_by: ClassVar[str] = "three cycles to one pressure on a new sample, then three to a larger one"
    parameters: ClassVar[tuple[Parameter, ...]] = (
        Parameter("softer", "", 0.0, 0.5, 0.08, 0.0, (0.02, 0.06, 0.15), "share of the film's stiffness that is lost"),
        Parameter("cycles", "", 0.03, 20.0, 0.5, None, (0.1, 1.0, 4.0), "cycles in which it is lost (63 % of it)"),
    )
    forms: ClassVar[tuple[str, ...]] = ("plain", "cycle by cycle", "largest so far", "run in")
    seen_in: ClassVar[tuple[str, ...]] = ("angle_deg", "flex_V", "volume_mL", "force_N")

    def cannot_show(self, scene: Scene) -> str:
        return (
            "" if scene.comes_again else "each sample was loaded once: no unloading, no second loading in a known order"
        )

    def knobs(self, at: At) -> Mapping[str, FloatArray | float]:
        through_film = at.values["softer"] > 0 and at.scene.has_knob("film_modulus")
        return {"film_modulus": self._stiffness(at)} if through_film else {}

    def angle(self, angle_deg: FloatArray, at: At) -> FloatArray:
        nothing = at.values["softer"] == 0 or at.scene.has_knob("film_modulus")
        return angle_deg if nothing else angle_deg / self._stiffness(at)

    def _stiffness(self, at: At) -> FloatArray:
        return 1 - at.values["softer"] * _damage(at)


def _damage(at: At) -> FloatArray:
    """(T, R): D."""
    scene = at.scene
    strain = np.maximum(scene.curve("angle_deg", at.load_MPa, {}), 0.0)
    largest = np.maximum(scene.largest_so_far(strain), 1e-9)
    if at.form == "largest so far":
        return largest / np.maximum(scene.full("angle_deg"), 1e-9)
    cycles = _cycles_below(scene, strain, largest)
    gone = -np.expm1(-cycles / at.values["cycles"])
    if at.form == "cycle by cycle":
        return gone
    if at.form == "run in":
        return gone - 1
    return (1 - (strain / largest) ** 2) * gone


def _cycles_below(scene: Scene, strain: FloatArray, largest: FloatArray) -> FloatArray:
    """(T, R): cycles gone below the largest strain so far, with those of earlier runs on the sample."""
    half = SMALLEST_MOVE / 2 * largest
    moved = scene.play(strain, half)
    way = np.abs(np.diff(moved, axis=0, prepend=moved[:1]))
    front = np.diff(largest - half, axis=0, prepend=(largest - half)[:1])
    below = np.cumsum(np.maximum(way - np.maximum(front, 0.0), 0.0), axis=0)
    return (below + scene.sum_before(below[-1])) / (2 * largest)
