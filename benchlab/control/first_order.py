"""A first-order lag with dead time, driven by a command that is held between samples, and its fit to a stretch of a run."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from scipy.optimize import least_squares

from benchlab.units import FloatArray


@dataclass(frozen=True)
class Fit:
    """coefficients: (C,) of the response's powers from the first on, then of 1.

    covariance: (C + 2, C + 2) of the coefficients, log τ and L; the residuals' correlation from sample to sample is in it.
    residual: (T,). correlation: of neighbouring residuals. response: (T,) the lagged command.
    """

    coefficients: FloatArray
    lag_s: float
    dead_time_s: float
    covariance: FloatArray
    residual: FloatArray
    correlation: float
    response: FloatArray


def response(time_s: FloatArray, command: FloatArray, lag_s: float, dead_time_s: float) -> FloatArray:
    """(T,) x of τ·dx/dt = u(t − L) − x at the samples' times, where u (T,) is held from each sample to the next: exact for any times.

    Before the first sample u has always been the first command.

    >>> t = np.array([0.0, 1.0, 2.0])
    >>> response(t, np.array([0.0, 1.0, 1.0]), 1.0, 0.5).round(4)  # at 2 s: half a second after the step arrived
    array([0.    , 0.    , 0.3935])
    """
    kept = np.exp(-np.diff(time_s) / lag_s).tolist()
    commands = command.tolist()
    x = commands[0]
    states = [x]
    for u, a in zip(commands, kept):
        x = u + (x - u) * a
        states.append(x)
    at = time_s - dead_time_s
    piece = np.searchsorted(time_s, at + 1e-12, side="right") - 1
    began = np.maximum(piece, 0)
    since = np.where(piece < 0, 0.0, at - time_s[began])
    found: FloatArray = command[began] + (np.array(states)[began] - command[began]) * np.exp(-since / lag_s)
    return found


def fit(time_s: FloatArray, command: FloatArray, angle: FloatArray, powers: int, longest_dead_s: float) -> Fit:
    """Least squares of angle (T,) = Σ a_i·x^i + b, i from 1 to powers, over τ and L, with x the lagged command (T,).

    The coefficients are linear and solved for inside (variable projection: Golub and Pereyra, SIAM J. Numer. Anal. 10, 413, 1973);
    τ and L are searched from the best point of a grid. The first sample is taken to be at rest.
    """
    span, dt = float(np.ptp(time_s)), float(np.median(np.diff(time_s)))

    def design(log_lag: float, dead: float) -> FloatArray:
        x = response(time_s, command, math.exp(log_lag), dead)
        return np.column_stack([*(x**i for i in range(1, powers + 1)), np.ones_like(x)])

    def residual(parameters: FloatArray) -> FloatArray:
        matrix = design(*parameters)
        solved = np.linalg.lstsq(matrix, angle, rcond=None)[0]
        left: FloatArray = angle - matrix @ solved
        return left

    low, high = math.log(dt / 2), math.log(max(2 * span, 2 * dt))
    lags = np.linspace(math.log(max(dt, 0.01)), math.log(max(span / 2, 4 * dt)), 10)
    deads = np.linspace(0, longest_dead_s, 11)
    start = min(((a, b) for a in lags for b in deads), key=lambda p: float(np.square(residual(np.array(p))).sum()))
    begin = np.clip(start, (low + 1e-6, 1e-6), (high - 1e-6, longest_dead_s))
    best = least_squares(
        residual, begin, bounds=((low, 0.0), (high, longest_dead_s + 1e-3)), x_scale=(1.0, 0.05), diff_step=1e-5
    ).x
    matrix = design(*best)
    coefficients: FloatArray = np.asarray(np.linalg.lstsq(matrix, angle, rcond=None)[0], dtype=float)
    left = angle - matrix @ coefficients
    slopes = [
        (design(*(best + step)) - design(*(best - step))) @ coefficients / (2 * float(np.abs(step).sum()))
        for step in (np.array([1e-4, 0.0]), np.array([0.0, min(1e-3, dt / 4)]))
    ]
    jacobian = np.column_stack([matrix, *slopes])
    correlation = _correlation(left)
    spread = float(left @ left) / max(len(left) - jacobian.shape[1], 1) * (1 + correlation) / (1 - correlation)
    covariance: FloatArray = np.linalg.pinv(jacobian.T @ jacobian) * spread
    lag, dead = math.exp(best[0]), float(best[1])
    return Fit(coefficients, lag, dead, covariance, left, correlation, response(time_s, command, lag, dead))


def _correlation(residual: FloatArray) -> float:
    """Of neighbouring residuals, from 0 to 0.99: what makes the variance of estimates (1 + ρ)/(1 − ρ) times as large (AR(1))."""
    size = float(residual @ residual)
    return min(max(float(residual[1:] @ residual[:-1]) / size, 0.0), 0.99) if size > 0 else 0.0
