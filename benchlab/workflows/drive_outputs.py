"""From the journal of a run to its drive file, table and picture: at the normal end of a run and after a crash alike."""

from __future__ import annotations

import tempfile
from pathlib import Path
from typing import Any

from benchlab.errors import InputError, UsageError
from benchlab.io.drive_file import origin, write_drive_file
from benchlab.io.drive_gaps import gaps_of
from benchlab.io.drive_table import write_drive_csv
from benchlab.io.files import cannot_write, check_new_file, check_regular_file, make_folder, sha256, written_whole
from benchlab.io.journal import Journal, read_journal, still_written, vent_told
from benchlab.report.drive_figure import draw_drive_figure
from benchlab.report.figures import save_png
from benchlab.workflows.outputs import Outputs

SUFFIXES = (".h5", ".csv", ".png")


def write_results(path: Path, out: Path | None = None, overwrite: bool = False) -> dict[str, Any]:
    """Write `<name>.h5`, `.csv` and `.png` of a journal beside it, or in the folder `out`, and say what is in them.

    The journal is only read. Raises UsageError for a journal that is still being written, a missing folder, or a file that is there
    without `overwrite`, and InputError for what is no journal, one without a sample, or a disk that refuses. A folder whose last part
    alone is missing is made. Where another process makes the same files, UsageError.
    """
    check_regular_file(path)
    if still_written(path):
        raise UsageError("is still being written", file=path, hint="its run makes these files itself when it ends")
    folder = out or path.parent
    outputs = [folder / f"{path.stem}{suffix}" for suffix in SUFFIXES]
    if path.resolve() in [output.resolve() for output in outputs]:
        raise UsageError("is read here and would be replaced", file=path, hint="give the journal another name")
    journal = read_journal(path)
    if not len(journal.samples):
        raise InputError("holds no sample", file=path, hint="the run ended before its first tick was answered")
    make_folder(folder)
    with Outputs(folder, path.stem).locked():
        for output in outputs:
            check_new_file(output, overwrite)
        _write_together(journal, path, outputs)
    return {"journal": str(path), **summary(journal), "outputs": [str(output) for output in outputs]}


def _write_together(journal: Journal, path: Path, outputs: list[Path]) -> None:
    """Make all files in a hidden folder and move them to their places: all, or none where the disk refuses."""
    folder = outputs[0].parent
    try:
        with tempfile.TemporaryDirectory(dir=folder, prefix=f".{path.stem[:40]}-") as hidden:
            stage = [Path(hidden, output.name) for output in outputs]
            drive_file, table, picture = stage
            write_drive_file(drive_file, journal, {"file": path.name, "sha256": sha256(path)})
            write_drive_csv(table, journal)
            with written_whole(picture) as temporary:
                save_png(draw_drive_figure(journal), temporary)
            for made, output in zip(stage, outputs):
                made.replace(output)
    except OSError as error:
        raise cannot_write(error, folder) from error
    except InputError as error:
        raise InputError(error.what, file=folder, hint=error.hint) from error


def summary(journal: Journal) -> dict[str, Any]:
    """What a journal holds and lacks, in JSON's own types.

    complete: whether it has a record of its end. vented, empty: None where nobody knows; left: how the bench was left, in words.
    """
    stop = journal.stop or {}
    plan = journal.header.get("plan")
    return {
        "title": str(journal.header.get("title", "")),
        "origin": origin(journal.header) or "measured",
        "complete": journal.complete,
        "reason": stop.get("reason"),
        "words": stop.get("words"),
        "vented": stop.get("vented"),
        "empty": stop.get("empty"),
        "left": vent_told(stop) if stop else None,
        "samples": len(journal.samples),
        "ticks": len(set(journal.samples["tick"].tolist())),
        "ticks_planned": plan.get("ticks") if isinstance(plan, dict) else None,
        "last_time_s": float(journal.samples["time_s"][-1]),
        "last_command_MPa": float(journal.samples["command_MPa"][-1]),
        "events": len(journal.events),
        "lost_bytes": journal.lost_bytes,
        "lost": journal.losses_told,
        "missing_ticks": sum(gap.ticks for gap in gaps_of(journal)),
        "gaps": [gap.words for gap in gaps_of(journal)],
    }
