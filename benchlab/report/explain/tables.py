"""What was explained as tables, for the page and for CSV files."""

from __future__ import annotations

from collections.abc import Iterable, Iterator

import numpy as np
from numpy.typing import NDArray

from benchlab.discrepancy.explanation import Curves, Explanation, Tried
from benchlab.report.document import NONE, Cell, Column, Table
from benchlab.report.explain.quantity import effect_words, main_quantity, quantity_of
from benchlab.report.explain.regions import and_words, p_told, pressure_words
from benchlab.report.explain.words import parameter_text, percent, set_words
from benchlab.report.rounding import count, digits, number, words
from benchlab.units import FloatArray


def regions_table(explanation: Explanation) -> Table:
    """Every region by itself, as it was found."""
    several = len({one.quantity for one in explanation.where}) > 1
    columns = (
        Column("design"), Column("quantity", "quantity" * several, False), Column("direction", "direction", False),
        Column("rate_MPa_s", "rate (MPa/s)"), Column("cycle", "cycle"), Column("low_MPa"), Column("high_MPa"),
        Column("", "pressure", False), Column("gap", "measured − simulated"), Column("p", "p"),
    )  # fmt: skip
    rows = tuple(
        (
            words(one.design, 40), words(one.quantity, 30), words(one.direction, 20), digits(one.rate_MPa_s, 2), count(one.cycle),
            digits(one.pressure_MPa[0]), digits(one.pressure_MPa[1]), Cell(None, pressure_words(one.pressure_MPa)),
            Cell(one.gap, quantity_of(explanation.curves, one.quantity).amount(one.gap, signed=True)), _p(one.p),
        )
        for one in explanation.where
    )  # fmt: skip
    holds = (
        "No p, because it is not known how samples scatter."
        if explanation.only_described
        else "p holds for all regions looked at together."
    )
    over_all = " Without a cycle: over all of them." * any(one.cycle is None for one in explanation.where)
    held = " Without a rate: held, or without a time." * any(one.rate_MPa_s is None for one in explanation.where)
    note = f"The gap is averaged over the interval. {holds}{over_all}{held}"
    return Table("regions", "Where measured and simulated differ.", columns, rows, note, by="design", most=15)


def parameters_table(explanation: Explanation) -> Table:
    columns = (
        Column("effect"), Column("form", "form", False), Column("parameter", "parameter", False), Column("what", "what it is", False),
        Column("value", "value"), Column("low"), Column("high"), Column("", "95 % interval"), Column("unit", "unit", False),
    )  # fmt: skip
    rows = []
    for found in explanation.effects:
        for name, estimate in found.parameters.items():
            value, interval = parameter_text(estimate)
            rows.append((
                Cell(found.name, effect_words(found.name)), words(found.form, 30), words(name, 40), words(estimate.what, 90),
                Cell(_finite(estimate.value), value), Cell(_finite(estimate.low), ""), Cell(_finite(estimate.high), ""),
                Cell(None, interval), words(estimate.unit, 20),
            ))  # fmt: skip
    return Table("parameters", "Parameters of what was named.", columns, tuple(rows), by="effect")


def rivals_table(explanation: Explanation, vocabulary: Iterable[str] = ()) -> Table:
    """Candidates that came near, and the names of those in the vocabulary that did not."""
    columns = (
        Column("effects", "candidate", False), Column("form", "form", False), Column("misfit", "misfit"),
        Column("share_explained", "explains"), Column("p_enough", "p, enough"), Column("in_set", "left", False),
        Column("reason", "why", False),
    )  # fmt: skip
    ranked = sorted(explanation.tried, key=lambda one: (not one.in_set, _last(one.misfit), one.names))
    note = (
        "Misfit: −2 log likelihood against the simulation alone; lower is better, and a difference below 2 tells nothing apart. "
        "p, enough: of the test that nothing is missing beside it. Left: not told apart from the best."
    )
    seen = {name for one in explanation.tried for name in one.names} | set(explanation.judged_not)
    if out := [effect_words(name) for name in vocabulary if name not in seen]:
        note += f" Screened out, as their curves explain too little of the gap, or none of what the means show: {and_words(out)}."
    caption = "Candidates that came near, those that are left first, then the best fit first."
    return Table("rivals", caption, columns, tuple(map(_tried, ranked)), note, most=30)


def _tried(one: Tried) -> tuple[Cell, ...]:
    return (
        Cell(" + ".join(one.names), set_words(one.names)), words(one.form, 40), number(one.misfit, 1),
        Cell(_finite(one.share_explained), percent(one.share_explained)),
        _p(one.p_enough), Cell("yes" if one.in_set else "no", "yes" if one.in_set else ""),
        words(one.reason, 120),
    )  # fmt: skip


def designs_table(explanation: Explanation) -> Table:
    """The gap of each design before and after; a line a quantity."""
    columns = (
        Column("quantity"), Column("design", "design", False), Column("features", "features"),
        Column("gap_mean", "mean gap"), Column("rmse_before", "RMSE before"), Column("rmse_after", "RMSE after"),
        Column("largest_left", "largest left"),
    )  # fmt: skip
    rows = []
    curves = explanation.curves
    for name, design, kept in by_design(curves):
        quantity = quantity_of(curves, name)
        gap, left = (curves.measured - model for model in (curves.simulated, curves.explained))
        known = kept & np.isfinite(gap) & np.isfinite(left)
        if not known.any():
            continue
        largest = float(left[known][np.argmax(np.abs(left[known]))])
        values = (float(gap[known].mean()), rms(gap[known]), rms(left[known]), largest)
        told = [Cell(value, quantity.amount(value, signed=index in (0, 3))) for index, value in enumerate(values)]
        rows.append((Cell(name, quantity.label), words(design, 40), count(int(known.sum())), *told))
    note = (
        "A feature is a bin of pressure (or of time in a hold) of a kind of run. Gaps are measured − model, means of the samples; "
        "before: simulated, after: with what was named."
    )
    return Table("designs", "The gap of each design before and after.", columns, tuple(rows), note, by="quantity")


def by_design(curves: Curves) -> Iterator[tuple[str, str, NDArray[np.bool_]]]:
    """Quantity, design and the features of both, in the order in which they come."""
    for name in dict.fromkeys(curves.quantity.tolist()):
        of_quantity = curves.quantity == name
        for design in dict.fromkeys(curves.design[of_quantity].tolist()):
            yield name, design, of_quantity & (curves.design == design)


def held_out_table(explanation: Explanation) -> Table:
    """Each sample, design and rate that was left out of the fit and predicted."""
    columns = (
        Column("left_out", "left out", False), Column("what", "which", False), Column("rmse_before", "RMSE before"),
        Column("rmse_after", "RMSE after"), Column("noise_floor", "noise floor"), Column("", "after / floor"),
    )  # fmt: skip
    quantity = main_quantity(explanation.curves)
    rows = tuple(
        (
            words(one.kind, 20), words(one.what, 50),
            *(Cell(_finite(value), quantity.amount(value)) for value in (one.before, one.after, one.noise_floor)),
            Cell(None, number(one.after / one.noise_floor if one.noise_floor > 0 else None, 2).text),
        )
        for one in explanation.held_out
    )  # fmt: skip
    return Table("held_out", "What the fit had not seen, predicted.", columns, rows, most=40)


def curves_table(explanation: Explanation) -> Table:
    """Every feature, for the CSV file."""
    curves = explanation.curves
    texts = [Column(name, "", False) for name in ("design", "quantity", "kind", "direction")]
    names = ("cycle", "rate_MPa_s", "pressure_MPa", "time_s", "measured", "sd", "n", "simulated", "explained", "p")
    rows = tuple(
        (
            *(words(str(getattr(curves, column.name)[i])) for column in texts),
            count(int(curves.cycle[i])),
            *(Cell(_finite(getattr(curves, name)[i]), "") for name in names[1:]),
        )
        for i in range(len(curves.design))
    )
    return Table("curves", "Every feature.", (*texts, *(Column(name) for name in names)), rows)


def rms(values: FloatArray) -> float:
    return float(np.sqrt(np.mean(np.square(values))))


def _p(p: float) -> Cell:
    return Cell(float(p), p_told(p)) if np.isfinite(p) else Cell(None, NONE)


def _finite(value: float) -> float | None:
    return float(value) if np.isfinite(value) else None


def _last(value: float) -> float:
    """For sorting: what is not known comes last."""
    return value if np.isfinite(value) else np.inf
