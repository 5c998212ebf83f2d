"""Ranges and lists of numbers on the command line."""

from __future__ import annotations

from decimal import Decimal, InvalidOperation
from typing import Any

import click

MOST = 10_000
"""Values that one range may have."""


class Values(click.ParamType):
    """`START:END[:STEP]` (step 1, ends included), `1,5,10` or one number; growing floats without their rounding errors.

    >>> Values().convert("0:0.3:0.1", None, None), Values().convert("10,1,5", None, None)
    ((0.0, 0.1, 0.2, 0.3), (1.0, 5.0, 10.0))
    """

    name = "values"

    def get_metavar(self, param: click.Parameter, ctx: click.Context) -> str:
        return "START:END[:STEP]|LIST"

    def convert(self, value: Any, param: click.Parameter | None, ctx: click.Context | None) -> tuple[float, ...]:
        if isinstance(value, tuple):
            return value
        text = str(value)
        found = self._steps(text, param, ctx) if ":" in text else self._numbers(text, ",", param, ctx)
        numbers = tuple(sorted(map(float, found)))
        if len(set(numbers)) < len(numbers):
            self.fail(f"{text!r} gives a number twice", param, ctx)
        return numbers

    def _steps(self, text: str, param: click.Parameter | None, ctx: click.Context | None) -> list[Decimal]:
        parts = self._numbers(text, ":", param, ctx)
        if len(parts) not in (2, 3):
            self.fail(f"{text!r} is not START:END or START:END:STEP", param, ctx)
        start, end, step = (*parts, Decimal(1))[:3]
        if step <= 0 or end < start:
            self.fail(f"{text!r} does not grow from START to END in steps above 0", param, ctx)
        if (end - start) / step >= MOST:
            self.fail(f"{text!r} has more than {MOST} values", param, ctx)
        return [start + i * step for i in range(int((end - start) / step) + 1)]

    def _numbers(
        self, text: str, separator: str, param: click.Parameter | None, ctx: click.Context | None
    ) -> list[Decimal]:
        try:
            found = [Decimal(part.strip()) for part in text.split(separator)]
        except InvalidOperation:
            found = []
        if not found or not all(number.is_finite() and abs(number) < Decimal("1e9") for number in found):
            self.fail(f"{text!r} is not a number, a list (1,5,10) or a range (START:END:STEP)", param, ctx)
        return found


class Span(Values):
    """As Values, but START:END without a step is all between: `(low, high)` and True; a list or steps come with False.

    >>> Span().convert("1:15", None, None), Span().convert("3", None, None)
    (((1.0, 15.0), True), ((3.0,), False))
    """

    name = "span"

    def convert(self, value: Any, param: click.Parameter | None, ctx: click.Context | None) -> Any:
        if isinstance(value, tuple):
            return value
        text = str(value)
        if text.count(":") != 1:
            return super().convert(text, param, ctx), False
        low, high = self._numbers(text, ":", param, ctx)
        if high <= low:
            self.fail(f"{text!r} does not grow from START to END", param, ctx)
        return (float(low), float(high)), True
