"""`benchlab design`."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import click

from benchlab.actuator import ShellDesign
from benchlab.cli.condition_options import condition_options
from benchlab.cli.options import Finite
from benchlab.cli.ranges import Span
from benchlab.errors import UsageError, printable


@click.command(short_help="Window and strip widths that bend to an angle, and what each costs.")
@click.option("--angle-deg", type=Finite("DEG"), required=True, help="Bending angle that is wanted.")
@click.option("--pressure-MPa", type=Finite("MPA"), default=0.3, show_default=True, help="At this pressure.")
@click.option("--force-N", type=Finite("N"), help="Least blocked force at that pressure, held straight in the fixture.")
@click.option(
    "--tw-mm", type=Span(), default="1:15", show_default=True, help="Window widths: START:END, a list, or one."
)
@click.option(
    "--slw-mm", type=Span(), default="1:30", show_default=True, help="Strip widths: START:END, a list, or one."
)
@click.option(
    "--fw-mm", type=Finite("MM"), default=ShellDesign.rib_width_mm, show_default=True, help="Fabric between windows."
)
@click.option(
    "--perimeter-mm", type=Finite("MM"), default=ShellDesign.perimeter_mm, show_default=True, help="Around the tube."
)
@click.option(
    "--length-mm", type=Finite("MM"), default=ShellDesign.length_mm, show_default=True, help="Actuator length al."
)
@click.option("--cap-mm", type=Finite("MM"), default=0.0, show_default=True, help="Rigid length at either end.")
@condition_options
@click.option("--overwrite", is_flag=True, help="Replace existing files.")
def design(
    angle_deg: float,
    force_n: float | None,
    tw_mm: Any,
    slw_mm: Any,
    conditions: Any,
    jobs: int,
    scheduler: str | None,
    out: Path,
    overwrite: bool,
    as_json: bool,
    **options: Any,
) -> None:
    """Find all pairs of window width tw and strip width slw with which the actuator bends to an angle, and compare them: volume,
    blocked force, strain of the film, and how far the angle moves when the laser is 0.1 mm off.

    Along lines of fixed tw, chosen so that whole windows fill the length (give --tw-mm as a list to choose them yourself), the
    angle is simulated at a few slw, and then where it passes the wanted one. Every design that is named was itself simulated, with
    its widths rounded to 0.01 mm.

    \b
    Writes into --out:
      design_90deg.csv                  all designs found, and what each is the best in
      design_90deg.png                  the angle over tw and slw, and the trade-offs
      design_90deg_balanced.yaml        the one that loses least in all four; for `benchlab simulate` and `cut`
      design_90deg_least_cut_error.yaml, ..._least_volume, ..._most_force, ..._least_film_strain

    \b
    Examples:
      benchlab design --angle-deg 90
      benchlab design --angle-deg 60 --pressure-MPa 0.2 --force-N 10 --lever-arm-mm 5 --out results
      benchlab design --angle-deg 45 --tw-mm 3 --slw-mm 10:30
    """
    import json

    from benchlab.cli.progress import progress
    from benchlab.workflows.design import design as find
    from benchlab.workflows.design_wish import Wish

    pressure = options["pressure_mpa"]
    if pressure <= 0:
        raise UsageError(f"--pressure-MPa is {pressure:g}", hint="give a pressure above 0")
    base = ShellDesign(10, 3, options["fw_mm"], options["perimeter_mm"], options["length_mm"])
    wish = Wish(angle_deg, force_n, tw_mm, slw_mm, base)
    with progress("simulations", quiet=False) as report:
        found = find(
            wish,
            conditions((pressure / 2, pressure), options["cap_mm"], True),
            out,
            jobs=jobs,
            scheduler=scheduler,
            overwrite=overwrite,
            progress=report,
        )
    _tell(found)
    if as_json:
        click.echo(json.dumps(found, indent=2, allow_nan=False))


def _tell(found: dict[str, Any]) -> None:
    from rich.console import Console
    from rich.table import Table
    from rich.text import Text

    from benchlab.workflows.design_outputs import PREFERENCES

    table = Table("tw, mm", "slw, mm", "angle, deg", "volume, mL", "force, N", "film strain", "deg/0.1 mm", "windows",
                  "best in", box=None, pad_edge=False)  # fmt: skip
    best = found["best"]
    names = {"balanced": "all together", **PREFERENCES}
    for index, row in enumerate(found["candidates"]):
        numbers = (row["volume_mL"], row["blocked_force_N"], row["peak_film_strain"], row["cut_error_deg"])
        cells = ["-" if v is None else f"{v:.3g}" for v in numbers]
        words = ", ".join(names[name] for name, chosen in best.items() if chosen == index)
        words = words if row["reaches_force"] else "force not reached"
        cells = [
            f"{row['tw_mm']:.2f}",
            f"{row['slw_mm']:.2f}",
            f"{row['angle_deg']:.2f}",
            *cells,
            str(row["whole_windows"]),
            words,
        ]
        table.add_row(*map(Text, cells), style="bold" if index == best["balanced"] else None)
    console = Console(stderr=True, highlight=False)
    if not console.is_terminal:
        console.width = 140
    console.print(table)
    click.echo(
        f"designs found: {len(found['candidates'])}, for {found['angle_deg']:g} deg at {found['pressure_MPa']:g} MPa (material "
        f"{printable(found['material'])}; force with {found['fixture']}); {found['seconds']:.1f} s",
        err=True,
    )
    for path in found["outputs"]:
        click.echo(f"  wrote {printable(path)}", err=True)
