"""A study as a YAML file: designs, their samples, the recordings of each, and what the designs should do.

Paths in the file are relative to it. `analysis:` may stand with the study, a design, a sample or a recording; what is nearer wins.
"""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Any

from benchlab.actuator import ShellDesign
from benchlab.errors import BenchlabError, InputError
from benchlab.io.design_file import read_design
from benchlab.io.study_analysis import AnalysisDocument, merged
from benchlab.io.study_parts import (
    ForceDocument,
    ForceSettings,
    Kind,
    RecordingDocument,
    SampleDocument,
    ShellDocument,
    SimulatedDocument,
    kind_of,
)
from benchlab.io.study_schema import DesignDocument, StudyDocument
from benchlab.io.study_values import ALL_DESIGNS, StudySet
from benchlab.io.yaml_file import read_document

STUDY_FILE = "study.yaml"

HOLD_TOLERANCE = 0.01
"""Share of the study's pressure within which it counts as held, where the study does not say."""


@dataclass(frozen=True)
class StudyRecording:
    """file: as it is written in the study; path: where it is. analysis: settings of `benchlab analyze`, paths resolved.
    counts: why it counts although its run was not completed, "" where the study does not say so."""

    file: str
    path: Path
    kind: Kind
    analysis: dict[str, Any]
    left_out: str = ""
    counts: str = ""


@dataclass(frozen=True)
class StudySample:
    """One made actuator with its recordings. left_out: why it does not count, "" where it does."""

    name: str
    recordings: tuple[StudyRecording, ...]
    notes: str = ""
    left_out: str = ""


@dataclass(frozen=True)
class StudySimulated:
    """A response or sweep file (path), or a stated angle and its source."""

    path: Path | None
    file: str
    angle_deg: float | None
    source: str


@dataclass(frozen=True)
class StudyForceFile:
    """The force record of one actuator. settings: steps_MPa, cycles, pressure (path) and how the file is read, where told."""

    file: str
    path: Path
    actuator: str
    settings: dict[str, Any]
    left_out: str = ""


@dataclass(frozen=True)
class StudyDesign:
    """One design. shell, simulated: None where the study does not tell."""

    name: str
    shell: ShellDesign | None
    simulated: StudySimulated | None
    samples: tuple[StudySample, ...]
    force: tuple[StudyForceFile, ...]
    notes: str = ""


@dataclass(frozen=True)
class Study:
    """A study file, read. sets: those of the file and, last, all designs."""

    path: Path
    title: str
    notes: str
    pressure_MPa: float
    hold_tolerance_MPa: float
    designs: tuple[StudyDesign, ...]
    sets: tuple[StudySet, ...]

    @property
    def folder(self) -> Path:
        """What its paths are relative to."""
        return self.path.parent


def read_study(path: Path) -> Study:
    """The study in a YAML file, or in the `study.yaml` of a folder.

    Raises UsageError for a missing file, InputError naming line and key of all that is wrong.
    """
    path = path / STUDY_FILE if path.is_dir() else path
    document = read_document(path, StudyDocument)
    designs = tuple(_design(path, name, item, document.analysis) for name, item in document.designs.items())
    sets = [
        StudySet(name, item.title or name, tuple(item.designs), item.x or "") for name, item in document.sets.items()
    ]
    everything = tuple(document.designs)
    if not any(set(chosen.designs) == set(everything) for chosen in sets):
        sets.append(StudySet(ALL_DESIGNS, "All designs", everything))
    tolerance = document.hold_tolerance_MPa or round(HOLD_TOLERANCE * document.pressure_MPa, 9)
    return Study(path, document.title, document.notes, document.pressure_MPa, tolerance, designs, tuple(sets))


def _design(path: Path, name: str, item: DesignDocument, above: AnalysisDocument) -> StudyDesign:
    levels = [above, item.analysis]
    shell = _shell(path, name, item.shell)
    samples = tuple(_sample(path.parent, key, sample, levels, shell) for key, sample in item.samples.items())
    simulated = _simulated(path.parent, item.simulated)
    return StudyDesign(name, shell, simulated, samples, _force(path.parent, item.force), item.notes)


def _simulated(folder: Path, item: SimulatedDocument | None) -> StudySimulated | None:
    if item is None:
        return None
    path = None if item.file is None else folder / item.file
    return StudySimulated(path, item.file or "", item.angle_deg, item.source)


def _shell(path: Path, name: str, item: ShellDocument | None) -> ShellDesign | None:
    if item is None:
        return None
    if item.named is None:
        return item.design()
    at = path.parent / item.named
    try:
        return read_design(at if at.exists() else item.named)
    except BenchlabError as error:
        what = ", ".join(part for part in (item.named, error.where) if part) + f": {error.what}"
        raise InputError(what, file=path, where=f"designs.{name}.shell", hint=error.hint) from None


def _sample(
    folder: Path, name: str, item: SampleDocument, levels: list[AnalysisDocument], shell: ShellDesign | None
) -> StudySample:
    recordings = tuple(_recording(folder, r, [*levels, item.analysis], shell) for r in item.recordings)
    return StudySample(name, recordings, item.notes, item.left_out)


def _recording(
    folder: Path, item: RecordingDocument, levels: list[AnalysisDocument], shell: ShellDesign | None
) -> StudyRecording:
    settings = merged([*levels, item.analysis])
    if shell is not None:
        settings.setdefault("length_mm", shell.length_mm)
    for name in ("lens", "pressure"):
        if name in settings:
            settings[name] = str(folder / settings[name])
    return StudyRecording(item.file, folder / item.file, kind_of(Path(item.file)), settings, item.left_out, item.counts)


def _force(folder: Path, item: ForceDocument | None) -> tuple[StudyForceFile, ...]:
    if item is None:
        return ()
    found = []
    for each in item.files:
        settings: dict[str, Any] = {}
        for level in (item, each):
            settings |= {
                name: value for name in ForceSettings.model_fields if (value := getattr(level, name)) is not None
            }
        if "pressure" in settings:
            settings["pressure"] = folder / settings["pressure"]
        path = folder / each.file
        found.append(StudyForceFile(each.file, path, each.actuator_name, settings, each.left_out))
    return tuple(found)
