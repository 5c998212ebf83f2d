"""What a report consists of on disk: the page, its numbers, tables, figures and, if wanted, the PDF. All of it or none."""

from __future__ import annotations

import json
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from benchlab.io.files import sha256
from benchlab.report.document import Document, write_table
from benchlab.report.page import render_page
from benchlab.report.pdf import render_pdf
from benchlab.report.study.numbers import SCHEMA
from benchlab.workflows.outputs import Outputs

PAGE, NUMBERS, PDF, VALUES = "report.html", "report.json", "report.pdf", "tables/values.csv"


@dataclass(frozen=True)
class ReportOutputs(Outputs):
    """names: files as from the folder. numbers: the one that vouches for the others with their SHA-256; schema: what it says it is."""

    names: tuple[str, ...] = (PAGE, NUMBERS)
    numbers: str = NUMBERS
    schema: str = SCHEMA

    @property
    def run_file(self) -> Path:
        return self.folder / self.numbers

    def paths(self, overlay: bool = False) -> list[Path]:
        return [self.folder / name for name in self.names]

    def _written_before(self) -> dict[str, str]:
        try:
            found = json.loads(self.run_file.read_bytes())
            told: object = found["provenance"]["outputs_sha256"] if found["schema"] == self.schema else None
        except (OSError, ValueError, LookupError, TypeError, RecursionError):
            return {}
        return {self.numbers: "any", **told} if isinstance(told, dict) and all(_inside(name) for name in told) else {}


def names_of(
    document: Document, pdf: bool = False, beside: Sequence[str] = (), numbers: str = NUMBERS
) -> tuple[str, ...]:
    """All files of a report, as from its folder. beside: those that are not of the document."""
    tables = [f"tables/{table.name}.csv" for table in document.tables]
    figures = [f"figures/{panel.name}.{suffix}" for panel in document.panels for suffix in ("svg", "png")]
    return (PAGE, *[PDF] * pdf, *beside, *tables, *figures, numbers)


def write_report(
    outputs: ReportOutputs, document: Document, numbers: dict[str, Any], beside: Callable[[Path], object]
) -> dict[str, Any]:
    """Write the files of `outputs.names`; returns the numbers with the sums of all files but their own. beside: writes those that are
    not of the document into a folder.

    Raises InputError where the disk refuses; then nothing has changed.
    """
    with outputs.staged() as stage:
        for path in stage.paths():
            path.parent.mkdir(exist_ok=True)
        (stage.folder / PAGE).write_text(render_page(document), encoding="utf-8")
        if PDF in outputs.names:
            (stage.folder / PDF).write_bytes(render_pdf(document))
        beside(stage.folder)
        for table in document.tables:
            write_table(stage.folder / "tables" / f"{table.name}.csv", table)
        for panel in document.panels:
            (stage.folder / "figures" / f"{panel.name}.svg").write_text(panel.svg, encoding="utf-8")
            (stage.folder / "figures" / f"{panel.name}.png").write_bytes(panel.png)
        sums = {name: sha256(path) for name, path in _made(stage)}
        whole = {**numbers, "provenance": {**numbers["provenance"], "outputs_sha256": sums}}
        stage.run_file.write_text(json.dumps(whole, indent=1, allow_nan=False) + "\n", encoding="utf-8")
    return whole


def _made(stage: ReportOutputs) -> Iterator[tuple[str, Path]]:
    return ((name, stage.folder / name) for name in stage.names if name != stage.numbers)


def _inside(name: object) -> bool:
    """Whether a name stays in the folder: a report.json may be anybody's."""
    return isinstance(name, str) and not Path(name).is_absolute() and ".." not in Path(name).parts
