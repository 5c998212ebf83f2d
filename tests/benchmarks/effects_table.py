"""Writes the catalogue in docs/effects.md from the effects themselves: `python tests/benchmarks/effects_table.py`."""

from __future__ import annotations

import re
import sys
from pathlib import Path

from benchlab.discrepancy.effects.catalogue import built_in
from benchlab.discrepancy.effects.effect import Effect, Parameter

PAGE = Path(__file__).resolve().parents[2] / "docs" / "effects.md"
START, END = "<!-- catalogue: made by tests/benchmarks/effects_table.py -->", "<!-- end of catalogue -->"


def overview() -> str:
    rows = [
        f"| [`{e.name}`](#{e.name}) | {_first_line(e)} | {e.acts_on} | {', '.join(f'`{form}`' for form in e.forms)} |"
        for e in built_in().values()
    ]
    return "\n".join(["| name | what it is | acts on | forms |", "|---|---|---|---|", *rows])


def chapter(effect: Effect) -> str:
    """One effect: physics, equation with the meaning of its constants, what it looks like, what shows it, parameters."""
    equation, *paragraphs = _doc(effect)[1:]
    rows = [_row(parameter) for parameter in effect.parameters]
    return "\n".join(
        [
            f"### {effect.name}",
            "",
            effect.physics,
            "",
            equation,
            "",
            *[f"{' '.join(line.split())}\n" for line in paragraphs],
            f"*Looks like:* {effect.looks_like}.  ",
            f"*Shown by:* {effect.shown_by}.  ",
            f"*Changes:* {', '.join(f'`{quantity}`' for quantity in effect.seen_in)}.",
            "",
            "| parameter | what it is | unit | bounds | typical | absent at |",
            "|---|---|---|---|---|---|",
            *rows,
        ]
    )


def catalogue() -> str:
    return "\n\n".join([START, overview(), *[chapter(effect) for effect in built_in().values()], END])


def placed(page: str) -> str:
    """The page with the catalogue of today."""
    return re.sub(f"{re.escape(START)}.*{re.escape(END)}", lambda _: catalogue(), page, flags=re.DOTALL)


def _doc(effect: Effect) -> list[str]:
    text = sys.modules[type(effect).__module__].__doc__ or ""
    return re.sub(r"\n(?=By nature)", "\n\n", text.strip()).split("\n\n")


def _first_line(effect: Effect) -> str:
    return _doc(effect)[0].split(": ", 1)[1].rstrip(".")


def _row(p: Parameter) -> str:
    absent = "–" if p.neutral is None else f"{p.neutral:g}"
    return f"| `{p.name}` | {p.what} | {p.unit or '–'} | {p.low:g} … {p.high:g} | {p.typical:g} | {absent} |"


if __name__ == "__main__":
    PAGE.write_text(placed(PAGE.read_text(encoding="utf-8")), encoding="utf-8")
