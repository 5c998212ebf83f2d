"""A table of means, a row a design and pressure, as papers print them."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from benchlab.discrepancy.measured import QUANTITIES, Summary
from benchlab.errors import InputError, counted, printable
from benchlab.io.measured_frame import Rows
from benchlab.units import FloatArray

if TYPE_CHECKING:
    import pandas

STANDARD = "angle_deg"
"""The quantity of a column that is called `mean` and nothing else; told."""

MOST_SAMPLES = 1_000_000_000


def summary_of(rows: Rows) -> Summary:
    """The means in rows. Raises InputError, with the line, for no mean, an n that is no count, a design twice at one pressure."""
    frame, told = rows.frame, rows.warnings
    key, quantity = _mean_of(rows)
    known = np.isfinite(frame[key].to_numpy()) & np.isfinite(frame[rows.x].to_numpy())
    if not known.all():
        told.append(f"{counted(int((~known).sum()), 'row')} without {quantity} or {rows.x} left out")
    rows = Rows(frame[known], rows.source, rows.word, rows.x, rows.against, rows.simulated, told)
    if not known.any():
        raise InputError("no data rows", file=rows.source, hint=f"no row has a mean of {quantity}")
    n = _counts(rows)
    _check_once(rows)
    sd = _spread(rows, quantity, n)
    frame = rows.frame
    order = np.lexsort([frame[rows.x].to_numpy(), frame["design"].astype(str).to_numpy()])
    return Summary(
        tuple(frame["design"].astype(str).to_numpy()[order].tolist()),
        frame[rows.x].to_numpy()[order],
        frame[key].to_numpy()[order],
        sd[order],
        n[order],
        quantity,
        rows.source,
        tuple(told),
    )


def _mean_of(rows: Rows) -> tuple[str, str]:
    """The column of the means, and their quantity."""
    frame: pandas.DataFrame = rows.frame
    candidates = [(f"{name} mean", name) for name in QUANTITIES if f"{name} mean" in frame]
    candidates += [(name, name) for name in QUANTITIES if name in frame]
    if "mean" in frame:
        known = [name for name in QUANTITIES if f"{name} sd" in frame]
        candidates.insert(0, ("mean", known[0] if len(known) == 1 else STANDARD))
        if len(known) != 1:
            rows.warnings.append(
                "column mean tells no quantity: read as angle_deg; name it force_mean_N if it is one of force"
            )
    if not candidates:
        hint = "name the column of means angle_mean_deg, force_mean_N, ..., or say --columns angle_mean_deg=NAME"
        raise InputError("no column of means", file=rows.source, hint=hint)
    for _, other in candidates[1:]:
        if other != candidates[0][1]:
            rows.warnings.append(f"a table of means is read for one quantity, {candidates[0][1]}: {other} is not read")
    return candidates[0]


def _counts(rows: Rows) -> FloatArray:
    if "n" not in rows.frame:
        hint = "add a column n: without the number of samples a mean has no uncertainty"
        raise InputError("no column n", file=rows.source, hint=hint)
    n = rows.frame["n"].to_numpy()
    wrong = ~((n >= 1) & (n <= MOST_SAMPLES) & (n == np.round(n)))
    if wrong.any():
        at = int(np.argmax(wrong))
        raise rows.refused(f"n is {n[at]:g}, not a count from 1", at, "give the number of samples behind the mean")
    if (n < 2).any():
        rows.warnings.append(
            f"{counted(int((n < 2).sum()), 'mean')} of one sample: how samples scatter is not known there"
        )
    return n


def _spread(rows: Rows, quantity: str, n: FloatArray) -> FloatArray:
    """The standard deviations, NaN where there is none."""
    key = next((key for key in (f"{quantity} sd", "sd") if key in rows.frame), None)
    sd = np.full(len(n), np.nan) if key is None else rows.frame[key].to_numpy().copy()
    if missing := int(((n >= 2) & ~np.isfinite(sd)).sum()):
        rows.warnings.append(f"{counted(missing, 'mean')} without a standard deviation")
    return sd


def _check_once(rows: Rows) -> None:
    frame = rows.frame
    again = frame.duplicated(["design", rows.x]).to_numpy()
    if again.any():
        at = int(np.argmax(again))
        row = frame.iloc[at]
        first = frame[(frame["design"] == row["design"]) & (frame[rows.x] == row[rows.x])].index[0]
        what = f"{printable(row['design'])} at {row[rows.x]:g} stands twice, first in {rows.word} {first}"
        raise rows.refused(what, at, "give one row a design and pressure")
