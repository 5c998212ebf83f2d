"""The score card as a table: targets beside figures with Wilson intervals, the confusion matrix, the pairs, the baselines. Markdown."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from tests.blind.cards import STRENGTHS, Case
from tests.blind.judge import RIGHT, WRONG, Coverage, chosen, coverages, outcome, set_returned, sets_named, spurious

Z = 1.959964


@dataclass(frozen=True)
class Scored:
    """A case with what is true, what was answered, and how long it took. second: the answer after the proposed experiment."""

    case: Case
    answer: Mapping[str, Any]
    result: Mapping[str, Any]
    seconds: float
    second: Mapping[str, Any] | None = None
    baselines: Mapping[str, str] | None = None

    @property
    def outcome(self) -> str:
        return outcome(self.case, self.result)


def wilson(hits: int, count: int) -> tuple[float, float]:
    """The 95 % interval of a share (Wilson 1927).

    >>> [round(x, 3) for x in wilson(5, 100)]
    [0.022, 0.112]
    """
    if not count:
        return 0.0, 1.0
    share, spread = hits / count, Z * Z / count
    middle = share + spread / 2
    half = Z * np.sqrt(share * (1 - share) / count + spread / count / 4)
    return max(0.0, float((middle - half) / (1 + spread))), min(1.0, float((middle + half) / (1 + spread)))


def share(flags: Iterable[bool]) -> str:
    """`95.0 % (19/20; 76–99)`"""
    every = [bool(flag) for flag in flags]
    if not every:
        return "–"
    low, high = wilson(sum(every), len(every))
    return f"{100 * np.mean(every):.1f} % ({sum(every)}/{len(every)}; {100 * low:.0f}–{100 * high:.0f})"


def table(head: Sequence[str], rows: Iterable[Sequence[object]]) -> str:
    lines = ["| " + " | ".join(head) + " |", "|" + "---|" * len(head)]
    lines += ["| " + " | ".join(str(cell) for cell in row) + " |" for row in rows]
    return "\n".join(lines)


def score_card(every: Sequence[Scored]) -> str:
    """All tables, one under the other."""
    parts = [
        ("Score card", _main(every)),
        ("By strength", _strengths(every)),
        ("By effect", _effects(every)),
        ("By layout of the study", _layouts(every)),
        ("Two effects", _twos(every)),
        ("Confounded pairs", _pairs(every)),
        ("Effects outside of the vocabulary", _unknowns(every)),
        ("Coverage of 95 % intervals", _coverage(every)),
        ("Confusion: truth × what was named first", _confusion(every)),
    ]
    if any(one.baselines for one in every):
        parts.append(("Baselines on the same cases", _baselines(every)))
    return "\n\n".join(f"### {title}\n\n{text}" for title, text in parts if text) + "\n"


def _main(every: Sequence[Scored]) -> str:
    of = _by_kind(every)
    named = of["single"] + of["pair"]
    rows: list[tuple[str, str, str]] = [
        (
            "null studies falsely named",
            "≤ 5 %, upper bound ≤ 9 %",
            share(bool(sets_named(o.result)) for o in of["null"]),
        ),
        ("null studies called unexplained", "–", share(o.outcome == "unexplained" for o in of["null"])),
        ("wrong name (truth outside the set)", "≤ 2 %", share(o.outcome in WRONG for o in named)),
        ("… of these the truth with others", "–", share(o.outcome == "with others" for o in named)),
    ]
    for strength, target in zip(STRENGTHS, (75, 90, 98)):
        flags = [o.outcome in RIGHT for o in of["single"] if o.case.strengths == (strength,)]
        rows.append((f"right, unique or in set, at {strength:g}×", f"≥ {target} %", share(flags)))
    pairs = of["pair"]
    separable = [o for o in pairs if o.case.separated_by == "protocol"]
    same = [c for o in every for c in coverages(o.case, o.answer, o.result) if c.same_form]
    ratios = [r for o in every if (r := _ratio(o)) is not None]
    seconds = np.array([o.seconds for o in every] or [np.nan])
    rows += [
        ("unknown effects named", "≤ 5 %", share(bool(sets_named(o.result)) for o in of["unknown"])),
        ("unknown effects called unexplained", "≥ 85 %", share(o.outcome == "unexplained" for o in of["unknown"])),
        ("two effects: both found", "≥ 85 %", share(o.outcome in RIGHT | {"with others"} for o in of["two"])),
        ("two effects: spurious third", "≤ 5 %", share(o.outcome == "with others" for o in of["two"])),
        ("pairs: set returned", "≥ 95 %", share(set_returned(o.case, o.result) for o in pairs)),
        ("pairs: set returned, or the truth alone", "–", share(_fair(o) for o in pairs)),
        ("pairs separable by a protocol: right alone after it", "≥ 80 %", share(_resolved(o) for o in separable)),
        ("interval coverage, same-form truths", "90–98 %", share(c.covered for c in same)),
        ("held-out RMSE after ≤ 1.15 × noise floor", "all", share(r <= 1.15 for r in ratios)),
        ("held-out RMSE after / noise floor, median, p95", "≤ 1.15", _quantiles(ratios)),
        ("worse on nulls, held out", "never", share(_worse(o) for o in of["null"])),
        ("time a study, s: median, p95, most", "≤ 60", f"{np.median(seconds):.1f}, {np.quantile(seconds, 0.95):.1f}, {seconds.max():.1f}"),
    ]  # fmt: skip
    return table(("", "target", "found"), rows)


def _strengths(every: Sequence[Scored]) -> str:
    rows = []
    for strength in STRENGTHS:
        here = [o for o in every if o.case.kind == "single" and o.case.strengths == (strength,)]
        rows.append(
            [f"{strength:g}×", *_shares(here, ("unique", "in set", "with others", "wrong", "unexplained", "agree"))]
        )
    return table(("RMS shift / noise floor", "unique", "in set", "with others", "wrong", "unexplained", "agree"), rows)


def _effects(every: Sequence[Scored]) -> str:
    rows = []
    for name in dict.fromkeys(o.case.names[0] for o in every if o.case.kind == "single"):
        here = [o for o in every if o.case.kind == "single" and o.case.names == (name,)]
        cells = []
        for strength in STRENGTHS:
            found = Counter(o.outcome for o in here if o.case.strengths == (strength,))
            cells.append(", ".join(f"{count} {what}" for what, count in sorted(found.items())) or "–")
        rows.append([f"`{name}`", *cells])
    return table(("effect", *(f"{s:g}×" for s in STRENGTHS)), rows)


def _layouts(every: Sequence[Scored]) -> str:
    rows = []
    for name, of_it in _LAYOUTS.items():
        here = [o for o in every if of_it(o.case)]
        nulls = [bool(sets_named(o.result)) for o in here if o.case.kind == "null"]
        strong = [o for o in here if o.case.kind == "single" and o.case.strengths[0] >= 2]
        rows.append(
            [
                name,
                share(nulls),
                share(o.outcome in RIGHT for o in strong),
                share(o.outcome in WRONG for o in strong),
            ]
        )
    return table(("study", "nulls named", "right at 2× and 4×", "wrong at 2× and 4×"), rows)


_LAYOUTS: dict[str, Callable[[Case], bool]] = {
    "5 designs × 5 samples, ordered": lambda c: _size(c) == (5, 5, 1) and c.layout.ordered and "hold" in c.layout.runs,
    "5 × 5, order unknown": lambda c: not c.layout.ordered,
    "5 × 5, no hold": lambda c: _size(c) == (5, 5, 1) and c.layout.runs[:2] == ("slow", "fast") and len(c.layout.runs) == 2,
    "5 × 3": lambda c: _size(c) == (5, 3, 1),
    "3 × 4": lambda c: _size(c) == (3, 4, 1),
    "3 × 2 or 3": lambda c: _size(c) in {(3, 2, 1), (3, 3, 1)},
    "3 × 3, two lengths": lambda c: _size(c)[2] == 2,
}  # fmt: skip


def _size(case: Case) -> tuple[int, int, int]:
    return len(case.layout.designs), case.layout.samples, len(case.layout.lengths_mm)


def _twos(every: Sequence[Scored]) -> str:
    rows = [
        [
            " + ".join(o.case.names),
            ", ".join(f"{strength:g}×" for strength in o.case.strengths),
            o.outcome,
            chosen(o.result),
            ", ".join(spurious(o.case, o.result)) or "–",
        ]
        for o in every
        if o.case.kind == "two"
    ]
    return table(("truth", "strengths", "outcome", "named first", "not true"), rows) if rows else ""


def _pairs(every: Sequence[Scored]) -> str:
    pairs = [o for o in every if o.case.kind == "pair"]
    rows = []
    for truth, rival in dict.fromkeys((o.case.names[0], o.case.rival) for o in pairs):
        here = [o for o in pairs if o.case.names == (truth,) and o.case.rival == rival]
        by = here[0].case.separated_by
        proposed = sum(bool((o.result.get("next_experiment") or {}).get("protocol")) for o in here)
        rows.append(
            [
                f"`{truth}` (`{rival}`)",
                f"{sum(set_returned(o.case, o.result) for o in here)}/{len(here)}",
                f"{sum(o.outcome == 'unique' for o in here)}/{len(here)}",
                f"{sum(o.outcome in WRONG for o in here)}/{len(here)}",
                by or "nothing",
                f"{proposed}/{len(here)}",
                f"{sum(_resolved(o) for o in here)}/{len(here)}",
                here[0].case.how,
            ]
        )
    head = (
        "truth (rival)",
        "set returned",
        "right alone",
        "wrong",
        "separated by",
        "proposed",
        "right alone after it",
        "how",
    )
    return table(head, rows) if rows else ""


def _unknowns(every: Sequence[Scored]) -> str:
    rows = []
    for name in dict.fromkeys(o.case.names[0] for o in every if o.case.kind == "unknown"):
        here = [o for o in every if o.case.names == (name,)]
        taken = Counter(chosen(o.result) for o in here if sets_named(o.result))
        rows.append(
            [
                f"`{name}`",
                *_shares(here, ("unexplained", "named", "agree")),
                ", ".join(f"{n} {w}" for w, n in taken.items()) or "–",
            ]
        )
    return table(("truth", "unexplained", "named", "agree", "as"), rows) if rows else ""


def _coverage(every: Sequence[Scored]) -> str:
    found = [c for o in every for c in coverages(o.case, o.answer, o.result)]
    names = sorted({c.effect for c in found})
    rows = [[f"`{name}`", *_covered([c for c in found if c.effect == name])] for name in names]
    rows.append(["all", *_covered(found)])
    return table(("effect", "truth of the same form", "truth of another form"), rows)


def _covered(found: Sequence[Coverage]) -> list[str]:
    return [share(c.covered for c in found if c.same_form == same) for same in (True, False)]


def _confusion(every: Sequence[Scored]) -> str:
    counts: dict[str, Counter[str]] = {}
    for o in every:
        truth = " + ".join(o.case.names) if o.case.kind in {"single", "pair"} else o.case.kind
        counts.setdefault(truth, Counter())[chosen(o.result) if o.case.kind != "two" else o.outcome] += 1
    rows = [
        [f"`{truth}`", ", ".join(f"{what} {count}" for what, count in found.most_common())]
        for truth, found in counts.items()
    ]
    return table(("truth", "named first, how often"), rows)


def _baselines(every: Sequence[Scored]) -> str:
    with_them = [o for o in every if o.baselines]
    rules = list(dict.fromkeys(rule for o in with_them for rule in o.baselines or {}))
    rows = []
    for rule in rules:
        named = {id(o): (o.baselines or {}).get(rule, "") for o in with_them}
        row = [rule, share(bool(named[id(o)]) for o in with_them if o.case.kind == "null")]
        for strength in STRENGTHS:
            here = [o for o in with_them if o.case.kind == "single" and o.case.strengths == (strength,)]
            right = sum(named[id(o)] == o.case.names[0] for o in here)
            wrong = sum(bool(named[id(o)]) and named[id(o)] != o.case.names[0] for o in here)
            row.append(f"{100 * right / len(here):.0f}/{100 * wrong / len(here):.0f}" if here else "–")
        rows.append([*row, share(bool(named[id(o)]) for o in with_them if o.case.kind == "unknown")])
    head = ("rule", "nulls named", *(f"right/wrong % at {s:g}×" for s in STRENGTHS), "unknown named")
    return table(head, rows)


def _by_kind(every: Sequence[Scored]) -> dict[str, list[Scored]]:
    return {kind: [o for o in every if o.case.kind == kind] for kind in ("null", "single", "unknown", "two", "pair")}


def _shares(here: Sequence[Scored], outcomes: Sequence[str]) -> list[str]:
    return [share(o.outcome == what for o in here) for what in outcomes]


def _fair(o: Scored) -> bool:
    return set_returned(o.case, o.result) or o.outcome == "unique"


def _resolved(o: Scored) -> bool:
    """Right alone from the start, or after the proposed experiment."""
    last = o.result if o.outcome == "unique" or o.second is None else o.second
    return outcome(o.case, last) == "unique"


def _ratio(o: Scored) -> float | None:
    """Held-out RMSE after over the identifier's own noise floor."""
    gap = o.result.get("gap") or {}
    after, floor = gap.get("heldout_after"), gap.get("noise_floor")
    return after / floor if after is not None and floor else None


def _worse(o: Scored) -> bool:
    gap = o.result.get("gap") or {}
    before, after = gap.get("heldout_before"), gap.get("heldout_after")
    return before is not None and after is not None and after > before * (1 + 1e-9)


def _quantiles(values: Sequence[float]) -> str:
    return f"{np.median(values):.2f}, {np.quantile(values, 0.95):.2f}" if values else "–"
