"""The force files of a study's design as its blocked force, with what failed, was left out or is doubtful."""

from __future__ import annotations

import os
from dataclasses import dataclass, replace
from pathlib import Path

from benchlab.errors import BenchlabError
from benchlab.force.curve import BlockedForce
from benchlab.io.files import sha256
from benchlab.io.machine_export import ExportOptions
from benchlab.io.study_file import StudyDesign, StudyForceFile
from benchlab.io.study_values import Missing
from benchlab.workflows.force import ForceInput, ForceRead, combined, origin_of, read_force
from benchlab.workflows.force_cycles import ForceSettings, FoundCycles
from benchlab.workflows.study_recordings import reason_for

_OF_READING = ("columns", "force_unit", "decimal", "encoding", "sort_time")


@dataclass(frozen=True)
class StudyForce:
    """force: None where there is none. inputs: file as in the study -> SHA-256."""

    force: BlockedForce | None
    failures: tuple[Missing, ...]
    left_out: tuple[Missing, ...]
    warnings: tuple[Missing, ...]
    inputs: dict[str, str]


def force_of(design: StudyDesign) -> StudyForce:
    """Blocked force of a design from its force files; a file that fails is among the failures, and the rest goes on."""
    failures, warnings, inputs = [], [], {}
    read: list[tuple[StudyForceFile, ForceRead]] = []
    for record in design.force:
        if record.left_out:
            continue
        try:
            found = read_force(ForceInput(record.path, record.actuator), force_settings(record))
        except BenchlabError as error:
            failures.append(Missing(reason_for(error, record.path), design.name, record.actuator, record.file))
            continue
        inputs[record.file] = found.sha256
        if "pressure" in record.settings:
            log = Path(record.settings["pressure"])
            inputs[os.path.relpath(log, record.path.parent)] = sha256(log)
        for one in found.found:
            if one.cycles is None:
                why = "no pressure of its cycles is known: give `steps_MPa`, or `pressure` with a log"
                failures.append(Missing(why, design.name, one.actuator, record.file))
            warnings += [
                Missing(text, design.name, one.actuator, record.file) for text in (*found.warnings, *one.warnings)
            ]
        warnings += [Missing(f"has the same content as {first}", design.name, record.actuator, record.file)
                     for first in _alike(found, read)]  # fmt: skip
        read.append((record, found))
    left_out = tuple(Missing(r.left_out, design.name, r.actuator, r.file) for r in design.force if r.left_out)
    force, more, doubts = _combined(design, read)
    return StudyForce(force, (*failures, *more), left_out, (*warnings, *doubts), inputs)


def force_settings(record: StudyForceFile) -> ForceSettings:
    """The settings that a study gives for a force file. Raises UsageError for values out of range, or without meaning together."""
    given = dict(record.settings)
    options = ExportOptions(**{name: given.pop(name) for name in _OF_READING if name in given})
    steps = tuple(given.pop("steps_MPa", ()))
    settings = ForceSettings(options, steps, **given)
    settings.check()
    return settings


def _combined(
    design: StudyDesign, read: list[tuple[StudyForceFile, ForceRead]]
) -> tuple[BlockedForce | None, list[Missing], list[Missing]]:
    found: list[FoundCycles] = [one for _, item in read for one in item.found if one.cycles is not None]
    if not found:
        return None, [Missing("no force file has a value", design.name)] if design.force else [], []
    arms = {record.settings.get("lever_arm_mm") for record, _ in read}
    tolerances = [record.settings["tolerance_MPa"] for record, _ in read if "tolerance_MPa" in record.settings]
    doubts = [] if len(arms) == 1 else ["its force files state different lever arms, so none is stated of their mean"]
    settings = ForceSettings(
        tolerance_MPa=max(tolerances, default=None), lever_arm_mm=arms.pop() if len(arms) == 1 else None
    )
    try:
        force, reasons = combined(found, settings)
    except BenchlabError as error:
        return None, [Missing(f"blocked force: {error}", design.name)], []
    if force is not None:
        doubts += [*force.notes, *reasons]
        if origins := [text for _, item in read if (text := origin_of(item.export))]:
            said = f"{len(origins)} of {len(read)} force files say that they were not measured: “{origins[0]}”"
            force = replace(force, notes=(*force.notes, said))
    return force, [], [Missing(f"blocked force: {text}", design.name) for text in doubts]


def _alike(found: ForceRead, read: list[tuple[StudyForceFile, ForceRead]]) -> list[str]:
    """The first file with the same content, if there is one: copies are no repetition."""
    return [record.file for record, other in read if other.sha256 == found.sha256][:1]
