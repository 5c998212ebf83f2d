"""Numbers as cells of a text table hold them: one decimal sign per table, and nothing that could be two numbers."""

from __future__ import annotations

import re
from pathlib import Path

from benchlab.errors import InputError, printable

MAX_NUMBER = 64
"""Characters in the longest cell that is read as a number."""

_NUMBER = re.compile(r"[+-]?(\d+[.,]?\d*|[.,]\d+)([eE][+-]?\d+)?")
_GROUPED = re.compile(r"[+-]?\d{1,3}(([.,' \u00a0\u202f]\d{3})+[.,]\d*|([.,' \u00a0\u202f]\d{3}){2,})")
_WITH_UNIT = re.compile(r"[+-]?(\d+[.,]?\d*|[.,]\d+)([eE][+-]?\d+)?\s*[A-Za-zµμ°%/²³]+")
_THOUSANDTHS = re.compile(r"[+-]?[1-9]\d{0,2},\d{3}")


class NumberReader:
    """Reads the cells of one table as numbers, holding the table to one decimal sign."""

    def __init__(self, path: Path, delimiter: str) -> None:
        self.path, self.delimiter = path, delimiter
        self.unreadable: list[tuple[int, str]] = []
        self._signs: dict[str, int] = {}
        self._maybe_thousands = True

    @property
    def commas_may_be_thousands(self) -> bool:
        """Whether there were commas, and each of them has one to three digits before it and three behind."""
        return "," in self._signs and self._maybe_thousands

    def read(self, cell: str, line: int) -> float:
        """The number in a cell; NaN for an empty one, and for one without a number, which is noted in `unreadable`.

        Raises InputError for what could be read as two different numbers, and for a unit in the cell.
        """
        text = cell.strip()
        if not text:
            return float("nan")
        if len(text) > MAX_NUMBER:
            raise self._refused(f"cell of {len(text)} characters, a number has at most {MAX_NUMBER}", line)
        if not _NUMBER.fullmatch(text):
            if _GROUPED.fullmatch(text):
                raise self._refused(f"{text!r} has thousands separators", line, "write numbers without them")
            if _WITH_UNIT.fullmatch(text):
                raise self._refused(f"unit in a cell: {text!r}", line, "put the unit in the header, e.g. pressure_kPa")
            self.unreadable.append((line, printable(text)))
            return float("nan")
        sign = "," if "," in text else "." if "." in text else ""
        if sign:
            self._check_sign(sign, text, line)
        value = float(text.replace(",", "."))
        if value in (float("inf"), float("-inf")):
            self.unreadable.append((line, text))
            return float("nan")
        return value

    def _check_sign(self, sign: str, text: str, line: int) -> None:
        if sign == "," and self.delimiter == ",":
            raise self._refused(
                f"comma in a number: {text!r}", line, "write a decimal point, and no thousands separators"
            )
        self._signs.setdefault(sign, line)
        if len(self._signs) > 1:
            points, commas = self._signs["."], self._signs[","]
            raise self._refused(f"decimal points (line {points}) and decimal commas (line {commas})", line, "use one")
        if sign == "," and not _THOUSANDTHS.fullmatch(text):
            self._maybe_thousands = False

    def _refused(self, what: str, line: int, hint: str | None = None) -> InputError:
        return InputError(what, file=self.path, where=f"line {line}", hint=hint)
