"""All recordings of a study analysed, those that changed again, and the angles of all cycles at the study's pressure."""

from __future__ import annotations

import functools
import math
import os
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np

from benchlab.errors import BenchlabError
from benchlab.io.files import make_folder, sha256
from benchlab.io.study_file import Study, StudyDesign, StudyRecording, StudySample
from benchlab.io.study_values import (
    CycleValue,
    DesignValues,
    Missing,
    RecordingValues,
    SampleValues,
    Simulated,
    StudyValues,
)
from benchlab.workflows.batch import run_batch
from benchlab.workflows.study_force import force_of
from benchlab.workflows.study_readings import Target
from benchlab.workflows.study_recordings import Place, copies, left_out_of, read_item, reason_for, study_items
from benchlab.workflows.study_simulated import simulated_of

Progress = Callable[[int, int | None], None]

RECORDINGS = "recordings"
"""Folder in the output folder with the analysed recordings, as DESIGN/SAMPLE/NAME.h5, .csv and .png."""


@dataclass(frozen=True)
class _Read:
    """What became of a recording. sha256: of its content, "" where it could not be read. measured: of what was measured in it, "" where
    only the file can tell."""

    values: RecordingValues
    sha256: str = ""
    measured: str = ""


def collect(
    study: Study, out: Path, jobs: int = 1, progress: Progress | None = None, overwrite: bool = False
) -> StudyValues:
    """Analyse the recordings of a study into `out`/recordings and read their values.

    Only recordings are analysed whose content or settings (or benchlab's version) have changed. One that fails is listed among the
    failures, and the rest goes on. A recording that is left out is analysed too, and does not count; that it cannot be is no failure.
    progress: called with recordings done and in all. Raises UsageError for a folder that cannot be written to. After Ctrl-C, what is
    finished is current the next time. Force files are read each time.
    """
    make_folder(out)
    make_folder(out / RECORDINGS)
    items = list(study_items(study, out / RECORDINGS))
    target = Target.of(study.pressure_MPa, study.hold_tolerance_MPa)
    work = functools.partial(read_item, target=target, overwrite=overwrite)
    read: dict[Place, _Read] = {}
    for outcome in run_batch(items, work, jobs):
        if outcome.result and outcome.result["partial"]:
            raise KeyboardInterrupt
        item, failed = outcome.item, outcome.error
        read[item.place] = _failed(item.recording, failed, target) if failed else _done(item.recording, outcome.result)
        if progress:
            progress(len(read), len(items))
    places = [item.place for item in items]
    for place, why in copies({place: (read[place].values.file, read[place].measured) for place in places}).items():
        values = read[place].values
        read[place] = replace(read[place], values=replace(values, left_out=values.left_out or why))
    return _assembled(study, target, read)


def _done(recording: StudyRecording, result: dict[str, Any] | None) -> _Read:
    assert result is not None
    readings = result["readings"]
    values = RecordingValues(
        recording.file,
        result["status"],
        readings.cycles,
        readings.curve_deg,
        left_out_of(recording, readings),
        readings.warnings,
        readings.origin,
    )
    return _Read(values, result["sha256"], readings.content)


def _failed(recording: StudyRecording, error: BenchlabError, target: Target) -> _Read:
    """A recording without values; its only cycle, number 0, says why."""
    why = reason_for(error, recording.path)
    none = np.full(len(target.curve_MPa), np.nan)
    return _Read(
        RecordingValues(recording.file, "failed", (CycleValue(0, math.nan, flag=why),), none, recording.left_out)
    )


def _assembled(study: Study, target: Target, read: Mapping[Place, _Read]) -> StudyValues:
    designs, failures = [], []
    forces = [force_of(design) for design in study.designs]
    for design, found in zip(study.designs, forces):
        samples = tuple(_sample(design, sample, read) for sample in design.samples)
        simulated, missing = simulated_or_missing(design, study.pressure_MPa)
        failures += [*missing, *found.failures]
        designs.append(DesignValues(design.name, design.shell, simulated, samples, found.force))
    failures += [*_without_values(designs)]
    inputs = {study.path.name: sha256(study.path)}
    inputs |= {item.values.file: item.sha256 for item in read.values() if item.sha256}
    inputs |= {s.file: sha256(s.path) for d in study.designs if (s := d.simulated) and s.path and s.path.is_file()}
    for found in forces:
        inputs |= found.inputs
    return StudyValues(
        title=study.title,
        notes=study.notes,
        pressure_MPa=study.pressure_MPa,
        hold_tolerance_MPa=study.hold_tolerance_MPa,
        curve_MPa=target.curve_MPa,
        designs=tuple(designs),
        sets=study.sets,
        failures=tuple(failures),
        left_out=(*_left_out(designs), *(one for found in forces for one in found.left_out)),
        warnings=(*_warnings(designs), *_twice(study, read), *(one for found in forces for one in found.warnings)),
        inputs=inputs,
    )


def _sample(design: StudyDesign, sample: StudySample, read: Mapping[Place, _Read]) -> SampleValues:
    recordings = tuple(read[design.name, sample.name, index].values for index in range(len(sample.recordings)))
    return SampleValues(sample.name, recordings, sample.left_out)


def simulated_or_missing(design: StudyDesign, pressure_MPa: float) -> tuple[Simulated | None, list[Missing]]:
    """What a design should do, and why its angle at the pressure is missing, if it is."""
    try:
        found = simulated_of(design, pressure_MPa)
    except BenchlabError as error:
        return None, [Missing(f"no simulated angle: {error}", design.name)]
    if found is not None and not math.isfinite(found.angle_deg):
        ends = (
            f"{found.pressure_MPa.min():g} to {found.pressure_MPa.max():g} MPa"
            if len(found.pressure_MPa)
            else "nothing"
        )
        return found, [Missing(f"no simulated angle at {pressure_MPa:g} MPa: simulated is {ends}", design.name)]
    return found, []


def _without_values(designs: list[DesignValues]) -> Iterator[Missing]:
    """Cycles, recordings, samples and designs that should have a value and have none."""
    for design in designs:
        for sample in design.samples:
            if sample.left_out:
                continue
            if not sample.recordings:
                yield Missing("the sample has no recording", design.name, sample.name)
            for recording in sample.recordings:
                if recording.left_out:
                    continue
                several = len(recording.cycles) > 1
                for cycle in recording.cycles:
                    if not cycle.known:
                        number = cycle.cycle if several else None
                        yield Missing(cycle.flag, design.name, sample.name, recording.file, number)
        if not design.counted:
            yield Missing("no sample of the design has a value", design.name)


def _left_out(designs: list[DesignValues]) -> Iterator[Missing]:
    for design in designs:
        for sample in design.samples:
            if sample.left_out:
                yield Missing(sample.left_out, design.name, sample.name)
            for recording in sample.recordings:
                if recording.left_out:
                    yield Missing(recording.left_out, design.name, sample.name, recording.file)


def _warnings(designs: list[DesignValues]) -> Iterator[Missing]:
    """What is doubtful about recordings that count, and about the frames that a value is from."""
    for design in designs:
        for sample in design.samples:
            for recording in () if sample.left_out else sample.recordings:
                for warning in () if recording.left_out else recording.warnings:
                    yield Missing(warning, design.name, sample.name, recording.file)
                for cycle in () if recording.left_out else recording.cycles:
                    if cycle.known and cycle.flag:
                        why = f"its angle is from doubtful frames: {cycle.flag}"
                        yield Missing(why, design.name, sample.name, recording.file, cycle.cycle)


def _twice(study: Study, read: Mapping[Place, _Read]) -> Iterator[Missing]:
    """Recordings with the same content as another file: copies are no repetition."""
    paths = {
        (design.name, sample.name, index): os.path.normpath(recording.path)
        for design in study.designs
        for sample in design.samples
        for index, recording in enumerate(sample.recordings)
    }
    first: dict[str, Place] = {}
    for place, path in paths.items():
        if not (content := read[place].sha256):
            continue
        other = first.setdefault(content, place)
        if paths[other] != path:
            why = f"has the same content as {read[other].values.file} of {other[0]} {other[1]}"
            yield Missing(why, place[0], place[1], read[place].values.file)
