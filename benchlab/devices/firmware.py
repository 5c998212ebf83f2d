"""The firmware in the package, as a bench needs it."""

from __future__ import annotations

import re
from importlib.resources import files

from benchlab.bench import Bench

SKETCH = "benchlab_nano"
"""Name of the sketch: the Arduino IDE wants it in a folder of its own name."""


def firmware_text(bench: Bench) -> str:
    """The sketch with this bench's ceiling in its settings.

    >>> "#define CEILING_CODE 2986 " in firmware_text(Bench(name="a", calibrated=True))
    True
    """
    text = (files("benchlab") / "firmware" / SKETCH / f"{SKETCH}.ino").read_text(encoding="utf-8")
    says = (
        f"/* codes above are refused: {bench.ceiling_MPa:.4g} MPa, {bench.volts(bench.ceiling_code):.3f} V"
        f" at a supply of {bench.supply_V:g} V */"
    )
    line = rf"\g<1>{bench.ceiling_code} {says}"
    written, count = re.subn(r"(#define CEILING_CODE )\d+ +/\*.*?\*/", line, text)
    if count != 1:
        raise ValueError(f"{count} ceilings in {SKETCH}.ino")
    return written
