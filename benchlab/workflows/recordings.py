"""Which recordings a list of paths means: files as they are, folders of stills as one, folders of videos as many."""

from __future__ import annotations

import re
from collections.abc import Sequence
from pathlib import Path

from benchlab.errors import InputError, UsageError

PICTURES = {".jpg", ".jpeg", ".png", ".tif", ".tiff"}
VIDEOS = {
    ".mp4",
    ".mov",
    ".m4v",
    ".mkv",
    ".avi",
    ".webm",
    ".mts",
    ".m2ts",
    ".ts",
    ".3gp",
    ".mpg",
    ".mpeg",
    ".wmv",
    ".ogv",
}


def natural_key(path: Path) -> list[tuple[int, int, str]]:
    """Sorts img2 before img10.

    >>> [p.name for p in sorted(map(Path, ["b10", "b2", "a1"]), key=natural_key)]
    ['a1', 'b2', 'b10']
    """
    parts = re.split(r"(\d+)", path.name.casefold())
    return [(1, int(part), "") if part.isdecimal() else (0, 0, part) for part in parts]


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
    videos = sorted((p for p in files if p.suffix.lower() in VIDEOS), key=natural_key)
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
