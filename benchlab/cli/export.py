"""`benchlab export`."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import click

from benchlab.actuator import ShellDesign
from benchlab.cli.design_options import Design
from benchlab.cli.options import Finite
from benchlab.errors import UsageError, printable


@click.command(short_help="Finite-element deck of a design for CalculiX or Abaqus.")
@click.argument("design", type=Design())
@click.option("--engine", type=click.Choice(["calculix", "abaqus"]), required=True, help="For which program.")
@click.option(
    "--cells", type=click.IntRange(1), help="Cells (rib and window) from the mirror plane to the cap. [default: 4]"
)
@click.option(
    "--whole",
    "full_length",
    is_flag=True,
    help="The whole actuator: whole windows and end margins, mirrored at mid length.",
)
@click.option("--pressure-MPa", type=Finite(), default=0.35, show_default=True, help="Last pressure.")
@click.option(
    "--steps", type=click.IntRange(1), default=10, show_default=True, help="Equal pressure steps with results."
)
@click.option(
    "--material", metavar="FILE|NAME", help="Layup: a file, or one that is shipped. [default: from-FEM-angles]"
)
@click.option(
    "--elements",
    type=click.Choice(["sheets", "shell", "solid"]),
    help="A shell for each layer on shared nodes (S8R), shells of laminates (S8R; S4R in Abaqus), or solids layer upon layer "
    "(C3D20R). [default: sheets in CalculiX, shell in Abaqus]",
)
@click.option("--around-mm", type=Finite("MM"), default=1.7, show_default=True, help="Largest element side, around.")
@click.option(
    "--along-mm", type=Finite("MM"), default=0.75, show_default=True, help="Largest element side, along the axis."
)
@click.option(
    "--edge-mm",
    type=Finite("MM"),
    help="Element length beside the borders of windows. [default: 0.2, or --along-mm if that is less]",
)
@click.option(
    "--bulk-over-shear",
    type=Finite(),
    default=2000.0,
    show_default=True,
    help="Bulk over shear modulus of the film in CalculiX; 200 is quicker and bends about 1 % more.",
)
@click.option("--out", type=click.Path(path_type=Path), help="Deck to write. [default: DESIGN_ENGINE.inp]")
@click.option("--overwrite", is_flag=True, help="Replace an existing deck.")
@click.option("--run", "run_it", is_flag=True, help="Also run it in CalculiX (ccx) and print the angle of every cell.")
@click.option("--json", "as_json", is_flag=True, help="One JSON document on standard output.")
def export(
    design: ShellDesign,
    engine: str,
    cells: int | None,
    full_length: bool,
    material: str | None,
    out: Path | None,
    overwrite: bool,
    run_it: bool,
    as_json: bool,
    **options: Any,
) -> None:
    """Write a deck of DESIGN, a design file (YAML) or a name such as tw3_slw10, so that benchlab can be checked in another
    engine: half a tube with follower pressure, or a fluid cavity in Abaqus, and a stiff end cap.

    The deck's first lines say design, materials, what is approximated, and how to read the angle of each cell.

    \b
    Examples:
      benchlab export tw3_slw10 --engine calculix --out tw3_slw10.inp
      benchlab export shell.yaml --engine abaqus --whole --material tpu.yaml
    """
    import json

    from benchlab.io.layup_file import DEFAULT_LAYUP
    from benchlab.workflows.calculix_run import run_and_read
    from benchlab.workflows.export import ExportSettings
    from benchlab.workflows.export import export as write

    if full_length and cells is not None:
        raise UsageError("--cells and --whole are both given", hint="give one of them")
    options["pressure_MPa"] = options.pop("pressure_mpa")
    if options["edge_mm"] is None:
        options["edge_mm"] = 0.2 if options["along_mm"] > 0.2 else None
    settings = ExportSettings(engine=engine, cells=None if full_length else cells or 4, **options)
    found = write(design, material or DEFAULT_LAYUP, settings, out or Path(f"{design.name}_{engine}.inp"), overwrite)
    click.echo(
        f"{found['cells']} cells, {found['element_count']} elements, {found['node_count']} nodes, "
        f"{len(found['pressures_MPa'])} pressures; wrote {printable(found['deck'])}",
        err=True,
    )
    if run_it:
        found["run"] = run_and_read(design, material or DEFAULT_LAYUP, settings)
        _tell_run(found["run"])
    if as_json:
        click.echo(json.dumps(found, indent=2, allow_nan=False))


def _tell_run(run: dict[str, Any]) -> None:
    """A line a pressure: the angle of an actuator of which every cell bends like this one, from the mirror plane to the cap."""
    click.echo(f"angles of every cell times the cells of the actuator, in {run['seconds']:.0f} s:", err=True)
    for pressure, angles in zip(run["pressure_MPa"], run["angle_deg"]):
        click.echo(f"  {pressure:.4g} MPa: {', '.join(f'{angle:.2f}' for angle in angles)} deg", err=True)
