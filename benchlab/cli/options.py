"""Values on the command line that are more than a number or a word."""

from __future__ import annotations

import math
from typing import Any

import click


class Numbers(click.ParamType):
    """A fixed number of finite numbers with commas between: `100,50,800,600`."""

    def __init__(self, *names: str) -> None:
        self.names = names
        self.name = ",".join(names)

    def get_metavar(self, param: click.Parameter, ctx: click.Context) -> str:
        return self.name

    def convert(self, value: Any, param: click.Parameter | None, ctx: click.Context | None) -> tuple[float, ...]:
        if isinstance(value, tuple):
            return value
        try:
            numbers = tuple(float(part) for part in str(value).split(","))
        except ValueError:
            numbers = ()
        if len(numbers) != len(self.names) or not all(map(math.isfinite, numbers)):
            self.fail(f"{value!r} is not {self.name} ({len(self.names)} numbers with commas between)", param, ctx)
        return numbers


class Finite(click.ParamType):
    """A number that is not inf or nan."""

    name = "number"

    def __init__(self, metavar: str = "NUMBER") -> None:
        self.metavar = metavar

    def get_metavar(self, param: click.Parameter, ctx: click.Context) -> str:
        return self.metavar

    def convert(self, value: Any, param: click.Parameter | None, ctx: click.Context | None) -> float:
        try:
            number = float(value)
        except (TypeError, ValueError):
            self.fail(f"{value!r} is not a number", param, ctx)
        if not math.isfinite(number):
            self.fail(f"{value!r} is not a finite number", param, ctx)
        return number
