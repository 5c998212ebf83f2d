"""What in a folder may belong to a study: recordings, force exports, simulations, told apart by suffix and content."""

from __future__ import annotations

import os
from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import Path

from benchlab.errors import BenchlabError, InputError, UsageError
from benchlab.io.delimited import open_table
from benchlab.io.drive_file import SCHEMA as DRIVE
from benchlab.io.force_file import SCHEMA as FORCE
from benchlab.io.hdf5 import open_hdf5
from benchlab.io.nexus import schema_of
from benchlab.io.response_file import SCHEMA as RESPONSE
from benchlab.io.run_file import SCHEMA as RUN
from benchlab.io.stills import SUFFIXES as PICTURES
from benchlab.io.stills import natural_key
from benchlab.io.study_parts import RUN_SUFFIXES, TABLE_SUFFIXES
from benchlab.io.sweep_file import SCHEMA as SWEEP
from benchlab.workflows.recordings import VIDEOS
from benchlab.workflows.report_outputs import NUMBERS, PAGE
from benchlab.workflows.study_values import RECORDINGS

MOST_FILES = 20_000

TRUTH = ".truth.csv"
"""Ends the name of the table that a run on a twin leaves of what was really there."""

FILM = ".film"
"""Ends the stem of the film of a run, as `NAME.film.mp4` beside `NAME.h5`."""

WRITTEN = frozenset([RECORDINGS, "tables", "figures"])
"""Folders that a report writes beside its page."""


@dataclass
class Contents:
    """Paths under the folder, in natural order. tables: without angles, so force exports by their names. unused: with the reason.
    pressures: of a film, the drive file of the run that it is of.
    """

    recordings: list[Path] = field(default_factory=list)
    tables: list[Path] = field(default_factory=list)
    simulated: list[Path] = field(default_factory=list)
    unused: list[tuple[Path, str]] = field(default_factory=list)
    pressures: dict[Path, Path] = field(default_factory=dict)


def look_into(folder: Path) -> Contents:
    """Look through a folder and the folders in it. Raises UsageError where there is none, InputError where it is too large."""
    if not folder.is_dir():
        raise UsageError(
            "is no folder" if folder.exists() else "no such folder", file=folder, hint="give the study's folder"
        )
    found = Contents()
    videos: dict[str, Path] = {}
    paths = list(_paths(folder, found))
    for path in paths:
        if path.suffix.lower() in VIDEOS and not path.is_dir():
            videos.setdefault(path.stem.casefold(), path)
    runs: dict[str, Path] = {}
    for path in paths:
        suffix, stem = path.suffix.lower(), path.stem.casefold()
        if ".overlay." in path.name:
            found.unused.append((path, "drawn into by an analysis"))
        elif path.name.endswith(TRUTH):
            found.unused.append((path, "the truth of a twin, which nobody measured"))
        elif path.is_dir() or suffix in VIDEOS:
            found.recordings.append(path)
        elif suffix in RUN_SUFFIXES and (film := videos.get(stem) or videos.get(stem + FILM)) and _is_drive(path):
            found.pressures[film] = path
            runs[stem] = path
        elif suffix in RUN_SUFFIXES | TABLE_SUFFIXES and (video := videos.get(stem)):
            found.unused.append((path, f"named as {video.name}: taken for its analysis"))
        elif suffix in RUN_SUFFIXES:
            _sort_hdf5(path, found)
            runs[stem] = path
        elif suffix in TABLE_SUFFIXES and (run := runs.get(stem)):
            found.unused.append((path, f"named as {run.name}: taken for its table"))
        elif suffix in TABLE_SUFFIXES:
            (found.recordings if _has_angles(path) else found.tables).append(path)
    return found


def _paths(folder: Path, found: Contents) -> Iterator[Path]:
    """Files, and folders that hold pictures alone, run files first: a table may be one of theirs."""
    count = 0
    for at, folders, files in os.walk(folder):
        folders[:] = sorted((name for name in folders if not name.startswith(".")), key=natural_key)
        names = sorted((name for name in files if not name.startswith(".")), key=natural_key)
        count += len(names)
        if count > MOST_FILES:
            what = f"holds more than {MOST_FILES} files"
            raise InputError(what, file=folder, hint="give the folder of the study alone")
        if {PAGE, NUMBERS} <= set(names):
            found.unused += [(Path(at, name), "written by a report of benchlab") for name in folders if name in WRITTEN]
            folders[:] = [name for name in folders if name not in WRITTEN]
        suffixes = {Path(name).suffix.lower() for name in names}
        if suffixes & PICTURES and not suffixes & (VIDEOS | RUN_SUFFIXES) and Path(at) != folder:
            yield Path(at)
            continue
        for name in sorted(names, key=lambda name: Path(name).suffix.lower() not in RUN_SUFFIXES):
            path = Path(at, name)
            if path.suffix.lower() in VIDEOS | RUN_SUFFIXES | TABLE_SUFFIXES and path.is_file():
                yield path


def _is_drive(path: Path) -> bool:
    try:
        return schema_of(path) == DRIVE.name
    except BenchlabError:
        return False


def _sort_hdf5(path: Path, found: Contents) -> None:
    try:
        with open_hdf5(path) as reader:
            schema = reader.attribute("schema")
    except BenchlabError as error:
        found.unused.append((path, error.what))
        return
    if schema in (RUN.name, DRIVE.name):
        found.recordings.append(path)
    elif schema in (SWEEP.name, RESPONSE.name):
        found.simulated.append(path)
    elif schema == FORCE.name:
        found.tables.append(path)
    else:
        found.unused.append((path, "an HDF5 file of another kind"))


def _has_angles(path: Path) -> bool:
    try:
        with open_table(path) as table:
            return "angle_deg" in table.header
    except BenchlabError:
        return False
