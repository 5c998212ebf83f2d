"""Drawn explanations for tests of the report: curves of which every number is known, with each verdict."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import Any

import numpy as np

from benchlab.discrepancy.effects.catalogue import built_in
from benchlab.discrepancy.explanation import (
    Curves,
    Estimate,
    Explanation,
    Found,
    Gap,
    HeldOut,
    NextExperiment,
    Region,
    Tried,
)
from benchlab.protocol.plan import Plan
from benchlab.report.document import Document
from benchlab.report.explain.document import explain_document

NAN = float("nan")
PAPER = {"tw3_slw5": 119.5, "tw3_slw10": 130.2, "tw3_slw20": 62.4, "tw9_slw10": 84.6, "tw15_slw10": 55.7}
PUBLISHED = (("tw3_slw5", 110.2, 119.5, 1.9), ("tw3_slw10", 125.7, 130.2, 4.0), ("tw3_slw20", 60.3, 62.4, 3.6),
             ("tw9_slw10", 79.9, 84.6, 1.7), ("tw15_slw10", 56.7, 55.7, 2.9))  # fmt: skip
RATES = (0.01, 0.12)
TOP_MPa = 0.35


def curves(designs: dict[str, float] | None = None, quantity: str = "angle_deg", rates: Sequence[float] = RATES, cycles: int = 1,
           bins: int = 8, hold: bool = True, loop: float = 0.05, left: float = 0.15) -> Curves:  # fmt: skip
    """Simulated a·p/0.35; measured loop·a below it in loading, above it in unloading and falling behind in holds, with SD 2 % of a;
    explained: a share `left` of the gap remains."""
    rows: list[tuple[Any, ...]] = []
    for design, a in (designs or PAPER).items():
        parts = [(f"{TOP_MPa} MPa at {rate:g} MPa/s", d, rate) for rate in rates for d in ("loading", "unloading")]
        for kind, direction, rate in parts + [(f"held at {TOP_MPa} MPa", "hold", NAN)] * hold:
            for cycle in range(1, cycles + 1):
                for share in np.arange(1, bins + 1) / bins:
                    p = TOP_MPa if direction == "hold" else TOP_MPa * share
                    simulated = a * p / TOP_MPa
                    gap = -loop * a * {"loading": share, "unloading": -0.8 * share, "hold": 1 - share / 2}[direction]
                    time, p_value = 30 * share if direction == "hold" else 0.0, 0.003 if share > 0.5 else 0.4
                    rows.append((design, quantity, kind, direction, cycle, rate, p, time, simulated + gap, 0.02 * a, 5.0, simulated,
                                 simulated + (1 - left) * gap, p_value))  # fmt: skip
    return of_rows(rows)


def of_rows(rows: Sequence[tuple[Any, ...]]) -> Curves:
    columns = [*zip(*rows)]
    return Curves(*(np.array(column) for column in columns[:4]), np.array(columns[4], dtype=np.int64),
                  *(np.array(column, dtype=float) for column in columns[5:]))  # fmt: skip


def regions(found: Curves) -> tuple[Region, ...]:
    """The upper half of every design, direction and rate, with the gap of `curves`."""
    where = []
    for design in dict.fromkeys(found.design.tolist()):
        for direction in ("loading", "unloading"):
            for rate in RATES:
                kept = (
                    (found.design == design)
                    & (found.direction == direction)
                    & (found.rate_MPa_s == rate)
                    & (found.p < 0.05)
                )
                p = found.pressure_MPa[kept]
                gap = float((found.measured - found.simulated)[kept].mean())
                where.append(
                    Region(design, "angle_deg", direction, rate, None, (float(p.min()), float(p.max())), gap, 0.009)
                )
    return tuple(where)


FRICTION = Found(
    "friction", "dahl", {"half_width_deg": Estimate(5.21, 4.4, 6.1, "deg", "half width of the loop at full pressure"),
                         "growth": Estimate(1.0, NAN, NAN, "", "growth of the width with pressure", True)}, 0.834, ("play",),
)  # fmt: skip
SOFTENING = Found(
    "softening", "plain", {"share": Estimate(0.081, 0.052, 0.11, "1", "share of the stiffness that is lost")}, 0.09
)
GAIN = Found("pressure_gain", "plain", {"gain": Estimate(1.05, 1.02, 1.08, "", "reading over true pressure")}, 0.74)
TRIED = (
    Tried(("friction",), "dahl", -84.2, 0.834, 0.41, True, ""),
    Tried(("viscoelasticity",), "prony", -61.7, 0.71, 0.0004, False, "the loop does not widen with the rate (Δ 22.5)"),
    Tried(("seam_margin",), "plain", -3.1, 0.04, 0.0, False, "moves both directions alike"),
)
GAP = Gap(4.8, 0.72, 4.9, 1.34, 1.21, 0.93)
NEXT = NextExperiment("next.yaml", "friction | viscoelasticity", 4.2, "Turn the mounting by 180°.")


def explanation(**changes: Any) -> Explanation:
    found = curves()
    given: dict[str, Any] = {
        "verdict": "named", "where": regions(found), "effects": (FRICTION,), "rivals": (("friction",),), "gap": GAP, "p_gap": 0.0002,
        "false_naming": 0.034, "tried": TRIED,
        "judged_not": {"temperature": "no temperature and no order of runs is known", "frame_compliance": "no force was measured"},
        "remainder": (), "held_out": held_out(), "curves": found, "warnings": ("tw9_slw10: 1 of 5 samples has no slow run",),
        "base": "cell", "source": "measured.csv", "simulated": False, "samples": 25, "next_experiment": None,
    }  # fmt: skip
    return Explanation(**{**given, **changes})


def held_out() -> tuple[HeldOut, ...]:
    samples = [HeldOut("sample", f"s{i}", 4.9 + 0.1 * i, 1.3 + 0.05 * i, 1.21) for i in range(1, 6)]
    designs = [HeldOut("design", name, 0.04 * a, 0.012 * a, 1.21) for name, a in PAPER.items()]
    return (*samples, *designs, *(HeldOut("rate", f"{rate:g} MPa/s", 4.8, 1.5, 1.21) for rate in RATES))


def agreeing() -> Explanation:
    found = curves(loop=0.004, left=1.0)
    quiet = replace(found, p=np.full(len(found.p), 0.6), explained=found.simulated)
    return explanation(
        verdict="agree", where=(), effects=(), rivals=(), gap=Gap(0.32, 0.32, 1.3, 1.3, 1.21, NAN), p_gap=0.47, tried=(),
        curves=quiet, held_out=(), warnings=(),
    )  # fmt: skip


def ambiguous() -> Explanation:
    rivals = (("friction", "softening"), ("viscoelasticity", "seam_margin"), ("regulator_lag",))
    both = Tried(("friction", "softening"), "dahl, plain", -90.1, 0.93, 0.5, True, "")
    tried = (both, TRIED[0], Tried(rivals[1], "prony, plain", -83.9, 0.83, 0.3, True, ""),
             Tried(rivals[2], "plain", -83.0, 0.82, 0.2, True, ""),
             TRIED[2])  # fmt: skip
    return explanation(
        verdict="ambiguous", rivals=rivals, tried=tried, effects=(FRICTION, SOFTENING), next_experiment=NEXT
    )


def unexplained() -> Explanation:
    found = curves(left=1.0)
    return explanation(
        verdict="unexplained", effects=(), rivals=(), curves=found, gap=replace(GAP, rmse_after=4.8, heldout_after=4.9),
        remainder=("grows with the cycle: −0.6° from one to the next (p = 0.002)", "is largest in tw3_slw10"), held_out=(),
        next_experiment=NextExperiment("", "", NAN, cannot="no protocol within 0.35 MPa parts them; a second length would"),
    )  # fmt: skip


def published() -> Explanation:
    """The paper's table: one pressure, no direction, rate or cycle; measured − FEM."""
    p = (0.0001, 0.009, 0.26, 0.008, 0.46)
    found = of_rows([(d, "angle_deg", "means", "all", 0, NAN, 0.35, 0.0, m, sd, 5.0, fem, fem * 0.952, each)
                     for (d, m, fem, sd), each in zip(PUBLISHED, p)])  # fmt: skip
    where = tuple(Region(d, "angle_deg", "all", None, None, (0.35, 0.35), m - fem, each)
                  for (d, m, fem, _), each in zip(PUBLISHED, p) if each < 0.05)  # fmt: skip
    unseen = "one pressure, no direction, rate or cycle"
    return explanation(
        verdict="ambiguous", where=where, effects=(GAIN,), rivals=(("pressure_gain",), ("fabric_compliance",), ("end_caps",)),
        gap=Gap(5.14, 2.6, NAN, NAN, 2.96, NAN), p_gap=0.00004, false_naming=NAN, curves=found, held_out=(), samples=25,
        judged_not=dict.fromkeys(("viscoelasticity", "softening", "friction", "regulator_lag"), unseen),
        next_experiment=replace(NEXT, protocol="protocol:\n  title: x\n"), warnings=(),
    )  # fmt: skip


def crowded() -> Explanation:
    """Fourteen designs with words for names, forces beside angles, five rates, four cycles."""
    names = {f"gripper finger {i} of <b>soft</b> & thin $x_{{{i}$": 40.0 + 6 * i for i in range(14)}
    angle = curves(names, rates=(0.005, 0.01, 0.03, 0.1, 0.3), cycles=4)
    force = curves({name: a / 20 for name, a in names.items()}, "force_N", rates=(0.01,), hold=False)
    lift = curves({name: a / 3 for name, a in names.items()}, "lift_mm", rates=(0.01,), hold=False)
    both = of_rows([*_rows(angle), *_rows(force), *_rows(lift)])
    where = tuple(
        Region(name, quantity, "loading", None, None, (0.2 + 0.002 * i, 0.35), -size, 0.001 * (i + 1))
        for i, name in enumerate(names) for quantity, size in (("angle_deg", 5.0 + i / 10), ("force_N", 0.21), ("lift_mm", 1.3))
    )  # fmt: skip
    return explanation(curves=both, where=where, simulated=True, samples=70)


def alone() -> Explanation:
    """One design, one sample: nothing to hold out, no scatter known."""
    found = curves({"mine": 60.0}, rates=(0.05,), hold=False)
    bare = replace(
        found,
        explained=found.simulated,
        sd=np.full(len(found.sd), NAN),
        n=np.ones(len(found.n)),
        p=np.full(len(found.p), NAN),
    )
    return explanation(verdict="unexplained", where=(), effects=(), rivals=(), curves=bare, gap=Gap(2.4, 2.4, NAN, NAN, NAN, NAN),
                       p_gap=NAN, false_naming=NAN, tried=(), held_out=(), samples=1, remainder=(), warnings=())  # fmt: skip


def _rows(found: Curves) -> list[tuple[Any, ...]]:
    return [*zip(*(getattr(found, name) for name in Curves.__dataclass_fields__))]


ALL = {"agree": agreeing, "named": explanation, "ambiguous": ambiguous, "unexplained": unexplained, "the published table": published,
       "fourteen designs": crowded, "one sample": alone}  # fmt: skip

MADE = {"versions": {"benchlab": "0", "numpy": "2"}, "argv": ["benchlab", "explain", "measured.csv"],
        "created": "2026-01-01T00:00:00+00:00",
        "git": None}  # fmt: skip


def document(found: Explanation, plan: Plan | None = None) -> Document:
    """Its report, with the built-in vocabulary and provenance that is the same each time."""
    return explain_document(found, built_in(), MADE, {"measured.csv": "0" * 64}, plan)
