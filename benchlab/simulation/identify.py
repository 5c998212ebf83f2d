"""Film coefficients from bending angles: what a film must be like for the cells of several designs to bend as they do."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from scipy.optimize import least_squares

from benchlab.actuator import ShellDesign
from benchlab.errors import InputError, UsageError
from benchlab.simulation.cell import Cell, State
from benchlab.simulation.laws import Law, Polynomial
from benchlab.simulation.laws.law import FloatArray
from benchlab.simulation.layup import Layup
from benchlab.simulation.newton import minimise
from benchlab.simulation.response import follow

_RAMP = np.array([0.06, 0.2, 0.45, 0.7, 1.0])
_STEP = 1e-3


@dataclass(frozen=True)
class Target:
    """A bending angle (degrees) of a design at a pressure."""

    design: ShellDesign
    pressure_MPa: float
    angle_deg: float


@dataclass(frozen=True)
class Identified:
    """The layup with the identified coefficients (MPa, by name), simulated − target angles (degrees), their RMSE, and the
    standard deviations of the logarithms of the coefficients (from the residuals, linearised; NaN with none to spare)."""

    layup: Layup
    coefficients_MPa: dict[str, float]
    residual_deg: FloatArray
    rmse_deg: float
    log_sd: dict[str, float]


class AngleModel:
    """Angles of several targets for one film after the other; each starts from the state found for the film before."""

    def __init__(self, layup: Layup, targets: Sequence[Target]) -> None:
        self.layup, self.targets = layup, tuple(targets)
        self._states: dict[int, State] = {}

    def angles_deg(self, film: Law) -> FloatArray:
        """Simulated angles of all targets; NaN where no stable state is found."""
        layup = replace(self.layup, film=film)
        return np.array([self._angle(number, target, layup) for number, target in enumerate(self.targets)])

    def _angle(self, number: int, target: Target, layup: Layup) -> float:
        cell = Cell.of(target.design, layup)
        if number in self._states:
            solved = minimise(lambda at: cell.potential(at, target.pressure_MPa), self._states[number])
            if solved.converged:
                self._states[number] = solved.state
                return float(np.degrees(solved.state.k * target.design.length_mm))
        path = follow(cell, list(target.pressure_MPa * _RAMP))
        if path.limit_pressure_MPa is not None:
            return float("nan")
        self._states[number] = path.points[-1].state
        return float(np.degrees(path.points[-1].state.k * target.design.length_mm))


def identify_film(
    targets: Sequence[Target], layup: Layup, names: Sequence[str], model: AngleModel | None = None
) -> Identified:
    """Least squares in the logarithms of the named coefficients of layup.film, from their present values, others kept.

    model: of the same targets, to start from its states. Raises UsageError where there are fewer targets than
    coefficients or a coefficient starts at 0, InputError where some target's design has no stable state at the start.
    """
    if not isinstance(layup.film, Polynomial):
        raise UsageError("only polynomial films are identified from angles", hint="start from a polynomial law")
    film = layup.film
    start = np.array([getattr(film, name) for name in names])
    if len(targets) < len(names) or not (start > 0).all():
        raise UsageError(
            f"{len(targets)} angles for the coefficients {', '.join(names)} from {start.tolist()}",
            hint="give at least as many angles as coefficients, and start from positive values",
        )
    wanted = np.array([target.angle_deg for target in targets])
    model = model or AngleModel(layup, targets)

    def film_of(logs: FloatArray) -> Polynomial:
        return replace(film, **dict(zip(names, np.exp(logs).tolist())))

    def residual(logs: FloatArray) -> FloatArray:
        found = model.angles_deg(film_of(logs)) - wanted
        # A film that bursts is far from every angle; the search turns back.
        return np.where(np.isnan(found), 180.0, found)

    if np.isnan(first := model.angles_deg(film)).any():
        burst = targets[int(np.flatnonzero(np.isnan(first))[0])]
        raise InputError(
            f"{burst.design.name} has no stable state at {burst.pressure_MPa:g} MPa with the film to start from",
            hint="start from a stiffer film",
        )
    found = least_squares(residual, np.log(start), diff_step=_STEP, xtol=1e-6, ftol=1e-6, max_nfev=30)
    spare = len(wanted) - len(names)
    covariance = np.linalg.inv(found.jac.T @ found.jac) * (found.fun @ found.fun / spare if spare else np.nan)
    values = np.exp(found.x).tolist()
    return Identified(
        layup=replace(layup, film=film_of(found.x)),
        coefficients_MPa=dict(zip(names, values)),
        residual_deg=found.fun,
        rmse_deg=float(np.sqrt(np.mean(found.fun**2))),
        log_sd=dict(zip(names, np.sqrt(np.diag(covariance)).tolist())),
    )


def leave_one_out(targets: Sequence[Target], layup: Layup, names: Sequence[str]) -> FloatArray:
    """Simulated − target angle (degrees) of each target, with the coefficients identified on all others."""
    errors = np.empty(len(targets))
    for out, target in enumerate(targets):
        others = [other for number, other in enumerate(targets) if number != out]
        found = identify_film(others, layup, names)
        errors[out] = AngleModel(found.layup, [target]).angles_deg(found.layup.film)[0] - target.angle_deg
    return errors
