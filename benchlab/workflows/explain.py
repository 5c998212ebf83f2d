"""`benchlab explain`: measurements and a simulation in; where they disagree, what is missing, and a model that has it, out."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from benchlab.discrepancy.base import Base
from benchlab.discrepancy.effects.catalogue import effects
from benchlab.discrepancy.every_fit import every_fit as fits_of
from benchlab.discrepancy.every_fit import measured_matrix
from benchlab.discrepancy.explain import Explained
from benchlab.discrepancy.measured import Measured, Summary
from benchlab.io.designs_table import designs_of_frame
from benchlab.io.experiment_protocol import protocol_of
from benchlab.io.layup_file import read_layup
from benchlab.io.measured_table import measured_of_frame
from benchlab.io.simulated_table import read_simulated
from benchlab.workflows.explain_answer import answer_of
from benchlab.workflows.explain_base import base_pressures, cell_base, foreign_base
from benchlab.workflows.explain_cache import default_cache
from benchlab.workflows.explain_measured import explain_measured

if TYPE_CHECKING:
    import pandas

DEFAULT_MATERIAL = "from-measured-angles"
"""Of the cell where none is given: the shipped film that was identified from what was measured."""


def explain_frame(
    frame: pandas.DataFrame,
    designs: pandas.DataFrame,
    *,
    seed: int = 1,
    simulation: Path | None = None,
    base: Base | None = None,
    cache: Path | None = None,
    jobs: int = 1,
    every_fit: bool = False,
    material: str = DEFAULT_MATERIAL,
) -> dict[str, Any]:
    """The answer of `benchlab explain --json` for tables in memory; nothing is written, `next_experiment.protocol` is the text of it.

    frame, designs: with the columns of MEASURED and --designs. base: in place of a simulation. every_fit: also each effect fitted alone,
    as tables of samples and features. Raises as the command.
    """
    measured, shapes = measured_of_frame(frame, "a table"), designs_of_frame(designs)
    if base is None:
        wanted = {name: shapes[name] for name in designs_in(measured) if name in shapes}
        cell = cell_base(
            wanted,
            read_layup(material),
            base_pressures(largest_MPa(measured)),
            forces="force_N" in quantities_in(measured),
            jobs=jobs,
            cache=cache or default_cache(),
        )
        base = cell if simulation is None else foreign_base(read_simulated(simulation), shapes, cell, simulation.name)
    found = explain_measured(measured, base, seed=seed)
    answer = answer_of(found.explanation)
    following = found.explanation.next_experiment
    if following is not None and following.experiment is not None:
        answer["next_experiment"]["protocol"] = protocol_of(following.experiment, largest_MPa(measured) * 1.1)
    return {**answer, "every_fit": _every_fit(found)} if every_fit else answer


def designs_in(measured: Measured | Summary) -> tuple[str, ...]:
    """Names of the measured designs, each once."""
    return tuple(dict.fromkeys(measured.design)) if isinstance(measured, Summary) else measured.designs


def quantities_in(measured: Measured | Summary) -> set[str]:
    """What was measured of them."""
    if isinstance(measured, Summary):
        return {measured.quantity}
    return {name for run in measured.runs for name, values in run.values.items() if np.isfinite(values).any()}


GAUGE_NOISE = 1.01
"""What lies less than this factor above a simulated pressure is noise of the gauge."""


def largest_MPa(measured: Measured | Summary) -> float:
    """Largest pressure, without the noise of the gauge: the 99.5th percentile of a run, so that like studies have the same simulation."""
    if isinstance(measured, Summary):
        return float(measured.pressure_MPa.max())
    return max(float(np.nanquantile(run.pressure_MPa, 0.995)) for run in measured.runs) / GAUGE_NOISE


def _every_fit(found: Explained) -> dict[str, Any] | None:
    """As rules that choose by a misfit alone take them. None where nothing can be fitted."""
    problem, judged = found.problem, found.explanation.judged_not
    fits = fits_of(problem, [effect for name, effect in effects().items() if name not in judged])
    return {
        "measured": measured_matrix(problem),
        "design": [problem.scene.names[design] for design in problem.features.sample_design],
        "fits": [
            {"effect": f.effect, "parameters": f.parameters, "predicted": f.predicted, "left_out": f.left_out}
            for f in fits
        ],
    }
