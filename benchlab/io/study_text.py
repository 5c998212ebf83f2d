"""The text of a new study file, made to be edited by hand: short, with a word on what each part is."""

from __future__ import annotations

import json
import re
import textwrap
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path, PurePath

from benchlab.actuator import DIMENSIONS, ShellDesign
from benchlab.errors import BenchlabError, InputError, printable
from benchlab.io.files import cannot_write, written_whole
from benchlab.io.study_file import Study, read_study
from benchlab.io.study_parts import kind_of
from benchlab.io.study_values import StudySet

ABOUT = """\
A study of benchlab: designs, their samples, and the recordings of each. Edit it as you like; paths are relative to this file.
All keys: docs/studies.md. What is missing: benchlab study check {name}"""

_PLAIN = re.compile(r"(\.\./)*[A-Za-z][A-Za-z0-9_./-]*( [A-Za-z0-9_./-]+)*|\d+:[\d.]+:[\d.]+", re.ASCII)
_NOT_TEXT = frozenset(["null", "true", "false"])


@dataclass(frozen=True)
class DesignDraft:
    """One design of a new study. samples: name -> files. shell: None where it is not known. force: files of blocked force."""

    name: str
    shell: ShellDesign | None
    samples: Mapping[str, Sequence[str]]
    simulated: str = ""
    force: Sequence[str] = ()
    force_settings: Mapping[str, object] = field(default_factory=dict)


@dataclass(frozen=True)
class StudyDraft:
    """What a new study file says. analysis: of all recordings. remarks: on its sets. unused: files and why they are not in it.
    pressures: of films, the file with their pressure. pressure_told: whether pressure_MPa was told, or is the default."""

    title: str
    pressure_MPa: float
    analysis: Mapping[str, object]
    designs: Sequence[DesignDraft]
    sets: Sequence[StudySet] = ()
    notes: str = ""
    unused: Sequence[tuple[str, str]] = ()
    pressures: Mapping[str, str] = field(default_factory=dict)
    pressure_told: bool = True

    @property
    def pressure_known(self) -> bool:
        """Whether it tells the pressure in its videos, or has none."""
        files = (file for design in self.designs for made in design.samples.values() for file in made)
        return bool({"ramp", "pressure"} & self.analysis.keys()) or all(
            file in self.pressures or kind_of(PurePath(file)) != "video" for file in files
        )


def write_study(path: Path, draft: StudyDraft) -> Study:
    """Write a study file, whole or not at all, and only one that reads back. Raises InputError."""
    with written_whole(path) as temporary:
        try:
            temporary.write_text(study_text(draft, path.name), encoding="utf-8", newline="\n")
        except OSError as error:
            raise cannot_write(error, path) from error
        try:
            return read_study(temporary)
        except BenchlabError as error:
            what = f"would not be a study: {error.what}"
            raise InputError(what, file=path, where=error.where, hint=error.hint or "rename what it names") from error


def study_text(draft: StudyDraft, name: str = "study.yaml") -> str:
    """The file's text. name: of the file.

    >>> draft = StudyDraft("Trial", 0.35, {}, [DesignDraft("a", None, {"s1": ["a 1.mp4"]})])
    >>> print(study_text(draft).partition("designs:")[2])
    <BLANKLINE>
      a:
        # shell: {tw_mm: 3, slw_mm: 10}  <- its dimensions are not known from its name
        samples:
          s1: a 1.mp4
    <BLANKLINE>
    """
    lines = [f"# {line}" for line in ABOUT.format(name=printable(name)).splitlines()]
    lines += ["", f"title: {_scalar(draft.title)}"]
    if draft.notes:
        lines += ["notes: >-", *(f"  {line}" for line in textwrap.wrap(draft.notes, 110, break_on_hyphens=False))]
    default = "" if draft.pressure_told else "; this is the default, nothing told it: make it yours"
    lines += [f"pressure_MPa: {draft.pressure_MPa:.9g}  # at which the designs are compared{default}", ""]
    lines += _analysis(draft.analysis)
    if not draft.pressure_known:
        lines += [
            "# The pressure is not known yet: give `ramp: START:END:SECONDS` in MPa, or `pressure: LOG.csv`, under analysis."
        ]
    lines += ["", "designs:"]
    for design in draft.designs:
        lines += _design(design, draft.pressures)
    if draft.sets:
        lines += [
            "",
            "# Compared with each other; proposed: designs that differ in one dimension and are alike in all others.",
            "sets:",
        ]
        lines += [_set(chosen) for chosen in draft.sets]
    if draft.unused:
        lines += ["", "# Not in this study:"]
        lines += [f"#   {printable(file)}: {printable(why)}" for file, why in draft.unused]
    return "\n".join(lines) + "\n"


def _analysis(settings: Mapping[str, object]) -> Iterator[str]:
    yield "# Settings of `benchlab analyze` for all recordings; a design, a sample or a recording may have its own."
    if settings:
        yield "analysis:"
        yield from (f"  {name}: {_value(value)}" for name, value in settings.items())


def _recording(file: str, pressures: Mapping[str, str]) -> str:
    if file not in pressures:
        return _scalar(file)
    return f"{{file: {_scalar(file)}, analysis: {{pressure: {_scalar(pressures[file])}}}}}"


def _design(design: DesignDraft, pressures: Mapping[str, str]) -> Iterator[str]:
    yield f"  {_scalar(design.name)}:"
    if design.shell is None:
        yield "    # shell: {tw_mm: 3, slw_mm: 10}  <- its dimensions are not known from its name"
    else:
        yield f"    shell: {_shell(design.shell)}"
    if design.simulated:
        yield f"    simulated: {_scalar(design.simulated)}"
    yield "    samples:"
    for name, files in design.samples.items():
        made = [_recording(file, pressures) for file in files]
        plain = len(files) == 1 and files[0] not in pressures
        yield f"      {_scalar(name)}: {made[0] if plain else '[' + ', '.join(made) + ']'}"
    if not design.force:
        return
    yield "    force:"
    yield "      files:"
    yield from (f"        - {_scalar(file)}" for file in design.force)
    yield from (f"      {name}: {_value(value)}" for name, value in design.force_settings.items())
    if not {"steps_MPa", "pressure"} & design.force_settings.keys():
        yield "      # steps_MPa: [0.035, 0.07]  <- pressures of its steps, where the files have no pressure; and cycles: 5"


def _shell(shell: ShellDesign) -> str:
    """All that differs from the paper's actuator."""
    values = {name: getattr(shell, part) for name, part in DIMENSIONS.items()}
    usual = {name: getattr(ShellDesign, part, None) for name, part in DIMENSIONS.items()}
    return "{" + ", ".join(f"{name}: {value:.9g}" for name, value in values.items() if value != usual[name]) + "}"


def _set(chosen: StudySet) -> str:
    parts = [f"designs: {_value(list(chosen.designs))}"]
    parts += [f"x: {chosen.x}"] if chosen.x else []
    parts += [f"title: {json.dumps(chosen.title, ensure_ascii=False)}"] if chosen.title else []
    return f"  {_scalar(chosen.name)}: {{{', '.join(parts)}}}"


def _value(value: object) -> str:
    if isinstance(value, list | tuple):
        return f"[{', '.join(map(_value, value))}]"
    if isinstance(value, str):
        return _scalar(value)
    return f"{value:.9g}" if isinstance(value, float) else json.dumps(value)


def _scalar(text: str) -> str:
    """A text as YAML: plain where it cannot be read as anything else."""
    if _PLAIN.fullmatch(text) and text.lower() not in _NOT_TEXT:
        return text
    return json.dumps(text, ensure_ascii=not text.isprintable())
