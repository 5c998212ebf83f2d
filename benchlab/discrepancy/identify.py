"""Which effects are missing: detect, fit, compare rivals, add further ones, and see whether anything is left."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field

import numpy as np

from benchlab.discrepancy.bank import DRAWS, Bank, Scan, bank_of, flexible, principal, scan
from benchlab.discrepancy.candidates import best_starts, distinct, fits_with, in_set, p_enough, reach
from benchlab.discrepancy.effects.effect import Effect
from benchlab.discrepancy.fit import Fit, fit, nothing
from benchlab.discrepancy.locate import gaps
from benchlab.discrepancy.problem import Problem, off
from benchlab.discrepancy.rules import Rules
from benchlab.units import FloatArray


WORSE = 1.5
"""A model whose means are farther from the measured ones than so many times the base's is no explanation."""


@dataclass(frozen=True)
class Identified:
    """verdict, as in explanation.VERDICTS. best: the model taken (the base alone for agree). rivals: fits that cannot be told from it, it
    first. tried: all fits of its size. forms: fits of the best effects in forms that are not excluded, the best first. p_gap: of no gap
    at all; p_left: of nothing being left beside the best. share: of the gap beyond scatter that the best explains."""

    verdict: str
    best: Fit
    rivals: tuple[Fit, ...]
    tried: tuple[Fit, ...]
    forms: tuple[Fit, ...]
    p_gap: float
    p_left: float
    share: float
    notes: tuple[str, ...] = ()
    stages: tuple[dict[str, float | str], ...] = field(default=())


def identify(
    problem: Problem,
    effects: Sequence[Effect],
    generator: np.random.Generator,
    rules: Rules | None = None,
    progress: Callable[[str], None] | None = None,
) -> Identified:
    """Find the effects of the vocabulary that explain the gap. effects: those that the data can show."""
    rules = rules or Rules()
    tell = progress or (lambda _: None)
    bare = nothing(problem)
    tell("directions of the effects")
    bank = bank_of(problem, effects)
    anything = flexible(problem)
    noise = problem.noise(generator, DRAWS)
    known = scan(problem, bank.directions, bare.residual, bare.tangent, noise, rules.multiplier)
    unknown = scan(problem, anything, bare.residual, bare.tangent, noise, rules.multiplier)
    if known.p > rules.first:
        verdict = "unexplained" if unknown.p < rules.adequate else "agree"
        return Identified(verdict, bare, (), (), (), min(known.p, unknown.p), unknown.p, 0.0)
    tell("fits of one effect")
    tried, forms = _extended(problem, [bare], bank, rules)
    stages = []
    while True:
        best = tried[0]
        stages.append({"model": " + ".join(best.names), "misfit": best.misfit})
        own = forms[tuple(sorted(best.names))]
        left = _left(problem, best, own, bank, noise, rules)
        if left > rules.further or len(best.names) >= rules.most:
            break
        tell(f"fits of {len(best.names) + 1} effects")
        more, more_forms = _extended(problem, tried[: rules.beam], bank, rules)
        if not more or not _worth(problem, more[0], best, rules):
            break
        tried, forms = more, more_forms
    best = tried[0]
    nuisance = beside(best, forms[tuple(sorted(best.names))])
    left_over = scan(problem, anything, best.residual, nuisance, noise, rules.multiplier)
    p_left = left_over.p
    share = share_explained(problem, bare, best, anything, left_over)
    rivals = tuple(one for one in tried if in_set(problem, one, best, bare, rules))
    verdict = "named" if len(rivals) == 1 else "ambiguous"
    notes: tuple[str, ...] = ()
    if p_left < rules.adequate:
        if share < rules.share[min(len(best.names), len(rules.share)) - 1]:
            verdict = "unexplained"
        else:
            notes = ("named with a remainder",)
    own = tuple(one for one in forms.get(tuple(sorted(best.names)), (best,)) if one.misfit - best.misfit < 4.0)
    return Identified(
        verdict, best, rivals, tuple(tried), own, min(known.p, unknown.p), p_left, share, notes, tuple(stages)
    )


def _extended(
    problem: Problem, before: Sequence[Fit], bank: Bank, rules: Rules
) -> tuple[list[Fit], dict[tuple[str, ...], tuple[Fit, ...]]]:
    """Fits with one effect more than those before: the most promising ones, best first; and by names the fits in all forms."""
    forms: dict[tuple[str, ...], list[Fit]] = {}
    for one in before:
        others = bank.of([name for name in dict.fromkeys(a.name for a in bank.actives) if name not in one.names])
        if not others.actives:
            continue
        could = reach(others, one.residual, one.tangent)
        order = sorted(could, key=lambda name: -could[name])
        wanted = order if not one.names else order[: rules.tries]
        floor = 0.3 * could[order[0]]
        for name in wanted:
            key = tuple(sorted((*one.names, name)))
            if key in forms or (could[name] < floor and order.index(name) > 2):
                continue
            forms[key] = fits_with(problem, one, others, name)
    fits = distinct([one for group in forms.values() for one in group if _plausible(problem, one)])
    return fits, {key: tuple(group) for key, group in forms.items()}


def _plausible(problem: Problem, one: Fit) -> bool:
    """Whether the means are not farther from the model than from the base: what the scatter forgives is no explanation."""
    before, after = (
        float(np.sqrt(np.mean(gaps(problem, problem.cells(actives)) ** 2))) for actives in ((), one.actives)
    )
    return after < WORSE * before


def _left(problem: Problem, best: Fit, forms: Sequence[Fit], bank: Bank, noise: FloatArray, rules: Rules) -> float:
    """p of no further effect of the vocabulary, beside what the effects of the model do in their other forms."""
    others = bank.of([name for name in dict.fromkeys(a.name for a in bank.actives) if name not in best.names])
    if not others.actives:
        return 1.0
    return scan(problem, others.directions, best.residual, beside(best, forms), noise, rules.multiplier).p


def beside(best: Fit, forms: Sequence[Fit]) -> FloatArray:
    """(C, q): what the model can still do: its tangent, and its effects in their other forms."""
    others = [(one.model - best.model)[:, None] for one in forms if one is not best]
    return np.concatenate([best.tangent, *others], axis=1)


def _worth(problem: Problem, more: Fit, best: Fit, rules: Rules) -> bool:
    """Whether the larger model moves the predictions enough to be worth its name."""
    before = gaps(problem, problem.cells(()))
    moved = gaps(problem, problem.cells(best.actives)) - gaps(problem, problem.cells(more.actives))
    return bool(np.sqrt(np.mean(moved**2)) > rules.moves * np.sqrt(np.mean(before**2)))


def share_explained(
    problem: Problem, bare: Fit, best: Fit, anything: FloatArray, left_over: Scan | None = None
) -> float:
    """Share of the misfit that any model could explain which this one does: gained/(gained + what misfits of no particular name still take).

    anything: (C, K) of `flexible`. Noise alone takes as much as there are dimensions, which does not count. left_over: of the scan of what is
    left: one direction may stand out where all together do not.
    """
    gained = bare.misfit - best.misfit
    basis = principal(anything, 0.02)
    left = max(float(((basis.T @ best.residual) ** 2).sum()) - basis.shape[1], 0.0)
    if left_over is not None:
        left = max(left, left_over.largest**2 - left_over.usual**2)
    return float(np.clip(gained / (gained + left), 0.0, 1.0)) if gained > 0 else 0.0


__all__ = ["Identified", "best_starts", "fit", "identify", "off", "p_enough", "share_explained"]
