"""Values in protocol files: pressures, durations, rates, frequencies, counts, and what they may be."""

from __future__ import annotations

from typing import Annotated, TypeVar

from pydantic import AfterValidator, BaseModel, Field

Model = TypeVar("Model", bound=BaseModel)


def _pressure(value: float) -> float:
    if value > 1:
        likely = next((f"{v:g}" for v in (value / 1000, value / 10) if v <= 1), None)
        meant = f"; if {'kPa' if value > 10 else 'bar'} are meant, write {likely}" if likely else ""
        raise ValueError(f"pressures are in MPa, and above 1 MPa nothing is driven{meant}")
    return value


Pressure = Annotated[float, Field(ge=0), AfterValidator(_pressure)]
Duration = Annotated[float, Field(gt=0, le=1e8)]
Rate = Annotated[float, Field(gt=0, le=1e6)]
Frequency = Annotated[float, Field(gt=0, le=250)]
Count = Annotated[int, Field(ge=1, le=10**9)]
Angle = Annotated[float, Field(ge=0, le=360)]


def one_of(document: Model, one: str, other: str) -> Model:
    """The document, if exactly one of two keys is given. ValueError where none or both are."""
    if (getattr(document, one) is None) == (getattr(document, other) is None):
        raise ValueError(f"give either {one} or {other}")
    return document
