"""The recordings of a study, each analysed where it is a video and has changed, and read."""

from __future__ import annotations

import itertools
import os
from collections import Counter
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from benchlab.errors import BenchlabError, InputError
from benchlab.io.angle_table import names_samples
from benchlab.io.files import cannot_write, check_regular_file, sha256
from benchlab.io.run_file import read_provenance
from benchlab.io.study_file import Study, StudyRecording
from benchlab.workflows.analyze import analyze
from benchlab.workflows.outputs import Outputs
from benchlab.workflows.settings import AnalyzeSettings
from benchlab.workflows.study_readings import Readings, Target, read_run, read_table

Place = tuple[str, str, int]
"""Design, sample, and which of its recordings."""


@dataclass(frozen=True)
class StudyItem:
    """One recording to be read. place: design, sample, and which of its recordings. folder, stem: where its analysis goes.

    shared: other samples have it too, as they may have a table.
    """

    place: Place
    recording: StudyRecording
    folder: Path
    stem: str
    shared: bool


def study_items(study: Study, folder: Path) -> Iterator[StudyItem]:
    times = Counter(
        os.path.normpath(recording.path)
        for design in study.designs
        for sample in design.samples
        for recording in sample.recordings
    )
    for design in study.designs:
        for sample in design.samples:
            used: set[str] = set()
            for index, recording in enumerate(sample.recordings):
                name = recording.path.name if recording.path.is_dir() else recording.path.stem
                names = itertools.chain([name], (f"{name}_{number}" for number in itertools.count(2)))
                stem = next(stem for stem in names if stem.casefold() not in used)
                used.add(stem.casefold())
                shared = times[os.path.normpath(recording.path)] > 1
                place = (design.name, sample.name, index)
                yield StudyItem(place, recording, folder / design.name / sample.name, stem, shared)


def read_item(item: StudyItem, target: Target, overwrite: bool) -> dict[str, Any]:
    """One recording, in this process or in a worker: its status, readings and content."""
    recording = item.recording
    if recording.kind == "video":
        return _analysed(item, target, overwrite)
    check_regular_file(recording.path)
    if recording.kind == "run":
        readings = read_run(recording.path, target)
    elif item.shared and not names_samples(recording.path):
        hint = "name its rows' samples there, or give each sample a table of its own"
        raise InputError("stands for several samples, and has no column `sample`", file=recording.path, hint=hint)
    else:
        design, sample, _ = item.place
        readings = read_table(recording.path, design, sample, target)
    return {"status": "read", "partial": False, "readings": readings, "sha256": sha256(recording.path)}


def _analysed(item: StudyItem, target: Target, overwrite: bool) -> dict[str, Any]:
    settings = analyze_settings(item.recording)
    try:
        item.folder.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise cannot_write(error, item.folder) from error
    outputs = Outputs(item.folder, item.stem, overwrite)
    status = analyze(item.recording.path, settings, outputs)["status"]
    return {
        "status": status,
        "partial": status == "partial",
        "readings": read_run(outputs.run_file, target),
        "sha256": (read_provenance(outputs.run_file) or {}).get("sha256", ""),
    }


def left_out_of(recording: StudyRecording, readings: Readings) -> str:
    """Why a recording does not count: the study's reason, or the one that it gives itself; "" where it does."""
    return recording.left_out or readings.never or ("" if recording.counts else readings.unfit)


def copies(measured: Mapping[Place, tuple[str, str]]) -> dict[Place, str]:
    """Which recordings hold what another one before them measured, and whose it is. measured: file and content of each."""
    first: dict[str, Place] = {}
    found = {}
    for place, (file, content) in measured.items():
        other = first.setdefault(content, place)
        if content and other != place:
            design, sample, _ = other
            if measured[other][0] != file:
                found[place] = (
                    f"has the same samples as {measured[other][0]} of {design} {sample}: a copy is no repetition"
                )
    return found


def reason_for(error: BenchlabError, path: Path) -> str:
    """What an error says, without the name of the file that it is told of."""
    elsewhere = error.file if error.file and Path(error.file) != path else None
    return str(BenchlabError(error.what, file=elsewhere, where=error.where, hint=error.hint))


def analyze_settings(recording: StudyRecording) -> AnalyzeSettings:
    """The settings that a study gives for a recording. Raises UsageError for values out of range or without meaning together."""
    given = dict(recording.analysis)
    onset = given.get("sync") == "onset"
    if onset:
        del given["sync"]
    if not (given.get("pressure") or given.get("ramp")):
        given.pop("sync", None)
        onset = False
    for name in ("roi_px", "reference_px"):
        if name in given:
            given[name] = tuple(given[name])
    settings = AnalyzeSettings(**given, sync_onset=onset)
    settings.check()
    return settings
