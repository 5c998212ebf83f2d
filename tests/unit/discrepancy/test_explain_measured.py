"""Runs of samples, explained: a name stands for what the fit has not seen too."""

from __future__ import annotations

from dataclasses import replace

import pytest

from benchlab.discrepancy import explain as room
from benchlab.discrepancy.effects.effect import Active
from benchlab.discrepancy.explain import Explained, explain
from benchlab.discrepancy.fit import fit
from benchlab.discrepancy.identify import Identified
from benchlab.discrepancy.measured import Measured
from benchlab.discrepancy.problem import Problem
from tests.unit.discrepancy.drawn import active, drawn, few
from tests.unit.discrepancy.scenes import base


def insisting(named: Active, monkeypatch: pytest.MonkeyPatch, measured: Measured) -> Explained:
    """Explained where whatever is there, this effect is said to be it."""

    def identified(problem: Problem, *_: object) -> Identified:
        best = fit(problem, (named,))
        return Identified("named", best, (best,), (best,), (best,), 0.04, 0.5, 1.0)

    monkeypatch.setattr(room, "identify", identified)
    return explain(measured, base(3), {one.name: one for one in few()})


def test_what_predicts_held_out_samples_no_better_is_not_named(monkeypatch: pytest.MonkeyPatch) -> None:
    named = active("viscoelasticity")
    worse = held = None
    for seed in range(1, 8):  # samples of which a little creep explains a little
        found = insisting(named, monkeypatch, drawn(seed)).explanation
        if found.warnings:
            worse = found
        else:
            held = found
    assert worse is not None, "with nothing hidden, some studies are predicted worse"
    assert worse.verdict == "unexplained" and not worse.effects and not worse.rivals
    assert "viscoelasticity fits best and is not named" in worse.warnings[-1]
    assert worse.gap.heldout_after == worse.gap.heldout_before and worse.gap.rmse_after == worse.gap.rmse_before
    assert held is None or held.gap.heldout_after < held.gap.heldout_before


def test_what_predicts_them_better_is(monkeypatch: pytest.MonkeyPatch) -> None:
    measured = drawn(1, [active("friction", half_width_deg=4)])
    found = insisting(active("friction"), monkeypatch, measured).explanation
    assert found.verdict == "named" and [effect.name for effect in found.effects] == ["friction"]
    assert found.gap.heldout_after < 0.8 * found.gap.heldout_before and not found.warnings


def test_what_is_true_of_one_design_alone_is_not_named(monkeypatch: pytest.MonkeyPatch) -> None:
    """One design bends a fifth more: a scale fits the samples better, and no design that the fit has not seen."""
    measured = drawn(1)
    odd = measured.designs[0]
    runs = [
        replace(run, values={"angle_deg": 1.2 * run.values["angle_deg"]}) if run.design == odd else run
        for run in measured.runs
    ]
    found = insisting(active("camera_scale"), monkeypatch, replace(measured, runs=tuple(runs))).explanation
    assert found.verdict == "unexplained" and not found.effects
    assert "held-out designs are predicted no better" in found.warnings[-1]
