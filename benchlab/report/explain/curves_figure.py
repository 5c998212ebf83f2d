"""Measured, simulated and explained against pressure, or against time in a hold: a panel a design and kind of run."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from benchlab.discrepancy.explanation import Curves
from benchlab.discrepancy.segments import STOPS
from benchlab.report.document import cut
from benchlab.report.explain.quantity import Quantity, quantity_of
from benchlab.report.explain.tables import rms
from benchlab.report.panels import BAND, BLUE, GREY, dress
from benchlab.report.study.figures import (
    OTHER,
    THIRD_IN,
    TITLE_IN,
    WIDE_IN,
    finish,
    make_room,
    name_rows,
    new_panel,
    write_title,
)
from benchlab.report.wording import fitted
from benchlab.units import FloatArray

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

EXPLAINED = "#009E73"
"""Colour of the model with what was named; simulated is OTHER, measured BLUE."""

MOST_PANELS = 18
_MOST_CYCLES = 2
_GAP_IN, _BETWEEN_IN = 0.95, 0.1
_DASHED = (0, (4, 2))
_KIND_IN = 0.15
"""Height of the line that says what kind of run it is."""
_TURNED = {"unloading": "v", "loading": "^"}


@dataclass(frozen=True)
class Kind:
    """The features of one panel. held: it is drawn against time."""

    design: str
    quantity: str
    kind: str
    held: bool
    index: NDArray[np.int64]
    gap: float

    @property
    def title(self) -> str:
        return f"{cut(self.design, 40)}, {cut(self.kind, 40)}"


def kinds(curves: Curves, quantity: str) -> list[Kind]:
    """One a design, kind of run and, in holds, pressure; in the order of the features."""
    found: dict[tuple[str, str, bool, float], list[int]] = {}
    for i in np.flatnonzero(curves.quantity == quantity):
        held = str(curves.direction[i]) in STOPS
        at = round(float(curves.pressure_MPa[i]), 3) if held else 0.0
        found.setdefault((str(curves.design[i]), str(curves.kind[i]), held, at), []).append(int(i))
    gap = curves.measured - curves.simulated
    return [
        Kind(design, quantity, kind, held, np.array(index), _rms(gap[index]))
        for (design, kind, held, _), index in found.items()
    ]


def chosen(found: list[Kind], most: int = MOST_PANELS) -> list[Kind]:
    """Those that are drawn: of each design that with the largest gap, then the others by their gap; in their own order."""
    first: dict[str, Kind] = {}
    for one in sorted(found, key=lambda one: -one.gap):
        first.setdefault(one.design, one)
    heads = list(first.values())
    rest = sorted((one for one in found if not any(one is head for head in heads)), key=lambda one: -one.gap)
    kept = [*heads, *rest][:most]
    return [one for one in found if any(one is each for each in kept)]


def is_point(curves: Curves, one: Kind) -> bool:
    """Whether it has a single place along its axis: a table of means at one pressure."""
    return len(np.unique(np.round(_along(curves, one), 6))) < 2


def draw_kind(
    curves: Curves,
    one: Kind,
    names: tuple[str, str],
    limits: tuple[tuple[float, float], tuple[float, float]],
    legend: bool,
) -> Figure:
    """names: what measured values, and the model with what was named, are called. limits: of values and of gaps, those of all panels."""
    bottom = 0.46 + _GAP_IN + _BETWEEN_IN
    head = TITLE_IN + _KIND_IN
    figure, upper = new_panel(THIRD_IN, bottom + 1.9 + head, bottom=bottom, top=head)
    plot_kind(upper, curves, one, names)
    upper.set_ylim(*limits[0])
    if legend:
        key = upper.legend(loc="best", fontsize=7, frameon=False, handlelength=1.8, labelspacing=0.3, borderaxespad=0.2)
        for text in key.get_texts():
            text.set_parse_math(False)
    write_title(figure, cut(one.design, 40))
    width, height = figure.get_size_inches()
    words = fitted(one.kind, width - 0.3, 8)
    figure.text(0.06 / width, 1 - 0.25 / height, words, va="top", fontsize=8, parse_math=False)
    make_room(figure, upper)
    box = upper.get_position()
    lower = figure.add_axes((box.x0, 0.46 / height, box.width, _GAP_IN / height), sharex=upper)
    plot_gap(lower, curves, one)
    lower.set_ylim(*limits[1])
    upper.tick_params(labelbottom=False)
    upper.set_xlabel("")
    return figure


def plot_gap(ax: Axes, curves: Curves, one: Kind) -> None:
    """Measured − simulated (dashed) and measured − explained (green); band: ± 1 standard deviation of a sample about 0."""
    x, changed = _along(curves, one), not np.array_equal(curves.explained, curves.simulated)
    ax.axhline(0, color=GREY, linewidth=0.8, zorder=1)
    for here, strength, direction in _lines(curves, one, x):
        at, index = x[here], one.index[here]
        sd = np.nan_to_num(curves.sd[index])
        ax.fill_between(at, -sd, sd, color=BAND, alpha=0.4, linewidth=0, zorder=0.5)
        marks: dict[str, Any] = {"marker": _TURNED.get(direction, "o"), "markersize": 2.8, "alpha": strength}
        ax.plot(
            at,
            (curves.measured - curves.simulated)[index],
            color=OTHER,
            linewidth=1.1,
            linestyle=_DASHED,
            zorder=3,
            **marks,
        )
        if changed:
            ax.plot(at, (curves.measured - curves.explained)[index], color=EXPLAINED, linewidth=1.2, zorder=4, **marks)
    ax.locator_params(axis="y", nbins=4)
    unit = quantity_of(curves, one.quantity).unit
    dress(ax, _axis(one), None)
    ax.set_ylabel(f"gap ({unit})" if unit else "gap", fontsize=8.5, parse_math=False)


def plot_kind(ax: Axes, curves: Curves, one: Kind, names: tuple[str, str]) -> None:
    """Band and line: measured, mean ± SD between samples, ▴ loading and ▾ unloading; dashed: simulated; green: explained.

    Of more than two cycles, the first (pale) and the last.
    """
    x, changed = _along(curves, one), not np.array_equal(curves.explained, curves.simulated)
    measured, simulated, explained = (*names[:1], "simulated", *names[1:])
    for here, strength, direction in _lines(curves, one, x):
        at, index = x[here], one.index[here]
        mean, sd = curves.measured[index], np.nan_to_num(curves.sd[index])
        ax.fill_between(at, mean - sd, mean + sd, color=BAND, alpha=0.6 * strength, linewidth=0, zorder=1)
        marks: dict[str, Any] = {"marker": _TURNED.get(direction, "o"), "markersize": 2.8, "alpha": strength}
        ax.plot(at, mean, color=BLUE, linewidth=1.2, zorder=4, label=measured, **marks)
        ax.plot(at, curves.simulated[index], color=OTHER, linewidth=1.2, linestyle=_DASHED, zorder=3, label=simulated)
        if changed:
            ax.plot(
                at, curves.explained[index], color=EXPLAINED, linewidth=1.3, alpha=strength, zorder=3.5, label=explained
            )
        measured = simulated = explained = ""
    ax.margins(x=0.02)
    dress(ax, _axis(one), None)
    ax.set_ylabel(quantity_of(curves, one.quantity).label, fontsize=8.5, parse_math=False)


def _lines(curves: Curves, one: Kind, x: FloatArray) -> Iterator[tuple[NDArray[np.int64], float, str]]:
    """Places in `one.index` of each line in the order of x, how strongly it is drawn, and its direction."""
    cycles = sorted(set(curves.cycle[one.index].tolist()))
    cycles = cycles if len(cycles) <= _MOST_CYCLES else [cycles[0], cycles[-1]]
    for direction in dict.fromkeys(curves.direction[one.index].tolist()):
        for cycle in reversed(cycles):
            here = np.flatnonzero((curves.direction[one.index] == direction) & (curves.cycle[one.index] == cycle))
            if len(here):
                yield here[np.argsort(x[here], kind="stable")], 1.0 if cycle == cycles[-1] else 0.5, direction


def _axis(one: Kind) -> str:
    return "time held (s)" if one.held else "pressure (MPa)"


def draw_points(curves: Curves, found: list[Kind], names: tuple[str, str], quantity: Quantity) -> Figure:
    """A row a design for tables of means: measured ± SD, simulated and explained."""
    figure, ax = new_panel(WIDE_IN, 1.05 + TITLE_IN + 0.27 * len(found), bottom=0.85, top=TITLE_IN)
    rows = np.arange(len(found), dtype=float)
    index = np.array([one.index[0] for one in found])
    ax.errorbar(curves.measured[index], rows, xerr=np.nan_to_num(curves.sd[index]), fmt="s", color=BLUE, ecolor="black", elinewidth=1.1,
                capsize=3, markersize=4, label=f"{names[0]}, ± 1 SD")  # fmt: skip
    style: dict[str, Any] = {"markersize": 5, "markerfacecolor": "white", "markeredgewidth": 1.2, "zorder": 4}
    ax.plot(curves.simulated[index], rows, "D", color=OTHER, label="simulated", **style)
    if not np.array_equal(curves.explained, curves.simulated):
        ax.plot(curves.explained[index], rows, "o", color=EXPLAINED, label=names[1], **style)
    pressures = {f"{p:.3g}" for p in curves.pressure_MPa[index]}
    several = len(pressures) > 1
    texts = [
        f"{one.design}, {curves.pressure_MPa[i]:.3g} MPa" if several else one.design for one, i in zip(found, index)
    ]
    name_rows(ax, texts, 0.4 * WIDE_IN)
    dress(ax, None, None)
    ax.set_xlabel(quantity.label, fontsize=10, parse_math=False)
    ax.grid(False, axis="y")
    finish(figure, ax, "Means of designs" if several else f"Means of designs at {pressures.pop()} MPa", columns=3)
    return figure


def limits_of(curves: Curves, quantity: str) -> tuple[tuple[float, float], tuple[float, float]]:
    """Limits of values and of gaps for all panels of a quantity, with a little room."""
    kept = curves.quantity == quantity
    measured, simulated, explained = (getattr(curves, name)[kept] for name in ("measured", "simulated", "explained"))
    sd = np.nan_to_num(curves.sd[kept])
    values = np.concatenate([measured - sd, measured + sd, simulated, explained])
    gaps = np.concatenate([-sd, sd, measured - simulated, measured - explained])
    return _room(values), _room(gaps)


def _room(values: FloatArray) -> tuple[float, float]:
    known = values[np.isfinite(values)]
    low, high = (float(known.min()), float(known.max())) if len(known) else (0.0, 1.0)
    room = 0.06 * (high - low) or 0.5
    return low - room, high + room


def _along(curves: Curves, one: Kind) -> FloatArray:
    return (curves.time_s if one.held else curves.pressure_MPa)[one.index]


def _rms(values: FloatArray) -> float:
    known = values[np.isfinite(values)]
    return rms(known) if len(known) else 0.0
