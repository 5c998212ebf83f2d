"""Models that may explain the gap: fitted sets of effects, and which of them the data can tell apart."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from scipy import stats

from benchlab.discrepancy.bank import Bank
from benchlab.discrepancy.effects.effect import Active
from benchlab.discrepancy.fit import Fit, fit
from benchlab.discrepancy.problem import Problem, off
from benchlab.discrepancy.rules import Rules
from benchlab.units import FloatArray


def reach(bank: Bank, residual: FloatArray, tangent: FloatArray) -> dict[str, float]:
    """By name: how much of |residual|² the best direction of an effect explains beside the tangent, with the sign that it has."""
    free = off(bank.directions, tangent)
    sizes, along = (free**2).sum(axis=0), residual @ free
    explained = np.divide(np.maximum(along, 0.0) ** 2, sizes, out=np.zeros_like(sizes), where=sizes > 1e-6)
    out: dict[str, float] = {}
    for active, value in zip(bank.actives, explained):
        out[active.name] = max(out.get(active.name, 0.0), float(value))
    return out


def best_starts(bank: Bank, residual: FloatArray, name: str) -> list[Active]:
    """For each form of an effect, the start that leaves least of the residual."""
    found: dict[str, tuple[float, Active]] = {}
    for i, active in enumerate(bank.actives):
        if active.name == name:
            left = float(((residual - bank.directions[:, i]) ** 2).sum())
            if active.form not in found or left < found[active.form][0]:
                found[active.form] = (left, active)
    return [active for _, active in found.values()]


def fits_with(problem: Problem, before: Fit, bank: Bank, name: str) -> list[Fit]:
    """The model before with one effect more, in each of its forms, best first."""
    starts = best_starts(bank, before.residual, name)
    return sorted((fit(problem, (*before.actives, start)) for start in starts), key=lambda found: found.misfit)


def p_enough(problem: Problem, candidate: Fit, best: Fit) -> tuple[float, float]:
    """(p, t) of the candidate being enough: t standard errors in the direction in which the best one differs from it (after Cox 1961).

    What the candidate's own parameters could still take up is left out of the direction. p: one-sided, of Student's t.
    """
    direction = off((best.model - candidate.model)[:, None], candidate.tangent)
    if float((direction**2).sum()) < 1e-6:
        return 1.0, 0.0
    t = float(problem.t_values(direction, candidate.residual)[0])
    return float(stats.t.sf(t, problem.freedom)), t


def in_set(problem: Problem, candidate: Fit, best: Fit, bare: Fit, rules: Rules) -> bool:
    """Whether the data cannot tell the candidate from the best one. bare: the base alone."""
    close = max(rules.close, rules.alike * (bare.misfit - best.misfit))
    if candidate is best or candidate.misfit - best.misfit < close:
        return True
    return p_enough(problem, candidate, best)[0] > rules.rival


def distinct(fits: Sequence[Fit]) -> list[Fit]:
    """The best fit of each set of names, best first."""
    found: dict[tuple[str, ...], Fit] = {}
    for one in sorted(fits, key=lambda f: f.misfit):
        found.setdefault(one.key, one)
    return list(found.values())
