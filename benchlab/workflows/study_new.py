"""`benchlab study new`: a study file from the names of the recordings in a folder."""

from __future__ import annotations

import os
import re
from collections import defaultdict
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

from benchlab.actuator import ShellDesign
from benchlab.errors import BenchlabError, InputError, UsageError
from benchlab.io.files import check_new_file, check_regular_file
from benchlab.io.pressure import MAX_PRESSURE_MPA, ramp
from benchlab.io.stills import natural_key
from benchlab.io.study_file import STUDY_FILE, StudyDesign, StudySimulated
from benchlab.io.study_parts import named
from benchlab.io.study_text import DesignDraft, StudyDraft, write_study
from benchlab.workflows.study_folder import FILM, Contents, look_into
from benchlab.workflows.study_pattern import NameParts, NamePattern, choose_pattern
from benchlab.workflows.study_sets import proposed_sets
from benchlab.workflows.study_simulated import simulated_of

PRESSURE_MPA = 0.35
FORCE_PATTERNS = ("{design}_a{sample}", "{design}-a{sample}", "{design}_actuator{sample}")
RENAME = "rename the file"

_SHELL = re.compile(r"tw(\d+(?:\.\d+)?)[_-]slw(\d+(?:\.\d+)?)", re.ASCII | re.IGNORECASE)


@dataclass(frozen=True)
class NewStudy:
    """What the file is to say beside what the folder holds. pressure_MPa: None for the end of the ramp, or 0.35."""

    pattern: str | None = None
    title: str | None = None
    pressure_MPa: float | None = None
    ramp: str | None = None
    pressure: Path | None = None

    @property
    def at_from(self) -> str:
        """What tells the pressure of comparison: "option", "ramp", or "default" where nothing does."""
        return "option" if self.pressure_MPa is not None else "ramp" if self.ramp else "default"

    @property
    def at_MPa(self) -> float:
        """The pressure of comparison. Raises UsageError for one that cannot be, or that the ramp does not reach."""
        end = max(ramp(self.ramp).start_MPa, ramp(self.ramp).end_MPa) if self.ramp else PRESSURE_MPA
        wanted = end if self.pressure_MPa is None else self.pressure_MPa
        if not 0 < wanted <= MAX_PRESSURE_MPA:
            limits = f"more than 0, at most {MAX_PRESSURE_MPA:g}"
            raise UsageError(f"--pressure-MPa is {wanted:g}", hint=f"give a pressure in MPa, {limits}")
        if self.ramp and wanted > end:
            raise UsageError(
                f"--pressure-MPa is {wanted:g}, and --ramp ends at {end:g}",
                hint="compare at a pressure that is reached",
            )
        return wanted


def new_study(folder: Path, out: Path | None, wish: NewStudy, overwrite: bool = False) -> dict[str, Any]:
    """Write the study file of a folder; returns what it says and what it leaves out, as `--json` shows it.

    out: None for `study.yaml` in the folder. Raises UsageError and InputError; then nothing is written.
    """
    path = folder / STUDY_FILE if out is None else out
    contents = look_into(folder)
    check_new_file(path, overwrite)
    if wish.ramp and wish.pressure:
        raise UsageError("--ramp and --pressure both tell the pressure", hint="give one of them")
    if wish.pressure:
        check_regular_file(wish.pressure)
    pattern, draft = _draft(folder, path.absolute().parent, contents, wish)
    study = write_study(path, draft)
    return {
        "study": str(path),
        "title": study.title,
        "pressure_MPa": study.pressure_MPa,
        "pressure_MPa_from": wish.at_from,
        "pattern": pattern,
        "recordings": sum(len(sample.recordings) for design in study.designs for sample in design.samples),
        "designs": [_told(design) for design in study.designs],
        "sets": [vars(chosen) | {"designs": list(chosen.designs)} for chosen in draft.sets],
        "pressure_known": draft.pressure_known,
        "unused": [{"file": file, "why": why} for file, why in draft.unused],
    }


def _draft(folder: Path, base: Path, contents: Contents, wish: NewStudy) -> tuple[str, StudyDraft]:
    names = {path: _name(path, folder) for path in contents.recordings}
    if not names:
        hint = "videos, folders of stills, run files and tables with angle_deg are"
        raise InputError("holds no recording", file=folder, hint=hint)
    try:
        pattern = NamePattern(wish.pattern) if wish.pattern else choose_pattern(list(names.values()))
    except InputError as error:
        raise InputError(error.what, file=folder, hint=error.hint) from None
    unused, refused = list(contents.unused), list[tuple[Path, str]]()
    samples: dict[str, dict[str, list[tuple[str, Path]]]] = defaultdict(lambda: defaultdict(list))
    for path, name in names.items():
        parts = pattern.read(name)
        if parts is None or not _is_text(path):
            unused.append((path, f"its name does not fit {pattern.text}" if _is_text(path) else "its name is not text"))
        elif why := _no_name(parts):
            unused.append((path, f"{why}; {RENAME}"))
            refused.append((path, why))
        else:
            samples[parts.design][parts.sample].append((parts.cycle, path))
    if not samples and refused:
        raise InputError(refused[0][1], file=refused[0][0], hint=RENAME)
    if not samples:
        what = f"no recording is named as {pattern.text}: there are {', '.join(map(repr, list(names.values())[:3]))}"
        raise InputError(what, file=folder, hint="give another --pattern")
    force = _force(contents.tables, folder, pattern, samples, unused)
    pressures = {_relative(film, base): _relative(drive, base) for film, drive in contents.pressures.items()}
    if wish.ramp or wish.pressure:
        told = "--ramp" if wish.ramp else "--pressure"
        unused += [(drive, f"{told} tells the pressure of {film.name}") for film, drive in contents.pressures.items()]
        pressures = {}
    designs = []
    for name in sorted(samples, key=natural_key):
        made = {
            sample: [_relative(path, base) for _, path in sorted(files, key=lambda file: natural_key(file[0]))]
            for sample, files in sorted(samples[name].items(), key=lambda item: natural_key(item[0]))
        }
        shell = _shell(name)
        simulated = _simulated(contents.simulated, name, shell)
        relative = "" if simulated is None else _relative(simulated, base)
        designs.append(DesignDraft(name, shell, made, relative, [_relative(path, base) for path in force[name]]))
    named = {design.simulated for design in designs}
    unused += [(p, "of no design here") for p in contents.simulated if _relative(p, base) not in named]
    analysis: dict[str, object] = {"ramp": wish.ramp} if wish.ramp else {}
    analysis |= {"pressure": _relative(wish.pressure, base)} if wish.pressure else {}
    unused = [(path, why) for path, why in unused if wish.pressure is None or not path.samefile(wish.pressure)]
    return pattern.text, StudyDraft(
        title=wish.title or folder.absolute().name,
        pressure_MPa=wish.at_MPa,
        pressure_told=wish.at_from != "default",
        analysis=analysis,
        designs=designs,
        sets=proposed_sets({d.name: d.shell for d in designs if d.shell}),
        pressures=pressures,
        unused=sorted((_relative(path, base), why) for path, why in unused),
    )


def _force(
    tables: Sequence[Path],
    folder: Path,
    pattern: NamePattern,
    designs: Mapping[str, Any],
    unused: list[tuple[Path, str]],
) -> dict[str, list[Path]]:
    """Force files of each design: those that say an actuator of it, and in a folder `force` also those named as the recordings."""
    found: dict[str, list[Path]] = defaultdict(list)
    for path in tables:
        named = [NamePattern(text) for text in FORCE_PATTERNS]
        named += [pattern] if path.parent.name.casefold() == "force" else []
        parts = next((parts for each in named if (parts := each.read(_name(path, folder)))), None)
        if parts is None or not _is_text(path):
            unused.append((path, f"no column angle_deg, and not named as a force file ({FORCE_PATTERNS[0]})"))
        elif parts.design not in designs:
            unused.append((path, f"a force file of {parts.design}, of which there is no recording"))
        else:
            found[parts.design].append(path)
    return found


def _no_name(parts: NameParts) -> str:
    """Why a study could not call its design or sample so; "" for no reason."""
    for what, text in (("design", parts.design), ("sample", parts.sample)):
        try:
            named(text)
        except ValueError as error:
            return f"a {what} cannot be called {text!r} ({error})"
    return ""


def _shell(name: str) -> ShellDesign | None:
    """The design that a name as `tw3_slw10` stands for; None for any other name, and for a design that cannot be made."""
    found = _SHELL.fullmatch(name)
    try:
        return None if found is None else ShellDesign(window_width_mm=float(found[1]), strip_width_mm=float(found[2]))
    except UsageError:
        return None


def _simulated(files: Sequence[Path], name: str, shell: ShellDesign | None) -> Path | None:
    """The first file that holds this design."""
    if shell is None:
        return None
    design = StudyDesign(name, shell, None, (), ())
    for path in files:
        try:
            simulated_of(replace(design, simulated=StudySimulated(path, path.name, None, "")), PRESSURE_MPA)
        except BenchlabError:
            continue
        return path
    return None


def _name(path: Path, folder: Path) -> str:
    relative = path.relative_to(folder)
    return relative.as_posix() if path.is_dir() else relative.with_suffix("").as_posix().removesuffix(FILM)


def _relative(path: Path, base: Path) -> str:
    return Path(os.path.relpath(path.absolute(), base)).as_posix()


def _is_text(path: Path) -> bool:
    """Whether a name can stand in a text file: names on disk may be any bytes."""
    try:
        return bool(str(path).encode())
    except UnicodeEncodeError:
        return False


def _told(design: StudyDesign) -> dict[str, Any]:
    return {
        "name": design.name,
        "shell": None if design.shell is None else vars(design.shell),
        "samples": {sample.name: [recording.file for recording in sample.recordings] for sample in design.samples},
        "simulated": None if design.simulated is None else design.simulated.file,
        "force": [record.file for record in design.force],
    }
