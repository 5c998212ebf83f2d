"""What `benchlab explain` writes: page, tables, figures, numbers, the model and the protocol of the next experiment. All of it or none."""

from __future__ import annotations

import os
import tempfile
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from importlib import import_module
from pathlib import Path
from typing import Any

from benchlab.discrepancy.effects.catalogue import effects
from benchlab.discrepancy.explanation import Explanation
from benchlab.io.files import sha256
from benchlab.io.layup_file import shipped_layups
from benchlab.io.model_file import (
    Measurement,
    ModelBase,
    ModelFile,
    ModelProvenance,
    digest_of,
    model_effects,
    write_model,
)
from benchlab.io.nexus import plain
from benchlab.io.protocol_file import read_protocol
from benchlab.protocol.plan import Plan
from benchlab.report.explain.document import NUMBERS, explain_document
from benchlab.report.explain.pictures import OVERVIEW, write_overview
from benchlab.report.explain.words import verdict_words
from benchlab.workflows.explain_answer import answer_of
from benchlab.workflows.explain_chosen import Chosen
from benchlab.workflows.explain_next import LONGEST_S, next_name, write_next
from benchlab.workflows.provenance import made_by
from benchlab.workflows.report_outputs import PAGE, ReportOutputs, names_of, write_report

SCHEMA = "benchlab.explanation/1"
MODEL = "model.yaml"
LIBRARIES = ("numpy", "scipy", "matplotlib", "jinja2")


@dataclass(frozen=True)
class ExplainOutputs(ReportOutputs):
    """explain.json vouches for the others."""

    names: tuple[str, ...] = (PAGE, NUMBERS)
    numbers: str = NUMBERS
    schema: str = SCHEMA


def written(
    explanation: Explanation,
    chosen: Chosen,
    inputs: Sequence[Path],
    outputs: ExplainOutputs,
    more: Mapping[str, Any],
) -> tuple[Explanation, dict[str, Any]]:
    """Write everything; returns the explanation with the path of its protocol, and the answer. more: further entries of it.

    Raises UsageError for what is in the way, InputError where the disk refuses; then nothing has changed.
    """
    for name in LIBRARIES:
        import_module(name)
    made = made_by(*LIBRARIES)
    sums = {path.name: sha256(path) for path in inputs if path.is_file()}
    text, plan = _protocol(explanation)
    if explanation.next_experiment is not None and explanation.next_experiment.experiment is not None:
        path = str(outputs.folder / next_name(explanation.next_experiment.experiment))
        explanation = replace(explanation, next_experiment=replace(explanation.next_experiment, protocol=path))
    model = model_of(explanation, chosen, sums, made, outputs.folder)
    there = {one.name for one in chosen.given}
    lacking = {name: effect for name, effect in effects().items() if name not in there}
    document = explain_document(explanation, lacking, made, sums, plan)
    beside = [OVERVIEW, *[MODEL] * (model is not None), *[Path(path).name for path in [_path(explanation)] if path]]
    outputs = replace(outputs, names=names_of(document, beside=beside, numbers=NUMBERS))
    outputs.check(overlay=False, inputs=inputs)

    def write_beside(folder: Path) -> None:
        write_overview(explanation, folder / OVERVIEW)
        if model is not None:
            write_model(folder / MODEL, model)
        if text:
            (folder / Path(_path(explanation)).name).write_text(text, encoding="utf-8")

    answer = answer_of(explanation, str(outputs.folder / MODEL) if model is not None else None)
    numbers: Any = plain({"schema": SCHEMA, **answer, **more, "inputs": sums, "provenance": made})
    whole = write_report(outputs, document, numbers, write_beside)
    return explanation, {**whole, "outputs": [str(path) for path in outputs.paths()]}


def model_of(
    explanation: Explanation, chosen: Chosen, sums: Mapping[str, str], made: Mapping[str, Any], folder: Path
) -> ModelFile | None:
    """The base with all effects, those that it had and those that were found; None where none was found."""
    if not explanation.effects:
        return None
    words = verdict_words(explanation)
    if explanation.verdict == "ambiguous":
        words = f"The best of several that cannot be told apart. {words}"
    return ModelFile(
        ModelBase(chosen.kind, _beside(chosen.source, folder), digest_of(chosen.kind, chosen.source)),
        (*chosen.given, *model_effects(explanation.effects)),
        ModelProvenance(
            made_by=f"benchlab {made['versions']['benchlab']}",
            date=made["created"],
            measured=tuple(Measurement(name, digest) for name, digest in sums.items()),
            simulated=explanation.simulated,
            explained=words,
        ),
    )


def _beside(source: str, folder: Path) -> str:
    """A source as the model file names it: a shipped layup by its name, a file as from the model's folder."""
    if source.strip().lower() in shipped_layups() and not Path(source).exists():
        return source
    try:
        return Path(os.path.relpath(source, folder)).as_posix()
    except ValueError:  # another drive
        return str(Path(source).resolve())


def _path(explanation: Explanation) -> str:
    following = explanation.next_experiment
    return following.protocol if following is not None and following.experiment is not None else ""


def _protocol(explanation: Explanation) -> tuple[str, Plan | None]:
    """Text and plan of the next experiment; empty and None where there is none."""
    following = explanation.next_experiment
    if following is None or following.experiment is None:
        return "", None
    with tempfile.TemporaryDirectory() as folder:
        path = Path(write_next(Path(folder), following).protocol)
        return path.read_text(encoding="utf-8"), read_protocol(path, LONGEST_S)
