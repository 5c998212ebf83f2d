"""What all commands that open a bench ask for: which one, and its calibration."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypeVar

import click

from benchlab.errors import UsageError

if TYPE_CHECKING:
    from benchlab.workflows.open_bench import Spec

BENCHES = "twin | twin:FILE | serial:PORT | emulated"

Command = TypeVar("Command", bound=Callable[..., Any])


def bench_option(
    also: str = "", default: str | None = "twin", required: bool | None = None
) -> Callable[[Command], Command]:
    """`--bench`, as `bench`. also: further kinds that this command knows, as `replay:FILE`. default None: it must be given, unless
    required is False."""
    kinds = f"{BENCHES} | {also}" if also else BENCHES
    wanted = default is None if required is None else required
    said: dict[str, Any] = {} if default is None else {"default": default, "show_default": True}
    return click.option(
        "--bench",
        metavar="BENCH",
        required=wanted,
        help=f"{kinds}. `benchlab bench ports` lists the ports. A twin is simulated, and what it writes says so.",
        **said,  # click takes a default of None for one
    )


calibration_option = click.option(
    "--calibration",
    type=click.Path(path_type=Path),
    metavar="FILE",
    help="The bench's calibration, by `benchlab bench calibrate`. Without it a real bench is given less than its limit: 0.32 MPa.",
)


def device_of(text: str) -> Spec:
    """`--bench` where a replay makes no sense: it is no device. UsageError for one, and for what is no bench."""
    from benchlab.workflows.open_bench import spec_of

    spec = spec_of(text)
    if spec.kind == "replay":
        raise UsageError("a replay is a recording, no bench", hint=f"give {BENCHES}")
    return spec
