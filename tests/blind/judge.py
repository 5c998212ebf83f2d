"""What an identifier's answer is worth, against what is true.

Both are plain dicts: the `--json` of `benchlab explain`, and a study's answer.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from tests.blind.cards import Case

Answer = Mapping[str, Any]


@dataclass(frozen=True)
class Coverage:
    """An interval held against the truth. same_form: the truth is the textbook's one-parameter form."""

    effect: str
    same_form: bool
    covered: bool


def sets_named(result: Answer) -> list[frozenset[str]]:
    """What the answer holds possible: the named effects first, then their rivals, each a set of effects that act together.

    Nothing for `agree` and `unexplained`, whatever else is written there.
    """
    if result["verdict"] not in {"named", "ambiguous"}:
        return []
    found = [frozenset(effect["name"] for effect in result["effects"])]
    found += [frozenset([rival] if isinstance(rival, str) else rival) for rival in result.get("rivals") or []]
    return list(dict.fromkeys(one for one in found if one))


def outcome(case: Case, result: Answer) -> str:
    """unique, in set, with others (the truth within a larger set), part (of two), wrong, unexplained, agree.

    For a null or unknown case: named, unexplained or agree.
    """
    named = sets_named(result)
    if not named:
        return str(result["verdict"])
    if not case.truth:
        return "named"
    if case.truth in named:
        return "unique" if len(named) == 1 else "in set"
    if any(one > case.truth for one in named):
        return "with others"
    return "part" if any(one < case.truth for one in named) else "wrong"


RIGHT = frozenset({"unique", "in set"})
WRONG = frozenset({"wrong", "with others"})


def chosen(result: Answer) -> str:
    """The first set, in words, or the verdict: a column of the confusion matrix."""
    named = sets_named(result)
    return " + ".join(sorted(named[0])) if named else str(result["verdict"])


COMPARED = {
    "end_caps": "cap_mm",
    "pressure_gain": "gain",
    "pressure_offset": "offset_MPa",
    "camera_scale": "scale",
    "camera_tilt": "tilt_deg",
    "marker_offset": "offset_mm",
    "clock_offset": "offset_s",
    "dead_pressure": "dead_pressure_MPa",
    "seam_margin": "margin_mm",
    "fabric_compliance": "fabric_modulus_MPa",
    "regulator_lag": "lag_s",
}
"""The parameter of the truth that an identifier's interval is held against; the others have none that both must share."""
_UNITS = {
    "MPa": ("MPa", 1.0),
    "kPa": ("MPa", 1e-3),
    "mm": ("mm", 1.0),
    "s": ("s", 1.0),
    "ms": ("s", 1e-3),
    "deg": ("deg", 1.0),
    "°": ("deg", 1.0),
    "": ("", 1.0),
    "1": ("", 1.0),
}


def coverages(case: Case, answer: Answer, result: Answer) -> list[Coverage]:
    """For every effect that is true, named first and has an interval of the unit of COMPARED."""
    found = []
    true = {effect["name"]: effect for effect in answer["effects"]}
    for effect in result["effects"] if sets_named(result) else []:
        key = COMPARED.get(effect["name"])
        if effect["name"] not in case.truth or key is None:
            continue
        interval = _interval(effect["parameters"], key.rsplit("_", 1)[-1] if "_" in key else "")
        if interval is not None:
            truth = true[effect["name"]]
            low, high = sorted(interval)
            covered = low <= truth["parameters"][key] <= high
            found.append(Coverage(effect["name"], truth["same_form"], covered))
    return found


def _interval(parameters: Mapping[str, Any], unit: str) -> tuple[float, float] | None:
    """Of the first parameter in that unit; None where there is none, or no interval for it."""
    for one in parameters.values():
        own, factor = _UNITS.get(one.get("unit") or "", (one.get("unit"), 1.0))
        if own == unit and one.get("low") is not None and one.get("high") is not None:
            return one["low"] * factor, one["high"] * factor
    return None


def set_returned(case: Case, result: Answer) -> bool:
    """Of a pair: both are held possible."""
    named = sets_named(result)
    return case.truth in named and frozenset({case.rival}) in named


def spurious(case: Case, result: Answer) -> Sequence[str]:
    """Effects in the first set that are not true."""
    named = sets_named(result)
    return sorted(named[0] - case.truth) if named else []
