"""Lens files: JSON, written by `benchlab calibrate camera`."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

from benchlab.errors import InputError
from benchlab.io.files import check_regular_file, written_whole
from benchlab.vision.lens import Lens

LARGEST_BYTES = 1_000_000


def read_lens(path: Path) -> Lens:
    """The lens in a file. Raises UsageError or InputError naming the file and the key that is wrong."""
    if check_regular_file(path).st_size > LARGEST_BYTES:
        raise InputError("is too large for a lens file", file=path, hint="make one with benchlab calibrate camera")
    try:
        document = json.loads(path.read_text(encoding="utf-8"))
        if isinstance(document, dict):
            document.pop("made_from", None)
        return Lens.from_json(document)
    except (json.JSONDecodeError, UnicodeDecodeError, RecursionError) as error:
        raise InputError(
            f"is not a lens file: {error}", file=path, hint="make one with benchlab calibrate camera"
        ) from None
    except InputError as error:
        raise InputError(error.what, file=path, where=error.where, hint=error.hint) from None


def write_lens(path: Path, lens: Lens, made_from: dict[str, Any]) -> None:
    """Write a lens whole, with what it was made from beside it."""
    with written_whole(path) as temporary:
        document = {**lens.as_json(), "made_from": made_from}
        temporary.write_text(json.dumps(document, indent=1) + "\n", encoding="utf-8")
