"""What can go wrong, as a tree. Each error says file, place, value, limit and remedy in one line, and knows its exit code.

Exit codes: 0 ok · 1 a bug in benchlab · 2 usage · 3 input refused · 4 batch finished with failures ·
5 bench or safety stop (vented) · 130 interrupted.
"""

from __future__ import annotations

import os


def printable(text: object) -> str:
    """Text that is safe on a terminal, in a log and in an XML file: control characters are shown as escapes.

    >>> printable("a\\nb\\x1b[31m")
    'a\\\\nb\\\\x1b[31m'
    """
    return "".join(c if c.isprintable() else c.encode("unicode_escape", "surrogatepass").decode() for c in str(text))


def counted(number: int, what: str) -> str:
    """A number of things, in words.

    >>> counted(1, "sample"), counted(3, "sample")
    ('1 sample', '3 samples')
    """
    return f"{number} {what}{'s' * (number != 1)}"


class BenchlabError(Exception):
    """An expected failure. `str(error)` is the one line that the user sees.

    >>> str(InputError("empty file (0 bytes)", file="a.mp4", hint="was the copy finished?"))
    'a.mp4: empty file (0 bytes); was the copy finished?'
    """

    exit_code = 1

    def __init__(
        self,
        what: str,
        *,
        file: str | os.PathLike[str] | None = None,
        where: str | None = None,
        hint: str | None = None,
    ) -> None:
        self.what = what
        self.file = None if file is None else os.fspath(file)
        self.where = where
        self.hint = hint
        super().__init__(what)

    def __str__(self) -> str:
        place = ", ".join(printable(p) for p in (self.file, self.where) if p)
        line = f"{place}: {printable(self.what)}" if place else printable(self.what)
        return f"{line}; {printable(self.hint)}" if self.hint else line

    def as_json(self) -> dict[str, dict[str, object]]:
        """The same facts for machines, as `--json` prints them."""
        return {
            "error": {
                "code": self.exit_code,
                "what": self.what,
                "file": self.file,
                "where": self.where,
                "hint": self.hint,
            }
        }


class UsageError(BenchlabError):
    """The command was called in a way that cannot work: a missing file, an option out of range."""

    exit_code = 2


class InputError(BenchlabError):
    """A file was read and refused: damaged, of the wrong kind, or without what was looked for."""

    exit_code = 3


class BatchError(BenchlabError):
    """A batch went through, and some of its items failed."""

    exit_code = 4


class BenchError(BenchlabError):
    """The bench stopped, or was stopped for safety, and was vented."""

    exit_code = 5
