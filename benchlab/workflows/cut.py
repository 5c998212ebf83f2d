"""`benchlab cut`: a design in, a drawing for the laser cutter out."""

from __future__ import annotations

import math
from dataclasses import asdict
from pathlib import Path
from typing import Any

import benchlab
from benchlab.actuator import ShellDesign
from benchlab.cutting.layout import CutSheet, lay_out
from benchlab.cutting.settings import CutSettings
from benchlab.io.cut_file import check_cut_path, write_cut
from benchlab.io.files import check_new_file


def cut(
    design: ShellDesign, settings: CutSettings, out: Path, sheet: str = "all", overwrite: bool = False
) -> dict[str, Any]:
    """Draw the parts of `sheet` ("all", "fabric", "film") into `out`; returns what was drawn, as `--json` shows it.

    Raises UsageError and InputError; then nothing has been written.
    """
    check_cut_path(out)
    check_new_file(out, overwrite)
    drawn = lay_out(design, settings, sheet)
    found = _summary(design, settings, drawn)
    about = {"program": f"benchlab {benchlab.__version__}", "unit": "mm", **found}
    write_cut(out, drawn, f"Cut pattern of {design.name}", about)
    return {"out": str(out), **found}


def _summary(design: ShellDesign, settings: CutSettings, drawn: CutSheet) -> dict[str, Any]:
    area, radius = design.window_width_mm * design.window_length_mm, settings.window_radius_mm
    weld = settings.weld_of(design)
    return {
        "design": {"name": design.name, **asdict(design), "window_length_mm": design.window_length_mm},
        "settings": {**asdict(settings), "weld_mm": weld},
        "sheet_mm": [round(drawn.width_mm, 4), round(drawn.height_mm, 4)],
        "parts": [
            {
                "name": part.name,
                "length_mm": part.size_mm[0],
                "width_mm": part.size_mm[1],
                "windows": len(part.windows),
                "holes": len(part.holes),
            }
            for part in drawn.parts
        ],
        "windows": design.whole_windows,
        "windows_eq7": design.window_count,
        "end_margin_mm": round(abs(design.end_margin_mm), 6),
        "seam_gap_mm": round(design.strip_width_mm - 2 * weld, 6),
        "window_area_mm2": round(design.whole_windows * (area - (4 - math.pi) * radius**2), 6),
        "window_area_eq6_whole_mm2": round(design.whole_windows * area, 6),
        "window_area_eq6_mm2": round(design.tpu_area_mm2, 6),
        "cut_length_mm": {layer: round(length, 3) for layer, length in drawn.cut_length_mm().items()},
    }
