"""Laminates of a tube as materials and shell section cards, alike in Abaqus and CalculiX but for what is said below.

A film that is laminated on fabric follows its small strains and carries a few per cent of the load. In a CalculiX
composite one solid element spans all layers and its thickness strain is linear across them, so a nearly incompressible
layer would lock; there the film has BONDED_BULK_OVER_SHEAR instead (Poisson's ratio 0.45).
"""

from __future__ import annotations

from benchlab.deck.grid import IntArray
from benchlab.deck.materials import material_card
from benchlab.deck.solid import Solid
from benchlab.deck.tube import Tube
from benchlab.simulation.laws import Law, StVenantKirchhoff

BONDED_BULK_OVER_SHEAR = 10.0
CAP_LAW = StVenantKirchhoff(2.0e5, 0.3)


class Materials:
    """Names for laws, in the order in which they are asked for."""

    def __init__(self) -> None:
        self.cards: dict[tuple[Law, float], str] = {}

    def name(self, law: Law, bulk_over_shear: float) -> str:
        elastic = isinstance(law, StVenantKirchhoff)
        key = (law, 0.0 if elastic else bulk_over_shear)
        kind = "ELASTIC" if elastic else "RUBBER"
        return self.cards.setdefault(key, f"{kind}_{len(self.cards) + 1}")

    def lines(self) -> list[str]:
        cards = ([f"*MATERIAL, NAME={name}", *material_card(law, bulk)] for (law, bulk), name in self.cards.items())
        return [line for card in cards for line in card]


def section_lines(tube: Tube, bulk_over_shear: float, bonded_bulk_over_shear: float) -> list[str]:
    """Materials, then a section card for each laminate and the cap; element sets must have been written before."""
    materials, cards = Materials(), []
    for section in (*tube.sections, *tube.overlays):
        if len(section.layers) == 1:
            (layer,) = section.layers
            name = materials.name(layer.law, bonded_bulk_over_shear if section.bonded else bulk_over_shear)
            cards += [f"*SHELL SECTION, ELSET={section.name}, MATERIAL={name}", f"{section.thickness_mm:.9g}"]
            continue
        cards.append(f"*SHELL SECTION, ELSET={section.name}, COMPOSITE")
        for layer in section.layers:
            name = materials.name(layer.law, bonded_bulk_over_shear)
            cards.append(f"{layer.top_mm - layer.bottom_mm:.9g}, , {name}")
    name = materials.name(CAP_LAW, 0)
    cards += [f"*SHELL SECTION, ELSET=CAP, MATERIAL={name}", f"{tube.cap_thickness_mm:g}"]
    return [*materials.lines(), *cards]


def set_lines(keyword: str, name: str, numbers: IntArray) -> list[str]:
    """*NSET or *ELSET with sixteen numbers a line."""
    rows = [numbers[i : i + 16] for i in range(0, len(numbers), 16)]
    return [f"*{keyword}, {keyword}={name}", *(", ".join(map(str, row)) for row in rows)]


def mesh_lines(tube: Tube, quad: str, triangle: str) -> list[str]:
    """Nodes, elements and sets; WALL, CAP, CAP_LOADED, a set for each laminate, and the node sets."""
    lines = ["*NODE"]
    lines += [f"{k}, {x:.9g}, {y:.9g}, {z:.9g}" for k, (x, y, z) in enumerate(tube.nodes_mm, start=1)]
    for kind, elements, first in ((quad, tube.quads, 1), (triangle, tube.triangles, len(tube.quads) + 1)):
        lines.append(f"*ELEMENT, TYPE={kind}")
        lines += [f"{k}, {', '.join(map(str, row))}" for k, row in enumerate(elements, start=first)]
    groups = {"WALL": tube.wall, "CAP": tube.cap, "CAP_LOADED": tube.cap_loaded}
    groups |= {section.name: section.elements for section in (*tube.sections, *tube.overlays)}
    for name, numbers in groups.items():
        lines += set_lines("ELSET", name, numbers)
    for name, numbers in tube.node_sets.items():
        lines += set_lines("NSET", name, numbers)
    return lines


def solid_lines(solid: Solid, bulk_over_shear: float) -> list[str]:
    """Nodes, elements, sets, materials and sections of solids; LOADED has pressure on its first face."""
    lines = ["*NODE"]
    lines += [f"{k}, {x:.9g}, {y:.9g}, {z:.9g}" for k, (x, y, z) in enumerate(solid.nodes_mm, start=1)]
    for kind, elements, first in (("C3D20R", solid.bricks, 1), ("C3D15", solid.wedges, len(solid.bricks) + 1)):
        lines.append(f"*ELEMENT, TYPE={kind}")
        for number, row in enumerate(elements, start=first):
            lines += [f"{number}, {', '.join(map(str, row[:10]))},", ", ".join(map(str, row[10:]))]
    lines += set_lines("ELSET", "CAP", solid.cap) + set_lines("ELSET", "LOADED", solid.loaded)
    for name, numbers in solid.node_sets.items():
        lines += set_lines("NSET", name, numbers)
    materials, cards = Materials(), []
    for law, numbers in solid.laws.items():
        name = materials.name(law, bulk_over_shear)
        cards += [
            *set_lines("ELSET", f"LAYERS_{name}", numbers),
            f"*SOLID SECTION, ELSET=LAYERS_{name}, MATERIAL={name}",
        ]
    cards.append(f"*SOLID SECTION, ELSET=CAP, MATERIAL={materials.name(CAP_LAW, 0)}")
    return lines + materials.lines() + cards
