"""Whether the interpolated curves by which structural effects were named are those of the simulation itself."""

from __future__ import annotations

from typing import Any

import numpy as np

from benchlab.discrepancy.base import KNOBS
from benchlab.discrepancy.explain import Explained
from benchlab.workflows.explain_base import check_surrogate
from benchlab.workflows.explain_chosen import Chosen
from benchlab.workflows.model_curves import knob_settings

PRESSURES = 4
"""At which designs are simulated anew."""

MOST_DESIGNS = 2
"""That are: the first and the last by the width of their windows, between which the others lie."""

TELLING_SHARE = 0.25
"""Of the RMS of what was explained, from which the error is a warning (chosen)."""


def surrogate_error(found: Explained, chosen: Chosen) -> tuple[dict[str, Any] | None, tuple[str, ...]]:
    """Largest and RMS error in degrees of the curves with the named structural effects, against designs simulated anew with them, and a
    warning where it is large. None where no such effect was named, or the curves are another engine's."""
    actives = (*chosen.base.given, *found.identified.best.actives)
    turned = {name: value for name, value in knob_settings(actives).items() if value != KNOBS[name][0]}
    base = chosen.base
    if not turned or base.kind == "foreign" or not found.explanation.effects:
        return None, ()
    names = sorted((n for n in base.designs if n in chosen.shapes), key=lambda n: chosen.shapes[n].window_width_mm)
    some = list(dict.fromkeys([*names[:1], *names[-(MOST_DESIGNS - 1) :]]))
    top = min(base.largest_pressure_MPa(name) for name in some)
    shapes = {name: chosen.shapes[name] for name in some}
    largest, rms = check_surrogate(base, shapes, chosen.layup, turned, np.linspace(0.0, top, PRESSURES))
    gap = found.explanation.gap
    told = {"largest_deg": largest, "rms_deg": rms, "designs": some}
    limit = TELLING_SHARE * max(gap.rmse_before, gap.noise_floor if np.isfinite(gap.noise_floor) else 0.0)
    if rms <= limit:
        return told, ()
    words = f"curves with the structural effects are interpolated, and off by {rms:.2g}° RMS from designs simulated with them"
    return told, (words,)
