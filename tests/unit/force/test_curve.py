"""Cycles within actuators, actuators as samples."""

from __future__ import annotations

import json

import numpy as np
import pytest

from benchlab.errors import InputError
from benchlab.force.curve import ActuatorCycles, BlockedForce, blocked_force
from benchlab.force.curve_json import blocked_force_json

LEVELS = np.repeat([0.1, 0.2, 0.3], 4)


def cycles(name: str, slope: float = 100.0, seed: int = 0, **changes) -> ActuatorCycles:
    force = slope * LEVELS + np.random.default_rng(seed).normal(0, 0.1, len(LEVELS))
    fields = {"force_N": force, "pressure_MPa": LEVELS, "lower_bound": np.zeros(len(LEVELS), bool), **changes}
    return ActuatorCycles(name, **fields)


def three(**changes) -> BlockedForce:
    return blocked_force([cycles("a", 98, 1, **changes), cycles("b", 102, 2), cycles("c", 105, 3)])


def test_actuators_are_the_samples_and_cycles_are_averaged_within() -> None:
    found = three()
    assert (found.actuators, found.pressure_MPa.tolist(), found.cycles.tolist()) == (
        ("a", "b", "c"),
        [0.1, 0.2, 0.3],
        [[4] * 3] * 3,
    )
    by_hand = [
        cycles(n, s, k).force_N.reshape(3, 4).mean(axis=1) for n, s, k in (("a", 98, 1), ("b", 102, 2), ("c", 105, 3))
    ]
    assert found.mean_N == pytest.approx(np.array(by_hand))
    assert found.over_actuators_N == pytest.approx(np.mean(by_hand, axis=0))
    assert found.sd_N == pytest.approx(np.std(by_hand, axis=0, ddof=1))
    assert found.cycle_sd_N[0, 0] == pytest.approx(cycles("a", 98, 1).force_N[:4].std(ddof=1))
    assert found.line is not None and found.line.actuators == 3


def test_more_cycles_of_one_actuator_are_not_more_samples() -> None:
    often = ActuatorCycles("a", np.tile(98 * LEVELS, 50), np.tile(LEVELS, 50), np.zeros(600, bool))
    found = blocked_force([often, cycles("b", 102, 2)])
    assert found.n.tolist() == [2, 2, 2]
    assert found.over_actuators_N[2] == pytest.approx((0.3 * 98 + cycles("b", 102, 2).force_N[8:].mean()) / 2)


def test_records_of_one_name_are_one_actuator() -> None:
    first, second = (
        ActuatorCycles("a", np.array([f]), np.array([p]), np.zeros(1, bool)) for f, p in ((9.0, 0.1), (21.0, 0.2))
    )
    found = blocked_force([first, second])
    assert (found.actuators, found.mean_N.tolist()) == (("a",), [[9.0, 21.0]])
    assert np.isnan(found.sd_N).all()


def test_a_step_that_an_actuator_lacks_is_not_in_the_line() -> None:
    short = ActuatorCycles("b", 100 * LEVELS[:8], LEVELS[:8], np.zeros(8, bool))
    found = blocked_force([cycles("a"), short])
    assert found.n.tolist() == [2, 2, 1]
    assert found.line is not None and found.line.pressure_MPa.tolist() == [0.1, 0.2]
    assert found.notes == ("not every actuator has a cycle at 0.3 MPa: the line is without it",)
    assert np.isnan(found.sd_N[2])


def test_a_lower_bound_marks_its_step_and_is_not_in_the_line() -> None:
    bound = np.arange(12) == 11
    found = three(lower_bound=bound)
    assert found.lower_bound.tolist() == [[False, False, True], [False] * 3, [False] * 3]
    assert found.line is not None and found.line.pressure_MPa.tolist() == [0.1, 0.2]
    assert "lower bounds" in found.notes[0]
    assert blocked_force_json(found)["largest"]["lower_bound"] is True


def test_what_has_no_line_says_why() -> None:
    one = ActuatorCycles("a", np.array([3.0]), np.array([0.2]), np.zeros(1, bool))
    assert "needs two pressures" in blocked_force([one]).line_reason
    zero = ActuatorCycles("a", np.zeros(12), LEVELS, np.zeros(12, bool))
    assert blocked_force([zero]).line_reason == "all forces are zero"
    with pytest.raises(ValueError, match="no cycle"):
        blocked_force([ActuatorCycles("a", np.zeros(0), np.zeros(0), np.zeros(0, bool))])


def test_steps_in_the_wrong_order_are_doubted() -> None:
    found = blocked_force([cycles("a", force_N=100 * LEVELS[::-1])])
    assert "falls from 30 N at 0.1 MPa to 20 N at 0.2 MPa" in found.notes[0]


def test_pressures_of_actuators_are_clustered_together() -> None:
    found = blocked_force([cycles("a"), cycles("b", pressure_MPa=LEVELS + 0.004)])
    assert found.pressure_MPa == pytest.approx([0.102, 0.202, 0.302])
    with pytest.raises(InputError, match="without a gap"):
        blocked_force([cycles("a", pressure_MPa=np.linspace(0.1, 0.2, 12))], tolerance_MPa=0.02)


def test_json_has_no_nan_and_states_the_lever_arm() -> None:
    alone = json.loads(json.dumps(blocked_force_json(blocked_force([cycles("a")])), allow_nan=False))
    assert alone["lever_arm_mm"] is None and "not stated" in alone["lever_arm"]
    assert alone["line"]["linearity"] is None and alone["pressures"][0]["sd_N"] is None
    told = blocked_force_json(blocked_force([cycles("a")], lever_arm_mm=7.5))
    assert told["lever_arm"] is None
    assert told["moment_at_largest_N_mm"] == pytest.approx(7.5 * told["largest"]["mean_N"])
