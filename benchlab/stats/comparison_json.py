"""A comparison as plain data for machines."""

from __future__ import annotations

import math
from dataclasses import asdict
from typing import TYPE_CHECKING, Any

from scipy import special

from benchlab.stats.components import Component
from benchlab.stats.groups import Group
from benchlab.stats.pairs import Pair
from benchlab.stats.power import WANTED, Power, PowerOfTest
from benchlab.stats.repeatability import FACTOR, Precision, Repeatability
from benchlab.stats.wording import verdict

if TYPE_CHECKING:
    from benchlab.stats.comparison import Comparison


def comparison_document(found: Comparison) -> dict[str, Any]:
    """The document of `benchlab stats --json`."""
    return {
        "verdict": verdict(found),
        "confidence": found.confidence,
        "anova": _anova(found),
        "welch": _welch(found),
        "tukey": [pair_document(pair) for pair in found.tukey],
        "games_howell": [pair_document(pair) for pair in found.games_howell],
        "groups": [
            _group(group, found.confidence, None if found.cycles is None else found.cycles[index])
            for index, group in enumerate(found.groups)
        ],
        "assumptions": _assumptions(found),
        "components": {
            "method": found.components.method,
            "cycle": _component(found.components.cycle),
            "sample": _component(found.components.sample),
            "design": _component(found.components.design),
        },
        "repeatability": _repeatability(found.repeatability),
        "power": None if found.power is None else _power(found.power),
        "warnings": list(found.warnings),
    }


def pair_document(pair: Pair) -> dict[str, Any]:
    """One pair; difference is mean of b − mean of a."""
    return _with_reason(asdict(pair), pair.reason)


def mean_interval(group: Group, confidence: float) -> tuple[float, float] | None:
    """Interval of a group's mean by Student's t with its own standard deviation; None for one sample."""
    if group.sd is None:
        return None
    half = float(special.stdtrit(group.n - 1, (1 + confidence) / 2)) * group.sd / math.sqrt(group.n)
    return group.mean - half, group.mean + half


def _group(group: Group, confidence: float, cycles: int | None) -> dict[str, Any]:
    low, high = mean_interval(group, confidence) or (None, None)
    found = {"name": group.name, "n": group.n, "mean": group.mean, "sd": group.sd, "low": low, "high": high}
    return found if cycles is None else {**found, "cycles": cycles}


def _anova(found: Comparison) -> dict[str, Any]:
    anova = found.anova
    low, high = anova.interval or (None, None)
    document = {
        "F": anova.F,
        "df": list(anova.df),
        "p": anova.p,
        "ss_between": anova.ss_between,
        "ss_within": anova.ss_within,
        "eta_squared": anova.eta_squared,
        "omega_squared": anova.omega_squared,
        "effect_low": low,
        "effect_high": high,
    }
    return _with_reason(document, anova.reason)


def _welch(found: Comparison) -> dict[str, Any]:
    welch = found.welch
    df = None if welch.df is None else list(welch.df)
    return _with_reason({"F": welch.F, "df": df, "p": welch.p, "left_out": list(welch.left_out)}, welch.reason)


def _assumptions(found: Comparison) -> dict[str, Any]:
    levene, shapiro = found.assumptions.levene, found.assumptions.shapiro
    df = None if levene.df is None else list(levene.df)
    return {
        "levene": _with_reason({"F": levene.F, "df": df, "p": levene.p, "centre": "median"}, levene.reason),
        "shapiro": _with_reason({"W": shapiro.W, "p": shapiro.p, "n": shapiro.n, "of": "residuals"}, shapiro.reason),
    }


def _component(component: Component | None) -> dict[str, Any] | None:
    return None if component is None else {**asdict(component), "sd": component.sd}


def _repeatability(found: Repeatability) -> dict[str, Any]:
    return {
        "replicate": found.replicate,
        "laboratory": "sample" if found.replicate == "cycle" else None,
        "factor": FACTOR,
        "s_r": found.pooled.s_r,
        "s_r_low": found.s_low,
        "s_r_high": found.s_high,
        "r": found.pooled.r,
        "s_R": found.pooled.s_R,
        "R": found.pooled.R,
        "sample_sd": found.sample_sd,
        "sample_limit": FACTOR * found.sample_sd,
        "groups": [_precision(design) for design in found.designs],
        "consistency": [{**asdict(cell), "outside": cell.outside} for cell in found.cells],
    }


def _precision(design: Precision) -> dict[str, Any]:
    return {"name": design.name, "s_r": design.s_r, "r": design.r, "s_R": design.s_R, "R": design.R}


def _power(power: Power) -> dict[str, Any]:
    return {
        "sd": power.sd,
        "n": power.n,
        "groups": power.groups,
        "alpha": power.alpha,
        "difference": power.difference,
        "anova": _power_of_test(power.anova),
        "pair": _power_of_test(power.pair),
    }


def _power_of_test(test: PowerOfTest) -> dict[str, Any]:
    names = [f"{wanted:g}" for wanted in WANTED]
    return {
        "power": test.power,
        "n_for_power": None if test.samples is None else dict(zip(names, test.samples)),
        "smallest_difference": dict(zip(names, test.smallest)),
    }


def _with_reason(document: dict[str, Any], reason: str | None) -> dict[str, Any]:
    """The document with its reason where there is one."""
    document.pop("reason", None)
    return {**document, "reason": reason} if reason else document
