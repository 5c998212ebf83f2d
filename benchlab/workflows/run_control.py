"""The control of a run: gains and where they are from, whether they can work on the plant that they name, whether the actuator
can bend as far as it is asked to."""

from __future__ import annotations

import math
import re
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

import numpy as np

from benchlab.bench import Bench
from benchlab.control.tuning import margins_at
from benchlab.errors import InputError
from benchlab.io.control_file import ControlFile, read_control
from benchlab.protocol.plan import Control, Plan
from benchlab.twin.curve import ResponseCurve

DOUBTFUL_MS = 3.0
"""Gains with a larger Ms on their plant are told of: a gain margin under 1.5."""

BEYOND = 0.1
"""A simulated curve is not better than this: feed-forward to a reference so far beyond its end is refused."""


@dataclass(frozen=True)
class Chosen:
    """Gains, where they are from, and what is doubtful about them."""

    control: Control
    origin: str
    warnings: tuple[str, ...] = ()


def choose(plan: Plan, bench: Bench, file: Path | None) -> Chosen | None:
    """The gains of `--control` or else of the protocol; None for a plan in open loop.

    Raises InputError where the angle is not measured, where there are no gains, and for gains that are unstable on the plant
    of their own file at the rate of this plan.
    """
    if not plan.closed_loop:
        return None
    if bench.flex is None:
        raise InputError(
            "the protocol controls the angle, and the flex sensor of this bench is not calibrated",
            hint="calibrate it with `benchlab control flex`",
        )
    if file is None:
        if plan.control is None:
            raise InputError("the protocol has no gains for its closed-loop steps", hint="give --control FILE")
        return Chosen(plan.control, "the protocol")
    told = read_control(file)
    control = Control(told.kp_MPa_per_deg, told.ki_MPa_per_deg_s, told.feed_forward, told.lead_s)
    warnings = _margins(told, plan.rate_Hz, file)
    if not math.isclose(told.rate_Hz, plan.rate_Hz):
        warnings.append(f"the gains are for {told.rate_Hz:g} Hz, and the plan runs at {plan.rate_Hz:g} Hz")
    source = re.sub(r"(sha256 \w{8})\w+", r"\1", told.source)
    return Chosen(control, f"{file.name} ({source})", tuple(warnings))


def check_reach(plan: Plan, top_MPa: float, curve: ResponseCurve | None, feed_forward: bool) -> list[str]:
    """What is to be told where the curve does not reach the largest reference at top_MPa.

    Raises InputError where it is far beyond and feed-forward goes by that curve. A PI alone does not go by it, and curves may be wrong.
    """
    if curve is None or not plan.closed_loop:
        return []
    asked = float(np.nanmax(plan.reference_deg))
    end_MPa = min(top_MPa, curve.last_MPa)
    reach = float(np.interp(end_MPa, curve.pressure_MPa, curve.angle_deg))
    if asked <= reach:
        return []
    words = (
        f"the reference goes to {asked:.4g}°, and the curve ({curve.source}) reaches {reach:.1f}° at {end_MPa:.4g} MPa"
    )
    if feed_forward and asked > (1 + BEYOND) * reach:
        raise InputError(
            words, hint="ask for a smaller angle, give the actuator's --design or --curve, or take feed_forward: false"
        )
    return [f"{words}: if that is right, the controller will stand at its limit"]


def control_told(chosen: Chosen | None, curve: ResponseCurve | None) -> dict[str, Any] | None:
    """Gains, where they are from, by which curve feed-forward goes, and all that in words; None in open loop."""
    if chosen is None:
        return None
    control, by = chosen.control, None
    words = f"PI of {chosen.origin}: kp {control.kp_MPa_per_deg:.4g} MPa/°, ki {control.ki_MPa_per_deg_s:.4g} MPa/(°·s)"
    if control.feed_forward and curve is not None:
        by = curve.source
        words += f"; feed-forward by the curve {by}, lead {control.lead_s:.3g} s"
    else:
        words += "; no feed-forward"
    return {**asdict(control), "from": chosen.origin, "curve": by, "words": words}


def two_curves(believed: ResponseCurve | None, own: ResponseCurve | None) -> list[str]:
    """That a twin bends by another curve than controller and guards go by."""
    if believed is None or own is None or believed is own:
        return []
    return [f"controller and guards go by the curve {believed.source}; the twin bends by its own, {own.source}"]


def _margins(told: ControlFile, rate_Hz: float, file: Path) -> list[str]:
    if not told.points:
        return []
    pressures, plants, _ = zip(*told.points)
    found = margins_at(told.kp_MPa_per_deg, told.ki_MPa_per_deg_s, plants, rate_Hz)
    worst = int(np.argmax([each.max_sensitivity if each.stable else math.inf for each in found]))
    margin = found[worst]
    gains = f"kp {told.kp_MPa_per_deg:g} MPa/°, ki {told.ki_MPa_per_deg_s:g} MPa/(°·s)"
    if not margin.stable:
        raise InputError(
            f"{gains} would oscillate on the plant of this file at {pressures[worst]:.4g} MPa: at {rate_Hz:g} Hz the loop's gain is "
            f"{1 / margin.gain_margin:.3g} times what it can be",
            file=file,
            where="gains",
            hint="smaller gains, as `benchlab control tune` writes them",
        )
    if margin.max_sensitivity <= DOUBTFUL_MS:
        return []
    return [f"{gains} have Ms {margin.max_sensitivity:.3g} at {pressures[worst]:.4g} MPa: the loop will swing"]
