"""A tube as an Abaqus/Standard deck: finite-strain shells S4R and S3R around a fluid cavity of prescribed pressure.

Abaqus' S8R takes no hyperelastic material, so every eight-node shell is cut into four S4R over its nodes and its centre.
The cavity is bounded by the reference surface, the cap and the two mirror planes, on which its reference node lies.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from benchlab.deck.grid import IntArray
from benchlab.deck.sections import mesh_lines, section_lines
from benchlab.deck.tube import Tube

QUAD_PARTS = ((0, 4, 8, 7), (4, 1, 5, 8), (8, 5, 2, 6), (7, 8, 6, 3))
TRIANGLE_PARTS = ((0, 3, 5), (3, 1, 4), (5, 4, 2), (3, 4, 5))


def abaqus_deck(
    tube: Tube, pressures_MPa: Sequence[float], heading: Sequence[str] = (), fluid_cavity: bool = True
) -> str:
    """The deck's text: pressure grows to the last of `pressures_MPa` (increasing, > 0); displacements of the rib
    mid-planes go to the .dat file at each of them. fluid_cavity: else pressure on the inner faces (follower load)."""
    fine = cut_in_four(tube)
    last = pressures_MPa[-1]
    times = np.asarray(pressures_MPa) / last
    cavity = len(fine.nodes_mm) + 1
    lines = ["*HEADING", heading[0] if heading else "benchlab"]
    lines += [f"** {line}".rstrip() for line in heading[1:]]
    lines += mesh_lines(fine, "S4R", "S3R")
    lines += section_lines(fine, np.inf, np.inf)
    lines += ["*SURFACE, TYPE=ELEMENT, NAME=INSIDE", "WALL, SNEG", "CAP, SNEG"]
    if fluid_cavity:
        lines += [f"*NODE, NSET=CAVITY\n{cavity}, 0, 0, 0", "*FLUID BEHAVIOR, NAME=FLUID", "*FLUID DENSITY", "1e-9"]
        lines += ["*FLUID CAVITY, NAME=BLADDER, BEHAVIOR=FLUID, REF NODE=CAVITY, SURFACE=INSIDE"]
    lines += ["*BOUNDARY", "MIRROR_Y, YSYMM", "MIRROR_Z, ZSYMM", "HOLD_X, 1, 1"]
    lines += ["*AMPLITUDE, NAME=RAMP", "0, 0, 1, 1", "*TIME POINTS, NAME=PRESSURES", *(f"{t:.9g}" for t in times)]
    lines += ["*STEP, NLGEOM=YES, INC=1000", "*STATIC", "0.01, 1., 1e-8, 0.1"]
    if fluid_cavity:
        lines += ["*BOUNDARY, AMPLITUDE=RAMP", f"CAVITY, 8, 8, {last:.9g}"]
    else:
        lines += ["*DSLOAD, AMPLITUDE=RAMP, FOLLOWER=YES", f"INSIDE, P, {last:.9g}"]
    lines += ["*OUTPUT, FIELD, TIME POINTS=PRESSURES", "*NODE OUTPUT", "U", "*ELEMENT OUTPUT", "S, LE"]
    if fluid_cavity:
        lines += ["*OUTPUT, HISTORY, TIME POINTS=PRESSURES", "*NODE OUTPUT, NSET=CAVITY", "PCAV, CVOL"]
    for name in (name for name in tube.node_sets if name.startswith("RIB_")):
        lines += [f"*NODE PRINT, NSET={name}, TOTALS=NO, SUMMARY=NO", "U"]
    return "\n".join([*lines, "*END STEP", ""])


def cut_in_four(tube: Tube) -> Tube:
    """The same tube in four-node quads and three-node triangles: element e becomes 4e − 3 ... 4e; nodes are added at the
    centres of the quads, and to the node sets of the mirror planes none, since no centre lies on them."""
    corners, middles = tube.nodes_mm[tube.quads[:, :4] - 1], tube.nodes_mm[tube.quads[:, 4:] - 1]
    centres = middles.sum(axis=1) / 2 - corners.sum(axis=1) / 4
    number = len(tube.nodes_mm) + 1 + np.arange(len(centres))
    nine = np.column_stack([tube.quads, number])
    nodes = np.vstack([tube.nodes_mm, centres])
    return replace(
        tube,
        nodes_mm=nodes,
        quads=nine[:, QUAD_PARTS].reshape(-1, 4),
        triangles=tube.triangles[:, TRIANGLE_PARTS].reshape(-1, 3),
        sections=tuple(replace(section, elements=_parts(section.elements)) for section in tube.sections),
        cap=_parts(tube.cap),
        cap_loaded=_parts(tube.cap_loaded),
        node_sets={**tube.node_sets, "ALL": np.arange(1, len(nodes) + 1)},
    )


def _parts(elements: IntArray) -> IntArray:
    return (4 * np.asarray(elements)[:, None] + np.arange(-3, 1)).ravel()
