"""Options of commands that simulate many designs: material, fixture, where and how many at once."""

from __future__ import annotations

import functools
import os
from collections.abc import Callable
from pathlib import Path
from typing import Any

import click

from benchlab.cli.options import Finite
from benchlab.errors import UsageError

model_option = click.option(
    "--model",
    type=click.Path(path_type=Path),
    metavar="FILE",
    help="A model file, as `benchlab explain` writes it: its base and its effects, in place of the cell alone.",
)

OPTIONS = (
    click.option(
        "--material",
        metavar="FILE|NAME",
        help="Layup: a file, or one that is shipped. [default: the one of `benchlab simulate`]",
    ),
    click.option(
        "--lever-arm-mm",
        type=Finite("MM"),
        help="Blocked force is the moment at this arm. [default: the arm that makes the published force the simulated moment]",
    ),
    click.option("--contact-area-mm2", type=Finite("MM2"), help="Or: blocked force is the pressure on this area."),
    click.option("--jobs", type=click.IntRange(1), help="Designs at once, one core each. [default: all cores]"),
    click.option(
        "--scheduler", metavar="tcp://HOST:PORT", help="Simulate on the workers of this dask scheduler instead."
    ),
    click.option(
        "--out", type=click.Path(path_type=Path), default=Path(), show_default="here", help="Folder for the results."
    ),
    click.option("--json", "as_json", is_flag=True, help="One JSON document on standard output."),
)


def condition_options(command: Callable[..., Any]) -> Callable[..., Any]:
    """Add OPTIONS; `command` is given `conditions` (pressures_MPa, cap_mm, blocked[, model] -> Conditions) and the other options."""

    @functools.wraps(command)
    def with_conditions(
        *args: Any,
        material: str | None,
        lever_arm_mm: float | None,
        contact_area_mm2: float | None,
        jobs: int | None,
        scheduler: str | None,
        **options: Any,
    ) -> Any:
        if jobs is not None and scheduler is not None:
            raise UsageError("--jobs and --scheduler are both given", hint="give one of them")
        conditions = functools.partial(conditions_of, material, lever_arm_mm, contact_area_mm2)
        return command(*args, conditions=conditions, jobs=jobs or os.cpu_count() or 1, scheduler=scheduler, **options)

    for option in reversed(OPTIONS):
        with_conditions = option(with_conditions)
    return with_conditions


def conditions_of(
    material: str | None,
    lever_arm_mm: float | None,
    contact_area_mm2: float | None,
    pressures_MPa: tuple[float, ...],
    cap_mm: float,
    blocked: bool,
    model: Path | None = None,
) -> Any:
    """What all designs have in common. Raises UsageError or InputError for a material, a model or a fixture that is none, and for both."""
    from benchlab.io.layup_file import DEFAULT_LAYUP, read_layup
    from benchlab.simulation.actuator_response import Fixture
    from benchlab.workflows.simulated import Conditions

    if lever_arm_mm is not None and contact_area_mm2 is not None:
        raise UsageError("--lever-arm-mm and --contact-area-mm2 are both given", hint="give one of them")
    given = {"lever_arm_mm": lever_arm_mm, "contact_area_mm2": contact_area_mm2}
    fixture = Fixture() if lever_arm_mm is None and contact_area_mm2 is None else Fixture(**given)
    if model is None:
        return Conditions(read_layup(material or DEFAULT_LAYUP), pressures_MPa, fixture, cap_mm, blocked)
    if material is not None:
        raise UsageError("--model and --material are both given", hint="a model has its own material: give one of them")
    from benchlab.workflows.model_curves import model_layup, open_model

    opened = open_model(model)
    return Conditions(model_layup(opened), pressures_MPa, fixture, cap_mm, blocked, opened)
