"""From `--bench` and `--calibration` to a bench: what it may be asked for, and, later, the open device."""

from __future__ import annotations

import datetime
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING

from benchlab.actuator import ShellDesign
from benchlab.bench import Bench
from benchlab.devices.interface import Device
from benchlab.errors import InputError, UsageError
from benchlab.twin.curve import ResponseCurve
from benchlab.twin.settings import TwinSettings

if TYPE_CHECKING:
    from benchlab.workflows.model_twin import ModelTwin

NEEDS = {"twin": None, "serial": "PORT", "emulated": None, "replay": "FILE"}
"""What must follow the kind of a bench after a colon. A twin may be followed by a file."""


@dataclass(frozen=True)
class Spec:
    """`--bench`, taken apart. kind: a key of NEEDS. where: what stood after the colon, empty if nothing."""

    kind: str
    where: str = ""

    def __str__(self) -> str:
        return f"{self.kind}:{self.where}" if self.where else self.kind


@dataclass(frozen=True)
class Actuator:
    """What is known of the actuator on a bench. length_mm: None where only the curve is."""

    curve: ResponseCurve
    name: str
    length_mm: float | None = None


def spec_of(text: str) -> Spec:
    """Take `--bench` apart. UsageError for a kind that there is not, or one without what it needs.

    >>> spec_of("serial:/dev/ttyUSB0")
    Spec(kind='serial', where='/dev/ttyUSB0')
    """
    kind, _, where = text.partition(":")
    kinds = "twin, twin:FILE, serial:PORT, emulated or replay:FILE"
    if kind not in NEEDS:
        raise UsageError(f"--bench {text!r} is no bench", hint=f"give {kinds}")
    if NEEDS[kind] and not where:
        raise UsageError(f"--bench {kind} does not say which", hint=f"give {kind}:{NEEDS[kind]}")
    if where and kind == "emulated":
        raise UsageError(f"--bench {text!r}: nothing follows `emulated`", hint=f"give {kinds}")
    return Spec(kind, where)


def twin_of(
    spec: Spec, seed: int | None = None, actuator: Actuator | None = None, model: TwinSettings | None = None
) -> TwinSettings | None:
    """What a twin is made from; None for another bench. seed: in place of its file's. actuator: where its file has no curve of its own.
    model: the twin of a model (`model_of`), that of the one that its file names where None.

    Raises UsageError and InputError as `read_twin`.
    """
    if spec.kind != "twin":
        return None
    from benchlab.io.twin_file import read_twin

    path = Path(spec.where) if spec.where else None
    if model is None and (found := model_of(spec)) is not None:
        model = found.settings
    settings = read_twin(path, model)
    if actuator is not None and not settings.own_curve:
        settings = replace(settings, curve=actuator.curve, design=actuator.name)
        if actuator.length_mm is not None:
            settings = replace(settings, length_mm=actuator.length_mm)
    return settings if seed is None else replace(settings, seed=seed)


def model_of(spec: Spec, path: Path | None = None, design: ShellDesign | None = None) -> ModelTwin | None:
    """The twin of the model file `path`, or of the one that a twin's file names; None where there is no model.

    design: of the actuator; where None the one that the twin's file names, else tw3_slw10. Raises UsageError, also for two models, and
    InputError.
    """
    from benchlab.io.design_file import read_design
    from benchlab.io.twin_file import SHIPPED_CURVE, named_model

    named = named_model(Path(spec.where)) if spec.kind == "twin" and spec.where else None
    if path is not None and named is not None:
        hint = "give one of them"
        raise UsageError(f"--model {path} and the model {named.path.name} of the twin's file are two", hint=hint)
    file = named.path if path is None and named is not None else path
    if file is None:
        return None
    from benchlab.workflows.explain_cache import default_cache
    from benchlab.workflows.model_curves import open_model
    from benchlab.workflows.model_twin import model_twin

    wanted = design or read_design(named.design if named is not None and named.design else SHIPPED_CURVE)
    opened = open_model(file)
    return model_twin(opened, wanted, cache=default_cache())


def bench_of(spec: Spec, calibration: Path | None = None, twin: TwinSettings | None = None) -> Bench:
    """What the bench may be asked for: its calibration file's, or what there is without one. Opens no port.

    A twin or an emulation without a file has the calibration that it is made with, a replay the one of its run. InputError for a
    bench of metal with the calibration of a twin.
    """
    from benchlab.io.bench_file import is_simulated, read_bench

    if calibration is not None:
        bench = read_bench(calibration)
        if spec.kind == "serial" and is_simulated(bench):
            what = f"its gauge is {bench.gauge!r}: no pressure of a bench of metal may rest on it"
            raise InputError(what, file=calibration, hint="calibrate this bench with `benchlab bench calibrate`")
        return bench
    if spec.kind == "twin":
        from benchlab.devices.twin.bench import twin_bench

        return twin_bench(twin or twin_of(spec))
    if spec.kind == "emulated":
        from benchlab.devices.emulated import emulated_bench

        return emulated_bench()
    if spec.kind == "replay":
        return _recorded_bench(Path(spec.where))
    return read_bench(None)


def bench_doubts(spec: Spec, bench: Bench) -> list[str]:
    """What must be told of a calibration: a limit above the paper's; of a bench of metal also that there is none, or that it is old."""
    from benchlab.io.bench_file import calibration_warnings, limit_notes

    return calibration_warnings(bench, datetime.date.today()) if spec.kind == "serial" else limit_notes(bench)


def open_bench(
    text: str, bench: Bench | None = None, *, fast: bool = False, twin: TwinSettings | None = None
) -> Device:
    """Open the bench that `--bench` names, disarmed. bench: its calibration, `bench_of` where None.

    fast: in virtual time; UsageError for a serial bench, which has only the real one. twin: what a twin is made from, `twin_of` where
    None. Raises BenchError where the bench does not answer, with the ports that there are.
    """
    spec = spec_of(text)
    twin = twin or twin_of(spec)
    bench = bench or bench_of(spec, None, twin)
    if spec.kind == "serial":
        if fast:
            raise UsageError("--fast is virtual time, which a real bench does not have", hint="leave --fast out")
        from benchlab.devices.serial_bench import open_serial

        return open_serial(spec.where, bench)
    if spec.kind == "emulated":
        from benchlab.devices.emulated import open_emulated

        return open_emulated(bench, lockstep=fast)
    if spec.kind == "replay":
        return _replay(Path(spec.where))
    from benchlab.devices.twin.twin import Twin

    assert twin is not None
    return Twin(twin, bench)


def _replay(path: Path) -> Device:
    from benchlab.devices.replay import Replay
    from benchlab.io.drive_file import read_run_record, trigger_ticks

    journal = read_run_record(path)
    if not len(journal.samples):
        raise InputError("holds no sample", file=path, hint="replay a run that began")
    watched = len(journal.samples) - len(journal.driven)
    return Replay(journal.samples, journal.header.get("device", {}), trigger_ticks(journal), watched)


def _recorded_bench(path: Path) -> Bench:
    from benchlab.io.drive_file import read_run_record
    from benchlab.io.recorded_bench import recorded_bench

    return recorded_bench(read_run_record(path).header, path)
