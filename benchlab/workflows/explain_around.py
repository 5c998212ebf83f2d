"""`benchlab explain --loop` as a whole: the base, the lab, round after round, and the report of all that was measured."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from benchlab.discrepancy.base import Base
from benchlab.discrepancy.experiment import BenchLimits
from benchlab.discrepancy.explain import Explained
from benchlab.discrepancy.explanation import Explanation
from benchlab.errors import UsageError
from benchlab.io.measured_table import read_measured
from benchlab.workflows.explain import ExplainedFiles, ExplainSettings, Tell, finished
from benchlab.workflows.explain_chosen import Wanted, choose_base
from benchlab.workflows.explain_loop import LoopSettings, explain_loop, lab_of
from benchlab.workflows.explain_measured import explain_measured
from benchlab.workflows.explain_outputs import ExplainOutputs
from benchlab.workflows.run_prepare import RunSettings

TOP_MPa = 0.35
"""Up to which designs are simulated, the paper's largest pressure."""


@dataclass(frozen=True)
class AroundSettings:
    """explain: of every round. loop: samples, rounds, minutes. run: bench, calibration. film, twin: of a twin."""

    explain: ExplainSettings
    loop: LoopSettings
    run: RunSettings = field(default_factory=RunSettings)
    film: bool = False
    twin: Path | None = None


def explain_around(settings: AroundSettings, ask: Callable[[str], object], tell: Tell) -> ExplainedFiles:
    """Go round, and write the report of all rounds beside them. ask: of whoever mounts samples.

    Raises UsageError and InputError for what cannot begin, BenchError from the bench; what was measured is kept.
    """
    asked, out = settings.explain, settings.loop.out
    if asked.choice.designs is None and asked.choice.simulation is None:
        raise UsageError("no design to measure", hint="give --designs, as a table with columns design, tw_mm, slw_mm")
    settings.loop.check()
    outputs = ExplainOutputs(out, "explain", asked.overwrite)
    outputs.check(overlay=False, inputs=asked.choice.reads)
    chosen = choose_base(
        Wanted((), TOP_MPa), asked.choice, progress=lambda done, total: tell("simulating designs", done, total)
    )
    lab = lab_of(settings.run, chosen.base, ask, seed=asked.seed, film=settings.film, twin=settings.twin)
    last: list[Explained] = []

    def explainer(tables: Sequence[Path], base: Base, limits: BenchLimits) -> Explanation:
        found = explain_measured(read_measured(tables), base, seed=asked.seed, limits=limits)
        last[:] = [found]
        return found.explanation

    with outputs.locked():
        loop = explain_loop(settings.loop, lab, chosen.base, explainer, lambda words: tell(words, 0, None))
        tables = [one.round.table for one in loop.rounds]
        extra: dict[str, Any] = {"loop": loop.as_json()}
        return finished(last[0], chosen, (*tables, *asked.choice.reads), outputs, tell, extra)
