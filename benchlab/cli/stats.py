"""`benchlab stats`."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import click

from benchlab.cli.options import Finite
from benchlab.errors import printable


@click.command(short_help="Do groups differ: ANOVA, pairs, repeatability, power.")
@click.argument("table", metavar="TABLE.csv", type=click.Path(path_type=Path))
@click.option("--value", metavar="COLUMN", help="Column with the measured values.")
@click.option(
    "--group",
    metavar="COLUMN",
    multiple=True,
    required=True,
    help="Column that names the group; twice for groups by two.",
)
@click.option(
    "--sample", metavar="COLUMN", help="Column that names the sample of a row; rows of one sample are its cycles."
)
@click.option("--rows-are-samples", is_flag=True, help="Each row is a sample, though another column looks as if not.")
@click.option("--mean", metavar="COLUMN", help="Means, of a table with a row a group.")
@click.option("--sd", metavar="COLUMN", help="Standard deviations (n − 1), of such a table.")
@click.option("--n", metavar="COLUMN", help="Numbers of samples, of such a table.")
@click.option("--confidence", type=Finite(), default=0.95, show_default=True, help="Of all intervals.")
@click.option(
    "--difference", type=Finite("D"), help="Smallest difference that matters: its power, and the samples it takes."
)
@click.option(
    "--leave-out-missing", is_flag=True, help="Leave out rows without a number (empty, NaN, inf), and say which."
)
@click.option("--out", type=click.Path(path_type=Path), help="Folder for the numbers, tables and figures.")
@click.option("--overwrite", is_flag=True, help="Replace existing files.")
@click.option("--strict", is_flag=True, help="Exit with 3 if there is any warning.")
@click.option("--json", "as_json", is_flag=True, help="One JSON document on standard output.")
def stats(table: Path, strict: bool, as_json: bool, **options: Any) -> int:
    """Compare groups of samples in a table: does any differ, which pairs, by how much, and how well do samples repeat?

    Always given, side by side: one-way ANOVA and Tukey's HSD, which take one scatter for all groups, and Welch's ANOVA and
    Games–Howell, which do not. With them come effect sizes with intervals, what the tests assume, where the scatter comes from,
    repeatability after ISO 5725 and ASTM E691, and power. No test is chosen by another test.

    A sample with several rows (cycles) counts once, with their mean. Ten cycles taken for ten samples find a difference where there
    is none nine times in ten: a table that looks so is refused until --sample says what tells samples.

    Values are read as decimals and centred before they are rounded, so that no digit is lost.

    \b
    With --out, the folder gets
      comparison.json                     all numbers
      groups.csv, tests.csv, pairs.csv, components.csv, consistency.csv, power.csv
      bars.svg/.png, intervals.svg/.png   means with brackets, differences with intervals

    \b
    Examples:
      benchlab stats angles.csv --value angle_deg --group design
      benchlab stats cycles.csv --value angle_deg --group design --sample sample --difference 5 --out results/compare
      benchlab stats grid.csv --value force_N --group tw_mm --group slw_mm --json
      benchlab stats table1.csv --group design --mean mean_deg --sd sd_deg --n samples
    """
    import json

    from benchlab.workflows.stats import StatsColumns
    from benchlab.workflows.stats import stats as run

    names = ("value", "sample", "mean", "sd", "n", "rows_are_samples")
    columns = StatsColumns(options["group"], **{name: options[name] for name in names})
    found = run(
        table, columns, options["confidence"], options["difference"], options["leave_out_missing"], options["out"], options["overwrite"]
    )  # fmt: skip
    if as_json:
        click.echo(json.dumps(found.document, indent=2, allow_nan=False))
    else:
        from benchlab.cli.stats_report import print_report

        print_report(found)
    for warning in found.document["warnings"]:
        click.echo(f"  warning: {printable(warning)}", err=True)
    for path in found.document["outputs"]:
        click.echo(f"  wrote {printable(path)}", err=True)
    if strict and found.document["warnings"]:
        click.echo("benchlab: there are warnings, and --strict was given", err=True)
        return 3
    return 0
