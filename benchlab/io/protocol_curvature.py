"""The keys of a `curvature` segment: exactly one of hold, ramp, sine, in degrees."""

from __future__ import annotations

from typing import Annotated

from pydantic import Field, model_validator

from benchlab.io.protocol_values import Angle, Count, Duration, Frequency, Rate, one_of
from benchlab.io.yaml_file import Document
from benchlab.protocol.curvature import AngleHold, AngleRamp, AngleSine
from benchlab.protocol.groups import Segment


class AngleHoldDocument(Document):
    angle_deg: Angle
    duration_s: Duration

    def segments(self, line: int) -> tuple[Segment, ...]:
        return (AngleHold(self.angle_deg, self.duration_s, line),)


class AngleRampDocument(Document):
    to_deg: Angle
    duration_s: Duration | None = None
    rate_deg_per_s: Rate | None = None

    @model_validator(mode="after")
    def _one(self) -> AngleRampDocument:
        return one_of(self, "duration_s", "rate_deg_per_s")

    def segments(self, line: int) -> tuple[Segment, ...]:
        return (AngleRamp(self.to_deg, self.duration_s, self.rate_deg_per_s, line),)


class AngleSineDocument(Document):
    mean_deg: Angle
    amplitude_deg: Annotated[float, Field(gt=0, le=180)]
    frequency_Hz: Frequency
    cycles: Count

    def segments(self, line: int) -> tuple[Segment, ...]:
        return (AngleSine(self.mean_deg, self.amplitude_deg, self.frequency_Hz, self.cycles, line),)


class CurvatureDocument(Document):
    hold: AngleHoldDocument | None = None
    ramp: AngleRampDocument | None = None
    sine: AngleSineDocument | None = None

    @model_validator(mode="after")
    def _one(self) -> CurvatureDocument:
        if len([part for part in (self.hold, self.ramp, self.sine) if part is not None]) != 1:
            raise ValueError(
                "give exactly one of hold, ramp, sine, as `curvature: {hold: {angle_deg: 60, duration_s: 5}}`"
            )
        return self

    def segments(self, line: int) -> tuple[Segment, ...]:
        chosen = self.hold or self.ramp or self.sine
        assert chosen is not None
        return chosen.segments(line)
