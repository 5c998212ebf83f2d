"""`benchlab force`: exports of testing machines in; normalised tables, and blocked force where pressures are known, out."""

from __future__ import annotations

import json
from collections.abc import Sequence
from dataclasses import dataclass, replace
from itertools import combinations
from pathlib import Path
from typing import Any

import numpy as np

from benchlab.errors import BenchlabError, UsageError
from benchlab.force.curve import BlockedForce, blocked_force
from benchlab.force.curve_json import blocked_force_json, record_json
from benchlab.io.files import check_new_file, check_regular_file, make_folder, sha256, written_whole
from benchlab.io.force_file import write_force_csv, write_force_file
from benchlab.io.machine_export import MachineExport, export_document, read_machine_export
from benchlab.io.nexus import plain
from benchlab.io.pressure import PressureRecord, read_pressure
from benchlab.report.force_figure import line_words
from benchlab.workflows.force_cycles import ForceSettings, FoundCycles, find_cycles
from benchlab.workflows.force_outputs import FINAL, draw_figures, write_blocked_csv, write_peaks_csv
from benchlab.workflows.provenance import made_by


@dataclass(frozen=True)
class ForceInput:
    """One file: how its actuator is called ("" for its name), and the log of its pressure."""

    path: Path
    actuator: str = ""
    pressure: Path | None = None


LEAST_ALIKE, ALIKE = 20, 1e-3
"""So many readings of force, each alike within this share of the largest, are one record exported twice."""


@dataclass(frozen=True)
class ForceRead:
    """One file, read: its export, the SHA-256 of its content, and the cycles of each actuator in it."""

    export: MachineExport
    sha256: str
    found: tuple[FoundCycles, ...]
    warnings: tuple[str, ...] = ()


def force(
    inputs: Sequence[ForceInput], out: Path | None, settings: ForceSettings, overwrite: bool = False
) -> dict[str, Any]:
    """Read force files, write each normalised, and blocked force where the pressures of cycles are known.

    out: folder, made if the one above it exists; default the folder of the first file. Returns what was found, as `--json` shows it; files
    that failed are in `failed`. Raises UsageError, and the error of a file that is the only one; then nothing was written.
    """
    settings.check()
    _refuse_same_names(inputs)
    folder = out or inputs[0].path.parent
    read, failed = [], []
    for one in inputs:
        try:
            read.append(read_force(one, settings))
        except BenchlabError as error:
            failed.append(_placed(error, one.path))
    if failed and len(inputs) == 1:
        raise failed[0]
    _refuse_copies(read)
    blocked, reasons = combined([found for item in read for found in item.found], settings)
    planned = [_outputs_of(item, folder) for item in read]
    final = [folder / name for name in FINAL] if blocked is not None else []
    _check_outputs([path for paths in planned for path in paths] + final, inputs, folder, overwrite)
    files = [_write_file(item, paths) for item, paths in zip(read, planned)]
    result: dict[str, Any] = {"files": files, "blocked_force": None, "failed": [e.as_json()["error"] for e in failed]}
    if blocked is not None:
        origins = list(dict.fromkeys(filter(None, (origin_of(item.export) for item in read))))
        result["blocked_force"] = _write_blocked(folder, blocked, reasons, origins)
    return {**result, "outputs": [path for one in files for path in one["outputs"]] + [str(path) for path in final]}


def read_force(one: ForceInput, settings: ForceSettings) -> ForceRead:
    """Read one file and find the cycles of each actuator in it. Raises UsageError or InputError."""
    check_regular_file(one.path)
    export = read_machine_export(one.path, settings.options)
    log = _log(one.pressure or settings.pressure)
    several = len(export.tests) > 1
    name = one.actuator or one.path.stem
    chosen = replace(settings, pressure=one.pressure or settings.pressure)
    found = tuple(
        find_cycles(test, f"{name} {test.specimen}" if several else name, chosen, log) for test in export.tests
    )
    return ForceRead(export, sha256(one.path), found, log.warnings if log else ())


def combined(found: Sequence[FoundCycles], settings: ForceSettings) -> tuple[BlockedForce | None, list[str]]:
    """Blocked force over all actuators whose pressures are known, and why others are not in it.

    An actuator that never touched the load cell counts only where none did. Raises InputError where pressures are not in steps.
    """
    known = [one for one in found if one.cycles is not None]
    reasons = [
        f"{one.actuator}: no pressure is known, so it is not in the blocked force"
        for one in found
        if one.cycles is None
    ]
    if not known:
        return None, []
    touching = [one for one in known if one.record.contact]
    if touching and len(touching) < len(known):
        reasons += [
            f"{one.actuator}: no contact seen, so it is not in the means" for one in known if not one.record.contact
        ]
    chosen = [one.cycles for one in touching or known if one.cycles is not None]
    return blocked_force(chosen, settings.tolerance_MPa, lever_arm_mm=settings.lever_arm_mm), reasons


def origin_of(export: MachineExport) -> str:
    """What a file says of itself where it says that it was not measured; else nothing."""
    texts = [f"{key}: {value}" for key, value in export.preamble.items()]
    return next((text for text in texts if "not measured" in text.lower()), "")


def _outputs_of(item: ForceRead, folder: Path) -> list[Path]:
    """What is written of one file."""
    ends = ["_force.csv", "_force.h5"] + ["_peaks.csv"] * any(found.cycles is not None for found in item.found)
    return [folder / f"{item.export.path.stem}{end}" for end in ends]


def _write_file(item: ForceRead, paths: list[Path]) -> dict[str, Any]:
    """Write the table of one file and its peaks; returns its part of the document."""
    made = made_by("numpy", "scipy", "pandas", "h5py")
    write_force_csv(paths[0], item.export)
    write_force_file(paths[1], item.export, {**made, "source": str(item.export.path), "sha256": item.sha256})
    for path in paths[2:]:
        write_peaks_csv(path, item.found)
    return {**_file_document(item), "outputs": [str(path) for path in paths]}


def _write_blocked(folder: Path, blocked: BlockedForce, reasons: list[str], origins: list[str]) -> dict[str, Any]:
    """Write blocked force as table, numbers and figure; returns its part of the document."""
    document = blocked_force_json(blocked)
    document["warnings"] += reasons
    document |= {"origin": origins, "words": line_words(blocked)}
    write_blocked_csv(folder / "blocked_force.csv", blocked)
    _write_json(folder / "blocked_force.json", {**document, **made_by("numpy", "scipy", "matplotlib")})
    draw_figures(folder, blocked, bool(origins))
    return document


def _file_document(item: ForceRead) -> dict[str, Any]:
    """One file as the issue of `--json` has it, with its actuators."""
    document = export_document(item.export)
    document["warnings"] += list(item.warnings)
    document["actuators"] = []
    for found in item.found:
        several = len(item.found) > 1
        document["warnings"] += [f"{found.actuator}: {text}" if several else text for text in found.warnings]
        pressures = plain(found.pressure_MPa)
        peaks = record_json(found.record)
        for peak, pressure in zip(peaks["peaks"], pressures if isinstance(pressures, list) else []):
            peak["pressure_MPa"] = pressure
        document["actuators"].append({"actuator": found.actuator, "inferred": found.inferred, **peaks})
    return document


def _log(path: Path | None) -> PressureRecord | None:
    if path is None:
        return None
    check_regular_file(path)
    return read_pressure(path)


def _placed(error: BenchlabError, path: Path) -> BenchlabError:
    return error if error.file else type(error)(error.what, file=path, where=error.where, hint=error.hint)


def _refuse_same_names(inputs: Sequence[ForceInput]) -> None:
    seen: dict[str, Path] = {}
    for one in inputs:
        stem = one.path.stem.casefold()
        if stem in seen:
            what = f"and {seen[stem]} would both be written as {one.path.stem}_force.csv"
            raise UsageError(what, file=one.path, hint="rename one, or read them one at a time")
        seen[stem] = one.path


def _refuse_copies(read: Sequence[ForceRead]) -> None:
    seen: dict[str, Path] = {}
    for item in read:
        if item.sha256 in seen:
            what = f"has the same content as {seen[item.sha256].name}"
            raise UsageError(what, file=item.export.path, hint="an actuator counts once: leave one of them out")
        seen[item.sha256] = item.export.path
    tests = [(item.export.path, test.columns["force_N"]) for item in read for test in item.export.tests]
    for (one, a), (other, b) in combinations(tests, 2):
        if (
            one != other
            and len(a) == len(b) >= LEAST_ALIKE
            and np.allclose(a, b, rtol=0, atol=ALIKE * np.nanmax(np.abs(a)), equal_nan=True)
        ):
            what = f"has the readings of {one.name}, perhaps in other units"
            raise UsageError(what, file=other, hint="an actuator counts once: leave one of them out")


def _check_outputs(paths: Sequence[Path], inputs: Sequence[ForceInput], folder: Path, overwrite: bool) -> None:
    read = {path.resolve() for one in inputs for path in (one.path, one.pressure) if path is not None}
    make_folder(folder)
    for path in paths:
        if path.resolve() in read:
            raise UsageError("is read here and would be replaced", file=path, hint="choose another --out")
        check_new_file(path, overwrite)


def _write_json(path: Path, document: dict[str, Any]) -> None:
    with written_whole(path) as temporary:
        temporary.write_text(json.dumps(plain(document), indent=2, allow_nan=False) + "\n", encoding="utf-8")
