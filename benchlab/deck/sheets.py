"""The tube's layers as shells of their own that share their nodes, all centred on the reference surface.

Where sections of one thickness meet, CalculiX expands a shell node once for all of them, so there are no rigid knots at the
borders of the windows and no steps in the inner face: the cleanest model of a shell in that engine, at the price of layers
that lie in one another instead of on one another.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from benchlab.deck.tube import Section, Tube
from benchlab.errors import UsageError


def sheets_of(tube: Tube) -> Tube:
    """A tube with a section for each layer. Raises UsageError where layers differ in thickness."""
    found = sorted({round(layer.top_mm - layer.bottom_mm, 9) for section in tube.sections for layer in section.layers})
    if len(found) > 1:
        raise UsageError(
            f"layers of {' and '.join(f'{t:g}' for t in found)} mm cannot share the nodes of sheets",
            hint="use solid or shell elements",
        )
    half, walls = found[0] / 2, len(tube.quads)
    first, overlays, quads = [], [], [tube.quads]
    number = walls + 1
    for section in tube.sections:
        layers = [replace(layer, bottom_mm=-half, top_mm=half) for layer in section.layers]
        first.append(Section(section.name, (layers[0],), section.elements, bonded=len(layers) > 1))
        for k, layer in enumerate(layers[1:], start=2):
            elements = np.arange(number, number + len(section.elements))
            overlays.append(Section(f"{section.name}_{k}", (layer,), elements, bonded=True))
            quads.append(tube.quads[section.elements - 1])
            number += len(section.elements)
    moved = number - walls - 1  # triangles are numbered after all quads
    return replace(
        tube,
        quads=np.vstack(quads),
        sections=tuple(first),
        overlays=tuple(overlays),
        cap=np.where(tube.cap > walls, tube.cap + moved, tube.cap),
        cap_loaded=np.where(tube.cap_loaded > walls, tube.cap_loaded + moved, tube.cap_loaded),
    )
