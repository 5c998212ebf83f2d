"""What a repeatability report is written from: the values of a study, its sets compared, and what the paper published."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, field
from functools import cached_property
from statistics import median
from typing import Any

from scipy import special

from benchlab.io.published import PublishedAngle
from benchlab.io.study_values import DesignValues, StudySet, StudyValues
from benchlab.report.document import NONE, cut
from benchlab.report.rounding import decimals_of, number
from benchlab.stats.comparison import Comparison
from benchlab.stats.repeatability import FACTOR

SAME_PRESSURE_MPa = 1e-6


@dataclass(frozen=True)
class ComparedSet:
    """A set of designs and what their comparison found; `reason` where they cannot be compared."""

    chosen: StudySet
    found: Comparison | None
    reason: str = ""


@dataclass(frozen=True)
class PublishedSet:
    """Designs of the paper compared by their published means, SDs and sizes alone. figure: where the paper marks them, or "".
    angles: what was published, in the order of the groups."""

    title: str
    figure: str
    angles: tuple[PublishedAngle, ...]
    found: Comparison


@dataclass(frozen=True)
class Scatter:
    """Pooled standard deviation of samples in degrees, with its chi-square interval and the degrees of freedom that it rests on."""

    sd_deg: float
    low_deg: float
    high_deg: float
    df: int

    @property
    def limit_deg(self) -> float:
        """The repeatability limit r of two samples (ISO 5725-6, ASTM E691)."""
        return FACTOR * self.sd_deg


@dataclass(frozen=True)
class StudyReport:
    """provenance: who made it, from what and how. published: the paper's angles; published_sets: empty where the study has none
    of the paper's designs. confidence: of all intervals."""

    values: StudyValues
    compared: tuple[ComparedSet, ...]
    published: tuple[PublishedAngle, ...] = ()
    published_sets: tuple[PublishedSet, ...] = ()
    provenance: dict[str, Any] = field(default_factory=dict)
    confidence: float = 0.95

    @property
    def whole(self) -> ComparedSet:
        """The set of all designs."""
        return max(self.compared, key=lambda one: len(one.chosen.designs))

    @cached_property
    def places(self) -> int:
        """Decimals of angles: as many as give the usual standard deviation two digits."""
        spreads = [sd for design in self.values.designs if (sd := sd_of(design)) is not None and sd > 0]
        return min(decimals_of(median(spreads)) if spreads else 1, 4)

    @property
    def percent(self) -> str:
        """The confidence in words, as `95 %`."""
        return f"{100 * self.confidence:g} %"

    def published_of(self, design: DesignValues) -> PublishedAngle | None:
        """The paper's figures for a design of the same dimensions at the same pressure."""
        return next((p for p in self.published if p.design == design.shell), None)


def mean_of(design: DesignValues) -> float | None:
    """Mean angle of the samples that count, in degrees."""
    angles = design.angles_deg
    return float(angles.mean()) if len(angles) else None


def sd_of(design: DesignValues) -> float | None:
    """Standard deviation between the samples, in degrees; None for fewer than two."""
    angles = design.angles_deg
    return float(angles.std(ddof=1)) if len(angles) > 1 else None


def scatter_of(report: StudyReport) -> Scatter | None:
    """Scatter of samples about the mean of their design, over all designs; None where none has two samples."""
    several = [angles for design in report.values.designs if len(angles := design.angles_deg) > 1]
    df = sum(len(angles) - 1 for angles in several)
    if not df:
        return None
    ss = sum(float(((angles - angles.mean()) ** 2).sum()) for angles in several)
    tail = (1 - report.confidence) / 2
    low, high = (math.sqrt(ss / float(special.chdtri(df, share))) for share in (tail, 1 - tail))
    return Scatter(math.sqrt(ss / df), low, high, df)


def interval_of(design: DesignValues, confidence: float) -> tuple[float | None, float | None]:
    """Student's interval of the mean angle with the design's own standard deviation, in degrees."""
    mean, sd, n = mean_of(design), sd_of(design), len(design.counted)
    if mean is None or sd is None:
        return None, None
    half = float(special.stdtrit(n - 1, (1 + confidence) / 2)) * sd / math.sqrt(n)
    return mean - half, mean + half


def simulated_of(design: DesignValues) -> float | None:
    """Simulated angle in degrees, where it is known."""
    found = design.simulated
    return found.angle_deg if found is not None and math.isfinite(found.angle_deg) else None


def error_of(design: DesignValues) -> float | None:
    """Simulated less measured, in degrees."""
    mean, simulated = mean_of(design), simulated_of(design)
    return None if mean is None or simulated is None else simulated - mean


def found_sets(report: StudyReport) -> list[tuple[ComparedSet, Comparison]]:
    """The sets that could be compared, with what was found."""
    return [(one, one.found) for one in report.compared if one.found is not None]


def name_of(one: ComparedSet) -> str:
    """The title of a set, cut."""
    return cut(one.chosen.title, 70)


def joined(items: Sequence[str], most: int = 5) -> str:
    """Items as words; of many, the first.

    >>> joined(["a", "b", "c"], 2)
    'a, b and 1 more'
    """
    return ", ".join(items[:most]) + (f" and {len(items) - most} more" if len(items) > most else "")


def span_text(low: float | None, high: float | None, places: int) -> str:
    """The ends of an interval, or a dash."""
    return NONE if low is None or high is None else f"{number(low, places).text} to {number(high, places).text}"
