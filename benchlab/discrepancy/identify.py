"""Which effects are missing: detect, fit, compare rivals, add further ones, and see whether anything is left."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field

import numpy as np

from benchlab.discrepancy.bank import DRAWS, Bank, bank_of, flexible, principal, scan
from benchlab.discrepancy.candidates import best_starts, distinct, fits_with, in_set, p_enough, reach
from benchlab.discrepancy.effects.effect import Effect
from benchlab.discrepancy.fit import Fit, fit, nothing
from benchlab.discrepancy.locate import gaps
from benchlab.discrepancy.problem import Problem, off
from benchlab.discrepancy.rules import Rules
from benchlab.units import FloatArray


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
        left = _left(problem, best, bank, noise, rules)
        if left > rules.further or len(best.names) >= rules.most:
            break
        tell(f"fits of {len(best.names) + 1} effects")
        more, more_forms = _extended(problem, tried[: rules.beam], bank, rules)
        if not more or not _worth(problem, more[0], best, rules):
            break
        tried, forms = more, more_forms
    best = tried[0]
    p_left = scan(problem, anything, best.residual, best.tangent, noise, rules.multiplier).p
    share = share_explained(problem, bare, best)
    rivals = tuple(one for one in tried if in_set(problem, one, best, bare, rules))
    verdict = "named" if len(rivals) == 1 else "ambiguous"
    notes: tuple[str, ...] = ()
    if p_left < rules.adequate:
        if share < rules.share:
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
    fits = distinct([one for group in forms.values() for one in group])
    return fits, {key: tuple(group) for key, group in forms.items()}


def _left(problem: Problem, best: Fit, bank: Bank, noise: FloatArray, rules: Rules) -> float:
    """p of no further effect of the vocabulary, beside all that the effects of the model could do in other forms and strengths."""
    others = bank.of([name for name in dict.fromkeys(a.name for a in bank.actives) if name not in best.names])
    if not others.actives:
        return 1.0
    own = np.concatenate([best.tangent, principal(bank.of(best.names).directions)], axis=1)
    return scan(problem, others.directions, best.residual, own, noise, rules.multiplier).p


def _worth(problem: Problem, more: Fit, best: Fit, rules: Rules) -> bool:
    """Whether the larger model moves the predictions enough to be worth its name."""
    before = gaps(problem, problem.cells(()))
    moved = gaps(problem, problem.cells(best.actives)) - gaps(problem, problem.cells(more.actives))
    return bool(np.sqrt(np.mean(moved**2)) > rules.moves * np.sqrt(np.mean(before**2)))


def share_explained(problem: Problem, bare: Fit, best: Fit) -> float:
    """Share of the misfit beyond scatter that is gone: 1 − (Q − Q∞)/(Q0 − Q∞), Q∞ that of a model without fault.

    The misfit of the means alone counts: F features scatter by F."""
    features = problem.features
    number = np.bincount(features.feature, minlength=len(features.features))
    means = np.bincount(features.feature, features.value, minlength=len(number)) / np.maximum(number, 1)
    within = problem.whiten(features.value - means[features.feature])
    floor = float(within @ within) + int((number > 0).sum())
    gap = bare.misfit - floor
    return float(np.clip(1 - (best.misfit - floor) / gap, 0.0, 1.0)) if gap > 0 else 1.0


__all__ = ["Identified", "best_starts", "fit", "identify", "off", "p_enough", "share_explained"]
