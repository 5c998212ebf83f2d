"""`benchlab simulate`."""

from __future__ import annotations

import json
from decimal import Decimal
from itertools import pairwise
from pathlib import Path
from typing import Any

import click

from benchlab.actuator import ShellDesign
from benchlab.cli.condition_options import conditions_of, model_option
from benchlab.cli.design_options import design_options
from benchlab.cli.options import Finite
from benchlab.cli.ranges import Values
from benchlab.errors import InputError, UsageError, printable

MOST_PRESSURES = 2000


class Pressures(Values):
    """`START:END:STEP` in MPa, END being a whole number of steps away, or growing numbers with commas between.

    >>> Pressures().convert("0:0.35:0.175", None, None), Pressures().convert("0.1,0.3", None, None)
    ((0.0, 0.175, 0.35), (0.1, 0.3))
    """

    name = "pressures"

    def get_metavar(self, param: click.Parameter, ctx: click.Context) -> str:
        return "START:END:STEP|LIST"

    def convert(self, value: Any, param: click.Parameter | None, ctx: click.Context | None) -> tuple[float, ...]:
        if isinstance(value, tuple):
            return value
        text = str(value)
        found = self._steps(text, param, ctx) if ":" in text else self._numbers(text, ",", param, ctx)
        if len(found) > MOST_PRESSURES:
            self.fail(f"{text!r} has {len(found)} pressures, more than {MOST_PRESSURES}", param, ctx)
        for before, after in pairwise(found):
            if after <= before:
                self.fail(f"{text!r}: {after} MPa follows {before} MPa; give pressures that grow", param, ctx)
        if found[0] < 0:
            self.fail(f"{text!r} begins at {found[0]} MPa; give pressures of 0 MPa or more", param, ctx)
        return tuple(map(float, found))

    def _steps(self, text: str, param: click.Parameter | None, ctx: click.Context | None) -> list[Decimal]:
        parts = self._numbers(text, ":", param, ctx)
        if len(parts) != 3:
            self.fail(f"{text!r} is not START:END:STEP", param, ctx)
        start, end, step = parts
        found = super()._steps(text, param, ctx)
        if found[-1] != end:
            hint = f"{end} MPa is no whole number of steps of {step} from {start}"
            self.fail(f"{text!r}: {hint}; the steps end at {found[-1]}", param, ctx)
        return found


@click.command(short_help="Bending, volume and blocked force of a design against pressure.")
@design_options
@click.option(
    "--material",
    metavar="FILE|NAME",
    help="Layup: a file, or one that is shipped. [default: the shipped one that the result names]",
)
@model_option
@click.option(
    "--pressure-MPa",
    "pressures",
    type=Pressures(),
    default="0:0.35:0.035",
    show_default=True,
    help="Pressures, ends included, or a list as 0.1,0.2,0.35.",
)
@click.option(
    "--lever-arm-mm",
    type=Finite("MM"),
    help="Blocked force is the moment at this arm. [default: the arm at which the published force is reached]",
)
@click.option("--contact-area-mm2", type=Finite("MM2"), help="Or: blocked force is the pressure on this area.")
@click.option("--cap-mm", type=Finite("MM"), default=0.0, show_default=True, help="Rigid length at either end.")
@click.option(
    "--tip-force-at-deg",
    type=Finite("DEG"),
    help="Also the force of the tip, along its path, when it is held at this angle.",
)
@click.option(
    "--out", type=click.Path(path_type=Path), default=Path(), show_default="here", help="Folder for the results."
)
@click.option("--name", help="Of the files. [default: the design's, as tw3_slw10]")
@click.option("--overwrite", is_flag=True, help="Replace files that are not of an earlier simulation.")
@click.option("--strict", is_flag=True, help="Exit with 3 if there is any warning.")
@click.option("--json", "as_json", is_flag=True, help="One JSON document on standard output.")
def simulate(
    design: ShellDesign,
    material: str | None,
    model: Path | None,
    pressures: tuple[float, ...],
    lever_arm_mm: float | None,
    contact_area_mm2: float | None,
    cap_mm: float,
    tip_force_at_deg: float | None,
    strict: bool,
    as_json: bool,
    **options: Any,
) -> int:
    """Simulate a design, given by --tw-mm and --slw-mm or --design, with a finite-element cell of its shell: free to bend, and
    held straight, at each pressure.

    \b
    Writes into --out:
      NAME.csv       pressure_MPa, angle_deg, curvature_per_mm, axial_stretch, volume_mL, moment_Nmm, blocked_force_N
      NAME.h5        the same with states, mesh, material and provenance (HDF5, NXdata)
      NAME.png       the bent actuator, and its angle, volume and blocked force over pressure
      NAME.cell.png  the inflated cell and its sections

    With --model, the curves are those of a model file's base with its effects, at rest after a slow first loading; NAME is then
    the design's and the model's, and NAME.h5 has no states, NAME.cell.png is not drawn, and what a curve at rest cannot show is a warning.

    Blocked force is true for the fixture that is stated with it only: the moment of the actuator held straight at a lever arm, or
    the pressure on a contact area. Where there is no stable state at a pressure (burst), the curves end below it, and a
    warning names the limit pressure.

    \b
    Examples:
      benchlab simulate --tw-mm 3 --slw-mm 10
      benchlab simulate --design shell.yaml --material rubber.yaml --pressure-MPa 0:0.5:0.01 --cap-mm 15 --out results
      benchlab simulate --tw-mm 3 --slw-mm 10 --model explained/model.yaml
      benchlab simulate --design tw9_slw10 --tip-force-at-deg 45 --contact-area-mm2 110 --json
    """
    from benchlab.cli.progress import progress
    from benchlab.workflows.simulate import simulate as run
    from benchlab.workflows.simulate_model import simulate_model

    conditions = conditions_of(material, lever_arm_mm, contact_area_mm2, pressures, cap_mm, True, model)
    if model is not None and tip_force_at_deg is not None:
        hint = "leave --tip-force-at-deg out, or simulate without --model"
        raise UsageError("a model does not know the force of a tip that is held at an angle", hint=hint)
    with progress(design.name) as report:
        if model is not None:
            found = simulate_model(design, conditions, **options)
        else:
            found = run(design, conditions, tip_force_at_deg=tip_force_at_deg, progress=report, **options)
    _tell(found)
    if as_json:
        click.echo(json.dumps(found, indent=2, allow_nan=False))
    if strict and found["warnings"]:
        click.echo("benchlab: there are warnings, and --strict was given", err=True)
        return InputError.exit_code
    return 0


def _tell(found: dict[str, Any]) -> None:
    """The last point, warnings and files on standard error."""
    last = found["points"][-1]
    force = _or_unknown(last["blocked_force_N"])
    tip = f"; {_or_unknown(last['straight_tip_force_N'])} at the tip" if "straight_tip_force_N" in last else ""
    volume = "volume unknown" if last["volume_mL"] is None else f"{last['volume_mL']:.2f} mL"
    click.echo(
        f"{found['design']['name']}, simulated with {_with_what(found)}, at {last['pressure_MPa']:g} MPa: "
        f"{last['angle_deg']:.2f} deg, {volume}, blocked force {force} ({found['fixture']['words']}{tip}); "
        f"{len(found['points'])} pressures in {found['seconds']:.1f} s",
        err=True,
    )
    if found.get("tip_force_at_deg") is not None:
        force = _or_unknown(last["tip_force_N"])
        click.echo(f"  tip held at {found['tip_force_at_deg']:g} deg, {last['pressure_MPa']:g} MPa: {force}", err=True)
    for warning in found["warnings"]:
        click.echo(f"  warning: {printable(warning)}", err=True)
    for path in found["outputs"]:
        click.echo(f"  wrote {printable(path)}", err=True)


def _with_what(found: dict[str, Any]) -> str:
    """Material, or model and what its base alone has."""
    if "model" not in found:
        return f"material {printable(found['material']['name'])}"
    bare = found["points"][-1]["base_angle_deg"]
    return f"model {printable(found['model']['file'])} (its base alone: {bare:.2f} deg)"


def _or_unknown(force_N: float | None) -> str:
    return "unknown" if force_N is None else f"{force_N:.2f} N"
