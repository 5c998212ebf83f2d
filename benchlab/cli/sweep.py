"""`benchlab sweep`."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import click

from benchlab.actuator import ShellDesign
from benchlab.cli.condition_options import condition_options, model_option
from benchlab.cli.options import Finite
from benchlab.cli.ranges import Values
from benchlab.errors import BatchError, printable


@click.command(short_help="Simulate all combinations of dimensions: angle, volume and force.")
@click.option("--tw-mm", type=Values(), default="3", show_default=True, help="Window widths, along the axis.")
@click.option("--slw-mm", type=Values(), default="10", show_default=True, help="Strip widths, around the tube.")
@click.option(
    "--fw-mm", type=Values(), default=f"{ShellDesign.rib_width_mm:g}", show_default=True, help="Fabric between windows."
)
@click.option(
    "--perimeter-mm", type=Values(), default=f"{ShellDesign.perimeter_mm:g}", show_default=True, help="Around the tube."
)
@click.option(
    "--length-mm", type=Values(), default=f"{ShellDesign.length_mm:g}", show_default=True, help="Actuator lengths al."
)
@click.option("--pressure-MPa", type=Values(), default="0:0.35:0.035", show_default=True, help="Pressures, in MPa.")
@click.option("--cap-mm", type=Finite("MM"), default=0.0, show_default=True, help="Rigid length at either end.")
@click.option(
    "--blocked/--no-blocked", default=True, help="Hold each design straight too, for its blocked force. [default: on]"
)
@model_option
@condition_options
@click.option("--overwrite", is_flag=True, help="Simulate all again, and replace files that are not benchlab's.")
def sweep(
    conditions: Any,
    model: Path | None,
    jobs: int,
    scheduler: str | None,
    out: Path,
    overwrite: bool,
    as_json: bool,
    **options: Any,
) -> int:
    """Simulate every combination of the dimensions given: START:END[:STEP] (step 1), a list as 1,5,10, or one value.

    \b
    Writes into --out (the name says what varies):
      sweep_tw3_slw1-30.csv   a row a design and pressure; a design that fails or bursts keeps its rows, with the reason
      sweep_tw3_slw1-30.h5    the same over all that varies, with settings (HDF5, NXdata)
      sweep_tw3_slw1-30.png   angle against what varies with the paper's points, volume against pressure and TPU area

    Ctrl-C keeps what is done, marked partial. The same command again goes on where it ended: designs with the same dimensions,
    pressures, material and simulation code are not simulated twice. A design that bursts is a result; one that cannot be made or
    simulated makes the exit code 4.

    --model takes the curves of a model file in place of those of the cell alone: at rest, loaded slowly for the first time.

    --scheduler sends the designs to the workers of a dask scheduler, which have 15 s to answer (extra `cluster`).

    \b
    Examples:
      benchlab sweep --slw-mm 1:30 --tw-mm 3 --out results --jobs 2
      benchlab sweep --tw-mm 1:15 --slw-mm 5,10,20 --pressure-MPa 0.1,0.2,0.35 --no-blocked
      benchlab sweep --slw-mm 1:30 --tw-mm 1:15 --scheduler tcp://192.168.1.5:8786
    """
    import json

    from benchlab.actuator import DIMENSIONS
    from benchlab.cli.progress import progress
    from benchlab.workflows.sweep import sweep as run

    axes = {name: options[name] for name in DIMENSIONS}
    with progress("designs", quiet=False) as report:
        try:
            found = run(
                axes,
                conditions(options["pressure_mpa"], options["cap_mm"], options["blocked"], model),
                out,
                jobs=jobs,
                scheduler=scheduler,
                overwrite=overwrite,
                progress=report,
            )
        except KeyboardInterrupt:
            click.echo("benchlab: what is done is kept, marked partial; the same command goes on from there", err=True)
            raise
    _tell(found)
    if as_json:
        click.echo(json.dumps(found, indent=2, allow_nan=False))
    return BatchError.exit_code if found["failed"] else 0


def _tell(found: dict[str, Any]) -> None:
    again = f", {found['reused']} of them by an earlier run" if found["reused"] else ""
    click.echo(
        f"{found['simulated']} of {found['designs']} designs simulated{again}; {found['seconds']:.1f} s", err=True
    )
    if best := found["largest_angle"]:
        click.echo(
            f"largest angle at {found['pressure_MPa'][-1]:g} MPa: {best['angle_deg']:.1f} deg at tw {best['tw_mm']:g}, "
            f"slw {best['slw_mm']:g} mm",
            err=True,
        )
    for one in found["bursting"][:5]:
        click.echo(
            f"  tw {one['tw_mm']:g}, slw {one['slw_mm']:g} mm bursts: no stable state beyond {one['limit_pressure_MPa']:.4g} MPa",
            err=True,
        )
    if len(found["bursting"]) > 5:
        click.echo(f"  and {len(found['bursting']) - 5} more burst", err=True)
    for error in found["failed"]:
        click.echo(f"  failed: {printable(error['what'])}", err=True)
    for path in found["outputs"]:
        click.echo(f"  wrote {printable(path)}", err=True)
