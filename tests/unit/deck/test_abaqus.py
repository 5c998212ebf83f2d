"""The Abaqus deck, by a small reader of keyword files: it is never run here."""

import re
from itertools import pairwise

import numpy as np
import pytest

from benchlab.actuator import ShellDesign
from benchlab.deck.abaqus import abaqus_deck
from benchlab.deck.tube import Extent, tube_of
from benchlab.simulation.laws import Polynomial
from benchlab.simulation.layup import Layup

KNOWN = {
    "HEADING", "NODE", "ELEMENT", "NSET", "ELSET", "MATERIAL", "HYPERELASTIC", "ELASTIC", "SHELL SECTION", "SURFACE",
    "FLUID BEHAVIOR", "FLUID DENSITY", "FLUID CAVITY", "BOUNDARY", "AMPLITUDE", "TIME POINTS", "STEP", "STATIC", "DSLOAD",
    "OUTPUT", "NODE OUTPUT", "ELEMENT OUTPUT", "NODE PRINT", "END STEP",
}  # fmt: skip
HISTORY = {"STATIC", "DSLOAD", "OUTPUT", "NODE OUTPUT", "ELEMENT OUTPUT", "NODE PRINT", "END STEP"}
Block = tuple[str, dict[str, str], list[list[str]]]


def blocks(deck: str) -> list[Block]:
    """Keyword, parameters and data lines, in order."""
    found: list[Block] = []
    for line in deck.splitlines():
        if line.startswith("**") or not line.strip():
            continue
        if line.startswith("*"):
            keyword, *parameters = (part.strip() for part in line[1:].split(","))
            found.append((keyword, dict(p.partition("=")[::2] for p in parameters), []))
        else:
            found[-1][2].append([part.strip() for part in line.split(",")])
    return found


@pytest.fixture(scope="module", params=[True, False], ids=["cavity", "pressure"])
def deck(request: pytest.FixtureRequest) -> list[Block]:
    layup = Layup("test", "guess", film=Polynomial(C10=1.5, C20=3.0))
    tube = tube_of(ShellDesign(strip_width_mm=10, window_width_mm=3), layup, Extent(2))
    return blocks(abaqus_deck(tube, [0.1, 0.35], ["title", "more"], fluid_cavity=request.param))


def numbers(deck: list[Block], keyword: str, name: str) -> set[int]:
    return {int(n) for k, p, rows in deck if k == keyword and p.get(keyword) == name for row in rows for n in row}


def test_keywords_are_known_and_in_model_or_step(deck: list[Block]) -> None:
    names = [keyword for keyword, _, _ in deck]
    assert set(names) <= KNOWN and names[0] == "HEADING" and names[-1] == "END STEP"
    step = names.index("STEP")
    assert not HISTORY & set(names[:step]) and set(names[step + 1 :]) <= HISTORY | {"BOUNDARY"}


def test_all_that_is_used_is_defined(deck: list[Block]) -> None:
    nodes = {int(row[0]) for k, _, rows in deck if k == "NODE" for row in rows}
    elements = {int(row[0]): [int(n) for n in row[1:]] for k, _, rows in deck if k == "ELEMENT" for row in rows}
    assert {n for row in elements.values() for n in row} <= nodes
    assert {len(row) for row in elements.values()} == {3, 4}
    sets = {p[k]: k for k, p, _ in deck if k in ("NSET", "ELSET")} | {
        p["NSET"]: "NSET" for k, p, _ in deck if k == "NODE" and p
    }
    for name, kind in sets.items():
        assert numbers(deck, kind, name) <= (nodes if kind == "NSET" else elements.keys())
    used = {row[0] for k, _, rows in deck if k == "BOUNDARY" for row in rows}
    used |= {
        p[x] for k, p, _ in deck for x in ("NSET", "ELSET") if k.endswith(("PRINT", "OUTPUT", "SECTION")) and x in p
    }
    used |= {row[0] for k, _, rows in deck if k == "SURFACE" for row in rows}
    assert used <= sets.keys()
    sections = [numbers(deck, "ELSET", p["ELSET"]) for k, p, _ in deck if k == "SHELL SECTION"]
    assert sum(map(len, sections)) == len(set().union(*sections)) == len(elements)
    materials = {p["NAME"] for k, p, _ in deck if k == "MATERIAL"}
    named = {p["MATERIAL"] for k, p, _ in deck if k == "SHELL SECTION" and "MATERIAL" in p}
    named |= {row[2] for k, p, rows in deck if k == "SHELL SECTION" and "COMPOSITE" in p for row in rows}
    assert named == materials
    fluids = {p["NAME"] for k, p, _ in deck if k == "FLUID BEHAVIOR"}
    assert {p["BEHAVIOR"] for k, p, _ in deck if k == "FLUID CAVITY"} == fluids


def test_the_inside_is_closed_and_its_normals_point_in(deck: list[Block]) -> None:
    """The surface's side SNEG looks against the element's normal; its volume by the divergence theorem is then negative."""
    at = {int(row[0]): np.array(row[1:], float) for k, _, rows in deck if k == "NODE" for row in rows}
    elements = {int(row[0]): [int(n) for n in row[1:]] for k, _, rows in deck if k == "ELEMENT" for row in rows}
    (surface,) = (rows for k, _, rows in deck if k == "SURFACE")
    volume, edges = 0.0, {}
    for name, side in surface:
        assert side == "SNEG"
        for number in numbers(deck, "ELSET", name):
            row = elements[number][::-1]  # seen from the other side
            for a, b in zip(row, row[1:] + row[:1]):
                edges[a, b] = edges.get((a, b), 0) + 1
            p = [at[n] for n in row]
            volume += sum(np.cross(q - p[0], r - p[0])[1] / 2 * (p[0] + q + r)[1] / 3 for q, r in pairwise(p[1:]))
    assert volume == pytest.approx(-np.pi * (20 / np.pi) ** 2 / 2 * 11, rel=0.01)
    assert set(edges.values()) == {1}  # neighbours run along a shared edge in opposite ways: one orientation
    for a, b in edges:
        on_mirror = max(abs(at[a][1]), abs(at[b][1])) < 1e-6 or max(at[a][2], at[b][2]) < 1e-6
        assert ((b, a) in edges) or on_mirror
    for reference in (p["REF NODE"] for k, p, _ in deck if k == "FLUID CAVITY"):
        (rows,) = (rows for k, p, rows in deck if k == "NODE" and p.get("NSET") == reference)
        assert [float(x) for x in rows[0][2:]] == [0, 0]  # on both mirror planes


def test_pressure_reaches_its_last_value_at_the_end(deck: list[Block]) -> None:
    loads = [rows[0] for k, p, rows in deck if k in ("BOUNDARY", "DSLOAD") and "AMPLITUDE" in p]
    assert loads in ([["CAVITY", "8", "8", "0.35"]], [["INSIDE", "P", "0.35"]])
    (points,) = (rows for k, _, rows in deck if k == "TIME POINTS")
    assert [float(row[0]) for row in points] == pytest.approx([0.1 / 0.35, 1.0])
    (hyper,) = (rows for k, _, rows in deck if k == "HYPERELASTIC")
    assert [float(x) for x in hyper[0]] == [1.5, 0, 3, 0, 0, 0, 0]
    assert re.fullmatch(r"title", next(rows for k, _, rows in deck if k == "HEADING")[0][0])
