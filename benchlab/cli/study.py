"""`benchlab study`."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import click

from benchlab.cli.options import Finite
from benchlab.errors import BatchError, counted, printable

MOST_LINES = 20
"""Files that are not in the study and are listed on the terminal."""

FROM = {"option": "", "ramp": ", the largest of --ramp", "default": ", which is the default (--pressure-MPa)"}
"""What told the pressure of comparison, in words."""

MARKS = {"found": "", "missing": "!", "left out": "-"}
WORDS = {"missing": "missing", "left_out": "left out", "notes": "note"}


@click.group(short_help="Study files: designs, samples and their recordings.")
def study() -> None:
    """A study file names designs, the samples made of each, and the recordings of each sample: what `benchlab report` compares.

    `new` makes one from the file names of a folder, `check` lists what is missing. docs/studies.md explains every key.
    """


@study.command(short_help="Study file from the file names of a folder.")
@click.argument("folder", type=click.Path(path_type=Path))
@click.option(
    "--pattern",
    metavar="PATTERN",
    help="How recordings are named, as '{design}_s{sample}'. [default: the first common one that fits more than half of them]",
)
@click.option("--out", type=click.Path(path_type=Path), help="Study file to write. [default: study.yaml in FOLDER]")
@click.option("--title", help="Of the study. [default: the name of FOLDER]")
@click.option(
    "--pressure-MPa",
    type=Finite("MPA"),
    help="Pressure at which designs are compared. [default: the largest of --ramp, else 0.35]",
)
@click.option(
    "--ramp", metavar="START:END:SECONDS", help="Pressure of all recordings: a linear ramp, in MPa, as 0:0.35:2.5."
)
@click.option(
    "--pressure", type=click.Path(path_type=Path), help="Pressure of all recordings: one log for all of them."
)
@click.option("--overwrite", is_flag=True, help="Replace an existing study file.")
@click.option("--json", "as_json", is_flag=True, help="One JSON document on standard output.")
def new(folder: Path, out: Path | None, overwrite: bool, as_json: bool, **options: Any) -> None:
    """Make a study file from the recordings in FOLDER and the folders in it: videos, folders of stills, run files of
    `benchlab analyze`, and tables with a column angle_deg. The file is short and made to be edited.

    A pattern stands for a name without its suffix. {design} is any text, {sample} and {cycle} a number, a letter, or one with the
    other behind it, and {anything} is passed over; with a / in it, it covers the last folders too. Recordings of the same
    design and sample are cycles of one sample.

    Designs named as tw3_slw10 get these dimensions, and sets are proposed in which one dimension varies. A table named
    {design}_a{sample}, or lying in a folder `force`, is taken for a force export, and files of `benchlab sweep` and `simulate` for
    what the designs should do. What was not taken stands, with the reason, on standard error and at the end of the file.

    \b
    Examples:
      benchlab study new sample_data --ramp 0:0.35:2.5 --out my_study.yaml
      benchlab study new bench --pattern '{anything}/{design}-{sample}_run{cycle}' --pressure bench/log.csv --pressure-MPa 0.2
    """
    from benchlab.workflows.study_new import NewStudy, new_study

    wish = NewStudy(options["pattern"], options["title"], options["pressure_mpa"], options["ramp"], options["pressure"])
    found = new_study(folder, out, wish, overwrite)
    _tell_new(found, options["pattern"] is None)
    if as_json:
        click.echo(json.dumps(found, indent=2, allow_nan=False))


def _tell_new(found: dict[str, Any], chosen: bool) -> None:
    how = " (the first common one that fits most)" if chosen else ""
    click.echo(f"{found['recordings']} recordings named {printable(found['pattern'])}{how}", err=True)
    for design in found["designs"]:
        shell = design["shell"]
        size = (
            f"tw {shell['window_width_mm']:g}, slw {shell['strip_width_mm']:g} mm from its name"
            if shell
            else "no dimensions"
        )
        more = [counted(len(design["samples"]), "sample"), size]
        more += [counted(len(design["force"]), "force file")] if design["force"] else []
        more += [f"simulated in {printable(design['simulated'])}"] if design["simulated"] else []
        click.echo(f"  {printable(design['name'])}: {', '.join(more)}", err=True)
        for sample, files in design["samples"].items():
            if len(files) > 1:
                click.echo(
                    f"    {printable(sample)} has {len(files)} recordings: {', '.join(map(printable, files))}", err=True
                )
    for each in found["sets"]:
        click.echo(
            f"  proposed set {each['name']} ({each['title']}): {', '.join(map(printable, each['designs']))}", err=True
        )
    for each in found["unused"][:MOST_LINES]:
        click.echo(f"  not in it: {printable(each['file'])}: {printable(each['why'])}", err=True)
    if len(found["unused"]) > MOST_LINES:
        click.echo(f"  and {len(found['unused']) - MOST_LINES} more not in it, at the end of the file", err=True)
    if not found["pressure_known"]:
        click.echo("  the pressure is not known: give it in the file, or with --ramp or --pressure", err=True)
    click.echo(f"  compared at {found['pressure_MPa']:g} MPa{FROM[found['pressure_MPa_from']]}", err=True)
    click.echo(f"  wrote {printable(found['study'])}; `benchlab study check` lists what is missing", err=True)


@study.command(short_help="What a study file has, and what is missing.")
@click.argument("file", metavar="STUDY", type=click.Path(path_type=Path))
@click.option("--json", "as_json", is_flag=True, help="One JSON document on standard output.")
def check(file: Path, as_json: bool) -> int:
    """List what a study has and what it lacks, without analysing anything: recordings and force files that are missing or cannot be
    opened, unknown pressures, copies, designs with fewer than two samples, simulations that do not fit. STUDY is the file, or a
    folder with `study.yaml` in it.

    The exit code is 0 when all is there, 4 when something is missing, and 3 when the file itself is wrong.

    \b
    Example:
      benchlab study check sample_data/study.yaml
    """
    from benchlab.workflows.study_check import check_study

    found = check_study(file)
    _tell_check(found)
    if as_json:
        click.echo(json.dumps(found, indent=2, allow_nan=False))
    return BatchError.exit_code if found["missing"] else 0


def _tell_check(found: dict[str, Any]) -> None:
    """A row a design, then what is missing, what was left out, and what else there is to say."""
    from rich.console import Console
    from rich.table import Table
    from rich.text import Text

    table = Table("design", "tw × slw, mm", "n", "samples", "simulated", "force", box=None, pad_edge=False)
    for design in found["designs"]:
        shell = design["shell"]
        row = [
            printable(design["name"]),
            f"{shell['window_width_mm']:g} × {shell['strip_width_mm']:g}" if shell else "-",
            str(design["n"]),
            " ".join(f"{printable(sample['name'])}{MARKS[sample['state']]}" for sample in design["samples"]),
            {"found": "yes", "missing": "NO", "none": "-"}[design["simulated"]],
            f"{sum(f['state'] == 'found' for f in design['force'])} of {len(design['force'])}"
            if design["force"]
            else "-",
        ]
        table.add_row(*map(Text, row))
    console = Console(stderr=True, highlight=False)
    if not console.is_terminal:
        console.width = 120
    console.print(Text(printable(found["title"]), style="bold"))
    console.print(table)
    if any(sample["state"] != "found" for design in found["designs"] for sample in design["samples"]):
        click.echo("n: samples that count; ! lacks something, - left out", err=True)
    for each in found["sets"]:
        click.echo(f"set {printable(each['name'])}: {', '.join(map(printable, each['designs']))}", err=True)
    for word in ("missing", "left_out", "notes"):
        for each in found[word]:
            about = f"{printable(each['what'])}: " if each["what"] else ""
            click.echo(f"  {WORDS[word]}: {about}{printable(each['why'])}", err=True)
    if found["missing"]:
        count = len(found["missing"])
        click.echo(f"benchlab: {count} {'thing is' if count == 1 else 'things are'} missing (above)", err=True)
    else:
        click.echo(f"complete: {_reached(found)}", err=True)


def _reached(found: dict[str, Any]) -> str:
    """Which recordings are known to reach the pressure of the study: not those that tell none."""
    states = [
        recording
        for design in found["designs"]
        for sample in design["samples"]
        for recording in sample["recordings"]
        if recording["state"] == "found"
    ]
    telling = sum(not recording["without_pressure"] for recording in states)
    if not telling:
        return "nothing is missing"
    which = "all recordings reach" if telling == len(states) else "all other recordings reach"
    return f"{which} {found['pressure_MPa']:g} MPa as far as is told"
