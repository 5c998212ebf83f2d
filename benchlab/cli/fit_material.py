"""`benchlab fit-material`."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import click

from benchlab.cli.options import Finite
from benchlab.errors import printable

LAWS = ("all", "neo-hooke", "mooney-rivlin", "yeoh", "polynomial-2", "ogden-1", "ogden-2", "ogden-3")


@click.command("fit-material", short_help="Material file from tensile tests.")
@click.argument("tests", metavar="TENSILE.csv...", nargs=-1, required=True, type=click.Path(path_type=Path))
@click.option(
    "--thickness-mm",
    type=Finite("MM"),
    help="Of the specimen; also of the film in the material file, unless --film-thickness-mm says otherwise.",
)
@click.option("--film-thickness-mm", type=Finite("MM"), help="Of the film in the shell, written to the material file.")
@click.option(
    "--width-mm", type=Finite("MM"), help="Of the specimen. With the thickness, forces are used, not stresses."
)
@click.option("--gauge-mm", type=Finite("MM"), help="Length that extends. With it, extensions are used, not strains.")
@click.option(
    "--columns", metavar="NAMES", help="What the columns are, as `force_N,extension_mm`; `-` for one not used."
)
@click.option("--decimal", type=click.Choice([".", ","]), help="Sign of decimals, where the file leaves it open.")
@click.option("--encoding", metavar="NAME", help="Of the files, where they leave it open, as `cp1250`.")
@click.option(
    "--stress",
    type=click.Choice(["nominal", "true"]),
    default="nominal",
    show_default=True,
    help="What a stress in the file is: force over first cross-section, or over the present one.",
)
@click.option("--law", type=click.Choice(LAWS), default="all", show_default=True, help="Fit and write this law only.")
@click.option("--max-stretch", type=Finite(), help="Fit up to this stretch, the largest that the simulation needs.")
@click.option("--keep-slack", is_flag=True, help="Leave slack at the start of the test as it is.")
@click.option(
    "--out", type=click.Path(path_type=Path), help="Material file to write. [default: TENSILE.yaml beside the first]"
)
@click.option("--overwrite", is_flag=True, help="Replace existing files.")
@click.option("--json", "as_json", is_flag=True, help="One JSON document on standard output.")
def fit_material(
    tests: tuple[Path, ...], out: Path | None, overwrite: bool, as_json: bool, stress: str, law: str, **options: Any
) -> None:
    """Fit hyperelastic laws to uniaxial tensile tests of one material, a file a specimen, and write the best as a material file
    for `benchlab simulate --material`, with a picture of all laws beside it.

    Reads Instron exports (any language, decimal commas, N to kN, lbf, kgf) and tables with units in their header: stretch,
    strain or extension against stress or force. Only the first loading is used, up to the break; slack is taken out.

    Written is the law with the lowest AICc of those that are stable (Drucker) over the test and, in biaxial tension, within twice
    what a law of I1 alone would say. That is a guide, not a proof: a uniaxial test barely separates some coefficients, and the
    intervals and warnings say which.

    \b
    Examples:
      benchlab fit-material Specimen_RawData_*.csv --thickness-mm 0.3 --width-mm 10 --gauge-mm 50
      benchlab fit-material treloar.csv --columns stretch,stress_MPa --max-stretch 3 --law yeoh --out rubber.yaml
    """
    from benchlab.io.tensile import SpecimenSize
    from benchlab.workflows.fit_material import FitSettings
    from benchlab.workflows.fit_material import fit_material as fit

    size = SpecimenSize(options["thickness_mm"], options["width_mm"], options["gauge_mm"])
    settings = FitSettings(
        size,
        law,
        options["columns"],
        stress == "true",
        options["keep_slack"],
        options["max_stretch"],
        options["film_thickness_mm"],
        options["decimal"],
        options["encoding"],
    )
    found = fit(tests, out, settings, overwrite)
    _tell(found)
    if as_json:
        click.echo(json.dumps(found, indent=2, allow_nan=False))


def _tell(found: dict[str, Any]) -> None:
    """The tests, a table of laws, warnings and files on standard error."""
    from rich.console import Console
    from rich.table import Table
    from rich.text import Text

    for test in found["tests"]:
        low, high = test["stretch"]
        click.echo(f"{printable(test['file'])}: {test['points']} points, stretches {low:.4g} to {high:.4g}", err=True)
        for note in test["notes"]:
            click.echo(f"  {printable(note)}", err=True)
    table = Table(
        "law", "coefficients (95 % interval)", "R²", "RMSE, MPa", "AICc", "stable", "biaxial", box=None, pad_edge=False
    )
    for law in found["laws"]:
        values = "\n".join(
            f"{c['name']} {c['value']:.4g} ({c['low']:.3g} to {c['high']:.3g})" for c in law["coefficients"]
        )
        aicc = "-" if law["aicc"] is None else f"{law['aicc']:.1f}"
        stable = "yes" if law["stable_over_data"] else "NO"
        biaxial = "-" if law["biaxial_factor"] is None else f"x {law['biaxial_factor']:.3g}"
        row = [law["law"], values, f"{law['r_squared']:.5f}", f"{law['rmse_MPa']:.3g}", aicc, stable, biaxial]
        table.add_row(*map(Text, row), style="bold" if law["law"] == found["law"] else None)
    console = Console(stderr=True, highlight=False)
    if not console.is_terminal:
        console.width = 120
    console.print(table)
    click.echo("stable: by Drucker over the test; biaxial: stress against that of a law of I1 alone", err=True)
    click.echo(f"{found['law']} is written; its AICc is only a guide", err=True)
    for warning in found["warnings"]:
        click.echo(f"  warning: {printable(warning)}", err=True)
    for path in found["outputs"]:
        click.echo(f"  wrote {printable(path)}", err=True)
