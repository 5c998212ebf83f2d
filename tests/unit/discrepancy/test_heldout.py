from dataclasses import replace

import numpy as np
import pytest

from benchlab.discrepancy.fit import fit, nothing
from benchlab.discrepancy.heldout import FOLDS, held_out, noise_floor, together
from tests.unit.discrepancy.drawn import active, problem

HIDDEN = active("friction", half_width_deg=6)


def test_with_what_was_hidden_the_floor_is_reached_on_what_was_left_out_and_without_it_is_not() -> None:
    made = problem(6, [HIDDEN], designs=3, samples=6, protocol=("slow", "fast"))
    parts = held_out(made, fit(made, [active("friction")]))
    for kind in ("sample", "design", "rate"):
        before, after, floor = (
            together(parts, kind, value) for value in (lambda p: p.before, lambda p: p.after, lambda p: p.noise_floor)
        )
        assert after == pytest.approx(floor, rel=0.15) and before > 2 * floor
    alone = held_out(made, nothing(made))
    assert [part.after for part in alone] == [part.before for part in alone]
    assert [part.kind for part in alone] == ["sample"] * FOLDS + ["design"] * 3 + ["rate"] * 2


def test_what_is_left_out_has_no_part_in_the_fit() -> None:
    made = problem(6, [HIDDEN], designs=2, samples=3, protocol=("slow",))
    of_one = np.array([f.design for f in made.features.features])[made.features.feature] == 1
    value = np.where(of_one, made.cells([active("friction", half_width_deg=2)]), made.cells([HIDDEN]))
    mixed = replace(made, features=replace(made.features, value=value))
    after = {
        part.what: part.after for part in held_out(mixed, fit(mixed, [active("friction")])) if part.kind == "design"
    }
    apart = mixed.cells([active("friction", half_width_deg=2)]) - mixed.cells([HIDDEN])
    for number, name in enumerate(made.scene.names):
        assert after[name] == pytest.approx(np.sqrt(np.mean(apart[of_one == bool(number)] ** 2)), rel=0.02)


def test_the_only_kind_of_run_cannot_be_left_out() -> None:
    made = problem(6, [HIDDEN], designs=2, samples=3, protocol=("slow",))
    (rate,) = [part for part in held_out(made, fit(made, [active("friction")])) if part.kind == "rate"]
    assert np.isnan(rate.after) and rate.before > 0


def test_the_floor_is_the_standard_deviation_between_samples() -> None:
    made = problem(6, designs=2, samples=5, protocol=("slow",))
    value, feature = made.features.value, made.features.feature
    variance = [np.var(value[feature == f], ddof=1) for f in range(len(made.features.features))]
    assert noise_floor(made) == pytest.approx(np.sqrt(np.mean(variance)))
    assert np.isnan(noise_floor(made, np.zeros(len(value), bool)))
