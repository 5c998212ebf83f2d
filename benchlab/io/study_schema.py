"""The keys of a whole study file, and what has to hold between them; `study_file` makes a `Study` of it."""

from __future__ import annotations

import difflib
import os
import unicodedata
from collections.abc import Iterator
from pathlib import PurePath
from typing import Any, Literal

from pydantic import Field, ValidationError, model_validator
from pydantic_core import InitErrorDetails, PydanticCustomError

from benchlab.io.study_analysis import AnalysisDocument
from benchlab.io.study_parts import (
    ForceDocument,
    Name,
    Positive,
    Pressure,
    SampleDocument,
    ShellDocument,
    SimulatedDocument,
    in_full,
    kind_of,
)
from benchlab.io.study_values import ALL_DESIGNS
from benchlab.io.yaml_commas import Place
from benchlab.io.yaml_file import Document

Wrong = tuple[Place, object, str]
"""Where in the file, what stands there, and what is wrong with it."""


class DesignDocument(Document):
    """One design with its samples."""

    shell: ShellDocument | None = None
    simulated: SimulatedDocument | None = None
    analysis: AnalysisDocument = AnalysisDocument()
    samples: dict[Name, SampleDocument] = Field(default_factory=dict)
    force: ForceDocument | None = None
    notes: str = ""


class SetDocument(Document):
    """Designs that are compared with each other."""

    designs: list[str] = Field(min_length=1)
    title: str = ""
    x: Literal["tw_mm", "slw_mm", "fw_mm", "perimeter_mm", "length_mm"] | None = None

    @model_validator(mode="before")
    @classmethod
    def _short(cls, value: Any) -> Any:
        return in_full(value, {list: "designs"}, "a list of designs, or a mapping with `designs:`")


class StudyDocument(Document):
    """The whole file."""

    title: str
    pressure_MPa: Pressure
    hold_tolerance_MPa: Positive | None = None
    notes: str = ""
    analysis: AnalysisDocument = AnalysisDocument()
    designs: dict[Name, DesignDocument] = Field(min_length=1)
    sets: dict[Name, SetDocument] = Field(default_factory=dict)

    @model_validator(mode="after")
    def _whole(self) -> StudyDocument:
        wrong = [*_wrong_sets(self), *_wrong_names(self), *_wrong_files(self)]
        if wrong:
            raise ValidationError.from_exception_data("study", [_at(*each) for each in wrong])
        return self


def _wrong_sets(study: StudyDocument) -> Iterator[Wrong]:
    for name, chosen in study.sets.items():
        if name.casefold() == ALL_DESIGNS:
            yield ("sets", name), list(chosen.designs), "every study has this set by itself: remove or rename it"
        for index, design in enumerate(chosen.designs):
            # In the short form the list is the set itself; a part of a place without a line is passed over.
            place = ("sets", name, "designs", index)
            if design not in study.designs:
                close = difflib.get_close_matches(design, list(study.designs), n=1)
                yield place, design, "is no design of this study" + (f"; did you mean {close[0]}?" if close else "")
            elif design in chosen.designs[:index]:
                yield place, design, "stands twice in this set"


def _wrong_names(study: StudyDocument) -> Iterator[Wrong]:
    """Names that some disks take for the same: of designs, and of the samples of one."""
    for place, names in [
        (("designs",), list(study.designs)),
        *((("designs", name, "samples"), list(design.samples)) for name, design in study.designs.items()),
    ]:
        seen: dict[str, str] = {}
        for name in names:
            first = seen.setdefault(unicodedata.normalize("NFC", name).casefold(), name)
            if first != name:
                yield (*place, name), name, f"would have the same folder as {first!r}: rename one of them"


def _wrong_files(study: StudyDocument) -> Iterator[Wrong]:
    """Recordings and force files that stand twice. A table may serve several samples, by its columns design and sample."""
    seen: dict[str, str] = {}
    for design, item in study.designs.items():
        for sample, made in item.samples.items():
            own: set[str] = set()
            for index, recording in enumerate(made.recordings):
                path = os.path.normpath(recording.file)
                first = seen.setdefault(path, f"{design} {sample}")
                if path in own or (first != f"{design} {sample}" and kind_of(PurePath(path)) != "table"):
                    place: Place = ("designs", design, "samples", sample, "recordings", index)
                    yield place, recording.file, f"is a recording of {first} already: name each recording once"
                own.add(path)
        actuators: set[str] = set()
        for index, record in enumerate(item.force.files if item.force else ()):
            place = ("designs", design, "force", "files", index)
            if (first := seen.setdefault(f"force {os.path.normpath(record.file)}", design)) != design:
                yield place, record.file, f"is a force file of {first} already"
            elif record.actuator_name in actuators:
                yield place, record.actuator_name, f"is an actuator of {design} already: one file an actuator"
            actuators.add(record.actuator_name)


def _at(place: Place, value: object, what: str) -> InitErrorDetails:
    error = PydanticCustomError("value_error", "Value error, {what}", {"what": what})
    return InitErrorDetails(type=error, loc=place, input=value)
