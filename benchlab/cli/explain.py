"""`benchlab explain`."""

from __future__ import annotations

import json
import os
from pathlib import Path
from typing import Any

import click

from benchlab.cli.bench_options import BENCHES, calibration_option
from benchlab.cli.options import Finite
from benchlab.cli.progress import stages
from benchlab.errors import InputError, UsageError, counted, printable

FILE = click.Path(path_type=Path)
OF_LOOP = {
    "bench": None,
    "calibration": None,
    "twin": None,
    "samples": None,
    "rounds": None,
    "minutes": None,
    "film": False,
}
"""Options that only --loop takes, with what stands there where they are not given."""


@click.command(short_help="Where simulation and measurement disagree, and what is missing.")
@click.argument("measured", nargs=-1, type=FILE, metavar="MEASURED...")
@click.option(
    "--simulation",
    type=FILE,
    metavar="FILE",
    help="Simulated curves of any engine: design, pressure_MPa, angle_deg or blocked_force_N or both[, volume_mL].",
)
@click.option(
    "--model",
    metavar="FILE|beam",
    help="In place of the shell cell: a model file of an earlier round, whose effects are kept; or the one-dimensional beam.",
)
@click.option(
    "--designs",
    type=FILE,
    metavar="FILE",
    help="design, tw_mm, slw_mm[, fw_mm, length_mm, perimeter_mm]; or a study. Names as tw3_slw10 say it.",
)
@click.option(
    "--columns",
    metavar="NAME=COLUMN,...",
    help="What the table calls our columns: angle_deg=Theta6,pressure_kPa=2 (or by place).",
)
@click.option("--simulation-columns", metavar="NAME=COLUMN,...", help="The same, of the simulated table.")
@click.option(
    "--against",
    multiple=True,
    metavar="COLUMN",
    help="A further column that may matter. Without a pressure the first takes its place.",
)
@click.option(
    "--pattern", metavar="TEXT", help="How run files are named. [default: by a common pattern, as {design}_s{sample}]"
)
@click.option(
    "--material",
    metavar="FILE|NAME",
    help="Layup of cell and beam: a file, or a shipped one. [default: from-measured-angles]",
)
@click.option(
    "--out", type=FILE, help="Folder for report, tables, figures, model and protocol. Without it, nothing is written."
)
@click.option("--jobs", type=click.IntRange(1), help="Designs at once, one core each. [default: all cores]")
@click.option(
    "--seed", type=int, default=1, show_default=True, help="Of the bootstrap; in a loop also of the twin's samples."
)
@click.option(
    "--no-cache",
    is_flag=True,
    help="Simulate anew, and keep nothing. [default: curves are kept, BENCHLAB_CACHE says where]",
)
@click.option("--overwrite", is_flag=True, help="Replace files that are not benchlab's.")
@click.option("--strict", is_flag=True, help="Exit with 3 if there is any warning.")
@click.option(
    "--loop",
    is_flag=True,
    help="Measure too: run a protocol, explain, run the one that is proposed, until there is an answer.",
)
@click.option(
    "--bench",
    metavar="BENCH",
    help=f"Of --loop: {BENCHES}. A twin is simulated, and what it writes says so.  [default: twin]",
)
@calibration_option
@click.option(
    "--twin", type=FILE, metavar="FILE", help="Of --loop: a twin file, whose effects are hidden in all samples."
)
@click.option("--samples", type=click.IntRange(1), help="Of --loop: samples of each design.  [default: 5]")
@click.option("--rounds", type=click.IntRange(1), help="Of --loop: rounds at most.  [default: 4]")
@click.option("--minutes", type=Finite("MIN"), help="Of --loop: no round begins later.  [default: 60]")
@click.option("--film", is_flag=True, help="Of --loop with a twin: draw each run as a film and analyse it.")
@click.option("--json", "as_json", is_flag=True, help="One JSON document on standard output.")
def explain(measured: tuple[Path, ...], loop: bool, strict: bool, as_json: bool, **options: Any) -> int:
    """Find where simulation and MEASURED disagree, name what the simulation lacks, add it, and show the gap shrink.

    MEASURED is a study, run files, or tables with a row a reading: design, sample, run, cycle, time_s, pressure_MPa and any of angle_deg,
    force_N, volume_mL, flex_V; also command_MPa, run_index, start_s, orientation_deg, temperature_C; other units by their names. A
    table of means (design, pressure_MPa, mean, sd, n) is taken too, and says less.

    \b
    The verdict is one of
      agree         they differ by no more than the samples do among themselves
      named         one explanation is left
      ambiguous     several are left that these data cannot tell apart; the next experiment does, where one can
      unexplained   they differ, and no effect of the vocabulary (docs/effects.md) explains it
    A name is given only where chance would give one in fewer than 5 of 100 studies without a gap.

    \b
    Writes into --out, all or nothing:
      report.html   the story: where, what, rivals, gap before and after, held-out data, what is left, what to do next
      explain.png   the verdict, the map of the gap and the largest gaps before and after, in one picture
      explain.json  all of it as numbers, as --json prints it
      model.yaml    where something was found: the simulation with it, for `benchlab simulate --model`, `sweep`, `run`, `explain --model`
      next_*.yaml   the protocol to run next, for `benchlab run`
      tables/, figures/

    \b
    Examples:
      benchlab explain loops.csv --designs designs.csv --out explained
      benchlab explain more.csv --designs designs.csv --model explained/model.yaml --out again
      benchlab explain means.csv --simulation fem.csv --json
      benchlab explain --loop --bench twin --twin twin.yaml --designs designs.csv --samples 4 --out loop
    """
    from benchlab.report.explain.words import told

    given = [name for name, absent in OF_LOOP.items() if options[name] != absent]
    if given and not loop:
        raise UsageError(f"--{given[0]} is given without --loop", hint="add --loop, or leave it out")
    with stages() as tell:
        found = _around(measured, options, tell) if loop else _once(measured, options, tell)
    click.echo("\n".join(told(found.explanation)), err=True)
    if loop:
        click.echo("\n".join(map(printable, _loop_lines(found.answer["loop"]))), err=True)
    _tell_files(found.answer.get("outputs", []))
    if as_json:
        click.echo(json.dumps(found.answer, indent=2, allow_nan=False))
    if strict and found.answer["warnings"]:
        click.echo("benchlab: there are warnings, and --strict was given", err=True)
        return InputError.exit_code
    return 0


def _settings(options: dict[str, Any]) -> Any:
    from benchlab.io.measured_columns import columns_of
    from benchlab.workflows.explain import ExplainSettings
    from benchlab.workflows.explain_cache import default_cache
    from benchlab.workflows.explain_chosen import Choice

    columns, theirs = (
        columns_of(options[name]) if options[name] else None for name in ("columns", "simulation_columns")
    )
    choice = Choice(
        simulation=options["simulation"],
        model=options["model"],
        designs=options["designs"],
        material=options["material"],
        jobs=options["jobs"] or os.cpu_count() or 1,
        cache=None if options["no_cache"] else default_cache(),
        columns=columns,
        simulation_columns=theirs,
    )
    rest = {name: options[name] for name in ("out", "against", "pattern", "seed", "overwrite")}
    return ExplainSettings(choice, **rest)


def _once(measured: tuple[Path, ...], options: dict[str, Any], tell: Any) -> Any:
    from benchlab.workflows.explain import explain as run

    if not measured:
        raise UsageError("nothing measured is given", hint="give tables, run files or a study; or --loop to measure")
    return run(measured, _settings(options), tell)


def _around(measured: tuple[Path, ...], options: dict[str, Any], tell: Any) -> Any:
    from benchlab.workflows.explain_around import AroundSettings, explain_around
    from benchlab.workflows.explain_loop import LoopSettings
    from benchlab.workflows.run_prepare import RunSettings

    if measured:
        raise UsageError("MEASURED is given beside --loop, which measures itself", hint="leave one of them out")
    if options["out"] is None:
        raise UsageError("--loop writes what it measures, and --out is missing", hint="give a folder")
    wanted = {name: options[name] for name in ("samples", "rounds", "minutes") if options[name] is not None}
    settings = AroundSettings(
        _settings(options),
        LoopSettings(options["out"], **wanted),
        RunSettings(bench=options["bench"] or "twin", calibration=options["calibration"], seed=options["seed"]),
        options["film"],
        options["twin"],
    )
    return explain_around(settings, lambda line: click.prompt(line, default="", show_default=False, err=True), tell)


def _loop_lines(told: dict[str, Any]) -> list[str]:
    """What was run in each round and what came out, why there is no further round, and on what all of it was measured.

    >>> one = {"round": 1, "experiment": "one cycle", "verdict": "ambiguous", "effects": ["a"], "rivals": [["a"], ["b"]]}
    >>> two = {"round": 2, "experiment": "a step", "verdict": "named", "effects": ["a"], "rivals": []}
    >>> _loop_lines({"rounds": [one, two], "ended": "one explanation is left", "measured_on": "a twin"})[2:4]
    ['  round 1: one cycle: ambiguous, 2 explanations left', '  round 2: a step: named, a']
    """
    rounds = [
        f"  round {one['round']}: {one['experiment']}: {one['verdict']}"
        + (f", {counted(len(one['rivals']), 'explanation')} left" if one["rivals"] else "")
        + (f", {', '.join(one['effects'])}" if one["effects"] and not one["rivals"] else "")
        for one in told["rounds"]
    ]
    return ["", "Loop:", *rounds, f"  ended: {told['ended']}", f"  measured on: {told['measured_on']}"]


def _tell_files(paths: list[str]) -> None:
    """Where everything is, on standard error."""
    for path in (path for path in paths if path.endswith((".html", ".yaml"))):
        click.echo(f"  wrote {printable(path)}", err=True)
    if paths:
        tables, figures = (sum(path.endswith(suffix) for path in paths) for suffix in (".csv", ".svg"))
        click.echo(
            f"  wrote beside it: explain.png, explain.json, {tables} tables (CSV), {figures} figures (SVG and PNG)",
            err=True,
        )
