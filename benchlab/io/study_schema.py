"""The keys of a study file, their types and what they may be; `study_file` makes a `Study` of them.

Short forms, put in full before they are checked: a text stands for a recording (its file), a sample (its one recording), a simulation
(its file) or a force file; a list stands for the recordings of a sample, the files of a force test or the designs of a set.
"""

from __future__ import annotations

import difflib
import re
from collections.abc import Iterator
from typing import Annotated, Any, Literal

from pydantic import AfterValidator, Field, ValidationError, field_validator, model_validator
from pydantic_core import InitErrorDetails, PydanticCustomError

from benchlab.actuator import DIMENSIONS, ShellDesign
from benchlab.errors import BenchlabError
from benchlab.io.pressure import MAX_PRESSURE_MPA, ramp
from benchlab.io.study_values import ALL_DESIGNS
from benchlab.io.yaml_file import Document

MAX_NAME = 80
"""Characters in the name of a design or a sample, which is also that of a folder."""

_NOT_IN_NAMES = re.compile(r'[/\\:*?"<>|]')


def _stated(text: str) -> str:
    if not text.strip():
        raise ValueError("say why, in words")
    return text.strip()


def _name(text: str) -> str:
    if not text or len(text) > MAX_NAME or not text.isprintable() or _NOT_IN_NAMES.search(text):
        raise ValueError(f'name it in 1 to {MAX_NAME} characters, without / \\ : * ? " < > |')
    if text != text.strip() or text.startswith("."):
        raise ValueError("a name has no blank at its ends and no dot at its start")
    return text


Name = Annotated[str, AfterValidator(_name)]
Words = Annotated[str, AfterValidator(_stated)]
File = Annotated[str, Field(min_length=1)]
Pressure = Annotated[float, Field(gt=0, le=MAX_PRESSURE_MPA)]
Positive = Annotated[float, Field(gt=0)]


class AnalysisDocument(Document):
    """Settings of `benchlab analyze`, under the names of its options."""

    length_mm: Positive | None = None
    markers: int | None = None
    colour: str | None = None
    threshold: float | None = None
    roi_px: list[float] | None = Field(default=None, min_length=4, max_length=4)
    fit: Literal["kasa", "pratt", "taubin", "hyper", "geometric"] | None = None
    flip: bool | None = None
    scale_mm_per_px: Positive | None = None
    reference_mm: Positive | None = None
    reference_px: list[float] | None = Field(default=None, min_length=4, max_length=4)
    marker_span_mm: Positive | None = None
    aruco_mm: Positive | None = None
    aruco_dictionary: str | None = None
    lens: File | None = None
    pressure: File | None = None
    ramp: str | None = None
    sync: float | Literal["onset"] | None = None
    stream: int | None = None
    fps: Positive | None = None
    capture_fps: Positive | None = None
    fast: bool | None = None
    allow_partial: bool | None = None
    max_pixels: int | None = None
    max_missing: float | None = None

    @field_validator("ramp")
    @classmethod
    def _is_ramp(cls, text: str | None) -> str | None:
        if text is not None:
            try:
                ramp(text)
            except BenchlabError as error:
                raise ValueError(f"{error.what}; {error.hint}") from None
        return text


class RecordingDocument(Document):
    """One video, folder of stills, run file or table of angles."""

    file: File
    analysis: AnalysisDocument = AnalysisDocument()
    left_out: Words = ""

    @model_validator(mode="before")
    @classmethod
    def _short(cls, value: Any) -> Any:
        return _full(value, {str: "file"}, "the path of a recording, or a mapping with `file:`")


class SampleDocument(Document):
    """One made actuator."""

    recordings: list[RecordingDocument] = Field(default_factory=list)
    analysis: AnalysisDocument = AnalysisDocument()
    notes: str = ""
    left_out: Words = ""

    @model_validator(mode="before")
    @classmethod
    def _short(cls, value: Any) -> Any:
        value = _full(value, {str: "recordings", list: "recordings"}, "recordings, or a mapping with `recordings:`")
        return _listed(value, "recordings")


class SimulatedDocument(Document):
    """A file of `benchlab simulate` or `benchlab sweep`, or an angle and who says so."""

    file: File | None = None
    angle_deg: float | None = None
    source: Words = ""

    @model_validator(mode="before")
    @classmethod
    def _short(cls, value: Any) -> Any:
        return _full(value, {str: "file"}, "the path of a response file, or `{angle_deg: ..., source: ...}`")

    @model_validator(mode="after")
    def _one(self) -> SimulatedDocument:
        if (self.file is None) == (self.angle_deg is None):
            raise ValueError("give either a file or angle_deg")
        if self.angle_deg is not None and not self.source:
            raise ValueError("say where the angle is from, with `source:`")
        return self


class ForceSettings(Document):
    """How the pressure of a force record is known, and how its file is read."""

    steps_MPa: list[Pressure] | None = Field(default=None, min_length=1)
    cycles: int | None = Field(default=None, ge=1)
    pressure: File | None = None
    columns: str | None = None
    force_unit: str | None = None
    decimal: Literal[".", ","] | None = None
    sort_time: bool | None = None


class ForceFileDocument(ForceSettings):
    """The record of one actuator."""

    file: File
    actuator: Name | None = None
    left_out: Words = ""

    @model_validator(mode="before")
    @classmethod
    def _short(cls, value: Any) -> Any:
        return _full(value, {str: "file"}, "the path of a force file, or a mapping with `file:`")


class ForceDocument(ForceSettings):
    """Blocked force of a design: a file an actuator; what is said here holds for all of them."""

    files: list[ForceFileDocument]

    @model_validator(mode="before")
    @classmethod
    def _short(cls, value: Any) -> Any:
        value = _full(value, {str: "files", list: "files"}, "force files, or a mapping with `files:`")
        return _listed(value, "files")


class ShellDocument(Document):
    """Dimensions in the paper's symbols, or `named`: a name as `tw3_slw10`, or a design file."""

    named: File | None = None
    tw_mm: float | None = None
    slw_mm: float | None = None
    fw_mm: float = ShellDesign.rib_width_mm
    perimeter_mm: float = ShellDesign.perimeter_mm
    length_mm: float = ShellDesign.length_mm

    @model_validator(mode="before")
    @classmethod
    def _short(cls, value: Any) -> Any:
        return _full(value, {str: "named"}, "dimensions, as `{tw_mm: 3, slw_mm: 10}`, or a design file")

    def design(self) -> ShellDesign:
        """The design of the dimensions. Raises UsageError for an impossible one."""
        return ShellDesign(**{field: getattr(self, key) for key, field in DIMENSIONS.items()})

    @model_validator(mode="after")
    def _possible(self) -> ShellDocument:
        if self.named is not None:
            if len(self.model_fields_set) > 1:
                raise ValueError("give either a name or dimensions")
            return self
        if self.tw_mm is None or self.slw_mm is None:
            raise ValueError("give at least tw_mm and slw_mm")
        try:
            self.design()
        except BenchlabError as error:
            raise ValueError(f"{error.what}; {error.hint}") from None
        return self


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
        return _full(value, {list: "designs"}, "a list of designs, or a mapping with `designs:`")


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
    def _sets_are_of_designs(self) -> StudyDocument:
        wrong = [_at(place, value, what) for place, value, what in self._wrong_in_sets()]
        if wrong:
            raise ValidationError.from_exception_data("study", wrong)
        return self

    def _wrong_in_sets(self) -> Iterator[tuple[tuple[str | int, ...], object, str]]:
        for name, chosen in self.sets.items():
            if name.casefold() == ALL_DESIGNS:
                yield ("sets", name), list(chosen.designs), "every study has this set by itself: remove or rename it"
            for index, design in enumerate(chosen.designs):
                # In the short form the list is the set itself; a part of a place without a line is passed over.
                place = ("sets", name, "designs", index)
                if design not in self.designs:
                    close = difflib.get_close_matches(design, list(self.designs), n=1)
                    yield place, design, "is no design of this study" + (f"; did you mean {close[0]}?" if close else "")
                elif design in chosen.designs[:index]:
                    yield place, design, "stands twice in this set"


def _full(value: Any, short: dict[type, str], wanted: str) -> Any:
    """A short form as the mapping that it stands for. Raises ValueError for what is neither."""
    for kind, key in short.items():
        if isinstance(value, kind):
            return {key: value}
    if not isinstance(value, dict):
        raise ValueError(f"give {wanted}")
    return value


def _listed(value: dict[str, Any], key: str) -> dict[str, Any]:
    """One item that stands for a list of it, as that list."""
    return {**value, key: [value[key]]} if isinstance(value.get(key), str | dict) else value


def _at(place: tuple[str | int, ...], value: object, what: str) -> InitErrorDetails:
    error = PydanticCustomError("value_error", "Value error, {what}", {"what": what})
    return InitErrorDetails(type=error, loc=place, input=value)
