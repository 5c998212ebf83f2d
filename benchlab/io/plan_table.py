"""A plan as a table: a row a tick."""

from __future__ import annotations

import csv
import math
from pathlib import Path

from benchlab.io.files import written_whole
from benchlab.protocol.plan import Plan

COLUMNS = ("time_s", "pressure_MPa", "reference_deg", "step", "kind", "event")


def write_plan_csv(path: Path, plan: Plan) -> None:
    """Each tick with the pressure or the angle that it asks for (the other is empty), its step (from 1) with its kind, and its events, as
    `mark: TEXT; trigger: camera`. InputError where the disk refuses."""
    events = {
        tick: "; ".join(f"{event.kind}: {event.text}" for event in here) for tick, here in plan.events_by_tick().items()
    }
    rows = zip(plan.time_s.tolist(), plan.pressure_MPa.tolist(), plan.reference_deg.tolist(), plan.step.tolist())
    with written_whole(path) as temporary, temporary.open("w", newline="", encoding="utf-8") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(COLUMNS)
        for tick, (time_s, pressure, reference, step) in enumerate(rows):
            values = ("" if math.isnan(value) else f"{value:.9g}" for value in (pressure, reference))
            writer.writerow([f"{time_s:.9g}", *values, step + 1, plan.steps[step].kind, events.get(tick, "")])
