"""Numbers with a decimal comma in YAML: a list or mapping in one line breaks them in two, and so they are found before that is read."""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass
from itertools import pairwise

from ruamel.yaml.nodes import MappingNode, Node, ScalarNode, SequenceNode

Place = tuple[str | int, ...]
_WHOLE, _DIGITS = re.compile(r"[-+]?\d+"), re.compile(r"\d+(?:\s*[^\W\d].*)?")
_NUMBER = re.compile(r"\s*([-+]?\d+,\d+)\s*")


@dataclass(frozen=True)
class Comma:
    """One number: where it stands, its line, the index of its comma in the text, and how it is written."""

    place: Place
    line: int
    index: int
    written: str


def find_commas(node: Node, text: str, place: Place = ()) -> Iterator[Comma]:
    """Numbers that the brackets {} and [] break at their comma: `{to_MPa: 0,35}`, and `[0,1, 0,25]` with blanks between numbers alone.

    A list such as [1,2] cannot be told from whole numbers and is left as it is.
    """
    if isinstance(node, MappingNode):
        for key, value in node.value:
            yield from find_commas(value, text, (*place, str(key.value)))
        for (key, value), (rest, nothing) in pairwise(node.value if node.flow_style else []):
            if _empty(nothing) and _broken(value, rest, text):
                yield _comma((*place, str(key.value)), value, rest, text)
    elif isinstance(node, SequenceNode):
        for index, item in enumerate(node.value):
            yield from find_commas(item, text, (*place, index))
        pairs = list(zip(node.value[::2], node.value[1::2]))
        apart = all(
            text[a.end_mark.index : b.start_mark.index] != "," for a, b in zip(node.value[1::2], node.value[2::2])
        )
        whole = node.flow_style and len(pairs) > 1 and 2 * len(pairs) == len(node.value)
        if whole and apart and all(_broken(*pair, text) for pair in pairs):
            yield from (_comma((*place, index), *pair, text) for index, pair in enumerate(pairs))


def with_points(text: str, commas: list[Comma]) -> str:
    """The text with a point in place of each comma."""
    letters = list(text)
    for comma in commas:
        letters[comma.index] = "."
    return "".join(letters)


def comma_told(value: object) -> tuple[str, str] | None:
    """What to say of a number that is written with a comma, and what to write; None for anything else.

    >>> comma_told("0,35"), comma_told("1,500"), comma_told("0.35")
    (('0,35 has a decimal comma', 'write 0.35'), ('1,500 has a comma', 'write 1.500, or 1500'), None)
    """
    found = _NUMBER.fullmatch(value) if isinstance(value, str) else None
    if found is None:
        return None
    written = found[1]
    point = written.replace(",", ".")
    if re.fullmatch(r"[-+]?[1-9]\d{0,2},\d{3}", written):
        return f"{written} has a comma", f"write {point}, or {written.replace(',', '')}"
    return f"{written} has a decimal comma", f"write {point}"


def _broken(whole: Node, rest: Node, text: str) -> bool:
    """Whether a comma alone is between a whole number and digits."""
    return (
        isinstance(whole, ScalarNode)
        and isinstance(rest, ScalarNode)
        and _WHOLE.fullmatch(_source(whole, text)) is not None
        and _DIGITS.fullmatch(_source(rest, text)) is not None
        and text[whole.end_mark.index : rest.start_mark.index] == ","
    )


def _source(node: Node, text: str) -> str:
    return text[node.start_mark.index : node.end_mark.index]


def _empty(node: Node) -> bool:
    return isinstance(node, ScalarNode) and node.start_mark.index == node.end_mark.index


def _comma(place: Place, whole: Node, rest: Node, text: str) -> Comma:
    written = text[whole.start_mark.index : rest.end_mark.index]
    return Comma(place, whole.start_mark.line + 1, whole.end_mark.index, written)
