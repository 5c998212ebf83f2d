"""What is doubtful about the cycles of a force record: one plain sentence each."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from benchlab.force.clocks import lag_s
from benchlab.force.peaks import ForceRecord
from benchlab.units import FloatArray

RESTING = 0.05
"""Share of the largest pressure that a rest may be under."""

LATE = 0.3
"""Share of a cycle's loaded time that the force may come before or behind the pressure."""


def doubts_of(record: ForceRecord) -> Iterator[str]:
    """What is doubtful about its peaks, whatever they are for."""
    yield from record.notes[-1:]
    if record.clipped_at_N is not None:
        clipped = [p.number for p in record.peaks if p.lower_bound]
        yield f"the load cell is at its limit: peaks are clipped at {record.clipped_at_N:.2f} N in {named_cycles(clipped)}, and count as ≥"
    elif missing := [p.number for p in record.peaks if p.lower_bound]:
        yield f"readings are missing while loaded in {named_cycles(missing)}: their peaks count as ≥"
    if alone := [p.number for p in record.peaks if p.alone]:
        yield f"readings that stand alone, far from both neighbours, do not count in {named_cycles(alone)}"
    if coarse := [p.number for p in record.peaks if p.coarse]:
        yield f"few readings in {named_cycles(coarse)}: their peaks are the largest readings, with all of their noise"


def doubts_of_cycles(record: ForceRecord, pressure: FloatArray | None) -> Iterator[str]:
    """What is doubtful about cycles whose pressures are known: cut ones, no rest, and rests under pressure."""
    for peak in record.peaks:
        if peak.cut:
            yield f"cycle {peak.number} was left out: {peak.why}"
    if record.baseline is None:
        return
    if not record.baseline.flat.any():
        yield "the force nowhere rests unloaded: the lowest between loadings is taken as its zero"
    if pressure is None:
        return
    known = np.flatnonzero(np.isfinite(pressure))
    resting = pressure[known[np.searchsorted(known, record.baseline.place.astype(int)).clip(0, len(known) - 1)]]
    most, largest = float(resting.max()), float(np.nanmax(pressure))
    if most > RESTING * largest:
        share = f"{most / largest:.0%} of the largest"
        yield f"the pressure is still {most:.3g} MPa in a rest between cycles ({share}): is the force unloaded where its zero is taken?"


def doubt_of_clocks(record: ForceRecord, time: FloatArray, force: FloatArray, pressure: FloatArray) -> Iterator[str]:
    """A doubt where the force comes well before or behind the pressure."""
    loaded = float(np.nanmedian([time[c.fall] - time[c.rise] for c in record.loadings]))
    if abs(late := lag_s(time, force, pressure)) > LATE * loaded:
        where = "behind" if late > 0 else "before"
        yield f"the force comes {abs(late):.3g} s {where} the pressure, which is on for {loaded:.3g} s: do their clocks agree?"


def named_cycles(numbers: list[int]) -> str:
    """Cycles in words.

    >>> named_cycles([5]), named_cycles(list(range(1, 10)))
    ('cycle 5', 'cycles 1, 2, 3, 4, 5, 6 and 3 more')
    """
    listed = ", ".join(map(str, numbers[:6])) + (f" and {len(numbers) - 6} more" if len(numbers) > 6 else "")
    return f"cycle{'s' * (len(numbers) != 1)} {listed}"
