"""The parts of a study file, their keys, types and what they may be.

Short forms, put in full before they are checked: a text stands for a recording (its file), a sample (its one recording), a simulation
(its file) or a force file; a list stands for the recordings of a sample or the files of a force test.
"""

from __future__ import annotations

import re
from pathlib import PurePath
from typing import Annotated, Any, Literal

from pydantic import AfterValidator, Field, model_validator

from benchlab.actuator import DIMENSIONS, ShellDesign
from benchlab.errors import BenchlabError
from benchlab.io.pressure import MAX_PRESSURE_MPA
from benchlab.io.study_analysis import AnalysisDocument
from benchlab.io.yaml_file import Document

MAX_NAME = 80
"""Characters in the name of a design or a sample, which is also that of a folder."""

RUN_SUFFIXES = frozenset([".h5", ".hdf5", ".hdf", ".nxs"])
TABLE_SUFFIXES = frozenset([".csv", ".tsv", ".txt"])

Kind = Literal["video", "run", "table"]

_NOT_IN_NAMES = re.compile(r'[/\\:*?"<>|]')


def kind_of(path: PurePath) -> Kind:
    """What a recording is, by its suffix: a run file, a table, or else a video or a folder of stills.

    >>> kind_of(PurePath("a.MP4")), kind_of(PurePath("a.h5")), kind_of(PurePath("a.csv"))
    ('video', 'run', 'table')
    """
    suffix = path.suffix.lower()
    return "run" if suffix in RUN_SUFFIXES else "table" if suffix in TABLE_SUFFIXES else "video"


def _stated(text: str) -> str:
    if not text.strip():
        raise ValueError("say why, in words")
    return text.strip()


def named(text: str) -> str:
    """A text that can be the name of a design or a sample, as it is. Raises ValueError for any other.

    >>> named("tw3_slw10")
    'tw3_slw10'
    """
    if not text or len(text) > MAX_NAME or not text.isprintable() or _NOT_IN_NAMES.search(text):
        raise ValueError(f'name it in 1 to {MAX_NAME} characters, without / \\ : * ? " < > |')
    if text != text.strip() or text != text.strip("."):
        raise ValueError("a name has no blank and no dot at its ends")
    return text


Name = Annotated[str, AfterValidator(named)]
Words = Annotated[str, AfterValidator(_stated)]
File = Annotated[str, Field(min_length=1)]
Pressure = Annotated[float, Field(gt=0, le=MAX_PRESSURE_MPA)]
Positive = Annotated[float, Field(gt=0)]


class RecordingDocument(Document):
    """One video, folder of stills, run file or table of angles."""

    file: File
    analysis: AnalysisDocument = AnalysisDocument()
    left_out: Words = ""
    counts: Words = ""

    @model_validator(mode="before")
    @classmethod
    def _short(cls, value: Any) -> Any:
        return in_full(value, {str: "file"}, "the path of a recording, or a mapping with `file:`")

    @model_validator(mode="after")
    def _one_of_both(self) -> RecordingDocument:
        if self.left_out and self.counts:
            raise ValueError("it counts or is left out: remove `left_out:` or `counts:`")
        return self

    @model_validator(mode="after")
    def _is_analysed(self) -> RecordingDocument:
        if "analysis" in self.model_fields_set and kind_of(PurePath(self.file)) != "video":
            raise ValueError(f"{self.file} is not analysed again, it is read as it is: remove its `analysis:`")
        return self


class SampleDocument(Document):
    """One made actuator."""

    recordings: list[RecordingDocument] = Field(default_factory=list)
    analysis: AnalysisDocument = AnalysisDocument()
    notes: str = ""
    left_out: Words = ""

    @model_validator(mode="before")
    @classmethod
    def _short(cls, value: Any) -> Any:
        value = in_full(value, {str: "recordings", list: "recordings"}, "recordings, or a mapping with `recordings:`")
        return listed(value, "recordings")


class SimulatedDocument(Document):
    """A file of `benchlab simulate` or `benchlab sweep`, or an angle and who says so."""

    file: File | None = None
    angle_deg: float | None = None
    source: Words = ""

    @model_validator(mode="before")
    @classmethod
    def _short(cls, value: Any) -> Any:
        return in_full(value, {str: "file"}, "the path of a response file, or `{angle_deg: ..., source: ...}`")

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
    encoding: str | None = None
    sort_time: bool | None = None
    negate: bool | None = None
    tolerance_MPa: Positive | None = None
    lever_arm_mm: Positive | None = None


class ForceFileDocument(ForceSettings):
    """The record of one actuator."""

    file: File
    actuator: Name | None = None
    left_out: Words = ""

    @model_validator(mode="before")
    @classmethod
    def _short(cls, value: Any) -> Any:
        return in_full(value, {str: "file"}, "the path of a force file, or a mapping with `file:`")

    @property
    def actuator_name(self) -> str:
        """As told, or else the name of its file."""
        return self.actuator or PurePath(self.file).stem


class ForceDocument(ForceSettings):
    """Blocked force of a design: a file an actuator; what is said here holds for all of them."""

    files: list[ForceFileDocument]

    @model_validator(mode="before")
    @classmethod
    def _short(cls, value: Any) -> Any:
        value = in_full(value, {str: "files", list: "files"}, "force files, or a mapping with `files:`")
        return listed(value, "files")


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
        return in_full(value, {str: "named"}, "dimensions, as `{tw_mm: 3, slw_mm: 10}`, or a design file")

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


def in_full(value: Any, short: dict[type, str], wanted: str) -> Any:
    """A short form as the mapping that it stands for. Raises ValueError for what is neither."""
    for kind, key in short.items():
        if isinstance(value, kind):
            return {key: value}
    if not isinstance(value, dict):
        raise ValueError(f"give {wanted}")
    return value


def listed(value: dict[str, Any], key: str) -> dict[str, Any]:
    """One item that stands for a list of it, as that list."""
    return {**value, key: [value[key]]} if isinstance(value.get(key), str | dict) else value
