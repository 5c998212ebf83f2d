"""`analysis:` in a study file: settings of `benchlab analyze` for a study, a design, a sample or a recording; what is nearer wins."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any, Literal

from pydantic import Field, field_validator, model_validator

from benchlab.errors import BenchlabError
from benchlab.io.analysis_ranges import RANGES, SCALES
from benchlab.io.pressure import ramp
from benchlab.io.yaml_file import Document
from benchlab.vision.colour import COLOURS

ALTERNATIVES = (
    (("pressure",), ("ramp",)),
    (("scale_mm_per_px",), ("reference_mm", "reference_px"), ("marker_span_mm",), ("aruco_mm",)),
)
"""Settings that tell the same in different ways: one way that is told nearer to a recording replaces the others."""


class AnalysisDocument(Document):
    """Settings of `benchlab analyze`, under the names of its options; null takes back what was said further up."""

    length_mm: float | None = None
    markers: int | None = None
    colour: str | None = None
    threshold: float | None = None
    roi_px: list[float] | None = Field(default=None, min_length=4, max_length=4)
    fit: Literal["kasa", "pratt", "taubin", "hyper", "geometric"] | None = None
    flip: bool | None = None
    scale_mm_per_px: float | None = None
    reference_mm: float | None = None
    reference_px: list[float] | None = Field(default=None, min_length=4, max_length=4)
    marker_span_mm: float | None = None
    aruco_mm: float | None = None
    aruco_dictionary: str | None = None
    lens: str | None = Field(default=None, min_length=1)
    pressure: str | None = Field(default=None, min_length=1)
    ramp: str | None = None
    sync: float | Literal["onset"] | None = None
    stream: int | None = Field(default=None, ge=0)
    fps: float | None = None
    capture_fps: float | None = None
    fast: bool | None = None
    allow_partial: bool | None = None
    max_pixels: int | None = None
    max_missing: float | None = None

    @field_validator(*RANGES)
    @classmethod
    def _in_range(cls, value: float | None, info: Any) -> float | None:
        low, high = RANGES[info.field_name]
        if value is not None and not low <= value <= high:
            raise ValueError(f"give a number from {low:g} to {high:g}")
        return value

    @field_validator("colour")
    @classmethod
    def _is_colour(cls, name: str | None) -> str | None:
        if name is not None and name not in COLOURS:
            raise ValueError(f"give one of {', '.join(COLOURS)}")
        return name

    @field_validator("ramp")
    @classmethod
    def _is_ramp(cls, text: str | None) -> str | None:
        if text is not None:
            try:
                ramp(text)
            except BenchlabError as error:
                raise ValueError(f"{error.what}; {error.hint}") from None
        return text

    @model_validator(mode="after")
    def _told_once(self) -> AnalysisDocument:
        for names, tell in ((("pressure", "ramp"), "pressure"), (SCALES, "scale")):
            given = [name for name in names if getattr(self, name) is not None]
            if len(given) > 1:
                raise ValueError(f"{' and '.join(given)} both tell the {tell}: give one of them")
        return self


def merged(levels: Iterable[AnalysisDocument]) -> dict[str, Any]:
    """The settings of all levels, the last one winning: a pressure replaces a ramp, one kind of scale another, null removes.

    >>> merged([AnalysisDocument(ramp="0:0.35:2.5", markers=7), AnalysisDocument(pressure="log.csv", markers=None)])
    {'pressure': 'log.csv'}
    """
    settings: dict[str, Any] = {}
    for level in levels:
        given = level.model_dump(exclude_unset=True)
        for ways in ALTERNATIVES:
            told = [way for way in ways if any(given.get(name) is not None for name in way)]
            for way in ways if told else ():
                settings = {name: value for name, value in settings.items() if way in told or name not in way}
        settings |= given
    return {name: value for name, value in settings.items() if value is not None}
