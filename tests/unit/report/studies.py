"""Drawn studies for tests of the report: the paper's designs with samples that have exactly the published means and SDs."""

from __future__ import annotations

from typing import Any

import numpy as np

from benchlab.actuator import ShellDesign
from benchlab.io.published import published_angles
from benchlab.io.study_values import (
    CycleValue,
    DesignValues,
    Missing,
    RecordingValues,
    SampleValues,
    Simulated,
    StudySet,
    StudyValues,
)
from benchlab.report.study.report import StudyReport
from benchlab.workflows.report import report_of

PAPER = (("tw3_slw5", 3, 5, 119.5, 110.2, 1.9), ("tw3_slw10", 3, 10, 130.2, 125.7, 4.0), ("tw3_slw20", 3, 20, 62.4, 60.3, 3.6),
         ("tw9_slw10", 9, 10, 84.6, 79.9, 1.7), ("tw15_slw10", 15, 10, 55.7, 56.7, 2.9))  # fmt: skip
SETS = (
    StudySet("slw", "Strip width, tw 3 mm", ("tw3_slw5", "tw3_slw10", "tw3_slw20"), "slw_mm"),
    StudySet("tw", "Window width, slw 10 mm", ("tw3_slw10", "tw9_slw10", "tw15_slw10"), "tw_mm"),
)
PRESSURE = np.linspace(0, 0.35, 36)


def drawn_samples(mean: float, sd: float, samples: int, cycles: int, seed: int) -> list[SampleValues]:
    """Samples whose means have exactly this mean and SD; cycles scatter about each with SD 0.3, and leave its mean."""
    rng = np.random.default_rng(seed)
    values = rng.normal(size=samples)
    values = mean + sd * (values - values.mean()) / (values.std(ddof=1) if samples > 1 else 1.0)
    found = []
    for number, value in enumerate(values, start=1):
        about = rng.normal(size=cycles)
        angles = value + 0.3 * (about - about.mean())
        cycle = tuple(CycleValue(i, float(a), 0.1, "held", "", 0.35) for i, a in enumerate(angles, start=1))
        curve = value * (PRESSURE / 0.35) ** 0.8
        found.append(
            SampleValues(f"s{number}", (RecordingValues(f"videos/{mean:g}_s{number}.mp4", "measured", cycle, curve),))
        )
    return found


def design(name: str, mean: float, sd: float, samples: int = 5, cycles: int = 3, shell: ShellDesign | None = None,
           simulated_deg: float | None = None, force: Any = None) -> DesignValues:  # fmt: skip
    curve = None if simulated_deg is None else simulated_deg * (PRESSURE / 0.35) ** 0.75
    simulated = (
        None if curve is None else Simulated(float(curve[-1]), "benchlab simulate, drawn for the test", PRESSURE, curve)
    )
    seed = sum(map(ord, name))
    return DesignValues(name, shell, simulated, tuple(drawn_samples(mean, sd, samples, cycles, seed)), force)


def paper_designs(cycles: int = 3) -> tuple[DesignValues, ...]:
    return tuple(
        design(
            name, mean, sd, cycles=cycles, shell=ShellDesign(window_width_mm=tw, strip_width_mm=slw), simulated_deg=fem
        )
        for name, tw, slw, fem, mean, sd in PAPER
    )


def values(designs: tuple[DesignValues, ...], sets: tuple[StudySet, ...] = (), **changes: Any) -> StudyValues:
    whole = StudySet("all", "All designs", tuple(d.name for d in designs))
    given: dict[str, Any] = {
        "title": "A drawn study", "notes": "Drawn data: nothing here was measured.", "pressure_MPa": 0.35,
        "hold_tolerance_MPa": 0.0035, "curve_MPa": PRESSURE, "designs": designs, "sets": (*sets, whole), "failures": (),
        "left_out": (), "warnings": (), "inputs": {"videos/a.mp4": "0" * 64},
    }  # fmt: skip
    return StudyValues(**{**given, **changes})


def paper_study(cycles: int = 3, **changes: Any) -> StudyValues:
    return values(paper_designs(cycles), SETS, **changes)


def doubtful_study() -> StudyValues:
    """With failures, samples left out, warnings."""
    return paper_study(
        failures=(Missing("truncated: index missing", "tw3_slw5", "s6", "videos/cut.mp4"),),
        left_out=(Missing("leaked at the seam", "tw9_slw10", "s7"),),
        warnings=(Missing("3 of 126 frames not measured", "tw3_slw10", "s2", "videos/b.mp4"),),
    )


def report(found: StudyValues, **options: Any) -> StudyReport:
    return report_of(found, published_angles(), **options)
