"""Which effects are missing: detect, fit, compare rivals, add further ones, and see whether anything is left."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from benchlab.discrepancy.bank import DRAWS, Bank, Scan, bank_of, flexible, principal, scan
from benchlab.discrepancy.candidates import distinct, fits_with, in_set, p_enough, reach
from benchlab.discrepancy.effects.effect import Effect
from benchlab.discrepancy.fit import Fit, nothing
from benchlab.discrepancy.locate import gaps
from benchlab.discrepancy.problem import Problem
from benchlab.discrepancy.rules import Rules
from benchlab.units import FloatArray

Forms = dict[tuple[str, ...], tuple[Fit, ...]]
"""By sorted names: the fits in all forms, best first."""


@dataclass(frozen=True)
class Identified:
    """verdict, as in explanation.VERDICTS. best: the model taken (the base alone for agree). rivals: fits that cannot be told from it, it
    first, smaller models last. tried: fits of its size, best first, then the smaller models on the way. forms: fits of the best effects in
    forms that are not excluded, the best first. p_gap: of no gap at all; p_left: of nothing being left beside the best. share: of the gap
    beyond scatter that the best explains.
    """

    verdict: str
    best: Fit
    rivals: tuple[Fit, ...]
    tried: tuple[Fit, ...]
    forms: tuple[Fit, ...]
    p_gap: float
    p_left: float
    share: float


def identify(
    problem: Problem,
    effects: Sequence[Effect],
    generator: np.random.Generator,
    rules: Rules | None = None,
    progress: Callable[[str], None] | None = None,
) -> Identified:
    """Find the effects of the vocabulary that explain the gap. effects: those that the data can show."""
    rules = (rules or Rules()).at(problem.freedom)
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
    if not tried:
        return Identified("unexplained", bare, (), (), (), min(known.p, unknown.p), unknown.p, 0.0)
    best = tried[0]
    span = principal(anything, 0.02)
    left_over = _left_over(problem, best, forms, anything, span, noise, rules)
    smaller: list[Fit] = []
    alike: list[Fit] = []
    while len(best.names) < rules.most:
        more_is_there = _further(problem, best, forms, bank, noise, rules)
        if more_is_there.p > rules.further:
            break
        tell(f"fits of {len(best.names) + 1} effects")
        more, more_forms = _extended(problem, _carried(tried, bare, rules), bank, rules)
        shown = [one for one in more if p_enough(problem, best, one)[1] > more_is_there.usual]
        more = [one for one in shown if _worth(problem, one, best, rules)]
        if not more:
            break
        if alike := _lookalikes(problem, more[0], tried, bare, rules):
            break
        rest = _left_over(problem, more[0], more_forms, anything, span, noise, rules)
        if rest.p < rules.adequate and not _clears(problem, more[0], best, rest, left_over, rules):
            break  # it does not clear up what was left: no effect that is missing, but the form of the one that is there
        smaller.append(best)
        tried, forms, best, left_over = more, more_forms, more[0], rest
    p_left, share = left_over.p, share_explained(bare, best, left_over)
    enough = [one for one in smaller if p_enough(problem, one, best)[0] > rules.rival]
    rivals = (*(one for one in tried if in_set(problem, one, best, bare, rules) or one in alike), *enough)
    tried = [*tried, *smaller]
    verdict = "named" if len(rivals) == 1 else "ambiguous"
    if (p_left < rules.doubtful and share < rules.half) or (
        p_left < rules.adequate and share < rules.share[min(len(best.names), len(rules.share)) - 1]
    ):
        verdict = "unexplained"
    own = tuple(one for one in forms[best.key] if one.misfit - best.misfit < 4.0)
    return Identified(verdict, best, rivals, tuple(tried), own, min(known.p, unknown.p), p_left, share)


def _extended(problem: Problem, before: Sequence[Fit], bank: Bank, rules: Rules) -> tuple[list[Fit], Forms]:
    """Fits with one effect more than those before: the most promising ones, best first; and by names the fits in all forms."""
    forms: dict[tuple[str, ...], list[Fit]] = {}
    for one in before:
        others = bank.without(one.names)
        if not others.actives:
            continue
        could = reach(others, one.residual, one.tangent)
        order = sorted(could, key=lambda name: -could[name])
        wanted = order if not one.names else order[: rules.tries]
        floor = 0.25 * could[order[0]]
        for name in wanted:
            key = tuple(sorted((*one.names, name)))
            if key in forms or (could[name] < floor and order.index(name) > 2):
                continue
            forms[key] = fits_with(problem, one, others, name)
    fits = distinct([one for group in forms.values() for one in group if _plausible(problem, one)])
    return fits, {key: tuple(group) for key, group in forms.items()}


def _carried(tried: Sequence[Fit], bare: Fit, rules: Rules) -> list[Fit]:
    """Those to which further effects are added: the best ones, as far as they are near the best."""
    near = rules.near * (bare.misfit - tried[0].misfit) + rules.close * 20
    return [one for one in tried[: rules.beam] if one.misfit - tried[0].misfit < near]


def _plausible(problem: Problem, one: Fit) -> bool:
    """Whether the means are no farther from the model than from the base, but for their own error.

    What scatter forgives explains nothing.
    """
    each = (problem.base_cells, problem.cells(one.actives))
    before, after = (_square(problem, problem.in_parts(gaps(problem, cells))) for cells in each)
    return after < before + len(problem.features.quantities)


def _square(problem: Problem, values: FloatArray) -> float:
    """Sum of squares of (quantities, PARTS), each against the error of the means."""
    return float(((values / problem.errors_of_means[:, None]) ** 2).sum())


def _further(problem: Problem, best: Fit, forms: Forms, bank: Bank, noise: FloatArray, rules: Rules) -> Scan:
    """Whether the vocabulary has a further effect, beside what the effects of the model do in their other forms."""
    others = bank.without(best.names).directions
    return scan(problem, others, best.residual, beside(best, forms[best.key]), noise, rules.multiplier)


@dataclass(frozen=True)
class Left:
    """p: of nothing being left beside a model. amount: misfit that is left for any other model, beyond what noise takes."""

    p: float
    amount: float


def _left_over(
    problem: Problem,
    best: Fit,
    forms: Forms,
    anything: FloatArray,
    span: FloatArray,
    noise: FloatArray,
    rules: Rules,
) -> Left:
    """What misfits of no particular name (C, K) still take: all that they span (C, q) together, or the one that stands out."""
    found = scan(problem, anything, best.residual, beside(best, forms[best.key]), noise, rules.multiplier)
    together = float(((span.T @ best.residual) ** 2).sum()) - span.shape[1]
    return Left(found.p, max(together, found.largest**2 - found.usual**2, 0.0))


def beside(best: Fit, forms: Sequence[Fit]) -> FloatArray:
    """(C, q): what the model can still do: its tangent, and its effects in their other forms."""
    others = [(one.model - best.model)[:, None] for one in forms if one is not best]
    return np.concatenate([best.tangent, *others], axis=1)


def _worth(problem: Problem, more: Fit, best: Fit, rules: Rules) -> bool:
    """Whether the step to the larger model, and each effect that it has more, moves the predictions enough to be worth a name: in some
    part of the gap by a share of it; a second effect also by most of what the first has left of it, as long as that is more than a form
    may leave.
    """
    smaller, larger = problem.cells(best.actives), problem.cells(more.actives)
    before, left = (problem.in_parts(gaps(problem, cells)) for cells in (problem.base_cells, smaller))
    needed = rules.moves[min(len(best.names), len(rules.moves)) - 1] * before
    if len(best.names) == 1:
        needed = np.minimum(needed, np.maximum(rules.moves_left * left, rules.moves_least * before))
    whole = np.sqrt((before**2).sum(axis=1, keepdims=True))
    needed = np.maximum(needed, rules.part * whole)
    least = rules.least * problem.errors_of_means[:, None]

    def enough(step: FloatArray) -> bool:
        moved = problem.in_parts(problem.mean_over_samples(step))
        size = np.sqrt((moved**2).sum(axis=1, keepdims=True))
        return bool(((moved > needed) & (size > least)).any())

    new = [i for i, name in enumerate(more.names) if name not in best.names]
    without = (problem.cells(more.actives[:i] + more.actives[i + 1 :]) for i in new)
    return enough(larger - smaller) and all(enough(larger - cells) for cells in without)


def _lookalikes(problem: Problem, more: Fit, tried: Sequence[Fit], bare: Fit, rules: Rules) -> list[Fit]:
    """Where there is one kind of run, the single effects that are no companions of the best but its rivals: each explains about what the
    best one does, and both together little more: the truth is one of them, in a form between the two. One loop does not tell two."""
    best = tried[0]
    gained = bare.misfit - best.misfit
    if len(problem.features.kinds) > 1 or len(best.names) > 1 or best.misfit - more.misfit > rules.together * gained:
        return []
    added = set(more.names) - set(best.names)
    return [one for one in tried if set(one.names) <= added and bare.misfit - one.misfit > rules.alone * gained]


def _clears(problem: Problem, more: Fit, best: Fit, rest: Left, left: Left, rules: Rules) -> bool:
    """Whether of what the smaller model left a share is gone: against the scatter, or in that part of the gap in which the larger one
    differs most from it."""
    cells = problem.cells(best.actives), problem.cells(more.actives)
    then, now = (problem.in_parts(gaps(problem, one)) for one in cells)
    moved = problem.in_parts(problem.mean_over_samples(cells[1] - cells[0]))
    place = np.unravel_index(np.argmax(moved / np.maximum(then, 1e-12)), moved.shape)
    return rest.amount <= rules.clears * left.amount or bool(now[place] ** 2 <= rules.clears * then[place] ** 2)


def share_explained(bare: Fit, best: Fit, left: Left) -> float:
    """Share of the misfit that any model could explain which this one does: gained/(gained + what is left)."""
    gained = bare.misfit - best.misfit
    return float(np.clip(gained / (gained + left.amount), 0.0, 1.0)) if gained > 0 else 0.0


def gained_share(bare: Fit, one: Fit, best: Fit, share: float) -> float:
    """The same for a candidate beside the best one, whose share is known."""
    whole = (bare.misfit - best.misfit) / max(share, 1e-9)
    return float(np.clip((bare.misfit - one.misfit) / whole, 0.0, 1.0)) if whole > 0 else 0.0
