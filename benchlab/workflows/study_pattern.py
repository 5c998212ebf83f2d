"""Names of recordings as a pattern: `{design}_s{sample}` reads design, sample and cycle from `tw3_slw10_s1`."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass

from benchlab.errors import InputError, UsageError

_COUNT = r"\d+[a-z]?|[a-z]\d*"
FIELDS = {"design": r"[^/]+", "sample": _COUNT, "cycle": _COUNT, "anything": r"[^/]*"}
"""What each field stands for: sample and cycle are a number, a letter, or one with the other behind it."""

COMMON = (
    "{design}_s{sample}_c{cycle}",
    "{design}_s{sample}",
    "{design}-s{sample}-c{cycle}",
    "{design}-s{sample}",
    "{design}_sample{sample}",
    "{design}_{sample}",
    "{design}-{sample}",
    "{design}/s{sample}",
    "{design}/sample{sample}",
    "{design}/{sample}",
)
"""Tried in this order where no pattern is given."""


@dataclass(frozen=True)
class NameParts:
    """What a name says. cycle: "" where it says none."""

    design: str
    sample: str
    cycle: str


class NamePattern:
    """A pattern, compiled. Capital letters do not matter; with a `/` in it, it covers the last folders too.

    >>> NamePattern("{design}_s{sample}").read("videos/tw3_slw10_s1")
    NameParts(design='tw3_slw10', sample='s1', cycle='')
    >>> NamePattern("{anything}/{design}-{sample}").read("day 2/glove-B")
    NameParts(design='glove', sample='B', cycle='')
    >>> NamePattern("{design}_s{sample}").read("tw3_slw10") is None
    True

    Raises UsageError for a pattern without {design} or {sample}, with a field twice, or with an unknown one.
    """

    def __init__(self, text: str) -> None:
        self.text = text
        pieces = re.split(r"\{(.*?)\}", text)
        fields = pieces[1::2]
        hint = "as '{design}_s{sample}'; {cycle} may follow, and {anything} is passed over"
        if unknown := [name for name in fields if name not in FIELDS]:
            raise UsageError(f"pattern {text!r}: {{{unknown[0]}}} is not known", hint=f"write it {hint}")
        for name in ("design", "sample", "cycle"):
            if fields.count(name) > 1 or (name != "cycle" and name not in fields):
                times = "twice" if name in fields else "not"
                raise UsageError(f"pattern {text!r}: {{{name}}} is {times} in it", hint=f"write it {hint}")
        parts = [re.escape(piece) if index % 2 == 0 else _group(piece) for index, piece in enumerate(pieces)]
        self._expression = re.compile("".join(parts), re.IGNORECASE)
        self._depth = text.count("/") + 1

    def read(self, name: str) -> NameParts | None:
        """The parts of a path without its suffix, with `/` between folders; None where it does not fit.

        A sample that is a number is called s1, s2: a name, not a number.
        """
        found = self._expression.fullmatch("/".join(name.split("/")[-self._depth :]))
        if found is None:
            return None
        sample = found["sample"]
        cycle = found["cycle"] if "cycle" in found.groupdict() else ""
        return NameParts(found["design"], f"s{sample}" if sample[0].isdecimal() else sample, cycle)


def choose_pattern(names: Sequence[str]) -> NamePattern:
    """The first of the common patterns that fits more than half of the names. Raises InputError where none does."""
    for text in COMMON:
        pattern = NamePattern(text)
        if 2 * sum(pattern.read(name) is not None for name in names) > len(names):
            return pattern
    shown = ", ".join(repr(name) for name in names[:3]) + (", ..." if len(names) > 3 else "")
    hint = "give it, as --pattern '{design}_s{sample}'"
    raise InputError(f"no common pattern fits the names of the recordings: {shown}", hint=hint)


def _group(name: str) -> str:
    return FIELDS[name] if name == "anything" else f"(?P<{name}>{FIELDS[name]})"
