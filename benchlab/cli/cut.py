"""`benchlab cut`."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import click

from benchlab.actuator import ShellDesign
from benchlab.cli.design_options import Design
from benchlab.cli.options import Finite
from benchlab.errors import printable

NUMBER = Finite("MM")


@click.command(short_help="Drawing of a shell's fabric, film and strip for a laser cutter.")
@click.argument("design", type=Design())
@click.option(
    "--out",
    type=click.Path(path_type=Path),
    default=Path("shell.dxf"),
    show_default=True,
    help="Drawing to write; .dxf or .svg says which format.",
)
@click.option(
    "--sheet",
    type=click.Choice(["all", "fabric", "film"]),
    default="all",
    show_default=True,
    help="What to draw: all parts, or what is cut from one material: fabric (windowed layer and strip), or film.",
)
@click.option(
    "--weld-mm",
    type=NUMBER,
    help="How far fabric and film reach under the strip on either side. [default: half of slw, so that their edges "
    "meet under its middle]",
)
@click.option(
    "--cap-mm", type=NUMBER, default=0.0, show_default=True, help="Length beyond al at either end, for the caps."
)
@click.option(
    "--hole-mm",
    type=NUMBER,
    default=2.0,
    show_default=True,
    help="Diameter of the alignment holes, on tabs that are trimmed off; 0 for neither holes nor tabs.",
)
@click.option(
    "--kerf-mm",
    type=NUMBER,
    default=0.0,
    show_default=True,
    help="Width of the beam: outer contours are drawn half of it larger, windows and holes smaller.",
)
@click.option(
    "--corner-radius-mm",
    type=NUMBER,
    default=0.0,
    show_default=True,
    help="Of the windows. Sharp corners are what is simulated; 0.5 spares the fabric a stress raiser, for 0.2 % of "
    "the area of a 3 x 30 mm window.",
)
@click.option("--overwrite", is_flag=True, help="Replace an existing drawing.")
@click.option("--json", "as_json", is_flag=True, help="One JSON document on standard output.")
def cut(design: ShellDesign, out: Path, sheet: str, overwrite: bool, as_json: bool, **lengths_mm: Any) -> None:
    """Draw what is cut for a shell of DESIGN, a design file (YAML) or a name such as tw3_slw10: the fabric with its windows,
    the TPU film, and the strip that closes the tube; in mm, at true size.

    Whole windows are drawn (Eq 7 rounded down), and what is left over is shared by both ends. The tabs carry four alignment
    holes, for pins through film, fabric and strip alike; they are trimmed off along the engraved line after welding.

    \b
    Layers, in the order of cutting:
      ENGRAVE     blue      names and trim lines, not cut
      HOLES       orange    alignment holes
      FABRIC_CUT  red       windows, then the contour
      FILM_CUT    green
      STRIP_CUT   magenta

    \b
    Examples:
      benchlab cut tw3_slw10 --out shell.dxf --kerf-mm 0.15
      benchlab cut shell.yaml --out fabric.svg --sheet fabric --cap-mm 15 --corner-radius-mm 0.5
    """
    import json

    from benchlab.cutting.settings import CutSettings
    from benchlab.workflows.cut import cut as draw

    found = draw(design, CutSettings(**lengths_mm), out, sheet, overwrite)
    click.echo(
        f"{found['windows']} windows (Eq 7: {found['windows_eq7']:.2f}), {found['end_margin_mm']:.2f} mm left over at "
        f"either end, {found['window_area_mm2']:.0f} mm2 of TPU window; wrote {printable(out)}",
        err=True,
    )
    if as_json:
        click.echo(json.dumps(found, indent=2, allow_nan=False))
