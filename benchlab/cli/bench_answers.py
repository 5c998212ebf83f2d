"""Asking somebody at a terminal while a bench is held: the waiting sees at once when the bench is lost."""

from __future__ import annotations

import os
import re
import select
import sys
from collections.abc import Callable

import click

from benchlab.errors import InputError, UsageError, printable
from benchlab.units import known_unit, to_MPa

LOOK_S = 0.1
"""How often, while waiting for an answer, the bench is looked after."""

_READING = re.compile(r"^\s*(?P<number>[+-]?(?:\d+[.,]?\d*|[.,]\d+)(?:[eE][+-]?\d+)?)\s*(?P<unit>[A-Za-zµ]*)\s*$")


class Answers:
    """Lines from standard input, be it a terminal or a pipe. check: raises what should end the waiting."""

    def __init__(self, check: Callable[[], None] = lambda: None) -> None:
        self.check = check
        self._read = b""

    def ask(self, question: str) -> str:
        """The answer to a question, which is shown on standard error. UsageError where standard input has ended."""
        click.echo(f"{question} ", nl=False, err=True)
        try:
            while b"\n" not in self._read:
                if self._ready():
                    self._read += self._more()
        except BaseException:
            click.echo(err=True)  # what is said next begins a line
            raise
        line, _, self._read = self._read.partition(b"\n")
        return line.decode("utf-8", "replace").strip()

    def _more(self) -> bytes:
        more = os.read(_input(), 4096)
        if not more:
            raise UsageError(
                "standard input ended before all was answered; vented, nothing written",
                hint="call it from a terminal, or give --readings FILE",
            )
        return more

    def _ready(self) -> bool:
        self.check()
        if (
            sys.platform == "win32"
        ):  # there select knows sockets only; the bench is held and vented by its own thread all the same
            return True
        return bool(select.select([_input()], [], [], LOOK_S)[0])


def _input() -> int:
    try:
        return sys.stdin.fileno()
    except (OSError, AttributeError, ValueError):
        raise UsageError(
            "there is no standard input", hint="call it from a terminal, or give --readings FILE"
        ) from None


def pressure_of(text: str, unit: str) -> float:
    """A typed gauge reading in MPa; `unit` where the text has none. InputError for what is none.

    >>> pressure_of("35 kPa", "MPa"), pressure_of("0,5", "bar")
    (0.035, 0.05)
    """
    found = _READING.match(text)
    if not found:
        raise InputError(f"{text!r} is not a pressure", hint="type a number, and a unit if it is another one")
    return float(to_MPa(float(found["number"].replace(",", ".")), found["unit"] or unit))


def ask_unit(answers: Answers) -> str:
    """The unit that the gauge reads in, asked until it is one."""
    while True:
        text = answers.ask("Which unit does the gauge read in (kPa, MPa, bar, psi)?")
        known = known_unit(text)
        if known and known[0] == "pressure":
            return known[1]
        click.echo(f"  {printable(text)!r} is not a unit of pressure", err=True)


def ask_volts(answers: Answers) -> float:
    """The supply, asked until it may be one."""
    while True:
        text = answers.ask("Volts between 5V and GND of the microcontroller, by a multimeter?")
        try:
            volts = float(text.removesuffix("V").strip().replace(",", "."))
        except ValueError:
            volts = 0.0
        if 4.5 <= volts <= 5.5:
            return volts
        click.echo("  type volts from 4.5 to 5.5", err=True)
