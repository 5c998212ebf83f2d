"""What is wrong with a YAML file in the words of its reader: line, key, value and remedy of each thing that a model finds."""

from __future__ import annotations

import difflib
import json
import math
from collections.abc import Callable, Mapping
from typing import Any

from pydantic import BaseModel, ValidationError

from benchlab.errors import counted
from benchlab.io.yaml_commas import Place, comma_told
from benchlab.io.yaml_units import in_unit_of_key, same_name

Told = tuple[str, str, str]
"""Line, what is wrong, and the remedy."""

_MAPPING, _LIST, _NUMBER, _WHOLE = (
    "write its keys below it, as `key: value`",
    "write a list, as [a, b]",
    "give a number",
    "give a whole number",
)
_REMEDIES: dict[str, Callable[[Mapping[str, Any]], str]] = {
    **dict.fromkeys(("model_type", "model_attributes_type", "dict_type"), lambda _: _MAPPING),
    **dict.fromkeys(("list_type", "tuple_type"), lambda _: _LIST),
    **dict.fromkeys(("float_type", "float_parsing"), lambda _: _NUMBER),
    **dict.fromkeys(("int_type", "int_parsing", "int_from_float", "int_parsing_size"), lambda _: _WHOLE),
    "string_type": lambda _: "give text, in quotes if it looks like a number",
    "bool_type": lambda _: "give true or false",
    "finite_number": lambda _: "give a finite number",
    "greater_than": lambda limit: f"give more than {limit['gt']:g}",
    "greater_than_equal": lambda limit: f"give {limit['ge']:g} or more",
    "less_than": lambda limit: f"give less than {limit['lt']:g}",
    "less_than_equal": lambda limit: f"give {limit['le']:g} or less",
    "too_short": lambda limit: f"give at least {counted(limit['min_length'], 'item')}",
    "too_long": lambda limit: f"give at most {counted(limit['max_length'], 'item')}",
    "string_too_short": lambda limit: f"give at least {counted(limit['min_length'], 'letter')}",
    "string_too_long": lambda limit: f"give at most {counted(limit['max_length'], 'letter')}",
    "literal_error": lambda limit: f"give {limit['expected']}",
}
"""What to do about each kind of error that pydantic names, from its limits."""

_NOT_FINITE = ("nan", "inf", "infinity")


def told_of(error: ValidationError, lines: Mapping[Place, int], model: type[BaseModel]) -> list[Told]:
    """All that a model finds wrong. lines: of each key and item, by its place."""
    known = _known_keys(model)
    return [_one(dict(each), lines, known) for each in _told_once([dict(e) for e in error.errors(include_url=False)])]


def name_of(place: Place) -> str:
    """As a reader finds it.

    >>> name_of(("film", "coefficients_MPa", "C10")), name_of(("steps", 2, "to_MPa"))
    ('film.coefficients_MPa.C10', 'steps[2].to_MPa')
    """
    text = "".join(f"[{part}]" if isinstance(part, int) else f".{part}" for part in place)
    return text.removeprefix(".") or "the document"


def _told_once(errors: list[dict[str, Any]]) -> list[dict[str, Any]]:
    """Errors without the missing keys that stand there misspelt or in another unit: those are told as unknown keys."""
    unknown = [error["loc"] for error in errors if error["type"] == "extra_forbidden"]
    return [
        error
        for error in errors
        if error["type"] != "missing"
        or not any(
            place[:-1] == error["loc"][:-1] and _like(str(place[-1]), {str(error["loc"][-1])}) for place in unknown
        )
    ]


def _one(error: dict[str, Any], lines: Mapping[Place, int], known: set[str]) -> Told:
    place: Place = ()
    for part in error["loc"]:  # parts that stand for a choice of models, not for a key, are left out
        if (*place, part) in lines:
            place = (*place, part)
    line = f"line {lines.get(place, 1)}"
    kind, value = error["type"], error["input"]
    if kind == "missing":
        inside = f" in {name_of(place)}" if place else ""
        return line, f"{error['loc'][-1]} is missing{inside}", f"add `{error['loc'][-1]}:`"
    if kind == "extra_forbidden":
        return line, f"unknown key {name_of(place)}", _remedy_of_key(str(place[-1]), value, known)
    if _wants_number(kind) and (comma := comma_told(value)):
        return line, f"{name_of(place)}: {comma[0]}", comma[1]
    if place and isinstance(value, str) and (wanted := in_unit_of_key(str(place[-1]), value, known)):
        return line, f"{name_of(place)} is {json.dumps(value, ensure_ascii=False)}", f"write {wanted}"
    return line, f"{name_of(place)} is {_shown(value)}", _remedy(error)


def _remedy(error: dict[str, Any]) -> str:
    """In the words of the table; of what it lacks, in those of the model."""
    kind, value = error["type"], error["input"]
    if isinstance(value, float) and not math.isfinite(value):
        kind = "finite_number"
    if _wants_number(kind) and isinstance(value, str) and value.lower().lstrip("+-.") in _NOT_FINITE:
        kind = "finite_number"
    if kind in _REMEDIES:
        return _REMEDIES[kind](error.get("ctx", {}))
    return str(error["msg"]).removeprefix("Value error, ")


def _wants_number(kind: str) -> bool:
    return kind.startswith(("float_", "int_"))


def _shown(value: object) -> str:
    if isinstance(value, float) and not math.isfinite(value):
        return str(value)
    text = json.dumps(value, ensure_ascii=False, default=str)
    return text if len(text) <= 60 else text[:57] + "..."


def _remedy_of_key(key: str, value: object, known: set[str]) -> str:
    """What to do about a key that is not known."""
    if wanted := in_unit_of_key(key, value, known):
        return f"write {wanted}"
    close = _like(key, known)
    return f"did you mean {' or '.join(close)}?" if close else "remove it"


def _like(key: str, known: set[str]) -> list[str]:
    return same_name(key, known) or difflib.get_close_matches(key, sorted(known), n=1)


def _known_keys(model: type[BaseModel]) -> set[str]:
    """Names of all fields of a model and of the models in it."""
    schema = model.model_json_schema()
    return {name for part in (schema, *schema.get("$defs", {}).values()) for name in part.get("properties", {})}
