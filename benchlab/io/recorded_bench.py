"""A bench as the head of a run tells it, back again."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

from benchlab.bench import Bench, Line
from benchlab.errors import InputError


def recorded_bench(header: dict[str, Any], path: Path) -> Bench:
    """The bench of a run from the head of its journal or drive file, which keeps a number that is not finite as null.

    Raises InputError naming the file, where the head tells of no bench.

    >>> recorded_bench({"bench": {"name": "a", "regulator": {"gain": 0.1, "offset": 0.0, "sd": None}}}, Path("a.journal")).name
    'a'
    """
    try:
        told = dict(header["bench"])
        lines = {name: _line(told[name]) for name in ("regulator", "monitor", "flex") if told.get(name) is not None}
        return Bench(**{**told, **lines})
    except (KeyError, TypeError, ValueError, AttributeError) as error:
        what = f"does not say which bench it was made with ({type(error).__name__}: {error})"
        raise InputError(what, file=path, hint="was it written by `benchlab run`?") from error


def _line(told: dict[str, Any]) -> Line:
    return Line(told["gain"], told["offset"], math.nan if told.get("sd") is None else told["sd"])
