"""`benchlab bench firmware`: the sketch for the Arduino IDE, with the bench's ceiling in it."""

from __future__ import annotations

from pathlib import Path

from benchlab.bench import Bench
from benchlab.devices.firmware import SKETCH, firmware_text
from benchlab.errors import UsageError
from benchlab.io.files import cannot_write, check_new_file, written_whole


def write_firmware(folder: Path, bench: Bench, overwrite: bool = False) -> Path:
    """Write `benchlab_nano/benchlab_nano.ino` into `folder` and return its path; the IDE wants a folder of the sketch's name.

    Raises UsageError where its folder cannot lie there or the sketch exists already, InputError where the disk refuses.
    """
    sketch = folder / SKETCH / f"{SKETCH}.ino"
    if not folder.absolute().parent.is_dir():
        raise UsageError("no such folder", file=folder.parent, hint="make it, or choose another --out")
    for place in (folder, sketch.parent):
        if place.exists() and not place.is_dir():
            raise UsageError("is a file, not a folder", file=place, hint="choose another --out")
        try:
            place.mkdir(exist_ok=True)
        except OSError as error:
            raise cannot_write(error, place) from error
    check_new_file(sketch, overwrite)
    with written_whole(sketch) as temporary:
        temporary.write_text(firmware_text(bench), encoding="utf-8")
    return sketch
