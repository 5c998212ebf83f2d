"""Which simulation `benchlab explain` compares with: the cell, the beam, curves of another engine, or a model of an earlier round."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path

from benchlab.actuator import ShellDesign
from benchlab.discrepancy.base import Base, DesignBase
from benchlab.errors import BenchlabError, InputError, UsageError, printable
from benchlab.io.delimited import open_table
from benchlab.io.designs_table import designs_beside, designs_of_names, read_designs
from benchlab.io.layup_file import read_layup
from benchlab.io.measured_frame import UNNAMED
from benchlab.io.model_file import ModelEffect, check_source
from benchlab.io.simulated_table import read_simulated
from benchlab.simulation.layup import Layup
from benchlab.workflows.explain_base import base_pressures, beam_base, cell_base, foreign_base
from benchlab.workflows.model_curves import check_range, model_layup, open_model

DEFAULT_MATERIAL = "from-measured-angles"
"""Of the cell where none is given: the shipped film that was identified from measured angles."""

BEAM = "beam"
"""What --model says for the beam in place of a file."""

Progress = Callable[[int, int], None]


@dataclass(frozen=True)
class Wanted:
    """What is to be simulated: designs by name, up to the largest pressure, also their blocked force? tables: that name the designs."""

    names: Sequence[str]
    largest_MPa: float
    forces: bool = False
    tables: Sequence[Path] = ()


@dataclass(frozen=True)
class Choice:
    """What the user says of the simulation. model: a file, or BEAM. material: a layup by name or file. cache: None for none.

    columns, simulation_columns: of the measured and the simulated table, as of `read_measured`.
    """

    simulation: Path | None = None
    model: str | None = None
    designs: Path | None = None
    material: str | None = None
    jobs: int = 1
    cache: Path | None = None
    columns: Mapping[str, str] | None = None
    simulation_columns: Mapping[str, str] | None = None

    def check(self) -> None:
        if self.simulation is not None and self.model is not None:
            raise UsageError("--simulation and --model are both given", hint="give one of them")
        if self.material is not None and self.model not in (None, BEAM):
            raise UsageError(
                "--model and --material are both given", hint="a model has its own material: give one of them"
            )

    @property
    def reads(self) -> tuple[Path, ...]:
        """Files that are read for it."""
        model = None if self.model in (None, BEAM) else Path(str(self.model))
        return tuple(path for path in (self.simulation, model, self.designs) if path is not None and path.is_file())


@dataclass(frozen=True)
class Chosen:
    """The base, and what it rests on: layup, and kind and source as a model file has them. shapes: of the designs, where known.

    given: effects that the model has already. told: what was assumed.
    """

    base: Base
    kind: str
    source: str
    layup: Layup
    shapes: Mapping[str, ShellDesign]
    given: tuple[ModelEffect, ...] = ()
    told: tuple[str, ...] = field(default=())


def choose_base(
    wanted: Wanted, choice: Choice, measured: Sequence[Path] = (), progress: Progress | None = None
) -> Chosen:
    """The simulation of the designs that are wanted. measured: files that may say their dimensions.

    Raises UsageError and InputError, also where no design has dimensions that the cell could be made of.
    """
    choice.check()
    told: list[str] = []
    shapes = _shapes(wanted, choice, measured, told)
    if choice.simulation is not None:
        layup = read_layup(choice.material or DEFAULT_MATERIAL)
        base, shapes = _foreign(choice.simulation, shapes, layup, wanted, choice, told, progress)
        return Chosen(base, "foreign", str(choice.simulation), layup, shapes, told=tuple(told))
    if choice.model in (None, BEAM):
        material = choice.material or DEFAULT_MATERIAL
        kind, layup = choice.model or "cell", read_layup(material)
        base = _simulated(kind, shapes, layup, wanted, choice, progress)
        return Chosen(base, kind, material, layup, shapes, told=tuple(told))
    return _of_model(Path(str(choice.model)), shapes, wanted, choice, told, progress)


def _of_model(
    path: Path,
    shapes: Mapping[str, ShellDesign],
    wanted: Wanted,
    choice: Choice,
    told: list[str],
    progress: Progress | None,
) -> Chosen:
    """The base of a model with its effects, and with all knobs, for further effects."""
    model = open_model(path)
    layup, source, kind = model_layup(model), check_source(path, model.file), model.file.base.kind
    if kind == "foreign":
        base, shapes = _foreign(Path(source), shapes, layup, wanted, choice, told, progress)
    else:
        base = _simulated(kind, shapes, layup, wanted, choice, progress)
    for name in base.designs:
        check_range(base, name, model.file.actives)
    names = ", ".join(effect.name for effect in model.file.effects)
    words = f"{base.source}, with {names} of {path.name}" if names else base.source
    base = replace(base, source=words, given=model.file.actives)
    return Chosen(base, kind, source, layup, shapes, model.file.effects, tuple(told))


def _shapes(wanted: Wanted, choice: Choice, measured: Sequence[Path], told: list[str]) -> dict[str, ShellDesign]:
    """Of the designs that are wanted: by --designs; else by the study, by columns of the tables, by their names."""
    if choice.designs is not None:
        known = dict(read_designs(choice.designs, told=told))
    else:
        known = dict(designs_of_names(wanted.names))
        for path in measured:
            study = path.is_dir() or path.suffix.lower() in (".yaml", ".yml")
            known |= read_designs(path, told=told) if study else designs_beside(path, choice.columns)
    return {name: known[name] for name in wanted.names if name in known} if wanted.names else known


def _simulated(
    kind: str,
    shapes: Mapping[str, ShellDesign],
    layup: Layup,
    wanted: Wanted,
    choice: Choice,
    progress: Progress | None,
) -> Base:
    if not shapes:
        which = "that --designs has, or columns tw_mm and slw_mm, or give simulated curves with --simulation"
        _check_designed(wanted, which, UsageError)
        listed = _some(wanted.names)
        what = f"no dimensions are known of {listed}" if listed else "no design is given"
        hint = "give --designs with columns design, tw_mm, slw_mm, or simulated curves with --simulation"
        raise UsageError(what, hint=hint)
    make = beam_base if kind == BEAM else cell_base
    base = make(
        shapes,
        layup,
        base_pressures(wanted.largest_MPa),
        forces=wanted.forces,
        jobs=choice.jobs,
        progress=progress,
        cache=choice.cache,
    )
    unknown = {name: "its dimensions are not known: give --designs" for name in wanted.names if name not in shapes}
    return replace(base, missing={**base.missing, **unknown})


def _check_designed(wanted: Wanted, which: str, fault: type[BenchlabError] = InputError) -> None:
    """Raises `fault` where a table does not say of which design its rows are. which: designs may be named."""
    if list(wanted.names) != [UNNAMED["design"]] or not wanted.tables:
        return
    with open_table(wanted.tables[0]) as table:
        there = ", ".join(map(printable, table.header))
    what = f"no column design: its rows are taken as of one that is called {UNNAMED['design']!r}, and none is simulated as that"
    hint = f"add a column design, with names {which}; the columns are {there}"
    raise fault(what, file=table.path, hint=hint)


def _some(names: Sequence[str]) -> str:
    return ", ".join(map(printable, names[:5])) + " …" * (len(names) > 5)


def _foreign(
    path: Path,
    shapes: Mapping[str, ShellDesign],
    layup: Layup,
    wanted: Wanted,
    choice: Choice,
    told: list[str],
    progress: Progress | None,
) -> tuple[Base, dict[str, ShellDesign]]:
    """Curves of another engine, with the sensitivities of the cell for designs whose dimensions are known."""
    every = read_simulated(path, choice.simulation_columns, told)
    curves = {name: every[name] for name in wanted.names if name in every} if wanted.names else dict(every)
    if not curves:
        _check_designed(wanted, f"of those that are simulated: {_some(tuple(every))}")
    shapes = {**_own_shapes(curves), **{name: shape for name, shape in shapes.items() if name in curves}}
    cell = None
    if shapes:
        try:
            cell = _simulated("cell", shapes, layup, wanted, choice, progress)
        except InputError as error:
            told.append(f"no structural effect is judged, because the cell cannot be simulated: {error}")
    base = foreign_base(curves or every, shapes, cell, source=path.name)
    missing = {name: "no simulated curve" for name in wanted.names if name not in every}
    return replace(base, missing={**base.missing, **missing}), shapes


def _own_shapes(curves: Mapping[str, DesignBase]) -> dict[str, ShellDesign]:
    return {name: one.shape for name, one in curves.items() if one.shape is not None}
