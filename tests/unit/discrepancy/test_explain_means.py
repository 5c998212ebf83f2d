"""A table of means, explained: its samples, its own standard deviations, designs held out. Why effects are not judged."""

from __future__ import annotations

import numpy as np
import pytest

from benchlab.discrepancy.effects.catalogue import built_in
from benchlab.discrepancy.explain import explain
from benchlab.discrepancy.measured import Summary
from tests.unit.discrepancy import scenes


def test_a_table_of_means_counts_its_samples_and_holds_out_designs() -> None:
    base = scenes.base(4, known=False)
    names = tuple(sorted(base.designs))
    mean = np.array([base.designs[name].curves["angle_deg"][-1] for name in names]) - 6.0
    sd, n = np.array([2.0, 3.0, 4.0, 2.5]), np.array([5.0, 5.0, 5.0, 10.0])
    table = Summary(names, np.full(4, scenes.TOP_MPa), mean, sd, n, "angle_deg", "a test")
    found = explain(table, base, built_in()).explanation
    assert found.samples == 25
    assert {part.kind for part in found.held_out} == {"design"}
    assert found.curves.sd.tolist() == sd.tolist() and found.curves.n.tolist() == n.tolist()
    pooled = np.sum((n - 1) * sd**2) / np.sum(n - 1)
    assert found.gap.noise_floor == pytest.approx(np.sqrt(np.mean(pooled / n)))
    assert found.verdict != "agree" and found.gap.rmse_before == pytest.approx(6.0)


@pytest.mark.parametrize(
    ("name", "knob"),
    [
        ("seam_margin", "seam_margin_mm"),
        ("fabric_compliance", "fabric_modulus"),
        ("bladder_stiffness", "bladder_N_per_mm"),
    ],
)
def test_why_a_structural_effect_is_not_judged(name: str, knob: str) -> None:
    effect = built_in()[name]
    assert effect.cannot_show(scenes.scene(on=scenes.base(2), designs=2)) == ""
    unknown = effect.cannot_show(scenes.scene(on=scenes.base(2, known=False), designs=2))
    assert "dimensions are not known" in unknown
    without = effect.cannot_show(scenes.scene(on=scenes.base(2, knobs=()), designs=2))
    assert without.startswith(f"the simulation has no sensitivity to {knob}")


def test_who_has_bulging_windows() -> None:
    effect = built_in()["window_ballooning"]
    reasons = {
        k: effect.cannot_show(scenes.scene(on=scenes.base(2, kind=k), designs=2)) for k in ("cell", "foreign", "beam")
    }
    assert reasons == {
        "cell": "the shell cell has it", "foreign": "whether another engine's curves have it is not known", "beam": ""
    }  # fmt: skip
