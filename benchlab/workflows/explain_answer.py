"""An explanation as `--json` shows it."""

from __future__ import annotations

import math
from dataclasses import asdict
from typing import Any

from benchlab.discrepancy.explanation import Estimate, Explanation, Found, NextExperiment, Region


def answer_of(explanation: Explanation, model: str | None = None) -> dict[str, Any]:
    """The answer in JSON's own types; a number that is not known is null. model: path of the model file, None where there is none."""
    found = {
        "verdict": explanation.verdict,
        "where": [_region(region) for region in explanation.where],
        "effects": [_effect(effect) for effect in explanation.effects],
        "rivals": [list(names) for names in explanation.rivals],
        "gap": asdict(explanation.gap),
        "gap_quantity": _only(explanation),
        "next_experiment": _next(explanation.next_experiment),
        "model": model,
        "warnings": list(explanation.warnings),
        "p_gap": explanation.p_gap,
        "false_naming_nominal": explanation.false_naming,
        "remainder": list(explanation.remainder),
        "not_judged": dict(explanation.judged_not),
        "held_out": [asdict(part) for part in explanation.held_out],
        "tried": [asdict(one) for one in explanation.tried],
        "base": explanation.base,
        "source": explanation.source,
        "simulated": explanation.simulated,
        "samples": explanation.samples,
    }
    return {name: _finite(value) for name, value in found.items()}


def _only(explanation: Explanation) -> str | None:
    """The quantity whose unit the gap has; None where several are in it."""
    names = set(explanation.curves.quantity.tolist())
    return str(names.pop()) if len(names) == 1 else None


def _region(region: Region) -> dict[str, Any]:
    return {**asdict(region), "pressure_MPa": list(region.pressure_MPa)}


def _effect(effect: Found) -> dict[str, Any]:
    parameters = {name: _number(estimate) for name, estimate in effect.parameters.items()}
    return {
        "name": effect.name,
        "form": effect.form,
        "other_forms": list(effect.other_forms),
        "parameters": parameters,
        "share_explained": effect.share_explained,
    }


def _number(estimate: Estimate) -> dict[str, Any]:
    return {"value": estimate.value, "low": estimate.low, "high": estimate.high, "unit": estimate.unit}


def _next(proposed: NextExperiment | None) -> dict[str, Any] | None:
    if proposed is None:
        return None
    names = ("protocol", "separates", "expected_sd", "setup", "cannot")
    told = {name: getattr(proposed, name) for name in names}
    if proposed.experiment is None:
        return told
    return told | {"mountings_deg": proposed.experiment.mountings_deg, "length_ratio": proposed.experiment.length_ratio}


def _finite(value: Any) -> Any:
    if isinstance(value, dict):
        return {name: _finite(inner) for name, inner in value.items()}
    if isinstance(value, list | tuple):
        return [_finite(inner) for inner in value]
    if isinstance(value, bool | str | int) or value is None:
        return value
    return float(value) if math.isfinite(value) else None
