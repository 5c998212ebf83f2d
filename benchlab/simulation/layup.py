"""What the shell is laminated from, and which pieces lie where on the flat sheet.

The sheet of half the circumference and half a cell: s in [0, P/2], 0 mid strip; Z in [0, (tw + fw)/2], 0 mid rib.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Literal

from benchlab.actuator import ShellDesign
from benchlab.errors import UsageError
from benchlab.simulation.laws import Law, Polynomial, StVenantKirchhoff

BLADDER_mm = 0.01
"""Thickness that a bladder is given; chosen so thin that its own bending and place do not count."""


@dataclass(frozen=True)
class Layup:
    """Materials and thicknesses (mm) of film, fabric and strip; everything about a shell that is not its cut.

    weld_width_mm: how far the windowed fabric reaches under the strip, from the strip's edge, on either side; beyond
    slw/2 it is whole. film_under_strip: the film closes the tube, or ends where the fabric does. moulded: the shell is
    free of bending stress as a round tube; otherwise as a flat sheet. stacking: every layer has its middle on the
    reference surface, as shell programs idealise it; or fabric and strip lie outside of the film, as they are glued.
    film_largest_stretch: of the tests that the film's law was fitted to; beyond it the law is a guess.
    seam_margin_mm: how far the weld reaches into a window from each of its edges; there the film is held as by fabric, so that
    the window is 2 m narrower and shorter while the cell's length stays. bladder_N_per_mm: Young's modulus times thickness of a bladder
    inside that is stretched with the film, 0 where it is slack.
    """

    name: str
    origin: str
    film: Law
    fabric: StVenantKirchhoff = field(default_factory=StVenantKirchhoff)
    film_thickness_mm: float = 0.3
    fabric_thickness_mm: float = 0.3
    strip_thickness_mm: float = 0.3
    film_under_strip: bool = True
    weld_width_mm: float = 0.0
    moulded: bool = True
    stacking: Literal["middle", "outside"] = "middle"
    film_largest_stretch: float | None = None
    seam_margin_mm: float = 0.0
    bladder_N_per_mm: float = 0.0

    def __post_init__(self) -> None:
        for name in ("film_thickness_mm", "fabric_thickness_mm", "strip_thickness_mm"):
            if not (math.isfinite(value := getattr(self, name)) and value > 0):
                raise UsageError(f"{name} is {value}", hint="give a positive thickness in mm")
        if self.film_largest_stretch is not None and not self.film_largest_stretch > 1:
            raise UsageError(f"film_largest_stretch is {self.film_largest_stretch}", hint="give a stretch above 1")
        for name, what in (("weld_width_mm", "width"), ("seam_margin_mm", "width"), ("bladder_N_per_mm", "stiffness")):
            if not (math.isfinite(value := getattr(self, name)) and value >= 0):
                raise UsageError(f"{name} is {value}", hint=f"give 0 or a {what} in {name.split('_', 1)[1]}")


@dataclass(frozen=True)
class Piece:
    """A rectangle of one material on the quarter cell, (s from, to) and (Z from, to) in mm. Pieces are stacked in order,
    the inner first."""

    name: str
    law: Law
    thickness_mm: float
    s_mm: tuple[float, float]
    Z_mm: tuple[float, float]

    def covers(self, s: float, Z: float) -> bool:
        return self.s_mm[0] < s < self.s_mm[1] and self.Z_mm[0] < Z < self.Z_mm[1]


@dataclass(frozen=True)
class Layer:
    """One layer of a laminate: z from `bottom_mm` to `top_mm`, outwards, 0 the middle of the film."""

    name: str
    law: Law
    bottom_mm: float
    top_mm: float

    @property
    def thickness_mm(self) -> float:
        return self.top_mm - self.bottom_mm


def pieces_of(design: ShellDesign, layup: Layup) -> tuple[Piece, ...]:
    """The pieces of the quarter cell: bladder, film, ribs of fabric, strip. Raises UsageError where the seams' margins close the window."""
    edge, end = design.strip_width_mm / 2, (design.window_width_mm + design.rib_width_mm) / 2
    around, margin = design.perimeter_mm / 2, layup.seam_margin_mm
    if widest_margin_mm(design) <= margin:
        raise UsageError(
            f"seam_margin_mm is {margin:g} and closes the windows of {design.name}",
            hint=f"give less than {widest_margin_mm(design):g}, half of the window's shorter side",
        )
    welded = max(0.0, edge - layup.weld_width_mm)
    film_from, rib, window = 0.0 if layup.film_under_strip else welded, design.rib_width_mm / 2 + margin, edge + margin
    pieces = [
        Piece("film", layup.film, layup.film_thickness_mm, (film_from, around), (0.0, end)),
        Piece("rib", layup.fabric, layup.fabric_thickness_mm, (welded, around), (0.0, rib)),
    ]
    if layup.bladder_N_per_mm:
        pieces.insert(0, Piece("bladder", bladder_law(layup.bladder_N_per_mm), BLADDER_mm, (0.0, around), (0.0, end)))
    if welded < window:
        # The windows end at the strip's edge or a margin beyond it: up to there the fabric is whole.
        pieces.append(Piece("weld", layup.fabric, layup.fabric_thickness_mm, (welded, window), (rib, end)))
    pieces.append(Piece("strip", layup.fabric, layup.strip_thickness_mm, (0.0, edge), (0.0, end)))
    return tuple(pieces)


def widest_margin_mm(design: ShellDesign) -> float:
    """The seam margin at which a window closes.

    >>> widest_margin_mm(ShellDesign(strip_width_mm=10, window_width_mm=3))
    1.5
    """
    return min(design.window_width_mm, design.window_length_mm) / 2


def bladder_law(stiffness_N_per_mm: float) -> Polynomial:
    """Neo-Hooke's rubber (Treloar 1943: E = 6·C10) that, BLADDER_mm thick, has this stiffness E·h; so thin that it does not bend."""
    return Polynomial(C10=stiffness_N_per_mm / (6 * BLADDER_mm))


def laminate_at(pieces: Sequence[Piece], s: float, Z: float, stacking: str = "middle") -> tuple[Layer, ...]:
    """The layers at a point, inner first."""
    at = next(number for number, piece in enumerate(pieces) if piece.name == "film")
    film, within = pieces[at], sum(piece.thickness_mm for piece in pieces[:at])
    outside = (-film.thickness_mm / 2 if film.covers(s, Z) else film.thickness_mm / 2) - within
    layers = []
    for piece in pieces:
        if piece.covers(s, Z):
            bottom = outside if stacking == "outside" else -piece.thickness_mm / 2
            layers.append(Layer(piece.name, piece.law, bottom, bottom + piece.thickness_mm))
            outside += piece.thickness_mm
    return tuple(layers)
