"""Model files as strict YAML: a base, the effects that it lacks with their numbers, and where they are from.

    base:
      kind: cell                          the shell cell; beam, the one-dimensional model; foreign, simulated curves from a file
      source: from-measured-angles        layup, by its name or a file; of a foreign base its file. Beside this file, where it is relative
      sha256: 9f86d0…                     of that file; of a layup by name, of what it says
    effects:                              in the order in which they act
      - name: friction
        form: plain
        parameters:
          half_width_deg: {value: 1.52, low: 1.21, high: 1.84, unit: deg}      95 % interval, null where the data do not bound it
          grows: {value: 0.8, low: null, high: null, unit: ""}
    provenance:
      made_by: benchlab 0.1.0
      date: "2024-05-01T12:00:00+00:00"
      measured: [{file: loops.csv, sha256: 60303a…}]
      simulated: false                    whether those were measured on a twin
      explained: in words

Names, forms, parameters, units and bounds of effects: benchlab/discrepancy/effects, and those of installed packages.
"""

from __future__ import annotations

import hashlib
import json
import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Literal

from pydantic import Field

from benchlab.discrepancy.effects.catalogue import effects as known_effects
from benchlab.discrepancy.effects.effect import Active, Effect
from benchlab.discrepancy.explanation import Estimate, Found
from benchlab.errors import InputError, printable
from benchlab.io.files import sha256
from benchlab.io.layup_file import layup_document, read_layup, shipped_layups
from benchlab.io.yaml_file import Document, read_document_with_lines, refused, write_document
from benchlab.io.yaml_words import Told

ABOUT = """\
A model: a simulation and the effects that it lacks, as `benchlab explain` found them or as somebody chose them.
`benchlab simulate`, `sweep`, `run --bench twin` and a further `explain` take it with --model."""

KINDS = ("cell", "beam", "foreign")


@dataclass(frozen=True)
class ModelBase:
    """kind: one of KINDS. source: layup by name or file, or file of foreign curves, as the model file has it. sha256: `digest_of` it."""

    kind: str
    source: str
    sha256: str


@dataclass(frozen=True)
class ModelEffect:
    """An effect with its numbers, each with the interval in which it is known."""

    name: str
    form: str
    parameters: Mapping[str, Estimate]

    @property
    def active(self) -> Active:
        values = {name: estimate.value for name, estimate in self.parameters.items()}
        return Active(known_effects()[self.name], values, self.form)


@dataclass(frozen=True)
class Measurement:
    """A file of measurements that a model rests on, by its name."""

    file: str
    sha256: str


@dataclass(frozen=True)
class ModelProvenance:
    """made_by: program and version. date: ISO 8601. simulated: whether the measurements are a twin's. explained: what, in words."""

    made_by: str
    date: str
    measured: tuple[Measurement, ...] = ()
    simulated: bool = False
    explained: str = ""


@dataclass(frozen=True)
class ModelFile:
    """All that a model file says."""

    base: ModelBase
    effects: tuple[ModelEffect, ...]
    provenance: ModelProvenance

    @property
    def actives(self) -> tuple[Active, ...]:
        return tuple(effect.active for effect in self.effects)


class _Base(Document):
    kind: Literal["cell", "beam", "foreign"]
    source: str = Field(min_length=1)
    sha256: str = Field(pattern="^[0-9a-f]{64}$")


class _Number(Document):
    value: float
    low: float | None = None
    high: float | None = None
    unit: str


class _Effect(Document):
    name: str
    form: str = "plain"
    parameters: dict[str, _Number]


class _Measurement(Document):
    file: str
    sha256: str = Field(pattern="^[0-9a-f]{64}$")


class _Provenance(Document):
    made_by: str
    date: str
    measured: tuple[_Measurement, ...] = ()
    simulated: bool = False
    explained: str = ""


class _Model(Document):
    base: _Base
    effects: tuple[_Effect, ...]
    provenance: _Provenance


def read_model(path: Path) -> ModelFile:
    """The model in a file. Files that it names are not opened (`check_source`).

    Raises UsageError for a missing file, InputError with the line of everything that is wrong: unknown effects, forms and parameters,
    those that are missing or twice, units and bounds.
    """
    found, lines = read_document_with_lines(path, _Model)
    told: list[Told] = [
        (f"line {lines.get(('effects', number, *place), 1)}", what, remedy)
        for number, effect in enumerate(found.effects)
        for place, what, remedy in _faults(effect, [other.name for other in found.effects[:number]], found.base.kind)
    ]
    if told:
        raise refused(path, told)
    known = known_effects()
    return ModelFile(
        ModelBase(**found.base.model_dump()),
        tuple(_effect(each, known[each.name]) for each in found.effects),
        ModelProvenance(
            **{
                **found.provenance.model_dump(),
                "measured": tuple(Measurement(each.file, each.sha256) for each in found.provenance.measured),
            }
        ),
    )


def write_model(path: Path, model: ModelFile) -> None:
    """Write a model so that `read_model` gives the same again, whole or not at all. InputError where the disk refuses.

    Raises ValueError for a model that `read_model` would refuse.
    """
    document = model_document(model)
    found = _Model.model_validate_json(json.dumps(document))
    for number, effect in enumerate(found.effects):
        names = [other.name for other in found.effects[:number]]
        for _, what, _ in _faults(effect, names, found.base.kind):
            raise ValueError(what)
    write_document(path, document, ABOUT)


def model_document(model: ModelFile) -> dict[str, Any]:
    """A model as plain data, in the order of the file."""
    made = model.provenance
    return {
        "base": dict(vars(model.base)),
        "effects": [
            {
                "name": effect.name,
                "form": effect.form,
                "parameters": {name: _number(each) for name, each in effect.parameters.items()},
            }
            for effect in model.effects
        ],
        "provenance": {
            "made_by": made.made_by,
            "date": made.date,
            "measured": [dict(vars(each)) for each in made.measured],
            "simulated": made.simulated,
            "explained": made.explained,
        },
    }


def model_effects(found: Sequence[Found]) -> tuple[ModelEffect, ...]:
    """What was found, as a model file has it."""
    return tuple(ModelEffect(each.name, each.form, dict(each.parameters)) for each in found)


def digest_of(kind: str, source: str | Path) -> str:
    """SHA-256 of what a base rests on: of a file its bytes, of a shipped layup its document. InputError for what is neither."""
    name = str(source).strip().lower()
    if kind != "foreign" and name in shipped_layups():
        return hashlib.sha256(json.dumps(layup_document(read_layup(name)), sort_keys=True).encode()).hexdigest()
    if not Path(source).exists():
        known = f"; or one of {', '.join(shipped_layups())}" if kind != "foreign" else ""
        raise InputError("no such file", file=source, hint=f"put it beside the model file{known}")
    return sha256(Path(source))


def check_source(path: Path, model: ModelFile) -> str:
    """What the model in the file `path` rests on: the name of a layup, or the path of a file as seen from here.

    Raises InputError where it is not there, or not what it was when the model was made.
    """
    base = model.base
    named = base.kind != "foreign" and base.source.strip().lower() in shipped_layups()
    source = base.source if named else str(path.parent / base.source)
    if (found := digest_of(base.kind, source)) != base.sha256:
        digests = f"sha256 {found[:12]}…, not {base.sha256[:12]}…"
        what = f"its base {printable(base.source)!r} is not the one that the model was made with ({digests})"
        raise InputError(what, file=path, where="base", hint="put the old one beside the model, or explain anew")
    return source


def _effect(found: _Effect, effect: Effect) -> ModelEffect:
    """With its parameters in the order of the effect."""
    about = {each.name: each for each in effect.parameters}
    return ModelEffect(
        found.name,
        found.form,
        {
            name: Estimate(
                number.value,
                math.nan if number.low is None else number.low,
                math.nan if number.high is None else number.high,
                number.unit,
                each.what,
                number.value in (each.low, each.high),
            )
            for name, each in about.items()
            for number in [found.parameters[name]]
        },
    )


def _number(estimate: Estimate) -> dict[str, Any]:
    low, high = (None if math.isnan(end) else float(end) for end in (estimate.low, estimate.high))
    return {"value": float(estimate.value), "low": low, "high": high, "unit": estimate.unit}


_Fault = tuple[tuple[str, ...], str, str]
"""Place within the effect, what is wrong, the remedy."""


def _faults(found: _Effect, before: Sequence[str], kind: str) -> Iterator[_Fault]:
    known = known_effects()
    if found.name not in known:
        yield ("name",), f"no effect is called {printable(found.name)!r}", f"use one of {', '.join(known)}"
        return
    if found.name in before:
        yield ("name",), f"effect {found.name} stands there twice", "keep one of them"
    if found.name == "window_ballooning" and kind != "beam":
        yield ("name",), f"window_ballooning is what a beam lacks, and the base is {kind}", "remove it"
    effect = known[found.name]
    if found.form not in effect.forms:
        yield (
            ("form",),
            f"{found.name} has no form {printable(found.form)!r}",
            f"use one of {', '.join(effect.forms)}",
        )
    names = [each.name for each in effect.parameters]
    for name in found.parameters:
        if name not in names:
            yield (
                ("parameters", name),
                f"{found.name} has no parameter {printable(name)!r}",
                f"it has {', '.join(names)}",
            )
    for about in effect.parameters:
        place = ("parameters", about.name)
        if about.name not in found.parameters:
            yield (
                ("parameters",),
                f"{found.name} is without {about.name}",
                f"give it, {about.low:g} to {about.high:g} {about.unit}".rstrip(),
            )
            continue
        number = found.parameters[about.name]
        if number.unit != about.unit:
            yield (*place, "unit"), f"{about.name} is told in {number.unit!r}", f"its unit is {about.unit!r}"
        if not about.low <= number.value <= about.high:
            yield (
                (*place, "value"),
                f"{about.name} is {number.value:g}",
                f"give {about.low:g} to {about.high:g} {about.unit}".rstrip(),
            )
        low, high = (-math.inf if number.low is None else number.low, math.inf if number.high is None else number.high)
        if not low <= number.value <= high:
            yield (
                place,
                f"{about.name} is {number.value:g}, outside of its interval {low:g} to {high:g}",
                "give an interval that holds it",
            )
