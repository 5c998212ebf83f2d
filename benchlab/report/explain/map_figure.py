"""The gap as a map: rows of designs, directions, rates and cycles against pressure; red where measured is more, blue where it is less."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass
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
_ORDER = {"loading": 0, "hold": 1, "unloading": 2, "rest": 3}
_ROW_IN, _FOOT_IN, _BAR_IN = 0.2, 0.52, 0.62


@dataclass(frozen=True)
class GapMap:
    """designs, details: of the rows (direction, rate, cycle, where they vary). pressure_MPa: (C + 1,) edges of the columns.

    gap: (rows, C), NaN where nothing was measured; sure: where any p of the cell is below ALPHA. hidden: designs that are not there.
    """

    designs: tuple[str, ...]
    details: tuple[str, ...]
    pressure_MPa: FloatArray
    gap: FloatArray
    sure: NDArray[np.bool_]
    hidden: int = 0


def gap_map(curves: Curves, quantity: str, model: Model = "simulated", most: int = MOST_ROWS) -> GapMap:
    """Mean gap of the features of each cell. Where rows were more than `most`, cycles and then rates are averaged over (directions never:
    their gaps may cancel); where they still are, the designs with the largest gaps of the simulation are kept."""
    kept = np.flatnonzero(curves.quantity == quantity)
    level, rows = next((found for found in _rows_by_level(curves, kept) if len(found[1]) <= most), ((), {}))
    if not rows:
        level, rows = list(_rows_by_level(curves, kept))[-1]
    designs = _kept_designs(curves, rows, most)
    order = [key for key in _ordered(rows, list(dict.fromkeys(curves.design[kept].tolist()))) if key[0] in designs]
    edges = _edges(curves.pressure_MPa[kept])
    cells = [_row(curves, np.array(rows[key]), edges, model) for key in order]
    varied = [len({key[1 + i] for key in order}) > 1 for i in range(len(level))]
    details = [
        ", ".join(filter(None, (_told(part) for part, several in zip(key[1:], varied) if several))) for key in order
    ]
    gap, sure = (np.array([cell[part] for cell in cells]) for part in (0, 1))
    return GapMap(
        tuple(key[0] for key in order),
        tuple(details),
        edges,
        gap,
        sure,
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


def _row(
    curves: Curves, index: NDArray[np.int64], edges: FloatArray, model: Model
) -> tuple[FloatArray, NDArray[np.bool_]]:
    """Mean gap and whether it is sure, (C,) each."""
    column = np.clip(np.searchsorted(edges, curves.pressure_MPa[index], side="right") - 1, 0, len(edges) - 2)
    difference = (curves.measured - getattr(curves, model))[index]
    gap, sure = np.full(len(edges) - 1, np.nan), np.zeros(len(edges) - 1, dtype=bool)
    for each in np.unique(column[np.isfinite(difference)]):
        here = (column == each) & np.isfinite(difference)
        gap[each], sure[each] = difference[here].mean(), (curves.p[index][here] < ALPHA).any()
    return gap, sure


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
    rows = np.arange(len(found.designs) + 1) - 0.5
    masked = np.ma.masked_invalid(found.gap)
    ax.set_facecolor("#eeeeee")
    drawn = ax.pcolormesh(
        found.pressure_MPa, rows, masked, cmap="RdBu_r", vmin=-limit, vmax=limit, edgecolors="white", linewidth=0.4
    )
    middles = (found.pressure_MPa[1:] + found.pressure_MPa[:-1]) / 2
    if dots:
        row, column = np.nonzero(found.sure)
        ax.plot(middles[column], row, "o", color="black", markersize=2.6, markeredgecolor="white", markeredgewidth=0.5)
    starts = [i for i, design in enumerate(found.designs) if i == 0 or found.designs[i - 1] != design]
    ax.hlines(np.array(starts[1:]) - 0.5, *found.pressure_MPa[[0, -1]], color=GREY, linewidth=0.8)
    ax.set_yticks(range(len(found.designs)), _row_names(found, starts, name_in), **TEXT)
    ax.tick_params(axis="y", length=0)
    ax.set_ylim(len(found.designs) - 0.5, -0.5)
    dress(ax, "pressure (MPa)", None)
    ax.grid(False)
    if len(middles) == 1:
        ax.set_xticks(middles, [f"{middles[0]:.3g}"])
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


def _edges(pressure_MPa: FloatArray) -> FloatArray:
    """Edges of columns: between the pressures where there are few, else of even columns."""
    known = np.unique(np.round(pressure_MPa[np.isfinite(pressure_MPa)], 4))
    if len(known) < 2:
        middle = float(known[0]) if len(known) else 0.0
        return np.array([middle - 0.5, middle + 0.5])
    if len(known) > MOST_COLUMNS:
        return np.linspace(known[0], known[-1], MOST_COLUMNS + 1)
    between = (known[1:] + known[:-1]) / 2
    return np.concatenate([[2 * known[0] - between[0]], between, [2 * known[-1] - between[-1]]])
