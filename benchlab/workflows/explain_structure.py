"""What the structural knobs of `benchlab explain` do to a layup, and the values at which they are simulated."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import replace

from benchlab.actuator import ShellDesign
from benchlab.discrepancy.base import KNOBS
from benchlab.errors import UsageError
from benchlab.simulation.laws import Law, describe_law, make_law
from benchlab.simulation.layup import Layup, widest_margin_mm

KNOB_VALUES = {
    "film_modulus": (0.5, 0.7, 1.0, 1.3, 1.6),
    "fabric_modulus": (0.25, 0.5, 1.0, 1.8, 3.0),
    "seam_margin_mm": (0.0, 0.4, 0.8, 1.2),
    "bladder_N_per_mm": (0.0, 0.5, 1.5, 3.0, 5.0),
    "ballooning": (0.0, 0.25, 0.5, 0.75, 1.0),
}
"""Values at which each knob is simulated, chosen wide enough for what such actuators may have; between them curves are interpolated."""

CELL_KNOBS = ("film_modulus", "fabric_modulus", "seam_margin_mm", "bladder_N_per_mm")
BEAM_KNOBS = ("film_modulus", "fabric_modulus", "ballooning")
WIDEST_SHARE = 0.8
"""Of the margin at which a window closes: a seam is simulated up to this."""


def design_with(design: ShellDesign, layup: Layup, knobs: Mapping[str, float]) -> tuple[ShellDesign, Layup]:
    """What is simulated for these knob values together. The design stays as drawn: all that changes is how it is laminated.

    film_modulus: the film's energy times a factor. fabric_modulus: Young's modulus of fabric and strip times a factor. seam_margin_mm
    and bladder_N_per_mm: added to those of the layup. `ballooning` is no part of a layup: `beam_response` takes it.
    Raises UsageError for an unknown knob and for margins that close the windows.

    >>> from benchlab.io.layup_file import read_layup
    >>> _, softer = design_with(ShellDesign(10, 3), read_layup("trial"), {"film_modulus": 0.5, "seam_margin_mm": 0.2})
    >>> softer.film.C10, softer.seam_margin_mm
    (0.75, 0.2)
    """
    for name, value in knobs.items():
        if name not in KNOBS:
            raise UsageError(f"no structural knob is called {name!r}", hint=f"use one of {', '.join(KNOBS)}")
        if value != KNOBS[name][0] and name in _CHANGES:
            layup = _CHANGES[name](layup, value)
    if layup.seam_margin_mm >= widest_margin_mm(design):
        raise UsageError(
            f"a seam margin of {layup.seam_margin_mm:g} mm closes the windows of {design.name}",
            hint=f"it stays below {widest_margin_mm(design):g} mm",
        )
    return design, layup


def knob_values(name: str, design: ShellDesign, layup: Layup) -> tuple[float, ...]:
    """Values at which a knob is simulated for a design: a seam's margin leaves a fifth of the window open.

    >>> from benchlab.io.layup_file import read_layup
    >>> knob_values("seam_margin_mm", ShellDesign(10, 1), read_layup("trial"))[-1]
    0.4
    """
    values = KNOB_VALUES[name]
    if name != "seam_margin_mm":
        return values
    room = WIDEST_SHARE * widest_margin_mm(design) - layup.seam_margin_mm
    return tuple(value * min(1.0, max(room, 0.0) / values[-1]) for value in values)


def scaled_law(law: Law, factor: float) -> Law:
    """A law of the catalogue with its energy times a factor: all of them are linear in their coefficients.

    >>> from benchlab.simulation.laws import Ogden
    >>> scaled_law(Ogden((0.6, -0.01), (1.3, -2.0)), 2.0)
    Ogden(mu_MPa=(1.2, -0.02), alpha=(1.3, -2.0))
    """
    known = describe_law(law)
    coefficients = {name: factor * value for name, value in known["coefficients_MPa"].items()}
    return make_law(known["law"], coefficients, known.get("exponents"))


def _with_fabric(layup: Layup, factor: float) -> Layup:
    fabric = replace(layup.fabric, youngs_modulus_MPa=factor * layup.fabric.youngs_modulus_MPa)
    return replace(layup, fabric=fabric)


_CHANGES: dict[str, Callable[[Layup, float], Layup]] = {
    "film_modulus": lambda layup, factor: replace(layup, film=scaled_law(layup.film, factor)),
    "fabric_modulus": _with_fabric,
    "seam_margin_mm": lambda layup, mm: replace(layup, seam_margin_mm=layup.seam_margin_mm + mm),
    "bladder_N_per_mm": lambda layup, more: replace(layup, bladder_N_per_mm=layup.bladder_N_per_mm + more),
}
