"""The figures of a report with their captions: bars of each set, intervals of differences, θ(p) of each design, h and k."""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING

import numpy as np

from benchlab.io.study_values import DesignValues
from benchlab.report.document import Block, Panel, Pictures, Words, cut
from benchlab.report.study.bars_figure import MOST_BRACKETED, Bar, draw_bars
from benchlab.report.study.consistency_figure import MOST_CELLS, MOST_DESIGNS, draw_consistency, what_of
from benchlab.report.study.figures import (
    HALF_IN,
    MOST_ROWS,
    THIRD_IN,
    WIDE_IN,
    AngleBand,
    Interval,
    draw_angle_band,
    draw_intervals,
)
from benchlab.report.study.origins import origins_mark, write_mark
from benchlab.report.study.report import ComparedSet, StudyReport, found_sets, mean_of, name_of, sd_of, simulated_of
from benchlab.report.svg import panel_of
from benchlab.stats.comparison import Comparison
from benchlab.stats.pairs import Pair
from benchlab.stats.wording import STARS_LEGEND, p_equals, stars

if TYPE_CHECKING:
    from matplotlib.figure import Figure

MOST_BANDS = 24

_STATISTICS = {
    "sample": "h: a sample’s mean from that of its design, over the standard deviation of the samples. k: the scatter of a sample’s "
    "cycles over the pooled one.",
    "design": "k: the scatter of a design’s samples over the pooled one.",
}


def bars_blocks(report: StudyReport) -> Iterator[Block]:
    """Bars of each set, with brackets where the set has been compared."""
    label = f"bending angle θ at {report.values.pressure_MPa:g} MPa (°)"
    panels, sizes = [], []
    bar_in = 1.0 if len(report.compared) == 1 else 0.64
    for one, name in _named(report.compared):
        bars = [bar for design in report.values.of(one.chosen) if (bar := bar_of(design)) is not None]
        if bars:
            sizes.append(len(bars))
            brackets = brackets_of(one.found, [bar.name for bar in bars])
            figure = draw_bars(bars, brackets, label, one.chosen.title, bar_in)
            panels.append(_panel(report, figure, f"bars_{name}", f"Bars of mean angle: {name_of(one)}"))
    if panels:
        yield Pictures(tuple(panels), _about_bars(report, sizes))
    else:
        yield Words("No sample has a value: there is nothing to draw.")


def _about_bars(report: StudyReport, sizes: Sequence[int]) -> str:
    """What the bars, or the rows of sets with more designs, show; only what is there."""
    designs, upright = report.values.designs, min(sizes) <= MOST_BRACKETED
    told = [
        f"{'Bars' if upright else 'Squares'}: mean bending angle of the samples.",
        "Points: samples, each the mean of its cycles (n: Table 1).",
        "Whiskers: ± 1 standard deviation between samples." * any(sd_of(design) is not None for design in designs),
        "Diamonds: simulated." * any(simulated_of(design) is not None for design in designs),
        f"Brackets: Tukey’s HSD within the set, {STARS_LEGEND}, else p." * (upright and bool(found_sets(report))),
        f"Sets of more than {MOST_BRACKETED} designs lie as rows without brackets."
        * (upright and max(sizes) > MOST_BRACKETED),
        f"The first {MOST_ROWS} designs are drawn." * (max(sizes) > MOST_ROWS),
    ]
    return " ".join(filter(None, told))


def bar_of(design: DesignValues) -> Bar | None:
    """None where no sample of the design has a value."""
    mean = mean_of(design)
    return None if mean is None else Bar(design.name, design.angles_deg, mean, sd_of(design), simulated_of(design))


def brackets_of(found: Comparison | None, names: Sequence[str]) -> list[tuple[int, int, str]]:
    """Pairs as (bar, bar, label): the stars that Tukey's p earns, else p itself."""
    if found is None:
        return []
    at = {name: index for index, name in enumerate(names)}
    return [(at[pair.a], at[pair.b], stars(pair.p) or p_equals(pair.p)) for pair in found.tukey if pair.p is not None]


def intervals_blocks(report: StudyReport) -> Iterator[Block]:
    """Intervals of all pairs of each set."""
    panels, cut_off = [], []
    width = HALF_IN if len(found_sets(report)) > 1 else WIDE_IN
    for one, name in _named(report.compared):
        if one.found is None or not one.found.tukey:
            continue
        rows = [interval_of(pair, other) for pair, other in zip(one.found.tukey, one.found.games_howell)]
        if len(rows) > MOST_ROWS:
            cut_off.append(f"{name_of(one)}: the first {MOST_ROWS} of {len(rows)} pairs are drawn.")
        figure = draw_intervals(rows, "difference of mean θ (°)", one.found.confidence, one.chosen.title, width)
        panels.append(_panel(report, figure, f"intervals_{name}", f"Intervals of differences: {name_of(one)}"))
    if panels:
        caption = (
            "Differences of mean angle with simultaneous intervals for all pairs of the set: Tukey’s with one variance for all designs, "
            "Games and Howell’s with each design’s own. An interval that does not touch the line at 0 shows a difference."
        )
        yield Pictures(tuple(panels), " ".join([caption, *cut_off]), stacked=len(panels) > 1)


def interval_of(pair: Pair, other: Pair) -> Interval:
    """A row of the figure of intervals."""

    def ends(one: Pair) -> tuple[float, float, float] | None:
        return None if one.low is None or one.high is None else (one.difference, one.low, one.high)

    return Interval(f"{cut(pair.b, 20)} − {cut(pair.a, 20)}", ends(pair), ends(other))


def bands_blocks(report: StudyReport) -> Iterator[Block]:
    """θ against pressure of each design that has a curve."""
    bands = [band for design in report.values.designs if (band := band_of(report, design)) is not None]
    if not bands:
        yield Words("No recording has a pressure: there is no curve against it.")
        return
    drawn = bands[:MOST_BANDS]
    largest = [np.nanmax([*band.mean_deg + np.nan_to_num(band.sd_deg), *_ends(band)]) for band in drawn]
    smallest = [np.nanmin([0.0, *band.mean_deg - np.nan_to_num(band.sd_deg)]) for band in drawn]
    room = 0.05 * (max(largest) - min(smallest))
    limits = (float(min(smallest) - room), float(max(largest) + room))
    width = THIRD_IN if len(drawn) > 2 else HALF_IN
    panels = [
        _panel(
            report,
            draw_angle_band(band, limits, width),
            f"curve_{name}",
            f"Angle against pressure of {cut(band.name, 40)}",
        )
        for band, name in zip(drawn, file_names([band.name for band in drawn]))
    ]
    off = f" The first {MOST_BANDS} of {len(bands)} designs are drawn." if len(bands) > MOST_BANDS else ""
    without = len(report.values.designs) - len(bands)
    off += f" {without} design{'s have' if without > 1 else ' has'} no such curve." if without else ""
    dashed = " Dashed: simulated." if any(band.simulated is not None for band in drawn) else ""
    yield Pictures(
        tuple(panels),
        "Bending angle against pressure as it rises; where it is held, as the hold begins: creep in a hold is in the mean that "
        "is compared, not in the curve. Line and band: mean of the samples ± 1 standard deviation between them. Grey: "
        f"single samples, each the mean of its cycles.{dashed}{off}",
    )


def band_of(report: StudyReport, design: DesignValues) -> AngleBand | None:
    """None where no sample has a curve; where only some samples reach, the mean and the band end there."""
    pressure = report.values.curve_MPa
    curves = design.curves_deg(len(pressure))
    kept = tuple((pressure, curve) for curve in curves if np.isfinite(curve).any())
    if not kept:
        return None
    mean, spread = design.band_deg(len(pressure))
    found = design.simulated
    simulated = (
        (found.pressure_MPa, found.curve_deg) if found is not None and np.isfinite(found.curve_deg).any() else None
    )
    return AngleBand(design.name, pressure, mean, spread, kept, simulated)


def consistency_blocks(report: StudyReport) -> Iterator[Block]:
    """h and k as figures, where there are few enough cells."""
    found = report.whole.found
    cells = () if found is None else found.repeatability.cells
    if not cells or len(cells) > MOST_CELLS or len(report.values.designs) > MOST_DESIGNS:
        return
    what = what_of(cells)
    panels = [
        _panel(report, draw_consistency(cells, statistic), f"consistency_{statistic}", f"{statistic} of each {what}")
        for statistic in ("h", "k")
        if any(getattr(cell, statistic) is not None for cell in cells)
    ]
    if panels:
        yield Pictures(
            tuple(panels),
            f"Mandel’s consistency statistics (ASTM E691). {_STATISTICS[what]} Dashed: critical values at 0.5 %; what is beyond is named.",
        )


def file_names(texts: Sequence[str]) -> list[str]:
    """Texts as names for files: small letters, digits and _, unlike each other.

    >>> file_names(["slw", "SLW", "<b>/../é"])
    ['slw', 'slw_2', 'b']
    """
    taken: set[str] = set()
    found = []
    for text in texts:
        stem = re.sub(r"[^a-z0-9]+", "_", text.lower())[:40].strip("_") or "unnamed"
        name, number = stem, 1
        while name in taken:
            number += 1
            name = f"{stem}_{number}"
        taken.add(name)
        found.append(name)
    return found


def _panel(report: StudyReport, figure: Figure, name: str, words: str) -> Panel:
    """A panel that says where its numbers are from, if they were not measured."""
    mark = origins_mark(report.values)
    write_mark(figure, mark)
    return panel_of(figure, name, f"{words} ({mark})" if mark else words)


def _named(compared: Sequence[ComparedSet]) -> Iterator[tuple[ComparedSet, str]]:
    return zip(compared, file_names([one.chosen.name for one in compared]))


def _ends(band: AngleBand) -> list[float]:
    """Largest values of the curves of a band."""
    curves = [curve for _, curve in band.curves] + ([band.simulated[1]] if band.simulated else [])
    return [float(np.nanmax(curve)) for curve in curves]
