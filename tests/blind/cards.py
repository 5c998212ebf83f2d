"""The cases: for tuning, for calibration (mostly nothing hidden) and for scoring, of disjoint seeds.

A case is a seed and what is hidden in it; `Case.study()` draws the study.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np

from tests.blind.generator.hidden.catalogue import KNOWN, UNKNOWN
from tests.blind.generator.setting import Layout
from tests.blind.generator.study import Study, study, truth

FIRST_SEED = {"tune": 1_000_000, "calibrate": 2_000_000, "score": 7_000_000}
"""Each card has a million seeds of its own. Three, five and six million were scoring cards whose answers were seen."""
STRENGTHS = (1.0, 2.0, 4.0)


@dataclass(frozen=True)
class Case:
    """kind: null, single, unknown, two, pair. rival: of a pair, what the data cannot tell from the truth.

    separated_by: what would tell them apart: protocol, length, orientation, designs, or nothing (""); how: in words.
    """

    name: str
    seed: int
    kind: str
    names: tuple[str, ...] = ()
    strengths: tuple[float, ...] = ()
    layout: Layout = field(default_factory=Layout)
    forms: tuple[tuple[str, str, Any], ...] = ()
    rival: str = ""
    separated_by: str = ""
    how: str = ""

    @property
    def truth(self) -> frozenset[str]:
        """What is to be named: nothing where nothing is hidden, or nothing that has a name."""
        return frozenset(self.names) if self.kind in {"single", "two", "pair"} else frozenset()

    def answer(self) -> dict[str, Any]:
        """That of its study, which is not drawn for it."""
        return truth(self.seed, self.names, self.strengths, self.layout, self.forms).answer

    def study(self) -> Study:
        return study(self.seed, self.names, self.strengths, self.layout, self.forms)


@dataclass(frozen=True)
class Pair:
    """Two effects that look alike with a layout. forms: (effect, field, value) that make them so."""

    first: str
    second: str
    layout: Layout
    separated_by: str
    how: str
    forms: tuple[tuple[str, str, Any], ...] = ()


ONE = (1,)
PAIRS = (
    Pair(
        "end_caps",
        "camera_scale",
        Layout(),
        "length",
        "no pressure tells them apart; rigid ends take more from a shorter actuator, a wrong scale does not",
        (("camera_scale", "longer", True),),
    ),
    Pair(
        "pressure_gain",
        "leakage",
        Layout(),
        "",
        "a leak behind the regulator takes its part of any pressure; only a valve closed in a hold would tell",
        (("pressure_gain", "high", True), ("leakage", "form", "laminar")),
    ),
    Pair(
        "pressure_offset",
        "dead_pressure",
        Layout(),
        "",
        "the same wherever the pressure passes p0; below it nothing bends in either case",
        (("pressure_offset", "high", True), ("dead_pressure", "form", "kink")),
    ),
    Pair(
        "regulator_lag",
        "line_resistance",
        Layout(designs=ONE),
        "designs",
        "one design has nearly one dV/dp above the first pressures; a design of wider windows has another",
    ),
    Pair(
        "camera_scale",
        "pressure_gain",
        Layout(designs=(0,)),
        "designs",
        "where the curve is nearly straight, more angle is more pressure; designs with curved curves tell",
        (("camera_scale", "longer", True), ("pressure_gain", "high", True)),
    ),
    Pair(
        "seam_margin",
        "bladder_stiffness",
        Layout(designs=ONE),
        "designs",
        "both make one design stiffer; narrow and wide windows feel a margin differently",
        (("seam_margin", "where", "even"), ("bladder_stiffness", "form", "film")),
    ),
    Pair(
        "gravity",
        "bladder_stiffness",
        Layout(designs=ONE, orientations_deg=(0.0,)),
        "orientation",
        "a hanging actuator is held back by its weight as by a spring; standing, the weight helps",
        (("bladder_stiffness", "form", "spring"),),
    ),
    Pair(
        "regulator_lag",
        "clock_offset",
        Layout(runs=("fast",)),
        "protocol",
        "behind ramps of one rate a lag is a delay; after a step it is a curve",
        (("clock_offset", "behind", False),),
    ),
    Pair(
        "friction",
        "viscoelasticity",
        Layout(runs=("fast",)),
        "protocol",
        "one rate has one loop; at another the creep's changes and the friction's stays, and in a hold only creep goes on",
    ),
    Pair(
        "softening",
        "friction",
        Layout(runs=("slow",)),
        "protocol",
        "the first loop looks alike; in a second cycle to the same pressure softening leaves none",
        (("softening", "form", "ogden-roxburgh"),),
    ),
    Pair(
        "viscoelasticity",
        "regulator_lag",
        Layout(runs=("fast",)),
        "protocol",
        "at one rate both come late; in a hold the lag is over in a second and the creep goes on",
        (("viscoelasticity", "form", "prony-pressure"), ("viscoelasticity", "slow", True)),
    ),
)

GROUPS = (
    ("viscoelasticity", "softening", "friction"),
    ("seam_margin", "bladder_stiffness", "fabric_compliance"),
    ("pressure_gain", "pressure_offset", "dead_pressure"),
    ("camera_scale", "camera_tilt", "marker_offset", "end_caps"),
    ("regulator_lag", "clock_offset", "line_resistance"),
    ("gravity",),
    ("temperature",),
    ("frame_compliance",),
)
"""Two effects hidden in one study come from two of these; and not both from those that only make every angle smaller or larger."""
_STATIC = {1, 2, 3}


def cases(card: str) -> tuple[Case, ...]:
    """All cases of a card: tune, calibrate or score."""
    seeds = iter(range(FIRST_SEED[card], FIRST_SEED[card] + 1_000_000))
    rng = np.random.default_rng(FIRST_SEED[card])
    build = {
        "tune": (40, 1, 3, 18, 1),
        "calibrate": (280, 0, 0, 0, 0),
        "score": (170, 4, 9, 66, 3),
    }
    nulls, singles, unknowns, twos, pairs = build[card]
    found = [*_nulls(nulls, rng), *_singles(singles, rng), *_unknowns(unknowns, rng), *_twos(twos, rng)]
    found += _pairs(pairs, rng)
    if card == "calibrate":
        found += [replace(case, name=f"{case.name}-c") for case in _singles(1, rng)]
    return tuple(replace(case, seed=next(seeds)) for case in found)


def _nulls(count: int, rng: np.random.Generator) -> Iterator[Case]:
    for number in range(count):
        layout = _layout(rng)
        if rng.random() < 0.12:
            layout = replace(layout, runs=(*layout.runs, "blocked"))
        if rng.random() < 0.15:
            layout = replace(layout, session=True, temperature=True, warming=True)
        if rng.random() < 0.15:
            layout = replace(layout, orientations_deg=(0.0, 180.0))
        yield Case(f"null-{number:03d}", 0, "null", layout=layout)


def _singles(count: int, rng: np.random.Generator) -> Iterator[Case]:
    for name in KNOWN:
        for strength in STRENGTHS:
            for number in range(count):
                layout = _fitting((name,), _layout(rng), rng)
                yield Case(f"{name}-{strength:g}x-{number}", 0, "single", (name,), (strength,), layout)


def _unknowns(count: int, rng: np.random.Generator) -> Iterator[Case]:
    for name in UNKNOWN:
        for number in range(count):
            strength = (2.0, 3.0, 4.0)[number % 3]
            layout = replace(_fitting((name,), _layout(rng), rng), session=True)
            yield Case(f"unknown-{name}-{strength:g}x-{number}", 0, "unknown", (name,), (strength,), layout)


def _twos(count: int, rng: np.random.Generator) -> Iterator[Case]:
    number = 0
    while number < count:
        first, second = (int(i) for i in rng.choice(len(GROUPS), 2, replace=False))
        if {first, second} <= _STATIC:
            continue
        names = tuple(str(rng.choice(GROUPS[i])) for i in (first, second))
        strengths = ((4.0, 4.0), (4.0, 2.0), (2.0, 4.0))[number % 3]
        layout = _fitting(names, Layout(), rng)
        yield Case(f"two-{number:02d}-{names[0]}-{names[1]}", 0, "two", names, strengths, layout)
        number += 1


def _pairs(count: int, rng: np.random.Generator) -> Iterator[Case]:
    for pair in PAIRS:
        for true, rival in ((pair.first, pair.second), (pair.second, pair.first)):
            for number in range(count):
                forms = tuple(form for form in pair.forms if form[0] == true)
                strength = float(rng.choice([3.0, 4.0]))
                layout = replace(pair.layout, command=bool(rng.integers(2)))
                name = f"pair-{true}-{rival}-{number}"
                yield Case(name, 0, "pair", (true,), (strength,), layout, forms, rival, pair.separated_by, pair.how)


def _layout(rng: np.random.Generator) -> Layout:
    """Mostly the standard study; some are smaller, unordered or of two lengths; what is written down besides varies."""
    kinds = {
        "standard": Layout(),
        "three samples": Layout(samples=3),
        "small": Layout(designs=(0, 1, 3), samples=int(rng.integers(2, 4))),
        "other designs": Layout(designs=(1, 2, 4), samples=4),
        "unordered": Layout(ordered=False),
        "two runs": Layout(runs=("slow", "fast")),
        "two lengths": Layout(designs=(1, 2, 3), samples=3, lengths_mm=(180.0, 120.0)),
    }
    name = str(rng.choice(list(kinds), p=[0.5, 0.1, 0.08, 0.08, 0.08, 0.08, 0.08]))
    return replace(
        kinds[name],
        session=bool(rng.random() < 0.3),
        temperature=bool(rng.random() < 0.3),
        command=bool(rng.random() < 0.3),
        orientations_deg=(0.0,) if rng.random() < 0.3 else (),
    )


def _fitting(names: tuple[str, ...], layout: Layout, rng: np.random.Generator) -> Layout:
    """With what a bench would have where these effects can be seen at all."""
    if "gravity" in names:
        turns = ((0.0,), (180.0,), (0.0, 180.0), (0.0, 90.0))
        layout = replace(layout, orientations_deg=turns[int(rng.integers(len(turns)))])
    if "temperature" in names:
        layout = replace(layout, session=True, temperature=bool(rng.random() < 0.8), warming=True)
    if "frame_compliance" in names:
        layout = replace(layout, runs=(*layout.runs, "blocked"))
    if "leakage" in names and rng.random() < 0.25:
        layout = replace(layout, runs=tuple("shut" if run == "hold" else run for run in layout.runs))
    if {"ratchet", "layer_slip"} & set(names):
        layout = replace(layout, ordered=True)
    return layout
