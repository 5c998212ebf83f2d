"""A tube as a CalculiX deck, of shells (S8R) or of solids (C3D20R); tried with CalculiX 2.20."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from benchlab.deck.sections import BONDED_BULK_OVER_SHEAR, mesh_lines, section_lines, solid_lines
from benchlab.deck.solid import Solid
from benchlab.deck.tube import Tube


def calculix_deck(
    model: Tube | Solid, pressures_MPa: Sequence[float], heading: Sequence[str] = (), bulk_over_shear: float = 2000.0
) -> str:
    """The deck's text: pressure grows to the last of `pressures_MPa` (increasing, > 0), displacements of the rib
    mid-planes are printed at each of them (at times p / p_last of the one step)."""
    last = pressures_MPa[-1]
    times = np.asarray(pressures_MPa) / last
    lines = [f"** {line}".rstrip() for line in heading]
    if isinstance(model, Solid):
        lines += solid_lines(model, bulk_over_shear)
        lines += ["*BOUNDARY", "MIRROR_Y, 2, 2", "MIRROR_Z, 3, 3", "HOLD_X, 1, 1"]
        loads = [f"LOADED, P1, {last:.9g}"]
    else:
        lines += mesh_lines(model, "S8R", "S6")
        lines += section_lines(model, bulk_over_shear, BONDED_BULK_OVER_SHEAR)
        lines += ["*BOUNDARY", "MIRROR_Y, 2, 2", "MIRROR_Y, 4, 4", "MIRROR_Y, 6, 6"]
        lines += ["MIRROR_Z, 3, 3", "MIRROR_Z, 4, 5", "HOLD_X, 1, 1"]
        loads = [f"WALL, P, {last:.9g}", f"CAP_LOADED, P, {last:.9g}"]
    lines += ["*TIME POINTS, NAME=PRESSURES", *(f"{time:.9g}" for time in times)]
    lines += ["*STEP, NLGEOM, INC=1000", "*STATIC", "0.02, 1., 1e-6, 0.1"]
    lines += ["*DLOAD", *loads]
    for name in (name for name in model.node_sets if name.startswith("RIB_")):
        lines += [f"*NODE PRINT, NSET={name}, TIME POINTS=PRESSURES", "U"]
    lines += ["*NODE FILE, OUTPUT=2D, TIME POINTS=PRESSURES", "U", "*END STEP", ""]
    return "\n".join(lines)
