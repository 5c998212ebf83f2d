"""A design on the command line: the DESIGN argument, and the options of commands that work on one design."""

from __future__ import annotations

import functools
from collections.abc import Callable
from dataclasses import replace
from typing import Any

import click

from benchlab.actuator import ShellDesign
from benchlab.cli.options import Finite
from benchlab.errors import UsageError

FIELDS = {
    "tw_mm": "window_width_mm",
    "slw_mm": "strip_width_mm",
    "fw_mm": "rib_width_mm",
    "perimeter_mm": "perimeter_mm",
    "length_mm": "length_mm",
}
"""Which field of ShellDesign an option fills."""


class Design(click.ParamType):
    """A design file (YAML), or a name such as `tw3_slw10`; a ShellDesign."""

    name = "design"

    def get_metavar(self, param: click.Parameter, ctx: click.Context) -> str:
        return "DESIGN" if isinstance(param, click.Argument) else "FILE|NAME"

    def convert(self, value: Any, param: click.Parameter | None, ctx: click.Context | None) -> ShellDesign:
        from benchlab.io.design_file import read_design

        return value if isinstance(value, ShellDesign) else read_design(str(value))


def _millimetres(name: str, text: str) -> Callable[[Callable[..., Any]], Callable[..., Any]]:
    return click.option(name, type=Finite("MM"), help=text)


OPTIONS = (
    _millimetres("--tw-mm", "Window width tw, along the axis."),
    _millimetres("--slw-mm", "Width slw of the strain-limiting strip, around the tube."),
    _millimetres(
        "--fw-mm", f"Fabric width fw between windows, along the axis. [default: {ShellDesign.rib_width_mm:g}]"
    ),
    _millimetres("--perimeter-mm", f"Around the tube: slw + window length wl. [default: {ShellDesign.perimeter_mm:g}]"),
    _millimetres("--length-mm", f"Actuator length al. [default: {ShellDesign.length_mm:g}]"),
    click.option(
        "--design",
        type=Design(),
        help="All of these at once: a design file (YAML), or a name such as tw3_slw10. "
        "Numbers given beside it replace its own.",
    ),
)


def design_options(command: Callable[..., Any]) -> Callable[..., Any]:
    """Add --tw-mm --slw-mm --fw-mm --perimeter-mm --length-mm --design; `command` is given one `design: ShellDesign`.

    Stands below @click.command, above the options that come after these in the help. Raises UsageError where the options
    make no design.
    """

    @functools.wraps(command)
    def with_design(*args: Any, design: ShellDesign | None, **options: Any) -> Any:
        lengths = {name: options.pop(name) for name in FIELDS}
        return command(*args, design=design_of(design, **lengths), **options)

    for option in reversed(OPTIONS):
        with_design = option(with_design)
    return with_design


def design_of(design: ShellDesign | None = None, **lengths_mm: float | None) -> ShellDesign:
    """The design that the options say; `lengths_mm` by the names in FIELDS, None where not given.

    >>> design_of(None, tw_mm=3, slw_mm=10).name
    'tw3_slw10'
    >>> design_of(design_of(None, tw_mm=3, slw_mm=10), slw_mm=5).name
    'tw3_slw5'

    Raises UsageError where a length is missing, or the design is impossible.
    """
    given = {FIELDS[name]: value for name, value in lengths_mm.items() if value is not None}
    if design:
        return replace(design, **given)
    missing = [option for option, field in FIELDS.items() if option in ("tw_mm", "slw_mm") and field not in given]
    if missing:
        names = " and ".join(f"--{name.replace('_', '-')}" for name in missing)
        raise UsageError(
            f"no design is given: {names} {'is' if len(missing) == 1 else 'are'} missing",
            hint="give --tw-mm and --slw-mm, or --design with a file or a name such as tw3_slw10",
        )
    return ShellDesign(**given)
