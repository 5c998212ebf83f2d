"""The keys of a protocol file and what has to hold between them, segment by segment; `protocol_file` makes a plan of it.

Every document knows how to become segments of the kernel. What depends on the segment before, the limit or the rate is not judged
here but by `protocol/survey.py`.
"""

from __future__ import annotations

import typing
from typing import Annotated, Any, Literal

from pydantic import AfterValidator, Field, model_validator

from benchlab.io.protocol_curvature import CurvatureDocument
from benchlab.io.protocol_values import Count, Duration, Frequency, Pressure, Rate, one_of
from benchlab.io.yaml_commas import Place
from benchlab.io.yaml_file import Document
from benchlab.protocol.groups import Repeat, Segment, Signal, levels_of, train
from benchlab.protocol.plan import Control
from benchlab.protocol.segments import Hold, Ramp, Sine, Triangle, Vent
from benchlab.protocol.survey import MAX_STEPS

Lines = dict[Place, int]


class RampDocument(Document):
    to_MPa: Pressure
    duration_s: Duration | None = None
    rate_MPa_per_s: Rate | None = None

    @model_validator(mode="after")
    def _one(self) -> RampDocument:
        return one_of(self, "duration_s", "rate_MPa_per_s")

    def segments(self, line: int) -> tuple[Segment, ...]:
        return (Ramp(self.to_MPa, self.duration_s, self.rate_MPa_per_s, line),)


class HoldDocument(Document):
    duration_s: Duration
    pressure_MPa: Pressure | None = None

    def segments(self, line: int) -> tuple[Segment, ...]:
        return (Hold(self.duration_s, self.pressure_MPa, line),)


class VentDocument(Document):
    duration_s: Duration

    def segments(self, line: int) -> tuple[Segment, ...]:
        return (Vent(self.duration_s, line),)


class StepsDocument(Document):
    levels_MPa: Annotated[list[Pressure], Field(min_length=1, max_length=1000)] | None = None
    from_MPa: Pressure | None = None
    to_MPa: Pressure | None = None
    step_MPa: Annotated[float, Field(gt=0, le=1)] | None = None
    hold_s: Duration
    rest_s: Duration | None = None
    cycles: Count = 1

    @model_validator(mode="after")
    def _whole(self) -> StepsDocument:
        spaced = [self.from_MPa, self.to_MPa, self.step_MPa]
        if (self.levels_MPa is not None) == any(value is not None for value in spaced):
            raise ValueError("give either levels_MPa, or from_MPa, to_MPa and step_MPa")
        if self.levels_MPa is None:
            if None in spaced:
                raise ValueError("give from_MPa, to_MPa and step_MPa together")
            self._levels()
        if self.cycles > 1 and self.rest_s is None:
            raise ValueError("cycles need a rest between them: give rest_s, in which the actuator is vented")
        return self

    def _levels(self) -> tuple[float, ...]:
        if self.levels_MPa is not None:
            return tuple(self.levels_MPa)
        assert self.from_MPa is not None and self.to_MPa is not None and self.step_MPa is not None
        if (count := abs(self.to_MPa - self.from_MPa) / self.step_MPa) > MAX_STEPS:
            raise ValueError(f"step_MPa makes {count:.4g} levels, and {MAX_STEPS:,} are the most")
        return levels_of(self.from_MPa, self.to_MPa, self.step_MPa)

    def segments(self, line: int) -> tuple[Segment, ...]:
        return train(self._levels(), self.hold_s, self.rest_s or 0.0, self.cycles, line)


class SineDocument(Document):
    mean_MPa: Pressure
    amplitude_MPa: Annotated[Pressure, Field(gt=0)]
    frequency_Hz: Frequency
    cycles: Count

    def segments(self, line: int) -> tuple[Segment, ...]:
        return (Sine(self.mean_MPa, self.amplitude_MPa, self.frequency_Hz, self.cycles, line),)


class TriangleDocument(Document):
    low_MPa: Pressure
    high_MPa: Pressure
    rate_MPa_per_s: Rate | None = None
    frequency_Hz: Frequency | None = None
    cycles: Count

    @model_validator(mode="after")
    def _one(self) -> TriangleDocument:
        if self.high_MPa <= self.low_MPa:
            raise ValueError(f"give a high_MPa above low_MPa: {self.high_MPa:g} is not above {self.low_MPa:g}")
        return one_of(self, "rate_MPa_per_s", "frequency_Hz")

    def segments(self, line: int) -> tuple[Segment, ...]:
        found = Triangle(self.low_MPa, self.high_MPa, self.cycles, self.rate_MPa_per_s, self.frequency_Hz, line)
        return (found,)


class RepeatDocument(Document):
    times: Count
    segments: Annotated[list[SegmentDocument], Field(min_length=1)]


class SegmentDocument(Document):
    """One item of the list: exactly one of these keys."""

    ramp: RampDocument | None = None
    hold: HoldDocument | None = None
    steps: StepsDocument | None = None
    sine: SineDocument | None = None
    triangle: TriangleDocument | None = None
    vent: VentDocument | None = None
    curvature: CurvatureDocument | None = None
    repeat: RepeatDocument | None = None
    mark: Annotated[str, Field(min_length=1, max_length=200)] | None = None
    trigger: Literal["camera"] | None = None

    @model_validator(mode="before")
    @classmethod
    def _mapping(cls, value: Any) -> Any:
        kinds = ", ".join(cls.model_fields)
        if not isinstance(value, dict) or len(value) != 1:
            raise ValueError(f"write one segment as `- ramp: {{to_MPa: 0.3, duration_s: 2}}`; there are {kinds}")
        if None in value.values():
            raise ValueError(f"write what belongs to `{next(iter(value))}:`, indented further than it or in {{}}")
        return value


def _titled(text: str) -> str:
    if not text.strip() or len(text) > 200 or "\n" in text.strip():
        raise ValueError("give a line of up to 200 letters")
    return text.strip()


class ControlDocument(Document):
    kp_MPa_per_deg: Annotated[float, Field(ge=0, le=1)]
    ki_MPa_per_deg_s: Annotated[float, Field(ge=0, le=10)]
    feed_forward: bool = False
    lead_s: Annotated[float, Field(ge=0, lt=10)] = 0.0

    def control(self) -> Control:
        return Control(self.kp_MPa_per_deg, self.ki_MPa_per_deg_s, self.feed_forward, self.lead_s)


class ProtocolDocument(Document):
    """The whole file."""

    title: Annotated[str, AfterValidator(_titled)]
    about: str = ""
    limit_MPa: Annotated[Pressure, Field(gt=0)]
    slew_limit_MPa_per_s: Rate | None = None
    rate_Hz: Annotated[float, Field(ge=1, le=500)] = 100.0
    control: ControlDocument | None = None
    segments: Annotated[list[SegmentDocument], Field(min_length=1)]


def segments_of(documents: typing.Iterable[SegmentDocument], place: Place, lines: Lines) -> tuple[Segment, ...]:
    """The kernel's segments of a list that stands at `place` in the file, each with its line."""
    found: list[Segment] = []
    for index, document in enumerate(documents):
        (kind,) = document.model_fields_set
        content, here = getattr(document, kind), (*place, index, kind)
        line = lines.get(here, 0)
        if isinstance(content, RepeatDocument):
            found.append(Repeat(content.times, segments_of(content.segments, (*here, "segments"), lines), line))
        elif isinstance(content, str):
            found.append(Signal(kind, content, line))
        else:
            found += content.segments(line)
    return tuple(found)
