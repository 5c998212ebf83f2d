"""Designs of shells as YAML files, or by name: `tw3_slw10` is tw 3 mm, slw 10 mm, all else as in the paper."""

from __future__ import annotations

import re
from pathlib import Path

from benchlab.actuator import ShellDesign
from benchlab.errors import InputError, UsageError
from benchlab.io.yaml_file import Document, read_document, write_document

_NUMBER = r"(\d+(?:\.\d*)?(?:e[+-]?\d+)?)"
_NAME = re.compile(rf"tw{_NUMBER}_slw{_NUMBER}", re.ASCII)

ABOUT = """\
A fabric-shelled actuator; lengths in mm.
window_width_mm: tw, along the axis. strip_width_mm: slw, around. rib_width_mm: fw, fabric between windows, along the axis.
perimeter_mm: slw + wl. length_mm: al."""


class _DesignDocument(Document):
    """The keys of a design file; what they may be, ShellDesign says."""

    strip_width_mm: float
    window_width_mm: float
    rib_width_mm: float = ShellDesign.rib_width_mm
    perimeter_mm: float = ShellDesign.perimeter_mm
    length_mm: float = ShellDesign.length_mm


def read_design(text: str | Path) -> ShellDesign:
    """The design that is called `text`, as `tw3_slw10` or `tw2.5_slw7.5`, or that stands in the YAML file `text`.

    >>> read_design("tw2.5_slw10")
    ShellDesign(strip_width_mm=10.0, window_width_mm=2.5, rib_width_mm=2.0, perimeter_mm=40.0, length_mm=180.0)

    A name goes before a file that is called the same; `./tw3_slw10` is the file.
    Raises UsageError where there is neither, or a named design is impossible; InputError for a file that is refused.
    """
    if isinstance(text, str) and (design := design_named(text)):
        return design
    path = Path(text)
    if not path.exists():
        raise UsageError(
            "no such design file, and not the name of a design",
            file=path,
            hint="a name is tw and slw in mm, as tw3_slw10; other than that give a YAML file",
        )
    document = read_document(path, _DesignDocument)
    try:
        return ShellDesign(**document.model_dump())
    except UsageError as error:
        raise InputError(error.what, file=path, hint=error.hint) from None


def design_named(text: str) -> ShellDesign | None:
    """The design of a name as `tw3_slw10`, None for another text. Raises UsageError where it is impossible."""
    name = _NAME.fullmatch(text)
    return ShellDesign(window_width_mm=float(name[1]), strip_width_mm=float(name[2])) if name else None


def write_design(path: Path, design: ShellDesign) -> None:
    """Write a design as YAML under the names of its fields; whole or not at all.

    Raises InputError where the disk refuses.
    """
    write_document(path, vars(design).copy(), ABOUT)
