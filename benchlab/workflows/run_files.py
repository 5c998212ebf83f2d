"""What is left of a run: its files, and what it came to in words and numbers."""

from __future__ import annotations

from typing import Any

from benchlab.errors import BenchError, BenchlabError, InputError
from benchlab.io.nexus import plain
from benchlab.workflows.drive_outputs import write_results
from benchlab.workflows.run import Driven
from benchlab.workflows.run_prepare import Prepared


def written(prepared: Prepared, driven: Driven) -> dict[str, Any]:
    """Write drive file, table, picture and, of a twin, its truth and, if asked for, its film from the journal; what `--json` prints.

    The journal stays whatever happens. What cannot be made of it is a warning, and exit code 3 where the run itself ended well.
    """
    end = driven.end
    outputs, troubles = [str(driven.journal)], [end.trouble] if end.trouble else []
    try:
        outputs += _results(prepared, driven)
    except BenchlabError as error:
        again = f"; make them with `benchlab recover {driven.journal}`" if end.ticks else ""
        troubles.append(f"no further files: {error}{again}")
    warnings = [*prepared.warnings, *driven.about.get("notes", ()), *_doubts(prepared, driven), *troubles]
    found: dict[str, Any] = {
        "title": prepared.plan.title,
        "bench": str(prepared.spec),
        **end.record(),
        "control": prepared.control,
        "late_ms": None if prepared.fast else end.late_ms,
        "went_first": driven.went_first,
        "exit_code": BenchError.exit_code
        if driven.left
        else end.exit_code or (InputError.exit_code if troubles else 0),
        "warnings": warnings,
        "outputs": outputs,
    }
    if found["exit_code"]:
        words = driven.left or (" ".join(troubles) if end.completed else f"{end.reason}: {end.cause.words}")
        found["error"] = {"code": found["exit_code"], "what": words, "file": None, "where": None, "hint": None}
    return {name: plain(value) for name, value in found.items()}


def _results(prepared: Prepared, driven: Driven) -> list[str]:
    made = list(write_results(driven.journal)["outputs"])
    if driven.truth is not None:
        from benchlab.io.truth_table import write_truth_csv

        path = prepared.path(".truth.csv")
        write_truth_csv(path, driven.truth)
        made.append(str(path))
    if prepared.settings.video and prepared.twin is not None:
        from benchlab.workflows.twin_film import write_twin_film

        path = prepared.path(".film.mp4")
        write_twin_film(path, driven.truth, prepared.twin)
        made.append(str(path))
    return made


def _doubts(prepared: Prepared, driven: Driven) -> list[str]:
    """What whoever uses the run should know beside its cause."""
    end, controller = driven.end, prepared.controller
    found = []
    if end.faults:
        found.append(f"{end.faults} faults on the way, each in the journal with its cause")
    if not end.vented:
        found.append(f"nobody confirmed the vent: {end.vent_words}")
    if driven.left:
        found.append(driven.left)
    if limited := getattr(controller, "limited", 0):
        found.append(f"the controller was at a limit of pressure in {limited} ticks")
    return found
