from dataclasses import replace

import numpy as np
import pytest
from scipy import stats

from benchlab.discrepancy.bank import Bank
from benchlab.discrepancy.candidates import distinct, in_set, p_enough, reach
from benchlab.discrepancy.fit import Fit, fit, nothing
from benchlab.discrepancy.rules import Rules
from tests.unit.discrepancy.drawn import TRUE, active, problem, studies


def test_what_an_effect_could_explain_counts_with_its_sign_and_beside_the_model() -> None:
    random = np.random.default_rng(1)
    direction, other = random.standard_normal((2, 30))
    bank = Bank((active("friction"), active("friction")), np.array([0.1 * direction, direction]).T)
    none = np.zeros((30, 0))
    assert reach(bank, 2 * direction, none) == {"friction": pytest.approx(4 * direction @ direction)}
    assert reach(bank, -2 * direction, none) == {"friction": 0.0}
    assert reach(bank, 2 * direction, direction[:, None]) == {"friction": 0.0}
    free = direction - other * (other @ direction) / (other @ other)
    assert reach(bank, 2 * direction, other[:, None])["friction"] == pytest.approx(4 * free @ free)


def test_the_truth_is_enough_as_often_as_p_says_and_its_rival_never() -> None:
    """The better of the two speaks against the other; where that is the truth, p is what it says."""
    p, wrong = [], []
    for made in studies():
        truth, rival = fit(made, [TRUE]), fit(made, [active("pressure_offset")])
        p.append(p_enough(made, truth, rival)[0])
        wrong.append(p_enough(made, rival, truth)[0])
    low, high = stats.binom(len(p), [0.05, 0.5]).interval(0.998)
    assert low[0] <= np.sum(np.array(p) < 0.05) <= high[0]
    assert low[1] <= np.sum(np.array(p) < 0.5) <= high[1]
    assert max(wrong) < 0.01


def test_what_is_the_same_at_one_length_stays_in_the_set_and_what_differs_does_not() -> None:
    made = problem(3, [active("end_caps", cap_mm=6)], designs=2, protocol=("slow", "fast"))
    bare = nothing(made)
    best, same, other = (fit(made, [active(name)]) for name in ("end_caps", "camera_scale", "friction"))
    assert in_set(made, best, best, bare, Rules())
    assert in_set(made, same, best, bare, Rules()) and p_enough(made, same, best)[0] > 0.05
    assert not in_set(made, other, best, bare, Rules())


@pytest.mark.parametrize(("gained", "smallest"), [(1000.0, 5.0), (100.0, 2.0)], ids=["a share of it", "so much"])
def test_what_explains_nearly_as_much_is_alike(gained: float, smallest: float) -> None:
    made = problem(3, [active("end_caps", cap_mm=6)], designs=2, protocol=("slow",))
    best, other = fit(made, [active("end_caps")]), fit(made, [active("friction")])
    assert p_enough(made, other, best)[0] < Rules().rival
    bare = replace(nothing(made), misfit=best.misfit + gained)
    assert in_set(made, replace(other, misfit=best.misfit + 0.99 * smallest), best, bare, Rules())
    assert not in_set(made, replace(other, misfit=best.misfit + 1.01 * smallest), best, bare, Rules())


def test_of_each_set_of_names_the_best_is_kept() -> None:
    nothing_there = np.zeros(0)

    def one(misfit: float, *names: str) -> Fit:
        return Fit(tuple(map(active, names)), nothing_there, nothing_there, nothing_there[:, None], misfit)

    fits = [one(3, "friction"), one(2, "softening", "friction"), one(1, "friction"), one(0, "friction", "softening")]
    assert distinct(fits) == [fits[3], fits[2]]


def test_what_its_own_parameters_could_take_up_does_not_speak_against_a_candidate() -> None:
    made = problem(3, [TRUE], designs=2, protocol=("slow",))
    one = fit(made, [TRUE])
    farther = replace(one, model=one.model + 3 * one.tangent[:, 0])
    assert p_enough(made, replace(one, residual=one.residual + 5 * one.tangent[:, 0]), farther) == (1.0, 0.0)
