"""`benchlab report STUDY`: how well designs repeat and whether they differ, as a page."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import click

from benchlab.cli.options import Finite
from benchlab.errors import BatchError, InputError, printable


@click.command(short_help="Study file to repeatability report: page, tables, figures.")
@click.argument("study", type=click.Path(path_type=Path))
@click.option(
    "--out", type=click.Path(path_type=Path), required=True, help="Folder for the report and the analysed recordings."
)
@click.option(
    "--jobs",
    type=click.IntRange(1),
    default=1,
    show_default=True,
    help="Recordings at once. One already uses all cores to decode.",
)
@click.option("--pdf", is_flag=True, help="Also write report.pdf (needs the extra: pip install 'benchlab[pdf]').")
@click.option("--confidence", type=Finite(), default=0.95, show_default=True, help="Of all intervals, 0.5 to 0.9999.")
@click.option(
    "--difference-deg",
    type=Finite("DEG"),
    help="Smallest difference that matters: also gives power, and how many samples would see it.",
)
@click.option("--overwrite", is_flag=True, help="Analyse everything again, and replace files that are not benchlab's.")
@click.option("--strict", is_flag=True, help="Exit with 3 if there is any warning.")
@click.option("--json", "as_json", is_flag=True, help="One JSON document on standard output.")
def report(study: Path, out: Path, strict: bool, as_json: bool, **options: Any) -> int:
    """Analyse the recordings of STUDY (a study file, or a folder with study.yaml), compare its designs, and write the report.

    Only recordings that have changed are analysed again. One that fails is listed in the report and does not stop the rest: exit 4.

    \b
    Writes into --out:
      report.html   the page: verdict, designs, figures, tests; one file, opens without network, prints
      report.json   all its numbers
      tables/       every table as CSV; values.csv has the angle of every cycle of every sample
      figures/      every figure as SVG and PNG
      recordings/   what benchlab analyze writes, for each recording

    \b
    Examples:
      benchlab report sample_data --out results
      benchlab report study.yaml --out results --jobs 2 --pdf --difference-deg 5
    """
    from benchlab.cli.progress import progress
    from benchlab.workflows.report import report as run

    with progress("recordings") as told:
        try:
            found = run(study, out, progress=told, **options)
        except KeyboardInterrupt:
            click.echo("benchlab: recordings that are done are kept and not analysed again", err=True)
            raise
    _tell(found)
    if as_json:
        click.echo(json.dumps(found, indent=2, allow_nan=False))
    if found["failures"]:
        click.echo(f"benchlab: {len(found['failures'])} without a value (above); the report has the rest", err=True)
        return BatchError.exit_code
    if strict and found["warnings"]:
        click.echo("benchlab: there are warnings, and --strict was given", err=True)
        return InputError.exit_code
    return 0


def _tell(found: dict[str, Any]) -> None:
    """The verdict, what is doubtful, and where everything is, on standard error."""
    for line in found["verdict"]:
        click.echo(printable(line), err=True)
    for kind, rows in (("failed", found["failures"]), ("left out", found["left_out"])):
        for row in rows:
            click.echo(f"  {kind}: {printable(row['what'])}: {printable(row['why'])}", err=True)
    for row in found["warnings"]:
        click.echo(f"  warning: {printable(row['what'])}: {printable(row['why'])}", err=True)
    paths = found["outputs"]
    for path in (path for path in paths if path.endswith((".html", ".pdf"))):
        click.echo(f"  wrote {printable(path)}", err=True)
    tables, figures = (sum(path.endswith(suffix) for path in paths) for suffix in (".csv", ".svg"))
    click.echo(f"  wrote beside it: report.json, {tables} tables (CSV), {figures} figures (SVG and PNG)", err=True)
