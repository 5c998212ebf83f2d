"""Blocked force in JSON's own types: a number that is not known is null."""

from __future__ import annotations

import math
from dataclasses import asdict
from typing import Any

from benchlab.force.baseline import Baseline
from benchlab.force.curve import BlockedForce, moment_N_mm
from benchlab.force.line import Estimate, ForceLine
from benchlab.force.peaks import ForcePeak, ForceRecord

LEVER_NOT_STATED = "not stated; a force without its lever arm is that of this fixture alone (--lever-arm-mm)"


def blocked_force_json(found: BlockedForce) -> dict[str, Any]:
    """The result as `benchlab force --json` and blocked_force.json have it."""
    largest = len(found.pressure_MPa) - 1
    return {
        "actuators": list(found.actuators),
        "pressures": [_pressure(found, j) for j in range(len(found.pressure_MPa))],
        "largest": _pressure(found, largest),
        "line": _line(found.line),
        "line_reason": found.line_reason or None,
        "tolerance_MPa": found.tolerance_MPa,
        "lever_arm_mm": found.lever_arm_mm,
        "lever_arm": None if found.lever_arm_mm is not None else LEVER_NOT_STATED,
        "moment_at_largest_N_mm": _number(moment_N_mm(float(found.over_actuators_N[largest]), found.lever_arm_mm)),
        "warnings": list(found.notes),
    }


def record_json(record: ForceRecord) -> dict[str, Any]:
    """The peaks of a record with its zero."""
    zero = record.baseline
    return {
        "contact": record.contact,
        "largest_reading_N": _number(record.high_N),
        "note": record.notes[-1] if record.notes else None,
        "clipped_at_N": record.clipped_at_N,
        "baseline": None if zero is None else _baseline(zero),
        "peaks": [peak_json(peak) for peak in record.peaks],
    }


def peak_json(peak: ForcePeak) -> dict[str, Any]:
    return {name: _number(value) if isinstance(value, float) else value for name, value in asdict(peak).items()}


def _baseline(zero: Baseline) -> dict[str, Any]:
    return {
        "first_N": float(zero.level_N[0]),
        "last_N": float(zero.level_N[-1]),
        "low_N": float(zero.level_N.min()),
        "high_N": float(zero.level_N.max()),
        "slope_N_per_s": _number(zero.slope_N_per_s),
        "sd_N": float(zero.sd_N.max()),
        "noise_N": zero.noise_N,
        "rests": len(zero.level_N),
        "flat_rests": int(zero.flat.sum()),
    }


def _pressure(found: BlockedForce, j: int) -> dict[str, Any]:
    return {
        "pressure_MPa": float(found.pressure_MPa[j]),
        "n": int(found.n[j]),
        "mean_N": _number(found.over_actuators_N[j]),
        "sd_N": _number(found.sd_N[j]),
        "lower_bound": bool(found.lower_bound[:, j].any()),
        "by_actuator": [
            {
                "actuator": name, "mean_N": _number(found.mean_N[i, j]), "cycles": int(found.cycles[i, j]),
                "cycle_sd_N": _number(found.cycle_sd_N[i, j]), "lower_bound": bool(found.lower_bound[i, j]),
            }
            for i, name in enumerate(found.actuators)
        ],
    }  # fmt: skip


def _line(line: ForceLine | None) -> dict[str, Any] | None:
    if line is None:
        return None
    straight = line.linearity
    return {
        "confidence": line.confidence,
        "pressures_MPa": line.pressure_MPa.tolist(),
        "intercept_N": _estimate(line.intercept_N),
        "slope_N_per_MPa": _estimate(line.slope_N_per_MPa),
        "through_origin_N_per_MPa": _estimate(line.through_origin_N_per_MPa),
        "r_squared": _number(line.r_squared),
        "residual_sd_N": _number(line.residual_sd_N),
        "linearity": None if straight is None else {
            "F": _number(straight.F), "df": list(straight.df), "p": _number(straight.p),
            "bow_N": _estimate(straight.bow_N), "bow_p": _number(straight.bow_p),
        },
    }  # fmt: skip


def _estimate(one: Estimate) -> dict[str, float | None]:
    return {"value": _number(one.value), "low": _number(one.low), "high": _number(one.high)}


def _number(value: float) -> float | None:
    return float(value) if math.isfinite(value) else None
