"""Control files: gains for a bench with an actuator, and what they are from, as YAML.

from, rate_Hz, gains {kp_MPa_per_deg, ki_MPa_per_deg_s}, feed_forward, lead_s, closed_loop_s, plant [{pressure_MPa,
gain_deg_per_MPa, lag_s, dead_time_s, gain_margin, phase_margin_deg, delay_margin_s, max_sensitivity, crossover_rad_per_s}]; a margin
that is infinite is left out.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from pydantic import Field

from benchlab.control.tuning import Lag, Margins, Tuning
from benchlab.io.yaml_file import Document, read_document, write_document


@dataclass(frozen=True)
class ControlFile:
    """How a closed loop is controlled, in MPa, degrees and seconds.

    source: the run, or the words, that it is from; rate_Hz: of the loop that it is for. points: (pressure, plant, margins) of each
    operating point that it was tuned for; none for gains that were found by hand.
    """

    kp_MPa_per_deg: float
    ki_MPa_per_deg_s: float
    feed_forward: bool
    lead_s: float
    rate_Hz: float
    source: str
    closed_loop_s: float = math.nan
    points: tuple[tuple[float, Lag, Margins], ...] = ()


class _Gains(Document):
    kp_MPa_per_deg: float = Field(ge=0)
    ki_MPa_per_deg_s: float = Field(ge=0)


class _Point(Document):
    pressure_MPa: float = Field(ge=0)
    gain_deg_per_MPa: float = Field(gt=0)
    lag_s: float = Field(gt=0)
    dead_time_s: float = Field(ge=0)
    gain_margin: float | None = Field(default=None, gt=0)
    phase_margin_deg: float | None = None
    delay_margin_s: float | None = None
    max_sensitivity: float = Field(ge=1)
    crossover_rad_per_s: float = Field(ge=0)


class _ControlDocument(Document):
    source: str = Field(alias="from", min_length=1)
    rate_Hz: float = Field(gt=0, le=1000)
    gains: _Gains
    feed_forward: bool = False
    lead_s: float = Field(default=0.0, ge=0, lt=10)
    closed_loop_s: float | None = Field(default=None, gt=0)
    plant: tuple[_Point, ...] = ()


def control_of_tuning(
    tuning: Tuning, pressures_MPa: list[float], plants: list[Lag], *, feed_forward: bool, rate_Hz: float, source: str
) -> ControlFile:
    """What is written of a tuning: pressures and plants in the order of its margins."""
    points = tuple(zip(pressures_MPa, plants, tuning.margins, strict=True))
    return ControlFile(
        tuning.kp_MPa_per_deg,
        tuning.ki_MPa_per_deg_s,
        feed_forward,
        tuning.lead_s,
        rate_Hz,
        source,
        tuning.closed_loop_s,
        points,
    )


def read_control(path: Path) -> ControlFile:
    """Read a control file. Raises UsageError for a missing file, InputError with the line of everything that is wrong."""
    found = read_document(path, _ControlDocument)
    points = tuple((p.pressure_MPa, Lag(p.gain_deg_per_MPa, p.lag_s, p.dead_time_s), _margins(p)) for p in found.plant)
    return ControlFile(
        kp_MPa_per_deg=found.gains.kp_MPa_per_deg,
        ki_MPa_per_deg_s=found.gains.ki_MPa_per_deg_s,
        feed_forward=found.feed_forward,
        lead_s=found.lead_s,
        rate_Hz=found.rate_Hz,
        source=found.source,
        closed_loop_s=math.nan if found.closed_loop_s is None else found.closed_loop_s,
        points=points,
    )


def write_control(path: Path, control: ControlFile, comment: str = "") -> None:
    """Write a control file whole; `read_control` gives the same again, to six digits. InputError where the disk refuses."""
    document: dict[str, Any] = {
        "from": control.source,
        "rate_Hz": _short(control.rate_Hz),
        "gains": {
            "kp_MPa_per_deg": _short(control.kp_MPa_per_deg),
            "ki_MPa_per_deg_s": _short(control.ki_MPa_per_deg_s),
        },
        "feed_forward": control.feed_forward,
        "lead_s": _short(control.lead_s),
    }
    if math.isfinite(control.closed_loop_s):
        document["closed_loop_s"] = _short(control.closed_loop_s)
    if control.points:
        document["plant"] = [_point(*point) for point in control.points]
    write_document(path, document, comment)


def _point(pressure_MPa: float, plant: Lag, margins: Margins) -> dict[str, float]:
    values = {"pressure_MPa": pressure_MPa, **vars(plant), **vars(margins)}
    return {name: _short(value) for name, value in values.items() if math.isfinite(value)}


def _short(value: float) -> float:
    return float(f"{value:.6g}")


def _margins(point: _Point) -> Margins:
    def known(value: float | None) -> float:
        return math.inf if value is None else value

    return Margins(
        known(point.gain_margin),
        known(point.phase_margin_deg),
        known(point.delay_margin_s),
        point.max_sensitivity,
        point.crossover_rad_per_s,
    )
