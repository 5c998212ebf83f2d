"""`benchlab calibrate`."""

from __future__ import annotations

from pathlib import Path

import click

from benchlab.cli.options import Finite


@click.group(short_help="Calibrate what the bench measures with.")
def calibrate() -> None:
    """Calibrate what the bench measures with."""


@calibrate.command(short_help="Lens file from pictures of a chessboard.")
@click.argument("pictures", nargs=-1, required=True, type=click.Path(path_type=Path))
@click.option("--square-mm", type=Finite(), required=True, help="Side of one square of the board.")
@click.option("--corners", default="9x6", show_default=True, metavar="COLUMNSxROWS", help="Inner corners of the board.")
@click.option(
    "--out", type=click.Path(path_type=Path), default=Path("lens.json"), show_default=True, help="Lens file to write."
)
@click.option("--overwrite", is_flag=True, help="Replace an existing lens file.")
@click.option("--json", "as_json", is_flag=True, help="One JSON document on standard output.")
def camera(
    pictures: tuple[Path, ...], square_mm: float, corners: str, out: Path, overwrite: bool, as_json: bool
) -> None:
    """Measure a camera's lens from PICTURES of a chessboard (files, folders or a video), held at many angles and filling the
    picture to its corners, with the zoom and focus used on the bench. `benchlab analyze --lens FILE` then removes its distortion.

    \b
    Example:
      benchlab calibrate camera board/*.jpg --square-mm 20 --corners 9x6 --out d3400_35mm.json
    """
    import json

    from benchlab.workflows.calibrate_camera import calibrate_camera

    found = calibrate_camera(pictures, square_mm, corners, out, overwrite)
    for warning in found["warnings"]:
        click.echo(f"warning: {warning}", err=True)
    click.echo(
        f"{found['pictures_used']} of {found['pictures']} pictures used, {found['rms_px']:.3f} px rms; wrote {out}",
        err=True,
    )
    if as_json:
        click.echo(json.dumps(found, indent=2))
