"""`benchlab study check`: what a study has and what it lacks, without analysing anything."""

from __future__ import annotations

import os
from collections import Counter
from collections.abc import Iterator
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np

from benchlab.errors import BenchlabError, counted
from benchlab.io.lens_file import read_lens
from benchlab.io.pressure import ramp, read_pressure
from benchlab.io.study_file import Study, StudyDesign, StudyRecording, StudySample, read_study
from benchlab.io.study_values import ALL_DESIGNS, Missing
from benchlab.workflows.measure import open_source
from benchlab.workflows.outputs import content_hash
from benchlab.workflows.study_force import force_of
from benchlab.workflows.study_readings import STATED, Readings, Target
from benchlab.workflows.study_recordings import (
    Place,
    StudyItem,
    analyze_settings,
    copies,
    left_out_of,
    read_item,
    reason_for,
    study_items,
)
from benchlab.workflows.study_values import simulated_or_missing

FEWEST = 2
"""Samples of a design that a comparison takes."""


@dataclass(frozen=True)
class _Checked:
    """One recording: what is wrong with it, "" for nothing. stated: it has angles and no pressure, so they are its maker's word.
    left_out: why it does not count. origin: as of RecordingValues. measured: as of Readings.content."""

    item: StudyItem
    wrong: str
    stated: bool = False
    left_out: str = ""
    origin: str = ""
    measured: str = ""


def check_study(path: Path) -> dict[str, Any]:
    """What is there, what is missing and what is to be said of a study file, as `--json` shows it.

    Videos are opened and not gone through; run files, tables and force files are read. Raises UsageError and InputError for a file
    that is no study.
    """
    study = read_study(path)
    target = Target.of(study.pressure_MPa, study.hold_tolerance_MPa)
    checked = {item.place: _checked(item, target) for item in study_items(study, Path())}
    again = copies({place: (each.item.recording.file, each.measured) for place, each in checked.items()})
    checked |= {place: replace(checked[place], left_out=checked[place].left_out or why) for place, why in again.items()}
    missing: list[Missing] = []
    left_out: list[Missing] = []
    designs = [_design(design, checked, study, missing, left_out) for design in study.designs]
    missing += _copies(study, checked)
    counts = {design["name"]: design["n"] for design in designs}
    return {
        "study": str(path),
        "title": study.title,
        "pressure_MPa": study.pressure_MPa,
        "designs": designs,
        "sets": [{"name": chosen.name, "designs": list(chosen.designs)} for chosen in study.sets],
        "missing": [_told(each) for each in missing],
        "left_out": [_told(each) for each in left_out],
        "notes": [_told(each) for each in (*_origins(checked), *_stated(study, designs), *_notes(study, counts))],
    }


def _design(
    design: StudyDesign,
    checked: dict[Place, _Checked],
    study: Study,
    missing: list[Missing],
    left_out: list[Missing],
) -> dict[str, Any]:
    samples = []
    for sample in design.samples:
        mine = [checked[design.name, sample.name, index] for index in range(len(sample.recordings))]
        samples.append(_sample(design, sample, mine, missing, left_out))
    n = sum(sample["counts"] for sample in samples)
    if n < FEWEST:
        missing.append(Missing(f"{n} samples that count, a comparison takes {FEWEST} at least", design.name))
    simulated, gone = simulated_or_missing(design, study.pressure_MPa)
    missing += gone
    state = "missing" if gone else "none" if simulated is None else "found"
    return {
        "name": design.name,
        "shell": None if design.shell is None else vars(design.shell),
        "n": n,
        "samples": [{key: value for key, value in sample.items() if key != "counts"} for sample in samples],
        "simulated": state,
        "force": _force(design, missing, left_out),
    }


def _sample(
    design: StudyDesign, sample: StudySample, mine: list[_Checked], missing: list[Missing], left_out: list[Missing]
) -> dict[str, Any]:
    """The state of a sample, `found`, `missing` or `left out`, and of its recordings; `counts`: whether it gives a value."""
    recordings, wrong = [], []
    for each in mine:
        recording = each.item.recording
        why = sample.left_out or each.left_out
        if each.left_out:
            left_out.append(Missing(each.left_out, design.name, sample.name, recording.file))
        elif each.wrong and not why:
            wrong.append(Missing(each.wrong, design.name, sample.name, recording.file))
        state = "left out" if why else "missing" if each.wrong else "found"
        recordings.append(
            {
                "file": recording.file,
                "kind": recording.kind,
                "state": state,
                "why": why or each.wrong or None,
                "without_pressure": each.stated,
            }
        )
    counted = [each for each in recordings if each["state"] != "left out"]
    if sample.left_out:
        left_out.append(Missing(sample.left_out, design.name, sample.name))
    elif not mine:
        wrong.append(Missing("the sample has no recording", design.name, sample.name))
    missing += wrong
    state = "missing" if wrong else "found" if counted else "left out"
    counts = any(each["state"] == "found" for each in recordings)
    return {"name": sample.name, "state": state, "recordings": recordings, "counts": counts}


def _checked(item: StudyItem, target: Target) -> _Checked:
    """Why a recording will have no value, as far as can be told without analysing it, and whether its pressure is told."""
    try:
        if item.recording.kind == "video":
            return _Checked(item, _wrong_video(item.recording, target), left_out=item.recording.left_out)
        readings: Readings = read_item(item, target, overwrite=False)["readings"]
    except BenchlabError as error:
        return _Checked(item, reason_for(error, item.recording.path), left_out=item.recording.left_out)
    wrong = "; ".join(dict.fromkeys(cycle.flag for cycle in readings.cycles if not cycle.known))
    stated = any(cycle.method == STATED for cycle in readings.cycles)
    why = left_out_of(item.recording, readings)
    return _Checked(item, wrong, stated, why, readings.origin, readings.content)


def _wrong_video(recording: StudyRecording, target: Target) -> str:
    settings = analyze_settings(recording)
    with open_source(recording.path, settings):
        pass
    if settings.lens:
        read_lens(Path(settings.lens))
    if settings.ramp:
        told = ramp(settings.ramp)
        most = max(told.start_MPa, told.end_MPa)
    elif settings.pressure:
        most = float(np.nanmax(read_pressure(Path(settings.pressure)).pressure_MPa))
    else:
        return "its pressure is not known: give ramp or pressure under analysis"
    if most < target.pressure_MPa - target.tolerance_MPa:
        return f"its pressure reaches {most:.4g} MPa at most, {target.pressure_MPa:g} MPa are wanted"
    return ""


def _force(design: StudyDesign, missing: list[Missing], left_out: list[Missing]) -> list[dict[str, Any]]:
    """The force files of a design and their states."""
    found = force_of(design)
    missing += found.failures
    left_out += found.left_out
    wrong = {each.recording: each.why for each in found.failures}
    files = []
    for record in design.force:
        why = record.left_out or wrong.get(record.file)
        state = "left out" if record.left_out else "missing" if why else "found"
        files.append({"file": record.file, "actuator": record.actuator, "state": state, "why": why})
    return files


def _copies(study: Study, checked: dict[Place, _Checked]) -> Iterator[Missing]:
    """Recordings with the content of another file. Only files of one size are read."""
    by_size: dict[int, dict[Path, Place]] = {}
    for place, each in checked.items():
        path = each.item.recording.path
        if size := _size(path):
            by_size.setdefault(size, {}).setdefault(path.resolve(), place)
    for alike in by_size.values():
        first: dict[str, Place] = {}
        for path, place in alike.items() if len(alike) > 1 else ():
            other = first.setdefault(content_hash(path), place)
            if other != place and not checked[place].left_out:
                file = checked[other].item.recording.file
                why = f"has the same content as {file} of {other[0]} {other[1]}: a copy is no repetition"
                yield Missing(why, place[0], place[1], checked[place].item.recording.file)


def _size(path: Path) -> int:
    """Bytes in a file or in the files of a folder; 0 for what cannot be read."""
    files = [each for each in path.iterdir() if each.is_file()] if path.is_dir() else [path]
    return sum(each.stat().st_size for each in files if each.is_file() and os.access(each, os.R_OK))


def _stated(study: Study, designs: list[dict[str, Any]]) -> Iterator[Missing]:
    """The tables of angles without a pressure that count, in one note."""
    recordings = [each for design in designs for sample in design["samples"] for each in sample["recordings"]]
    files = {each["file"] for each in recordings if each["without_pressure"] and each["state"] == "found"}
    if files:
        yield Missing(
            f"{counted(len(files), 'table')} of angles without a pressure: the angles are taken as those at "
            f"{study.pressure_MPa:g} MPa, on the maker's word"
        )


def _origins(checked: dict[Place, _Checked]) -> Iterator[Missing]:
    """That recordings which count are not measured, or that some are and some are not."""
    counting = Counter(each.origin for each in checked.values() if not each.left_out and not each.wrong)
    made = {"": "measured", "twin": "simulated on the twin", "emulated": "of an emulated bench"}
    told = ", ".join(f"{count} {made[kind]}" for kind, count in sorted(counting.items()))
    if len(counting) > 1:
        yield Missing(f"MIXED ORIGINS: of the recordings that count, {told}: a difference may be that of the benches")
    elif counting and "" not in counting:
        yield Missing(f"nothing was measured: of the recordings that count, {told}")


def _notes(study: Study, counts: dict[str, int]) -> Iterator[Missing]:
    """What does not stop anything and should be known."""
    chosen = [each for each in study.sets if each.name != ALL_DESIGNS]
    within = {design for each in chosen for design in each.designs}
    for each in study.sets:
        if len(each.designs) < FEWEST:
            yield Missing(f"set {each.name} has one design: there is nothing to compare it with")
    for design in study.designs:
        if chosen and design.name not in within:
            yield Missing("is in no set of its own, only among all designs", design.name)
    if len(set(counts.values())) > 1:
        listed = ", ".join(f"{name} {n}" for name, n in counts.items())
        yield Missing(f"the designs have unlike numbers of samples ({listed}): the tests take that into account")


def _told(each: Missing) -> dict[str, str]:
    return {"what": each.what, "why": each.why}
