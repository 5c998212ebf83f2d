"""The `benchlab` command: its sub-commands, and the one place where an error becomes a line and an exit code."""

from __future__ import annotations

import errno
import json
import os
import sys
from typing import Any

import click

import benchlab
from benchlab.cli.analyze import analyze
from benchlab.cli.bench import bench
from benchlab.cli.calibrate import calibrate
from benchlab.cli.control import control
from benchlab.cli.cut import cut
from benchlab.cli.design import design
from benchlab.cli.explain import explain
from benchlab.cli.export import export
from benchlab.cli.fit_material import fit_material
from benchlab.cli.force import force
from benchlab.cli.protocol import protocol
from benchlab.cli.recover import recover
from benchlab.cli.report import report
from benchlab.cli.run import run as run_protocol
from benchlab.cli.sample_data import sample_data
from benchlab.cli.simulate import simulate
from benchlab.cli.stats import stats
from benchlab.cli.study import study
from benchlab.cli.sweep import sweep
from benchlab.errors import BenchlabError, InputError, printable

EXIT_BUG, EXIT_INTERRUPTED = 1, 130


class NobodyReadsError(Exception):
    """Whoever read our output has gone."""


class Commands(click.Group):
    """Commands whose broken pipes are told apart from errors: click and rich leave with 1 for them."""

    def invoke(self, ctx: click.Context) -> Any:
        try:
            return super().invoke(ctx)
        except BrokenPipeError as error:
            raise NobodyReadsError from error
        except SystemExit as left:
            if isinstance(left.__context__, BrokenPipeError):
                raise NobodyReadsError from left
            raise


@click.group(cls=Commands, context_settings={"help_option_names": ["-h", "--help"], "max_content_width": 110})
@click.version_option(benchlab.__version__, prog_name="benchlab")
@click.option("--debug", is_flag=True, help="Show the traceback of an error.")
def cli(debug: bool) -> None:
    """Bench software for soft-robotics labs.

    See: `benchlab analyze VIDEO` finds the markers on a bending actuator and writes its angle against time.

    Measure: `benchlab force FILE` reads exports of testing machines, and finds blocked force in them.

    Compare: `benchlab report STUDY` and, of any table, `benchlab stats TABLE.csv`: do designs differ, how well do samples repeat?

    Predict: `benchlab simulate --tw-mm 3 --slw-mm 10` simulates a fabric-shelled actuator: angle, volume, blocked force;
    `sweep` many designs, `design` the one that is wanted, `cut` it.

    Explain: `benchlab explain MEASURED` finds where simulation and measurement disagree, and names what is missing.

    \b
    Exit codes: 0 ok, 1 a bug in benchlab, 2 usage, 3 input refused, 4 a batch finished with failures,
    5 the bench stopped or was stopped, 130 interrupted (what was measured is kept, marked partial).
    """


cli.add_command(analyze)
cli.add_command(bench)
cli.add_command(calibrate)
cli.add_command(control)
cli.add_command(cut)
cli.add_command(design)
cli.add_command(explain)
cli.add_command(export)
cli.add_command(fit_material)
cli.add_command(force)
cli.add_command(recover)
cli.add_command(protocol)
cli.add_command(report)
cli.add_command(run_protocol)
cli.add_command(sample_data)
cli.add_command(simulate)
cli.add_command(stats)
cli.add_command(study)
cli.add_command(sweep)


def run(arguments: list[str] | None = None) -> None:
    """Run the command line and leave the process with its exit code."""
    arguments = sys.argv[1:] if arguments is None else arguments
    for stream in (sys.stdout, sys.stderr):
        if hasattr(stream, "reconfigure"):
            stream.reconfigure(errors="backslashreplace")
    debug, as_json = "--debug" in arguments, "--json" in arguments
    try:
        code = cli.main(args=arguments, prog_name="benchlab", standalone_mode=False) or 0
        sys.stdout.flush()
    except BenchlabError as error:
        if debug:
            raise
        _say(error, as_json)
        code = error.exit_code
    except click.ClickException as error:
        error.show()
        if as_json:
            _print_json(
                {"error": {"code": 2, "what": error.format_message(), "file": None, "where": None, "hint": None}}
            )
        code = 2
    except (click.Abort, KeyboardInterrupt):
        click.echo("benchlab: interrupted", err=True)
        code = EXIT_INTERRUPTED
    except (BrokenPipeError, NobodyReadsError):
        # There is nobody left to tell.
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        code = 0
    except Exception as error:
        if debug:
            raise
        if isinstance(error, OSError) and error.errno == errno.ENOSPC:
            sys.exit(_full())
        what = f"{type(error).__name__}: {printable(error)}"
        click.echo(f"benchlab: this is a bug in benchlab: {what}; run again with --debug and report it", err=True)
        if as_json:
            _print_json({"error": {"code": EXIT_BUG, "what": what, "file": None, "where": None, "hint": "report it"}})
        code = EXIT_BUG
    sys.exit(code)


def _full() -> int:
    """Standard output goes to a disk that is full; files of ours say so themselves."""
    os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
    click.echo("benchlab: disk full: what stands on standard output is not whole; free some space", err=True)
    return InputError.exit_code


def _say(error: BenchlabError, as_json: bool) -> None:
    click.echo(f"benchlab: {error}", err=True)
    if as_json:
        _print_json(error.as_json())


def _print_json(document: dict[str, Any]) -> None:
    click.echo(json.dumps(document, indent=2))
