"""What was measured, explained against a base, with the experiment that should come next."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import replace

import numpy as np
from threadpoolctl import threadpool_limits

from benchlab.discrepancy.base import Base
from benchlab.discrepancy.effects.catalogue import effects
from benchlab.discrepancy.experiment import BenchLimits
from benchlab.discrepancy.explain import Explained, explain
from benchlab.discrepancy.explanation import NextExperiment
from benchlab.discrepancy.foreseen import foreseen
from benchlab.discrepancy.intervals import covariance
from benchlab.discrepancy.measured import Measured, Summary
from benchlab.discrepancy.next_experiment import BESIDE, Proposal, default_proposal, proposal
from benchlab.discrepancy.separation import Rival

MOST_RIVALS = 6
"""Of which the next experiment tells apart at once, the likeliest ones."""


def explain_measured(
    measured: Measured | Summary,
    base: Base,
    *,
    seed: int = 1,
    progress: Callable[[str], None] | None = None,
    limits: BenchLimits | None = None,
    propose: bool = True,
) -> Explained:
    """The explanation, and where it leaves something open the experiment to come; its protocol is not written yet.

    limits: of the bench; None: up to the simulated pressures, as the runs were mounted. Raises InputError where the data carry no verdict.
    """
    there = {active.name for active in base.given}
    missing = {name: effect for name, effect in effects().items() if name not in there}
    with threadpool_limits(1):  # of BLAS: its matrices are small, and more threads only wait for each other
        found = explain(measured, base, missing, seed=seed, progress=progress)
        if not propose:
            return found
        if progress:
            progress("the next experiment")
        following = next_experiment(found, limits or _limits(measured, base))
    return replace(found, explanation=replace(found.explanation, next_experiment=following))


def next_experiment(found: Explained, limits: BenchLimits) -> NextExperiment | None:
    """For rivals the one that separates them, without an explanation the default one, None where nothing is open."""
    verdict, problem = found.explanation.verdict, found.problem
    if verdict in ("agree", "named"):
        return None
    if verdict == "unexplained":
        why = (
            "what depends on rate, direction, time and cycle from what does not, so that the remainder can be described"
        )
        told = default_proposal(limits, why).told
        more = "two samples of each design, or three runs of the one, so that it is known what scatters"
        return (
            replace(told, setup="; ".join(filter(None, [more, told.setup])))
            if found.explanation.only_described
            else told
        )
    quantity = main_quantity(found)
    sizes = problem.scatter.components.get(quantity, {})
    if not sizes or not all(math.isfinite(size) for size in sizes.values()):
        return _beside(default_proposal(limits).told, found)
    rivals = [Rival(fit.actives, covariance(problem, fit)) for fit in found.identified.rivals[:MOST_RIVALS]]
    samples = max(1, int(np.median(np.bincount(problem.features.sample_design))))
    designs = [name for name in problem.scene.names if len(problem.scene.base.designs[name].pressure_MPa) > 1]
    noise = foreseen(problem, samples, quantity)
    return _separating(lambda some: proposal(problem.scene.base, designs, some, noise, limits, quantity), rivals)


def _separating(propose: Callable[[Sequence[Rival]], Proposal], rivals: list[Rival]) -> NextExperiment:
    """The experiment for these rivals; where two of them cannot be separated, which is told, that for the others and one of the two."""
    found = propose(rivals)
    cannot = found.told.cannot
    while found.told.experiment is None and found.considered and len(rivals) > 2:
        twin = found.considered[0].pair[1]
        rivals = [rival for place, rival in enumerate(rivals) if place != twin]
        found = propose(rivals)
    return replace(found.told, cannot=cannot)


def main_quantity(found: Explained) -> str:
    """The one in which rivals are to be told apart: the angle where it was measured (a flex sensor feels it)."""
    quantities = found.problem.features.quantities
    return next((name for name in ("angle_deg", "force_N", "volume_mL") if name in quantities), "angle_deg")


def _beside(told: NextExperiment, found: Explained) -> NextExperiment:
    """With what else would show the rivals, where it is not known how a sample's curve scatters."""
    names = dict.fromkeys(name for rival in found.explanation.rivals for name in rival)
    words = [f"{name}: {BESIDE[name]}" for name in names if name in BESIDE]
    return replace(told, setup="; ".join(filter(None, [told.setup, *words])))


def _limits(measured: Measured | Summary, base: Base) -> BenchLimits:
    top = max(base.largest_pressure_MPa(name) for name in base.designs)
    mounted = [] if isinstance(measured, Summary) else [run.orientation_deg for run in measured.runs]
    known = [angle for angle in mounted if angle is not None]
    limits = BenchLimits(pressure_MPa=top)
    return replace(limits, mounting_deg=float(np.median(known))) if known else limits
