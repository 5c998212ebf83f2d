"""Protocol files: read, checked and unrolled; and the protocols that come with benchlab, by their names."""

from __future__ import annotations

import difflib
import math
from importlib.resources import files
from pathlib import Path

from benchlab.errors import InputError, UsageError
from benchlab.io.files import check_regular_file
from benchlab.io.protocol_schema import ProtocolDocument, segments_of
from benchlab.io.yaml_file import read_document_with_lines, read_text, refused
from benchlab.protocol.curvature import AngleHold, AngleRamp, AngleSine
from benchlab.protocol.groups import Repeat, Segment
from benchlab.protocol.plan import Plan
from benchlab.protocol.survey import Bounds, Problem, survey
from benchlab.protocol.unroll import unroll

MAX_DURATION_S = 3600.0
MAX_BYTES = 250_000
"""Of a protocol file, some thousands of segments: reading YAML strictly takes seconds then."""


def shipped_protocols() -> dict[str, Path]:
    """The protocols that come with benchlab, by name.

    >>> "linear_ramp" in shipped_protocols()
    True
    """
    return {path.stem: path for path in sorted(_folder().glob("*.yaml"))}


def read_protocol(protocol: str | Path, max_duration_s: float = MAX_DURATION_S, rate_Hz: float | None = None) -> Plan:
    """The plan of a protocol file, or of a shipped protocol by its name. rate_Hz: in place of the file's.

    Nothing is unrolled before all of it is found to be right. Raises UsageError for what is no file and no name, InputError naming line,
    key, value and remedy of everything that is wrong.

    >>> plan = read_protocol("linear_ramp")
    >>> round(float(plan.pressure_MPa.max()), 3), plan.steps[0].label
    (0.35, 'ramp 0 to 0.35 MPa in 2.5 s')
    """
    _check_options(max_duration_s, rate_Hz)
    path = protocol_path(protocol)
    if (size := check_regular_file(path).st_size) > MAX_BYTES:
        what = f"{size / 1e6:.2f} MB, more than the limit of {MAX_BYTES / 1e6:g} MB for a protocol"
        raise InputError(what, file=path, hint="write what comes again as `repeat` or `steps`")
    document, lines = read_document_with_lines(path, ProtocolDocument)
    segments = segments_of(document.segments, ("segments",), lines)
    rate = document.rate_Hz if rate_Hz is None else float(rate_Hz)
    bounds = Bounds(rate, document.limit_MPa, document.slew_limit_MPa_per_s, max_duration_s)
    problems = list(survey(segments, bounds).problems)
    if document.control is not None and not _closed_loop(segments):
        what = "control is given, and no segment is closed-loop"
        problems.append(Problem(lines[("control",)], what, "remove it, or add a curvature segment"))
    if problems:
        problems.sort(key=lambda one: one.line or math.inf)
        raise refused(path, [(f"line {p.line}" if p.line else "", p.what, p.remedy) for p in problems])
    control = None if document.control is None else document.control.control()
    return unroll(segments, document.title, rate, document.limit_MPa, control, document.about.strip())


def protocol_text(protocol: str | Path) -> str:
    """The text of a protocol file, or of a shipped protocol by its name. Raises as `read_protocol` for what cannot be read."""
    return read_text(protocol_path(protocol))


def protocol_path(protocol: str | Path) -> Path:
    """Where a protocol lies: a shipped one by its name, anything else as a path. UsageError for what is neither."""
    shipped = shipped_protocols()
    if (name := str(protocol)) in shipped:
        return shipped[name]
    path = Path(protocol)
    if not path.exists() and len(path.parts) <= 1:
        close = difflib.get_close_matches(path.stem, shipped, n=1)
        hint = f"did you mean {close[0]}?" if close else f"give a file, or one of {', '.join(shipped)}"
        raise UsageError("no such file, and no protocol of this name", file=path, hint=hint)
    return path


def _folder() -> Path:
    """Beside the package in a clone, in it where it is installed."""
    package = Path(str(files("benchlab")))
    inside, beside = package / "protocols", package.parent / "protocols"
    return inside if inside.is_dir() else beside


def _check_options(max_duration_s: float, rate_Hz: float | None) -> None:
    if not 0 < max_duration_s <= 1e8:
        raise UsageError(f"--max-duration-s is {max_duration_s:g}", hint="give more than 0 and at most 1e8")
    if rate_Hz is not None and not 1 <= rate_Hz <= 500:
        raise UsageError(f"--rate-Hz is {rate_Hz:g}", hint="give 1 to 500")


def _closed_loop(segments: tuple[Segment, ...]) -> bool:
    return any(
        _closed_loop(one.segments) if isinstance(one, Repeat) else isinstance(one, (AngleHold, AngleRamp, AngleSine))
        for one in segments
    )
