"""The next experiment: of all that a bench can do, that which moves the rivals farthest apart.

Two rivals i and j in an experiment with noise V are apart by the smallest value, over what j's parameters θ may become, of
√(|f_i − f_j(θ)|²_V + |θ − θ_j|²_C), C: covariance of θ from the data so far, and the same with i and j exchanged. That is the square
root of the χ² by which the data, old and new together, would speak against the wrong one (Hunter and Reiner 1965, Technometrics 7, 307,
take the distance without refitting). An experiment is as good as its closest pair.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from benchlab.discrepancy.base import Base
from benchlab.discrepancy.experiment import BenchLimits, Experiment
from benchlab.discrepancy.experiments import default_experiment, family
from benchlab.discrepancy.explanation import NextExperiment
from benchlab.discrepancy.separation import Noise, Rival, Trial
from benchlab.discrepancy.trial import trial_scene
from benchlab.units import FloatArray

LEAST_SD, ENOUGH_SD, CERTAIN_SD, NEAR = 1.0, 5.0, 20.0, 0.9
"""Below the first, rivals are not separated. From the second, nobody is asked to turn or make samples for more. Above the third it does
not matter by how much. The last, as a share of the best, is as good. All are chosen."""

FAR = 2.0
"""Pairs so many times as far apart as the closest one, along the tangent, are not refitted."""

TURN_S, MAKE_S = 120.0, 7200.0
"""What turning a sample, and making one, takes in time (chosen)."""

BESIDE = {
    "camera_scale": "a scale bar in the picture, at the depth of the actuator",
    "camera_tilt": "a square target in the plane of bending, to see how the camera stands",
    "pressure_gain": "a second gauge at the regulator, read at several pressures",
    "pressure_offset": "the reading of the vented bench, against a second gauge",
    "marker_offset": "markers on the strip's own line, or the distance of the markers from it, measured",
    "end_caps": "the length of the actuator that does not bend, measured, or samples of another length",
    "seam_margin": "the width of the welds, measured under a microscope",
    "clock_offset": "a lamp in the picture that the bench switches",
    "frame_compliance": "the force frame pressed by a known weight, and its give measured",
    "leakage": "a hold with the supply shut by hand: pressure that leaks is lost",
    "fabric_compliance": "a tensile test of the fabric",
    "bladder_stiffness": "a sample without its bladder, or a tensile test of it",
    "temperature": "runs at two temperatures of the room",
}
"""What shows an effect apart from any other that is not on this bench."""


@dataclass(frozen=True)
class Scored:
    """An experiment, and how far it moves the closest two rivals apart, in standard deviations. pair: their places."""

    experiment: Experiment
    sd: float
    pair: tuple[int, int]

    @property
    def worth(self) -> float:
        return min(self.sd, CERTAIN_SD)

    @property
    def effort_s(self) -> float:
        """Of one sample: on the bench, and what is to be done beside."""
        one = self.experiment
        return one.sample_s + TURN_S * one.turned + MAKE_S * (one.length_ratio != 1)


@dataclass(frozen=True)
class Proposal:
    """What to do next. told: as the result has it. considered: all experiments, best first."""

    told: NextExperiment
    considered: tuple[Scored, ...] = ()


def proposal(
    base: Base,
    designs: Sequence[str],
    rivals: Sequence[Rival],
    noise: Noise,
    limits: BenchLimits | None = None,
    quantity: str = "angle_deg",
) -> Proposal:
    """The experiment of the family that separates the closest pair of rivals best; of those nearly as good, the one with least effort.

    designs: on which it is run. noise: covariance of the means over the samples that there will be. With fewer than two rivals, or no
    design, it is the default experiment. Where nothing reaches LEAST_SD, `told.cannot` says so, and what would.
    """
    limits = _within(limits or BenchLimits(), base, designs)
    if len(rivals) < 2 or not designs:
        return default_proposal(limits)
    experiments = [one for one in family(limits) if quantity != "force_N" or one.length_ratio == 1]
    plain = [one for one in experiments if not _asks_more(one)]
    scored = _scored(base, designs, rivals, noise, plain, quantity)
    if not scored or scored[0].sd < ENOUGH_SD:
        more = [one for one in experiments if _asks_more(one)]
        scored = _best_first([*scored, *_scored(base, designs, rivals, noise, more, quantity)])
    if not scored or scored[0].sd < LEAST_SD:
        return Proposal(_cannot(rivals, scored), tuple(scored))
    enough = [one for one in scored if one.worth >= NEAR * scored[0].worth]
    chosen = min(enough, key=lambda one: (one.effort_s, -one.sd))
    told = NextExperiment(
        protocol=chosen.experiment.name,
        separates=" from ".join(rival.name for rival in rivals),
        expected_sd=chosen.sd,
        setup=chosen.experiment.setup,
        experiment=chosen.experiment,
    )
    return Proposal(told, tuple(scored))


def default_proposal(limits: BenchLimits | None = None, why: str = "") -> Proposal:
    """For data that cannot show most effects, or that nothing explains. expected_sd is NaN: there is no pair that it was chosen for."""
    experiment = default_experiment(limits or BenchLimits())
    separates = why or "what depends on rate, direction, time and cycle from what does not"
    return Proposal(NextExperiment(experiment.name, separates, float("nan"), experiment.setup, experiment=experiment))


def _within(limits: BenchLimits, base: Base, designs: Sequence[str]) -> BenchLimits:
    """Not beyond where the simulation ends; no other length where lengths are not known."""
    top = min([limits.pressure_MPa, *(base.largest_pressure_MPa(name) for name in designs)])
    known = all(base.designs[name].shape is not None for name in designs)
    return replace(limits, pressure_MPa=top, other_length=limits.other_length and known)


def _asks_more(experiment: Experiment) -> bool:
    """Whether samples must be turned, or made."""
    return experiment.turned or experiment.length_ratio != 1


def _scored(
    base: Base,
    designs: Sequence[str],
    rivals: Sequence[Rival],
    noise: Noise,
    experiments: Sequence[Experiment],
    quantity: str,
) -> list[Scored]:
    """Best first. Refitting is done where the tangent alone does not already say that another one is better."""
    trials = []
    for experiment in experiments:
        trial = Trial(trial_scene(experiment, base, designs), rivals, noise, quantity)
        if trial.told:
            trials.append((_closest(trial.linear()), experiment, trial))
    trials.sort(key=lambda one: -one[0][0])
    scored: list[Scored] = []
    for along, experiment, trial in trials:
        best = max((one.worth for one in scored), default=0.0)
        hopeful = along[0] >= NEAR * best
        scored.append(Scored(experiment, *(min(along, _closest(trial.refitted(FAR * along[0]))) if hopeful else along)))
    return _best_first(scored)


def _best_first(scored: Sequence[Scored]) -> list[Scored]:
    return sorted(scored, key=lambda one: (-one.worth, one.effort_s))


def _closest(distance: FloatArray) -> tuple[float, tuple[int, int]]:
    """The smallest distance of two rivals, and which."""
    i, j = np.tril_indices(len(distance), -1)
    at = int(np.argmin(distance[i, j]))
    return float(distance[i[at], j[at]]), (int(j[at]), int(i[at]))


def _cannot(rivals: Sequence[Rival], scored: Sequence[Scored]) -> NextExperiment:
    if not scored:
        return NextExperiment(
            "", "", float("nan"), cannot="no experiment fits into the time that a sample may be on the bench"
        )
    best = scored[0]
    first, second = (rivals[place] for place in best.pair)
    names = dict.fromkeys(active.effect for rival in (first, second) for active in rival.actives)
    words = "; ".join(f"{effect.name}: {BESIDE.get(effect.name, effect.shown_by)}" for effect in names)
    cannot = (
        f"cannot be separated on this bench: {first.name} and {second.name} would be {best.sd:.2g} standard deviations apart at most "
        f"({best.experiment.what}). What would tell: {words}"
    )
    return NextExperiment("", "", best.sd, cannot=cannot)
