"""All of a run that can be refused without a bench: protocol, limits, control, guards, names and room on disk."""

from __future__ import annotations

import hashlib
import shutil
from collections.abc import Callable
from dataclasses import asdict, dataclass
from datetime import datetime
from pathlib import Path
from typing import TYPE_CHECKING, Any

from benchlab.actuator import ShellDesign
from benchlab.bench import Bench
from benchlab.control.controller import Controller, controller_of
from benchlab.errors import InputError, UsageError
from benchlab.io.files import check_new_folder
from benchlab.protocol.plan import Plan
from benchlab.runner.guards.bend import expected_along, least_expected_deg
from benchlab.runner.guards.choice import Guard, guards_of
from benchlab.runner.guards.limits import Limits
from benchlab.twin.curve import ResponseCurve
from benchlab.twin.settings import TwinSettings
from benchlab.workflows.open_bench import Actuator, Spec, bench_doubts, bench_of, model_of, spec_of, twin_of
from benchlab.workflows.run_control import check_reach, choose, control_told, two_curves
from benchlab.workflows.run_curve import actuator_of

if TYPE_CHECKING:
    from benchlab.workflows.model_twin import ModelTwin

REAL_RATES_HZ = (10.0, 500.0)
"""Of a real or emulated bench: slower and its silence limit vents it, faster and the line cannot answer."""

BYTES_A_TICK, ROOM_BYTES = 600, 20_000_000
"""Of journal and results together, as an upper bound; and what is kept free beside them."""

LONGEST_NAME = 200

SUFFIXES = (".journal", ".h5", ".csv", ".png", ".truth.csv", ".film.mp4")
"""Of the files of a run."""


@dataclass(frozen=True)
class RunSettings:
    """What the options of `benchlab run` say. guards: words as `follow_MPa=0.02`. name: of the files; None is protocol and date."""

    bench: str = "twin"
    calibration: Path | None = None
    design: ShellDesign | None = None
    curve: Path | None = None
    model: Path | None = None
    control: Path | None = None
    out: Path = Path()
    name: str | None = None
    rate_Hz: float | None = None
    fast: bool = False
    video: bool = False
    seed: int | None = None
    max_duration_s: float = 3600.0
    pause_limit_s: float = 10.0
    guards: tuple[str, ...] = ()


@dataclass(frozen=True)
class Prepared:
    """A run that may begin. text, sha256: of the protocol. control: as `control_told`; it and controller are None in open loop.
    curve: what controller and guards believe of the actuator, None where nobody knows it; twin: None for another bench. model: the
    model file by its name and SHA-256, None where there is none."""

    settings: RunSettings
    spec: Spec
    bench: Bench
    plan: Plan
    text: str
    sha256: str
    source: str
    limits: Limits
    curve: ResponseCurve | None
    twin: TwinSettings | None
    control: dict[str, Any] | None
    controller: Controller | None
    model: dict[str, Any] | None
    stem: Path
    warnings: tuple[str, ...]

    @property
    def fast(self) -> bool:
        """Whether time is virtual, as it always is for a replay."""
        return self.settings.fast or self.spec.kind == "replay"

    @property
    def expected_deg(self) -> Callable[[float], float]:
        """The angle that a pressure should give, by the response curve, or the least that any actuator gives."""
        return (
            least_expected_deg if self.curve is None else expected_along(self.curve.pressure_MPa, self.curve.angle_deg)
        )

    def guards(self) -> list[Guard]:
        """New guards for one run: they remember what they saw."""
        return guards_of(self.bench, self.plan.rate_Hz, self.limits, self.expected_deg)

    @property
    def suffixes(self) -> tuple[str, ...]:
        """Of the files that will be written."""
        left_out = {".truth.csv": self.spec.kind != "twin", ".film.mp4": not self.settings.video}
        return tuple(suffix for suffix in SUFFIXES if not left_out.get(suffix))

    def path(self, suffix: str) -> Path:
        return self.stem.with_name(self.stem.name + suffix)


def prepare(protocol: str, settings: RunSettings) -> Prepared:
    """Read and check everything; no port is opened and nothing is written.

    Raises UsageError, InputError and LimitError, each saying what to change.
    """
    from benchlab.protocol.checks import check_limits

    spec = _checked_spec(settings)
    limits = Limits.of(settings.guards)
    model = model_of(spec, settings.model, settings.design)
    actuator = _actuator(settings, model)
    twin = twin_of(spec, settings.seed, actuator, None if model is None else model.settings)
    bench = bench_of(spec, settings.calibration, twin)
    plan, text, source = read_plan(protocol, settings)
    check_limits(plan, bench, protocol)
    _check_rate(plan, spec)
    curve = actuator.curve if actuator is not None else None if twin is None else twin.curve
    chosen = choose(plan, bench, settings.control)
    controller, warnings = None, two_curves(None if actuator is None else curve, None if twin is None else twin.curve)
    if chosen is not None:
        top_MPa = min(plan.limit_MPa, bench.ceiling_MPa)
        known = None if curve is None else (curve.pressure_MPa, curve.angle_deg)
        warnings += [*chosen.warnings, *check_reach(plan, top_MPa, curve, chosen.control.feed_forward)]
        controller = controller_of(**asdict(chosen.control), ceiling_MPa=top_MPa, curve=known)
    elif settings.control is not None:
        warnings.append("--control is not used: no step is closed-loop")
    stem = _stem(source, settings)
    check_room(stem, plan)
    return Prepared(
        settings=settings,
        spec=spec,
        bench=bench,
        plan=plan,
        text=text,
        sha256=hashlib.sha256(text.encode()).hexdigest(),
        source=source,
        limits=limits,
        curve=curve,
        twin=twin,
        control=control_told(chosen, curve),
        controller=controller,
        model=None if model is None else model.about,
        stem=stem,
        warnings=(
            *bench_doubts(spec, bench),
            *_blind(bench),
            *limits.off_words,
            *warnings,
            *(model.notes_for(twin) if model else ()),
        ),
    )


def _actuator(settings: RunSettings, model: ModelTwin | None) -> Actuator | None:
    """What is believed of the actuator: --curve, or the model's curve at rest, or that of --design."""
    if model is None or settings.curve is not None:
        return actuator_of(settings.design, settings.curve)
    return Actuator(model.settings.curve, model.settings.design, model.settings.length_mm)


def check_room(stem: Path, plan: Plan) -> None:
    """The folder, or the one that it will be made in, may be written and has room; nothing has the name of our files.

    Raises UsageError and, for a full disk, InputError.
    """
    folder = stem.parent
    check_new_folder(folder)
    there = folder if folder.is_dir() else folder.absolute().parent
    for suffix in SUFFIXES:
        if (path := stem.with_name(stem.name + suffix)).exists():
            hint = "choose another --name or --out"
            raise UsageError("exists, and measured data is never replaced", file=path, hint=hint)
    free, need = shutil.disk_usage(there).free, BYTES_A_TICK * len(plan.time_s) + ROOM_BYTES
    if free < need:
        what = f"disk full: {free / 1e6:.0f} MB free, {need / 1e6:.0f} MB are kept for a run of this length"
        raise InputError(what, file=there, hint="free some space, or choose another --out")


def read_plan(protocol: str, settings: RunSettings) -> tuple[Plan, str, str]:
    """The plan, the text of the protocol and its name. protocol: a path, or the name of a shipped one."""
    from benchlab.io.protocol_file import protocol_text, read_protocol

    plan = read_protocol(protocol, settings.max_duration_s, settings.rate_Hz)
    return plan, protocol_text(protocol), Path(protocol).stem


def _checked_spec(settings: RunSettings) -> Spec:
    spec = spec_of(settings.bench)
    if settings.fast and spec.kind == "serial":
        raise UsageError("--fast is virtual time, which a real bench does not have", hint="leave --fast out")
    if spec.kind != "twin":
        for option in ("video", "seed"):
            if getattr(settings, option) not in (None, False):
                raise UsageError(f"--{option} is for a twin, and the bench is {spec}", hint=f"leave --{option} out")
    if settings.model is not None and settings.curve is not None:
        raise UsageError("--model and --curve both give a response curve", hint="give one of them")
    if settings.design is not None and settings.curve is not None:
        raise UsageError("--design and --curve both give a response curve", hint="give one of them")
    if not 0 < settings.pause_limit_s <= 600:
        raise UsageError(f"--pause-limit-s is {settings.pause_limit_s:g}", hint="give more than 0 and at most 600")
    return spec


def _check_rate(plan: Plan, spec: Spec) -> None:
    low, high = REAL_RATES_HZ
    if spec.kind in ("serial", "emulated") and not low <= plan.rate_Hz <= high:
        raise InputError(
            f"the plan's rate is {plan.rate_Hz:g} Hz, and {spec} takes {low:g} to {high:g} Hz", hint="give --rate-Hz"
        )


def _blind(bench: Bench) -> list[str]:
    """What is not seen on a bench without sensors."""
    if bench.monitor is not None or bench.flex is not None:
        return []
    return ["neither monitor nor flex sensor is calibrated: a leak, a burst or a tube that is off is not seen"]


def _stem(source: str, settings: RunSettings) -> Path:
    name = f"{source}-{datetime.now():%Y%m%d-%H%M%S}" if settings.name is None else settings.name
    hint = f"give --name without folders, up to {LONGEST_NAME} bytes, and --out for the folder"
    if suffix := next((each for each in SUFFIXES if name.endswith(each)), ""):
        hint = f"give --name {name.removesuffix(suffix)}: the suffixes come by themselves"
    odd = name != Path(name).name or not name.strip() or name.startswith((".", "-")) or not name.isprintable()
    if odd or suffix or len(name.encode()) > LONGEST_NAME:
        raise UsageError(f"{name[:60]!r} is no name for files", hint=hint)
    return settings.out / name
