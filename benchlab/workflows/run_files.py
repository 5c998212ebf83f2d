"""What is left of a run: its files, and what it came to in words and numbers."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from benchlab.errors import BenchlabError, InputError, counted
from benchlab.io.nexus import plain
from benchlab.runner.stop import Stop
from benchlab.workflows.drawn_film import Progress
from benchlab.workflows.drive_outputs import write_results
from benchlab.workflows.run import Driven
from benchlab.workflows.run_prepare import Prepared

INTERRUPTED = 130


class EnoughError(Exception):
    """Whoever asked for the film does not want it any more."""


def written(
    prepared: Prepared, driven: Driven, stop: Stop | None = None, progress: Progress | None = None
) -> dict[str, Any]:
    """Write drive file, table, picture and, of a twin, its truth and, if asked for, its film from the journal; what `--json` prints.

    The journal stays whatever happens. What cannot be made of it is a warning, and exit code 3 where the run itself ended well, or 130
    where somebody interrupted it: `stop` says so. progress: called with frames drawn and frames in all.
    """
    end, made = driven.end, [driven.journal]
    troubles, code = [end.trouble] if end.trouble and end.reason != "journal" else [], InputError.exit_code
    try:
        _write_results(prepared, driven, made)
        _write_film(prepared, driven, made, stop or Stop(), progress)
    except BenchlabError as error:
        if driven.journal.exists():
            troubles.append(f"no further files: {error}{_again(driven) if len(made) == 1 else ''}")
    except EnoughError:
        troubles.append("the film was not drawn: interrupted")
        code = INTERRUPTED
    except KeyboardInterrupt:
        troubles.append(f"interrupted while files were written{_again(driven)}")
        code = INTERRUPTED
    gone = [path for path in made if not path.exists()]
    if driven.journal in gone and not end.trouble:
        troubles.append(f"{driven.journal} is gone: somebody took it away while it was written")
    warnings = [*prepared.warnings, *driven.about.get("notes", ()), *_doubts(prepared, driven), *troubles]
    found: dict[str, Any] = {
        "title": prepared.plan.title,
        "bench": str(prepared.spec),
        **end.record(),
        "control": prepared.control,
        "guards_off": list(prepared.limits.off),
        "late_ms": None if prepared.fast else end.late_ms,
        "went_first": driven.went_first,
        "exit_code": end.exit_code or (code if troubles else 0),
        "warnings": warnings,
        "outputs": [str(path) for path in made if path not in gone],
    }
    if found["exit_code"]:
        words = " ".join(troubles) if end.completed else f"{end.reason}: {end.cause.words}"
        if end.emptied.empty is False and end.reason != "not empty":
            words += f"; and after the vent {end.emptied.words}"
        found["error"] = {"code": found["exit_code"], "what": words, "file": None, "where": None, "hint": None}
    return {name: plain(value) for name, value in found.items()}


def _again(driven: Driven) -> str:
    """How to make what is missing."""
    return (
        f"; make them with `benchlab recover {driven.journal}`" if driven.end.ticks and driven.journal.exists() else ""
    )


def _write_results(prepared: Prepared, driven: Driven, made: list[Path]) -> None:
    made += [Path(path) for path in write_results(driven.journal)["outputs"]]
    if driven.truth is not None:
        from benchlab.io.truth_table import write_truth_csv

        path = prepared.path(".truth.csv")
        write_truth_csv(path, driven.truth)
        made.append(path)


def _write_film(prepared: Prepared, driven: Driven, made: list[Path], stop: Stop, progress: Progress | None) -> None:
    if not prepared.settings.video or prepared.twin is None:
        return
    from benchlab.workflows.twin_film import write_twin_film

    def drawn(done: int, total: int | None) -> None:
        if stop.enough:
            raise EnoughError
        if progress is not None:
            progress(done, total)

    path = prepared.path(".film.mp4")
    drawn(0, None)
    write_twin_film(path, driven.truth, prepared.twin, progress=drawn)
    made.append(path)


def _doubts(prepared: Prepared, driven: Driven) -> list[str]:
    """What whoever uses the run should know beside its cause."""
    end, controller = driven.end, prepared.controller
    found = []
    if end.faults:
        found.append(f"{counted(end.faults, 'fault')} on the way, each in the journal with its cause")
    if not end.vented:
        found.append(f"nobody confirmed the vent: {end.vent_words}")
    if limited := getattr(controller, "limited", 0):
        found.append(f"the controller was at a limit of pressure in {limited} ticks")
    return found
