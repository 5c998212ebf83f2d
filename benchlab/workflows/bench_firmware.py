"""`benchlab bench firmware`: the sketch for the Arduino IDE, with the bench's ceiling in it."""

from __future__ import annotations

from pathlib import Path

from benchlab.bench import Bench
from benchlab.devices.firmware import SKETCH, firmware_text
from benchlab.errors import InputError
from benchlab.io.bench_file import is_simulated
from benchlab.io.files import check_new_file, make_folder, written_whole


def write_firmware(folder: Path, bench: Bench, overwrite: bool = False) -> Path:
    """Write `benchlab_nano/benchlab_nano.ino` into `folder` and return its path; the IDE wants a folder of the sketch's name.

    Raises UsageError where its folder cannot lie there or the sketch exists already, InputError where the disk refuses, and for the
    calibration of a twin or an emulation: a sketch is for a bench of metal.
    """
    if is_simulated(bench):
        raise InputError(
            f"bench {bench.name} was calibrated by {bench.gauge!r}: no firmware of a bench of metal may rest on it",
            hint="calibrate that bench, or leave --calibration out",
        )
    sketch = folder / SKETCH / f"{SKETCH}.ino"
    make_folder(folder)
    check_new_file(sketch, overwrite)
    with written_whole(sketch) as temporary:
        temporary.write_text(firmware_text(bench), encoding="utf-8")
    return sketch
