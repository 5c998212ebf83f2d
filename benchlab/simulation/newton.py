"""A regularised Newton method that only goes down in energy, so that it ends in a stable state or says that it does not."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from scipy.linalg import LinAlgError, cho_solve_banded, cholesky_banded

from benchlab.simulation.cell import Potential, State
from benchlab.simulation.laws.law import FloatArray

MOST_STEPS = 25
TOLERANCE = 1e-5
"""Size of the last step, as the root of the share of the energy that it gains. Newton squares it: the state is good to about 1e-8."""

_NO_RISE = 1e-12
_SHIFTS = 14
_ROUNDING_MM = 3e-7
"""Displacements below this, against the stiffest component, are not told from rounding of the energy."""


@dataclass(frozen=True)
class Solved:
    """A state with its potential, the steps taken, and whether it is a minimum of Π to the tolerance."""

    state: State
    potential: Potential
    steps: int
    converged: bool


def minimise(
    potential_at: Callable[[State], Potential],
    start: State,
    free: tuple[bool, bool] = (True, True),
    most_steps: int = MOST_STEPS,
    tolerance: float = TOLERANCE,
    astray: Callable[[State], bool] = lambda state: False,
    look: bool = True,
) -> Solved:
    """The minimum of Π next to `start`, in the fields and in those of (k, λ) that are free.

    Each step solves (H + μ·diag H)·δ = −g with the smallest μ that makes the matrix positive definite and the energy
    fall (Levenberg 1944). A step whose predicted gain is `tolerance` of the strain energy scale ends the search. Not
    converged: more than `most_steps`, no way down, or a state that is `astray`. look: after the last step too; otherwise the potential of
    a solved state is that of the one before it, and a third of the work is spared.
    """
    state, here, shift = start, potential_at(start), 0.0
    border = np.array(free)
    if not math.isfinite(here.value):
        return Solved(state, here, 0, converged=False)
    noise = _ROUNDING_MM**2 * float(here.band[0].max())
    for step in range(most_steps):
        for _ in range(_SHIFTS):
            move = _newton_step(here, border, shift)
            if move is not None:
                fields, (k, lam), gain = move
                trial = State(state.fields + fields, state.k + k, state.lam + lam)
                small = shift == 0 and gain <= max(tolerance**2 * abs(here.value), noise)
                if small and not look:
                    return Solved(trial, here, step + 1, converged=not astray(trial))
                there = potential_at(trial)
                if there.value <= here.value + _NO_RISE * abs(here.value) + noise - 1e-4 * gain:
                    break
            shift = max(4 * shift, 1e-4)
        else:
            return Solved(state, here, step, converged=False)
        state, here = trial, there
        if astray(state):
            return Solved(state, here, step + 1, converged=False)
        if small:
            return Solved(state, here, step + 1, converged=True)
        shift = 0.0 if shift <= 1e-4 else shift / 8
    return Solved(state, here, most_steps, converged=False)


def condensed(at: Potential) -> FloatArray:
    """(2, 2): Hessian in (k, λ), the fields in balance (Schur complement). Raises LinAlgError where they are not stable."""
    factor = cholesky_banded(at.band, lower=True, check_finite=False)
    return np.asarray(at.border - at.coupling.T @ cho_solve_banded((factor, True), at.coupling, check_finite=False))


def _newton_step(
    at: Potential, border: np.ndarray, shift: float
) -> tuple[FloatArray, tuple[float, float], float] | None:
    """Step in the fields and in (k, λ), and the gain in energy that it predicts; None where H + shift is not positive
    definite."""
    band = at.band
    if shift:
        band = band.copy()
        band[0] += shift * np.abs(band[0])
    try:
        factor = cholesky_banded(band, lower=True, check_finite=False)
    except LinAlgError:
        return None
    right = np.column_stack([at.gradient, at.coupling])
    solved = cho_solve_banded((factor, True), right, check_finite=False)
    schur = at.border * (1 + shift * np.eye(2)) - at.coupling.T @ solved[:, 1:]
    slope = at.border_gradient - at.coupling.T @ solved[:, 0]
    chosen = np.flatnonzero(border)
    move = np.zeros(2)
    if len(chosen):
        inner = schur[np.ix_(chosen, chosen)]
        if np.linalg.eigvalsh(inner)[0] <= 0:
            return None
        move[chosen] = -np.linalg.solve(inner, slope[chosen])
    fields = -solved[:, 0] - solved[:, 1:] @ move
    gain = -0.5 * float(at.gradient @ fields + at.border_gradient[border] @ move[border])
    return fields, (float(move[0]), float(move[1])), gain
