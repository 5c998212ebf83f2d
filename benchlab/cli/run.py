"""`benchlab run`."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import click

from benchlab.cli.bench_options import bench_option, calibration_option
from benchlab.cli.design_options import Design
from benchlab.cli.options import Finite
from benchlab.cli.progress import progress
from benchlab.errors import counted, printable

BY_HAND = "close the supply and open the relief valve by hand"


@click.command(short_help="Run a pressure protocol on a bench or its twin.")
@click.argument("protocol", metavar="PROTOCOL")
@bench_option(also="replay:FILE")
@calibration_option
@click.option(
    "--design",
    type=Design(),
    help="Actuator on the bench, as feed-forward and the guard of bending believe it: a design file, or a name such as tw3_slw10, whose "
    "curve is simulated. A twin without a curve of its own bends by it too.",
)
@click.option(
    "--curve", type=click.Path(path_type=Path), help="Or that curve from a file, as `benchlab simulate` writes it."
)
@click.option(
    "--model",
    type=click.Path(path_type=Path),
    metavar="FILE",
    help="Or by a model file of `benchlab explain`, for --design or tw3_slw10; a twin then has the model's effects, and no others.",
)
@click.option(
    "--control", type=click.Path(path_type=Path), help="Gains of closed-loop steps, in place of the protocol's."
)
@click.option(
    "--out", type=click.Path(path_type=Path), default=Path(), show_default="here", help="Folder for the results."
)
@click.option("--name", help="Of the files. [default: the protocol's name with date and time]")
@click.option("--rate-Hz", "rate_Hz", type=Finite("HZ"), help="Ticks a second, in place of the protocol's.")
@click.option("--dry-run", is_flag=True, help="Check everything and say what would run; open and write nothing.")
@click.option("--fast", is_flag=True, help="In virtual time, as fast as it can: twin and emulated bench only.")
@click.option("--video", is_flag=True, help="Also a drawn film of the twin, for `benchlab analyze`.")
@click.option("--seed", type=int, help="Of the twin's noise, in place of its own.")
@click.option("--max-duration-s", type=Finite("S"), default=3600.0, show_default=True, help="Longest protocol to take.")
@click.option(
    "--pause-limit-s",
    type=Finite("S"),
    default=10.0,
    show_default=True,
    help="A pause that lasts longer vents and ends.",
)
@click.option(
    "--guard",
    "guards",
    multiple=True,
    metavar="NAME=VALUE",
    help="A limit that stops the run, as follow_MPa=0.02, or bend_s=off. May be given again; docs/drive.md lists them.",
)
@click.option("--quiet", is_flag=True, help="Show no progress.")
@click.option("--json", "as_json", is_flag=True, help="One JSON document on standard output.")
def run(protocol: str, dry_run: bool, quiet: bool, as_json: bool, **options: Any) -> int:
    """Run PROTOCOL, a file or the name of a shipped one, and write what was asked for and measured.

    Everything is checked before the bench is opened: a protocol above its limit is refused. Each tick is asked for at its own time
    and goes into a journal at once, which survives whatever happens. Every end vents: the last tick, an error, Ctrl-C, SIGTERM, a
    closed terminal, a lost port. The run stops by itself where the pressure or the angle does not follow, a sensor cannot be
    believed, the device says that something is wrong, or ticks come too late.

    On a terminal, p pauses (the pressure is held, for --pause-limit-s at most) and goes on, q stops; SIGUSR1 pauses too.

    \b
    Writes into --out, never over a file that is there:
      NAME.journal    every tick, as it was measured; `benchlab recover` makes the others from it
      NAME.h5         the drive file (HDF5, NXdata): pressure asked for and measured, angle, lateness, events, all settings
      NAME.csv        the same, a row a tick
      NAME.png        pressure and angle against time
      NAME.truth.csv  of a twin: what was really there

    \b
    Exit codes: 0 completed, 130 interrupted and vented, 5 stopped by the bench or for safety, 3 refused or disk full.

    \b
    Examples:
      benchlab run linear_ramp --fast --out results
      benchlab run linear_ramp --fast --model explained/model.yaml --design tw9_slw10 --out results
      benchlab run mine.yaml --bench serial:/dev/ttyUSB0 --calibration bench.yaml --dry-run
      benchlab run mine.yaml --bench serial:/dev/ttyUSB0 --calibration bench.yaml --out results --guard follow_MPa=0.02
    """
    from benchlab.workflows.run_prepare import RunSettings, prepare
    from benchlab.workflows.run_told import planned

    prepared = prepare(protocol, RunSettings(**options))
    if dry_run:
        found = planned(prepared)
        _tell_plan(found)
        _print_json(found, as_json)
    else:
        _tell_before(prepared)
        found = _drive(prepared, quiet, as_json)
    return int(found.get("exit_code", 0))


def _drive(prepared: Any, quiet: bool, as_json: bool) -> dict[str, Any]:
    """What the run came to, which is told. A bug that ended it is raised then.

    Signals are ours from the beginning to the last word, so that no second Ctrl-C keeps the outcome from being told."""
    from benchlab.cli.run_keys import have_keys, keys_to
    from benchlab.cli.run_screen import Screen, shown
    from benchlab.runner.stop import Stop, signals_to
    from benchlab.workflows.run import drive
    from benchlab.workflows.run_files import written

    stop, keys = Stop(pausable=not prepared.fast), have_keys() and not quiet
    screen = Screen(prepared.plan, stop, keys)
    with signals_to(stop):
        with keys_to(stop, keys), shown(screen, f"{prepared.plan.title} on {prepared.spec}", quiet):
            driven = drive(prepared, stop, None if quiet else screen.on_tick)
        stop.write()
        with progress("drawing the film, frames", quiet or not prepared.settings.video) as reporter:
            found = written(prepared, driven, stop, reporter)
        _tell(found, prepared.warnings)
        bug = driven.end.cause.error if driven.end.reason == "bug" else None
        _print_json(found, as_json and bug is None)
    if bug is not None:
        raise bug
    return found


def _print_json(found: dict[str, Any], wanted: bool) -> None:
    if wanted:
        click.echo(json.dumps(found, indent=2, allow_nan=False))


def _tell_plan(found: dict[str, Any]) -> None:
    """What would run, on standard error."""
    plan, bench = found["plan"], found["bench"]
    peak, slew = plan["peak_MPa"], plan["slew_MPa_per_s"]
    lines = [
        f"{plan['title']}: {plan['duration_s']:g} s, {plan['ticks']} ticks at {plan['rate_Hz']:g} Hz, {counted(plan['steps'], 'step')}",
        f"  asks for up to {peak or 0:.4g} MPa, in ramps of up to {slew or 0:.3g} MPa/s{', and for angles' * plan['closed_loop']}",
        f"  bench {found['bench_spec']}: {bench['name']}, up to {bench['ceiling_MPa']:.4g} MPa, {bench['ceiling_V']:.3f} V",
        f"  watched: {', '.join(found['guards'])}{', empty at the end' if 'empty_s' not in found['guards_off'] else ''}",
        *([f"  control: {found['control']['words']}"] if found["control"] else []),
        *(f"  warning: {warning}" for warning in found["warnings"]),
        *(f"  would write {path}" for path in found["would_write"]),
        "dry run complete: no port was opened and nothing was written",
    ]
    for line in lines:
        click.echo(printable(line), err=True)


def _tell_before(prepared: Any) -> None:
    """What whoever stands at the bench must know before it is opened, on standard error."""
    if prepared.control is not None:
        click.echo(printable(f"control: {prepared.control['words']}"), err=True)
    for warning in prepared.warnings:
        click.echo(f"warning: {printable(warning)}", err=True)


def _tell(found: dict[str, Any], known: tuple[str, ...]) -> None:
    """How it ended, warnings that are not known yet, and files, on standard error."""
    done = f"{found['ticks']} of {found['ticks_planned']} ticks in {found['time_s']:.1f} s"
    late = found["late_ms"]
    lateness = f", late by {late['p50']:.2g} ms (median) to {late['max']:.2g} ms" if late else ", in virtual time"
    who = "" if found["reason"] == "completed" else "benchlab: "
    click.echo(f"{who}{printable(found['reason'])}: {printable(found['words'])}", err=True)
    click.echo(f"  {done}{lateness}; {_vented(found)}", err=True)
    for warning in found["warnings"]:
        if warning not in known:
            click.echo(f"  warning: {printable(warning)}", err=True)
    for path in found["outputs"]:
        click.echo(f"  wrote {printable(path)}", err=True)


def _vented(found: dict[str, Any]) -> str:
    """What the device said of its vent, and what was seen after it."""
    seen = printable(found["empty_words"])
    if not found["vented"]:
        return f"NOT CONFIRMED VENTED ({printable(found['vent_words'])}): {BY_HAND}"
    if found["empty"] is None:
        return f"vented, as the device says, and not seen empty ({seen})"
    if found["empty"]:
        return f"vented and seen empty ({seen})"
    return f"the device says that it vented, and it is NOT EMPTY ({seen}). PRESSURE MAY BE LEFT INSIDE: {BY_HAND}"
