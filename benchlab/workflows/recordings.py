"""Which recordings a list of paths means: files as they are, folders of stills as one, folders of videos as many."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from benchlab.errors import InputError, UsageError
from benchlab.io.stills import SUFFIXES as PICTURES
from benchlab.io.stills import natural_key

VIDEOS = frozenset(
    [".mp4", ".mov", ".m4v", ".mkv", ".avi", ".webm", ".mts", ".m2ts", ".ts", ".3gp", ".mpg", ".mpeg", ".wmv", ".ogv"]
)


def expand(inputs: Sequence[Path]) -> list[Path]:
    """The recordings, in the order given; a folder of videos stands for its videos, in natural order.

    Raises InputError for a folder that holds neither pictures nor videos, or both.
    """
    found: list[Path] = []
    for path in inputs:
        found += _of_folder(path) if path.is_dir() else [path]
    twice = {p for p in found if found.count(p) > 1}
    if twice:
        raise UsageError("is given twice", file=min(twice))
    return found


def _of_folder(folder: Path) -> list[Path]:
    files = [p for p in folder.iterdir() if not p.name.startswith(".") and p.is_file() and ".overlay." not in p.name]
    videos = sorted((p for p in files if p.suffix.lower() in VIDEOS), key=lambda p: natural_key(p.name))
    pictures = any(p.suffix.lower() in PICTURES for p in files)
    results = {p.stem for p in files if p.suffix == ".h5"}
    if videos and any(p.suffix.lower() in PICTURES and p.stem not in results for p in files):
        raise InputError(
            "holds both videos and pictures", file=folder, hint="give the videos, or a folder of the pictures alone"
        )
    if videos:
        return videos
    if pictures:
        return [folder]
    raise InputError(
        "holds no video and no picture", file=folder, hint="JPEG, PNG and TIFF stills are read, or give a video"
    )
