"""What `benchlab explain` is given: tables, run files and drive files, or a whole study, as measured runs or a table of means."""

from __future__ import annotations

import functools
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path

from benchlab.discrepancy.measured import Measured, Run, Summary
from benchlab.errors import BenchlabError, InputError, UsageError, printable
from benchlab.io.files import check_regular_file, make_folder
from benchlab.io.hdf5 import is_hdf5
from benchlab.io.measured_frame import RunName
from benchlab.io.measured_recording import Recorded, read_recording
from benchlab.io.measured_runs import measured_of_runs
from benchlab.io.measured_table import read_measured
from benchlab.io.study_file import STUDY_FILE, Study, read_study
from benchlab.workflows.batch import run_batch
from benchlab.workflows.drawn_film import TWIN_CAMERA
from benchlab.workflows.outputs import Outputs
from benchlab.workflows.study_folder import FILM
from benchlab.workflows.study_pattern import NamePattern, choose_pattern
from benchlab.workflows.study_readings import Target
from benchlab.workflows.study_recordings import StudyItem, read_item, reason_for, study_items
from benchlab.workflows.study_values import RECORDINGS

Progress = Callable[[int, int | None], None]


@dataclass
class _Gathered:
    """Runs with the file of each, and what is to be told."""

    runs: list[Run] = field(default_factory=list)
    files: list[str] = field(default_factory=list)
    warnings: list[str] = field(default_factory=list)
    simulated: bool = False

    def add(self, file: str, runs: Sequence[Run], warnings: Sequence[str], simulated: bool) -> None:
        self.runs += runs
        self.files += [file] * len(runs)
        self.warnings += [f"{printable(Path(file).name)}: {words}" for words in warnings]
        self.simulated |= simulated

    def measured(self, source: str) -> Measured:
        return measured_of_runs(self.runs, source, self.files, self.simulated, self.warnings)


def read_explained(
    paths: Sequence[Path],
    columns: Mapping[str, str] | None = None,
    against: Sequence[str] = (),
    pattern: str | None = None,
    out: Path | None = None,
    jobs: int = 1,
    progress: Progress | None = None,
) -> Measured | Summary:
    """What was measured, out of one study (its file or folder), or of tables, run files and drive files in any mixture.

    columns, against: of tables, as of `read_measured`. pattern: how files are named, as `{design}_s{sample}`; run files without one are
    read by the first common pattern that fits. out: where the videos of a study are analysed into, as `benchlab report` does.
    Raises UsageError or InputError naming file, place and remedy.
    """
    studies = [path for path in paths if path.is_dir() or path.suffix.lower() in (".yaml", ".yml")]
    if studies and len(paths) > 1:
        hint = "give the study alone; it names its recordings"
        raise UsageError("a study beside other files", file=studies[0], hint=hint)
    if studies:
        return _of_study(read_study(_study_file(studies[0])), columns, against, out, jobs, progress)
    recordings = [path for path in paths if check_regular_file(path) and is_hdf5(path)]
    tables = [path for path in paths if path not in recordings]
    names = _names(recordings, pattern) | (_names(tables, pattern) if pattern else {})
    if not recordings:
        return read_measured(tables, columns, against, names)
    found = _Gathered()
    for path in recordings:
        _add_recorded(found, path, read_recording(path, names[path]))
    if tables:
        _add_table(found, tables, read_measured(tables, columns, against, names))
    return found.measured(", ".join(map(str, paths)))


def _study_file(path: Path) -> Path:
    if path.is_dir() and not (path / STUDY_FILE).is_file():
        hint = "give the files themselves, or make a study of the folder with `benchlab study new`"
        raise UsageError(f"a folder without {STUDY_FILE}", file=path, hint=hint)
    return path


def _names(paths: Sequence[Path], pattern: str | None) -> dict[Path, RunName]:
    """Design, sample and run of each file by its name; InputError for a name that does not fit."""
    if not paths:
        return {}
    names = {path: path.with_suffix("").as_posix().removesuffix(FILM) for path in paths}
    chosen = NamePattern(pattern) if pattern else choose_pattern(list(names.values()))
    found = {}
    for path, name in names.items():
        if (parts := chosen.read(name)) is None:
            hint = "rename the file, or give another --pattern"
            raise InputError(f"its name does not fit {chosen.text!r}", file=path, hint=hint)
        found[path] = RunName(parts.design, parts.sample, path.stem)
    return found


def _add_recorded(found: _Gathered, path: Path, recorded: Recorded) -> None:
    if recorded.never:
        found.warnings.append(f"{printable(path.name)} left out: {recorded.never}")
    else:
        simulated = recorded.simulated or TWIN_CAMERA in recorded.title
        found.add(str(path), [recorded.run], recorded.warnings, simulated)


def _add_table(found: _Gathered, paths: Sequence[Path], measured: Measured | Summary) -> None:
    if isinstance(measured, Summary):
        hint = "explain them one after the other"
        raise UsageError("a table of means beside runs", file=paths[0], hint=hint)
    file = ", ".join(map(str, paths))
    found.add(file, measured.runs, measured.warnings, measured.simulated)


def _of_study(
    study: Study,
    columns: Mapping[str, str] | None,
    against: Sequence[str],
    out: Path | None,
    jobs: int,
    progress: Progress | None,
) -> Measured:
    """The runs of a study's recordings; those that are left out, or cannot be read, are told with the reason."""
    found = _Gathered()
    items = list(_that_count(study, out or study.folder, found))
    failed = _analysed([item for item in items if item.recording.kind == "video"], study, out, jobs, progress)
    for item in items:
        try:
            if (error := failed.get(item.place)) is not None:
                raise error
            _add_item(found, item, columns, against)
        except BenchlabError as error:
            reason = reason_for(error, item.recording.path)
            found.warnings.append(f"{printable(item.recording.file)} left out: {reason}")
    if not found.runs:
        why = found.warnings[0] if found.warnings else "it has no recordings"
        raise InputError(f"no run can be read: {why}", file=study.path, hint="see `benchlab study check`")
    return found.measured(str(study.path))


def _that_count(study: Study, out: Path, found: _Gathered) -> Iterator[StudyItem]:
    left_out = {(design.name, sample.name): sample.left_out for design in study.designs for sample in design.samples}
    for item in study_items(study, out / RECORDINGS):
        if why := item.recording.left_out or left_out[item.place[:2]]:
            found.warnings.append(f"{printable(item.recording.file)} left out: {why}")
        else:
            yield item


def _analysed(
    items: Sequence[StudyItem], study: Study, out: Path | None, jobs: int, progress: Progress | None
) -> dict[tuple[str, str, int], BenchlabError]:
    """Analyse videos that are new or have changed; what went wrong, by recording."""
    if not items:
        return {}
    if out is None:
        hint = "say where their analyses go, with --out"
        raise UsageError("has videos", file=study.path, hint=hint)
    make_folder(out)
    make_folder(out / RECORDINGS)
    target = Target.of(study.pressure_MPa, study.hold_tolerance_MPa)
    failed = {}
    for done, outcome in enumerate(
        run_batch(items, functools.partial(read_item, target=target, overwrite=False), jobs)
    ):
        if outcome.result and outcome.result["partial"]:
            raise KeyboardInterrupt
        if outcome.error:
            failed[outcome.item.place] = outcome.error
        if progress:
            progress(done + 1, len(items))
    return failed


def _add_item(found: _Gathered, item: StudyItem, columns: Mapping[str, str] | None, against: Sequence[str]) -> None:
    """The run of one recording of a study, or those of its sample in a table."""
    design, sample, _ = item.place
    recording = item.recording
    if recording.kind == "table":
        name = {recording.path: RunName(design, sample, item.stem)}
        measured = read_measured([recording.path], columns, against, name)
        if isinstance(measured, Summary):
            raise InputError("a table of means", file=recording.path, hint="explain it by itself")
        runs = [run for run in measured.runs if (run.design, run.sample) == (design, sample)]
        if not runs:
            raise InputError(f"no row of {design} {sample}", file=recording.path, hint="is it called so there?")
        found.add(str(recording.path), runs, measured.warnings, measured.simulated)
        return
    path = Outputs(item.folder, item.stem).run_file if recording.kind == "video" else recording.path
    recorded = read_recording(path, RunName(design, sample, item.stem))
    if recorded.unfit and not recording.counts:
        raise InputError(recorded.unfit, file=recording.path, hint="say `counts:` in the study where it does")
    _add_recorded(found, path, recorded)
