"""The gap as a map: rows of designs, directions, rates and cycles against pressure; red where measured is more, blue where it is less."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, replace
from itertools import pairwise
from typing import TYPE_CHECKING, Any, Literal

import numpy as np
from numpy.typing import NDArray

from benchlab.discrepancy.explanation import Curves
from benchlab.report.document import cut
from benchlab.report.explain.quantity import Quantity
from benchlab.report.explain.regions import rate_key
from benchlab.report.panels import GREY, dress
from benchlab.report.study.figures import TEXT, TITLE_IN, WIDE_IN, make_room, new_panel, write_title
from benchlab.report.wording import fitted, fitted_apart, width_in
from benchlab.units import FloatArray

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

MOST_ROWS, MOST_COLUMNS = 60, 24
ALPHA = 0.05
"""Probability below which a gap is dotted."""

Model = Literal["simulated", "explained"]

_LEVELS = (("direction", "rate", "cycle"), ("direction", "rate"), ("direction",))
RAMPS = ("loading", "unloading")
_ORDER = {"loading": 0, "hold": 1, "unloading": 2, "rest": 3}
_ROW_IN, _FOOT_IN, _BAR_IN = 0.2, 0.52, 0.62


@dataclass(frozen=True)
class Row:
    """The cells of a row side by side, C of them. edges_MPa: (C + 1,); middle_MPa, gap: means of the cell's features; sure: where any p of
    them is below ALPHA."""

    edges_MPa: FloatArray
    middle_MPa: FloatArray
    gap: FloatArray
    sure: NDArray[np.bool_]


@dataclass(frozen=True)
class GapMap:
    """designs, details: of the rows (direction, rate, cycle, where they vary). rows: what each has. hidden: designs that are not there."""

    designs: tuple[str, ...]
    details: tuple[str, ...]
    rows: tuple[Row, ...]
    hidden: int = 0


def gap_map(curves: Curves, quantity: str, model: Model = "simulated", most: int = MOST_ROWS) -> GapMap:
    """Mean gap of the features of each cell; a row has its own cells.

    Where rows were more than `most`, cycles and then rates are averaged over (directions never:
    their gaps may cancel); where they still are, the designs with the largest gaps of the simulation are kept."""
    kept = np.flatnonzero(curves.quantity == quantity)
    level, rows = next((found for found in _rows_by_level(curves, kept) if len(found[1]) <= most), ((), {}))
    if not rows:
        level, rows = list(_rows_by_level(curves, kept))[-1]
    designs = _kept_designs(curves, rows, most)
    order = [key for key in _ordered(rows, list(dict.fromkeys(curves.design[kept].tolist()))) if key[0] in designs]
    parts = [_cells(curves, np.array(rows[key]), _together(curves, kept), model) for key in order]
    usual = [np.diff(part.middle_MPa).min() for part in parts if len(part.middle_MPa) > 1]
    width = float(np.median(usual)) if usual else 1.0
    varied = [len({key[1 + i] for key in order}) > 1 for i in range(len(level))]
    details = [
        ", ".join(filter(None, (_told(part) for part, several in zip(key[1:], varied) if several))) for key in order
    ]
    ends = _ends([part.middle_MPa for part in parts], [key[1] in RAMPS for key in order])
    return GapMap(
        tuple(key[0] for key in order),
        tuple(details),
        tuple(replace(part, edges_MPa=_edges(part.middle_MPa, width).clip(*ends)) for part in parts),
        len(dict.fromkeys(curves.design[kept].tolist())) - len(designs),
    )


def _rows_by_level(curves: Curves, kept: NDArray[np.int64]) -> Iterator[tuple[tuple[str, ...], dict[Any, list[int]]]]:
    """Features of each row, from the finest rows to the coarsest."""
    for level in _LEVELS:
        rows: dict[Any, list[int]] = {}
        for i in kept.tolist():
            rows.setdefault((str(curves.design[i]), *(_part(curves, i, part) for part in level)), []).append(i)
        yield level, rows


def _kept_designs(curves: Curves, rows: dict[Any, list[int]], most: int) -> set[str]:
    gap = np.nan_to_num(np.abs(curves.measured - curves.simulated))
    largest: dict[str, float] = {}
    for key, index in rows.items():
        largest[key[0]] = max(largest.get(key[0], 0.0), float(gap[index].max()))
    each = max(1, len(rows) // max(len(largest), 1))
    return set(sorted(largest, key=lambda design: -largest[design])[: max(1, most // each)])


def _ordered(rows: Iterable[Any], designs: list[str]) -> list[Any]:
    return sorted(rows, key=lambda key: (designs.index(key[0]), *(_rank(part) for part in key[1:])))


def _together(curves: Curves, kept: NDArray[np.int64]) -> float:
    """Pressures that are not further apart are one cell: a part of all pressures, as holds scatter about theirs."""
    known = curves.pressure_MPa[kept]
    return float(np.ptp(known[np.isfinite(known)])) / MOST_COLUMNS if np.isfinite(known).any() else 0.0


def _cells(curves: Curves, index: NDArray[np.int64], together_MPa: float, model: Model) -> Row:
    """A row without its edges. Where it has several kinds of run, directions or cycles, their bins that lie half a step apart are one."""
    gap = (curves.measured - getattr(curves, model))[index]
    kept = np.isfinite(gap) & np.isfinite(curves.pressure_MPa[index])
    index, gap = index[kept], gap[kept]
    pressure = curves.pressure_MPa[index]
    steps = [np.median(np.diff(np.sort(pressure[mine]))) for mine in _runs_alike(curves, index) if mine.sum() > 1]
    together_MPa = max([together_MPa, *(float(step) / 2 for step in steps)])
    order = np.argsort(pressure, kind="stable")
    groups: list[list[int]] = []
    for i in order.tolist():
        if groups and pressure[i] - pressure[groups[-1][0]] <= together_MPa:
            groups[-1].append(i)
        else:
            groups.append([i])
    return Row(
        np.empty(0),
        np.array([pressure[group].mean() for group in groups]),
        np.array([gap[group].mean() for group in groups]),
        np.array([bool((curves.p[index[group]] < ALPHA).any()) for group in groups], dtype=bool),
    )


def _runs_alike(curves: Curves, index: NDArray[np.int64]) -> Iterator[NDArray[np.bool_]]:
    """Of each kind of run, direction and cycle, which they are."""
    names = list(zip(curves.kind[index].tolist(), curves.direction[index].tolist(), curves.cycle[index].tolist()))
    for one in dict.fromkeys(names):
        yield np.array([name == one for name in names])


def _ends(middles_MPa: Sequence[FloatArray], ramps: Sequence[bool]) -> tuple[float, float]:
    """Where the data begin and end: half an interval beyond the outermost of a ramp, and where a hold is held. One pressure has room.

    >>> _ends([np.array([0.25, 0.75]), np.array([0.5, 0.75])], [True, False])
    (0.0, 1.0)
    """
    half = [float(np.diff(row).min()) / 2 if ramp and len(row) > 1 else 0.0 for row, ramp in zip(middles_MPa, ramps)]
    spans = [(row[0] - more, row[-1] + more) for row, more in zip(middles_MPa, half) if len(row)]
    low, high = min((low for low, _ in spans), default=0.0), max((high for _, high in spans), default=0.0)
    return (float(low), float(high)) if high > low else (-np.inf, np.inf)


def _edges(middle_MPa: FloatArray, width_MPa: float) -> FloatArray:
    """(C + 1,): between the middles, the ends as far out as the next edge is in, yet not below 0; of one alone, as wide as usual.

    >>> _edges(np.array([0.02, 0.06, 0.10]), 0.04).round(3).tolist(), _edges(np.array([0.35]), 0.04).round(3).tolist()
    ([0.0, 0.04, 0.08, 0.12], [0.33, 0.37])
    """
    if len(middle_MPa) < 2:
        return np.concatenate([middle_MPa - width_MPa / 2, middle_MPa + width_MPa / 2])
    between = (middle_MPa[1:] + middle_MPa[:-1]) / 2
    first, last = 2 * middle_MPa[0] - between[0], 2 * middle_MPa[-1] - between[-1]
    return np.concatenate([[max(first, 0.0) if middle_MPa[0] >= 0 else first], between, [last]])


def draw_gap_map(
    found: GapMap, quantity: Quantity, title: str, limit: float, dots: bool = True, width: float = WIDE_IN
) -> Figure:
    """limit: the gap at the ends of the colours, that of the map before where two are to be compared."""
    height = TITLE_IN + _ROW_IN * max(len(found.designs), 3) + _FOOT_IN
    figure, ax = new_panel(width, height, bottom=_FOOT_IN, top=TITLE_IN)
    box = ax.get_position()
    ax.set_position((box.x0, box.y0, box.width - _BAR_IN / width, box.height))
    drawn = plot_gap_map(ax, found, limit, dots, 0.42 * width)
    write_title(figure, title)
    make_room(figure, ax)
    plot_colours(figure, ax, drawn, quantity)
    return figure


def plot_gap_map(ax: Axes, found: GapMap, limit: float, dots: bool, name_in: float) -> Any:
    """Cells, dots where the gap is sure, a line between designs; returns what the colours belong to."""
    from matplotlib.collections import PolyCollection

    cells = [(at, *pair) for at, row in enumerate(found.rows) for pair in pairwise(row.edges_MPa.tolist())]
    corners = [[(a, at - 0.5), (b, at - 0.5), (b, at + 0.5), (a, at + 0.5)] for at, a, b in cells]
    drawn = PolyCollection(corners, cmap="RdBu_r", edgecolors="white", linewidths=0.4)
    drawn.set_array(np.concatenate([row.gap for row in found.rows]))
    drawn.set_clim(-limit, limit)
    ax.set_facecolor("#eeeeee")
    ax.add_collection(drawn)
    middles = np.array([(a + b) / 2 for _, a, b in cells])
    if dots:
        sure = np.concatenate([row.sure for row in found.rows])
        rows = np.array([at for at, _, _ in cells])
        ax.plot(
            middles[sure], rows[sure], "o", color="black", markersize=2.6, markeredgecolor="white", markeredgewidth=0.5
        )
    ends = (min((a for _, a, _ in cells), default=0.0), max((b for _, _, b in cells), default=1.0))
    ax.set_xlim(*ends)
    starts = [i for i, design in enumerate(found.designs) if i == 0 or found.designs[i - 1] != design]
    ax.hlines(np.array(starts[1:]) - 0.5, *ends, color=GREY, linewidth=0.8)
    ax.set_yticks(range(len(found.designs)), _row_names(found, starts, name_in), **TEXT)
    ax.tick_params(axis="y", length=0)
    ax.set_ylim(len(found.designs) - 0.5, -0.5)
    dress(ax, "pressure (MPa)", None)
    ax.grid(False)
    if len(alone := {round(float(middle), 6) for middle in middles}) == 1:
        ax.set_xticks([*alone], [f"{alone.pop():.3g}"])
    return drawn


def _row_names(found: GapMap, starts: list[int], inches: float) -> list[str]:
    """The design where its rows begin, and the detail of each row; the design is cut where both have no room."""
    texts = list(found.details)
    heads = fitted_apart([found.designs[i] for i in starts], inches, TEXT["fontsize"])
    rooms = [inches - width_in(f", {found.details[i]}", TEXT["fontsize"]) for i in starts]
    for i, head, room in zip(starts, heads, rooms):
        detail = found.details[i]
        texts[i] = f"{fitted(found.designs[i], room, TEXT['fontsize'])}, {detail}" if detail else head
    return texts


def plot_colours(figure: Figure, ax: Axes, drawn: Any, quantity: Quantity) -> None:
    """The scale of the colours, beside the map."""
    width, height = figure.get_size_inches()
    box = ax.get_position()
    tall = min(box.height, 2.6 / height)
    bar = figure.colorbar(drawn, cax=figure.add_axes((box.x1 + 0.1 / width, box.y1 - tall, 0.12 / width, tall)))
    bar.ax.tick_params(labelsize=7.5, color=GREY)
    bar.outline.set_visible(False)
    unit = f" ({quantity.unit})" * bool(quantity.unit)
    short = tall * height < 1.9
    label = f"gap{unit}" if short else f"measured − model{unit}"
    bar.set_label(label, fontsize=7.5, parse_math=False, labelpad=1)


def colour_limit(curves: Curves, quantity: str) -> float:
    """The gap at the ends of the colours: the largest of the simulation, but not less than two standard deviations of a sample, so that
    scatter looks pale."""
    kept = curves.quantity == quantity
    gaps, spread = np.abs(curves.measured - curves.simulated)[kept], curves.sd[kept]
    sizes = [float(np.max(known)) for known in (gaps[np.isfinite(gaps)],) if len(known)]
    usual = [2 * float(np.median(known)) for known in (spread[np.isfinite(spread)],) if len(known)]
    return max([*sizes, *usual, 1e-9])


def _part(curves: Curves, index: int, part: str) -> Any:
    if part == "rate":
        return rate_key(float(curves.rate_MPa_s[index])) or 0.0
    return str(curves.direction[index]) if part == "direction" else int(curves.cycle[index])


def _rank(part: Any) -> Any:
    return _ORDER.get(part, len(_ORDER)) if isinstance(part, str) else part


def _told(part: Any) -> str:
    if isinstance(part, str):
        return cut(part, 16)
    return f"cycle {part}" if isinstance(part, int) else f"{part:g} MPa/s" if part else ""
