"""What a repeatability report is written from: the values of a study, its sets compared, and what the paper published."""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from statistics import median
from typing import Any

from benchlab.io.published import PublishedAngle
from benchlab.io.study_values import DesignValues, StudySet, StudyValues
from benchlab.report.rounding import decimals_of
from benchlab.stats.comparison import Comparison

SAME_PRESSURE_MPa = 1e-6


@dataclass(frozen=True)
class ComparedSet:
    """A set of designs and what their comparison found; `reason` where they cannot be compared."""

    chosen: StudySet
    found: Comparison | None
    reason: str = ""


@dataclass(frozen=True)
class PublishedSet:
    """Designs of the paper compared by their published means, SDs and sizes alone. figure: where the paper marks them, or ""."""

    title: str
    figure: str
    found: Comparison


@dataclass(frozen=True)
class StudyReport:
    """provenance: who made it, from what and how. published: the paper's angles; published_sets: empty where the study has none
    of the paper's designs."""

    values: StudyValues
    compared: tuple[ComparedSet, ...]
    published: tuple[PublishedAngle, ...] = ()
    published_sets: tuple[PublishedSet, ...] = ()
    provenance: dict[str, Any] = field(default_factory=dict)

    @property
    def whole(self) -> ComparedSet:
        """The set of all designs."""
        return max(self.compared, key=lambda one: len(one.chosen.designs))

    @property
    def places(self) -> int:
        """Decimals of angles: as many as give the usual standard deviation two digits."""
        spreads = [sd for design in self.values.designs if (sd := sd_of(design)) is not None and sd > 0]
        return min(decimals_of(median(spreads)) if spreads else 1, 4)

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


def simulated_of(design: DesignValues) -> float | None:
    """Simulated angle in degrees, where it is known."""
    found = design.simulated
    return found.angle_deg if found is not None and math.isfinite(found.angle_deg) else None


def error_of(design: DesignValues) -> float | None:
    """Simulated less measured, in degrees."""
    mean, simulated = mean_of(design), simulated_of(design)
    return None if mean is None or simulated is None else simulated - mean
