"""`benchlab explain`: measurements and a simulation in; where they disagree, what is missing, and a model that has it, out."""

from __future__ import annotations

import contextlib
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from benchlab.discrepancy.base import Base
from benchlab.discrepancy.effects.catalogue import effects
from benchlab.discrepancy.every_fit import every_fit as fits_of
from benchlab.discrepancy.every_fit import measured_matrix
from benchlab.discrepancy.explain import Explained
from benchlab.discrepancy.explanation import Explanation
from benchlab.discrepancy.measured import Measured, Summary
from benchlab.errors import UsageError
from benchlab.io.designs_table import designs_of_frame
from benchlab.io.experiment_protocol import protocol_of
from benchlab.io.hdf5 import is_hdf5
from benchlab.io.layup_file import read_layup
from benchlab.io.measured_table import measured_of_frame
from benchlab.io.simulated_table import read_simulated
from benchlab.workflows.explain_answer import answer_of
from benchlab.workflows.explain_base import base_pressures, cell_base, foreign_base
from benchlab.workflows.explain_cache import default_cache
from benchlab.workflows.explain_chosen import DEFAULT_MATERIAL, Choice, Chosen, Wanted, choose_base
from benchlab.workflows.explain_measured import explain_measured
from benchlab.workflows.explain_next import LIMIT_MPa
from benchlab.workflows.explain_outputs import ExplainOutputs, written
from benchlab.workflows.explain_read import read_explained
from benchlab.workflows.explain_surrogate import surrogate_error
from benchlab.workflows.explain_units import check_units

if TYPE_CHECKING:
    import pandas

GAUGE_NOISE = 1.01
"""What lies less than this factor above a simulated pressure is noise of the gauge."""

Tell = Callable[[str, int, int | None], None]
"""What is being done, and how much of it: done, in all (None where unknown)."""


def _silent(words: str, done: int, total: int | None) -> None:
    pass


@dataclass(frozen=True)
class ExplainSettings:
    """What the options of `benchlab explain` say. out: folder of the results; None: nothing is written."""

    choice: Choice = field(default_factory=Choice)
    out: Path | None = None
    against: tuple[str, ...] = ()
    pattern: str | None = None
    seed: int = 1
    overwrite: bool = False


@dataclass(frozen=True)
class ExplainedFiles:
    """What was found, as objects for the terminal and as the JSON answer."""

    explanation: Explanation
    answer: dict[str, Any]


def explain(paths: Sequence[Path], settings: ExplainSettings, tell: Tell = _silent) -> ExplainedFiles:
    """Explain what the files hold, and write report, numbers, model and next protocol into `out`, all or none.

    Raises UsageError, InputError and BatchError; then nothing was written.
    """
    settings.choice.check()
    if settings.seed < 0:
        raise UsageError(f"--seed is {settings.seed}", hint="give 0 or more")
    read = (*paths, *settings.choice.reads)
    if settings.out is None:
        return _explained(paths, settings, tell, None)
    outputs = ExplainOutputs(settings.out, "explain", settings.overwrite)
    fresh = not settings.out.exists()
    try:
        outputs.check(overlay=False, inputs=read)
        with outputs.locked():
            return _explained(paths, settings, tell, outputs)
    except BaseException:
        if fresh:
            with contextlib.suppress(OSError):  # not empty, or never made
                settings.out.rmdir()
        raise


def _explained(
    paths: Sequence[Path], settings: ExplainSettings, tell: Tell, outputs: ExplainOutputs | None
) -> ExplainedFiles:
    choice = settings.choice
    tell("reading", 0, None)
    measured = read_explained(
        paths,
        choice.columns,
        settings.against,
        settings.pattern,
        settings.out,
        choice.jobs,
        lambda done, total: tell("analysing recordings", done, total),
    )
    tables = [path for path in paths if path.is_file() and not is_hdf5(path)]
    wanted = Wanted(designs_in(measured), largest_MPa(measured), "force_N" in quantities_in(measured), tables)
    chosen = choose_base(wanted, choice, paths, lambda done, total: tell("simulating designs", done, total))
    check_units(measured, chosen.base, wanted.largest_MPa)
    found = explain_measured(measured, chosen.base, seed=settings.seed, progress=lambda words: tell(words, 0, None))
    return finished(found, chosen, (*paths, *choice.reads), outputs, tell)


def finished(
    found: Explained,
    chosen: Chosen,
    inputs: Sequence[Path],
    outputs: ExplainOutputs | None,
    tell: Tell = _silent,
    extra: Mapping[str, Any] | None = None,
) -> ExplainedFiles:
    """The answer, and its files where there are outputs. inputs: files that it rests on. extra: further entries of the answer."""
    tell("checking the simulation of what was named", 0, None)
    error, doubts = surrogate_error(found, chosen)
    warnings = (*chosen.told, *chosen.base.warnings, *found.explanation.warnings, *doubts)
    explanation = replace(found.explanation, warnings=tuple(dict.fromkeys(warnings)))
    more = {"simulation_error": error, **(extra or {})}
    if outputs is None:
        return ExplainedFiles(explanation, {**answer_of(explanation), **more})
    tell("writing the report", 0, None)
    return ExplainedFiles(*written(explanation, chosen, inputs, outputs, more))


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
    propose: bool = True,
    material: str = DEFAULT_MATERIAL,
) -> dict[str, Any]:
    """The answer of `benchlab explain --json` for tables in memory; nothing is written, `next_experiment.protocol` is the text of it.

    frame, designs: with the columns of MEASURED and --designs. base: in place of a simulation. every_fit: also each effect fitted alone,
    as tables of samples and features. propose: also the next experiment. Raises as the command.
    """
    measured, shapes = measured_of_frame(frame, "a table"), designs_of_frame(designs)
    if base is None:
        cell = cell_base(
            {name: shapes[name] for name in designs_in(measured) if name in shapes},
            read_layup(material),
            base_pressures(largest_MPa(measured)),
            forces="force_N" in quantities_in(measured),
            jobs=jobs,
            cache=cache or default_cache(),
        )
        base = cell if simulation is None else foreign_base(read_simulated(simulation), shapes, cell, simulation.name)
    found = explain_measured(measured, base, seed=seed, propose=propose)
    answer = answer_of(found.explanation)
    following = found.explanation.next_experiment
    if following is not None and following.experiment is not None:
        known = following.expected_sd if np.isfinite(following.expected_sd) else None
        top = max(float(following.experiment.trace()[1].max()), LIMIT_MPa)
        answer["next_experiment"]["protocol"] = protocol_of(following.experiment, top, following.separates, known)
    return {**answer, "every_fit": _every_fit(found)} if every_fit else answer


def designs_in(measured: Measured | Summary) -> tuple[str, ...]:
    """Names of the measured designs, each once."""
    return tuple(dict.fromkeys(measured.design)) if isinstance(measured, Summary) else measured.designs


def quantities_in(measured: Measured | Summary) -> set[str]:
    """What was measured of them."""
    if isinstance(measured, Summary):
        return {measured.quantity}
    return {name for run in measured.runs for name, values in run.values.items() if np.isfinite(values).any()}


def largest_MPa(measured: Measured | Summary) -> float:
    """Largest pressure, without the noise of the gauge: the 99.5th percentile of a run, so that like studies have the same simulation."""
    if isinstance(measured, Summary):
        return float(measured.pressure_MPa.max())
    return max(float(np.nanquantile(run.pressure_MPa, 0.995)) for run in measured.runs) / GAUGE_NOISE


def _every_fit(found: Explained) -> dict[str, Any]:
    """As rules that choose by a misfit alone take them; no fit where it is not known how samples scatter."""
    problem, judged = found.problem, found.explanation.judged_not
    usable = [effect for name, effect in effects().items() if name not in judged]
    fits = [] if found.explanation.only_described else fits_of(problem, usable)
    return {
        "measured": measured_matrix(problem),
        "design": [problem.scene.names[design] for design in problem.features.sample_design],
        "fits": [
            {"effect": f.effect, "parameters": f.parameters, "predicted": f.predicted, "left_out": f.left_out}
            for f in fits
        ],
    }
