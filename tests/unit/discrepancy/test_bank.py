import numpy as np
import pytest
from scipy import stats

from benchlab.discrepancy.bank import MOST_STARTS, bank_of, flexible, principal, scan, starts_of
from benchlab.discrepancy.problem import Problem
from tests.unit.discrepancy.drawn import EFFECTS, active, problem
from tests.unit.discrepancy.scenes import base

FEW = [EFFECTS[name] for name in ("friction", "camera_scale", "pressure_offset")]


@pytest.fixture(scope="module")
def made() -> Problem:
    return problem(2, designs=2, protocol=("slow",))


def test_a_direction_is_what_the_effect_does_to_the_base(made: Problem) -> None:
    found = bank_of(made, [EFFECTS["camera_scale"], EFFECTS["flex_hysteresis"]])
    assert {one.name for one in found.actives} == {"camera_scale"}  # without a flex sensor the other one does nothing
    expected = [(1 / one.values["factor"] - 1) * made.base for one in found.actives]
    assert np.allclose(found.directions.T, expected, atol=1e-9)
    assert found.without(["camera_scale", "flex_hysteresis"]).directions.shape == (len(made.base), 0)


def test_a_form_that_does_the_same_is_kept_once() -> None:
    effect = EFFECTS["temperature"]
    forms = {}
    for knobs in ((), ("film_modulus",)):
        made = problem(1, designs=2, protocol=("slow", "fast"), against=base(2, knobs=knobs))
        forms[knobs] = {one.form for one in bank_of(made, [effect]).actives}
    assert forms["film_modulus",] == set(effect.forms)
    assert forms[()] == set(effect.forms) - {"on the angle"}  # as without the knob all of it acts there


def test_starts_are_few_and_reach_from_the_first_to_nearly_the_last() -> None:
    for effect in EFFECTS.values():
        found = starts_of(effect)
        whole = int(np.prod([len(p.starts or (0,)) for p in effect.parameters]))
        assert min(whole, MOST_STARTS / 2) <= len(found) <= MOST_STARTS
        assert len({tuple(values.values()) for values in found}) == len(found)
        first = effect.parameters[0]
        assert {values[first.name] for values in found} == set(map(float, first.starts or (first.typical,)))


def test_misfits_of_no_name_span_a_gain_of_one_design_and_a_loop(made: Problem) -> None:
    basis = principal(flexible(made), 1e-9)
    about = [made.features.features[i] for i in made.features.feature]
    gain = made.cells(()) * np.array([one.design == 1 for one in about])
    way = np.array([{"loading": -1.0, "unloading": 1.0}[one.direction] for one in about])
    loop = way * np.array([one.pressure_MPa * (0.35 - one.pressure_MPa) for one in about])
    for misfit, most in ((gain, 0.01), (loop, 1e-6), (gain + 20 * loop, 0.01)):
        white = made.whiten(misfit)
        assert np.sum((white - basis @ (basis.T @ white)) ** 2) < most * np.sum(white**2)
    jagged = made.whiten(np.array([(-1.0) ** one.bin for one in about]))
    assert np.sum((jagged - basis @ (basis.T @ jagged)) ** 2) > 0.3 * np.sum(jagged**2)


def test_of_scatter_alone_p_is_what_it_says(made: Problem) -> None:
    directions, none = bank_of(made, FEW).directions, np.zeros((len(made.base), 0))
    random = np.random.default_rng(1)
    noise = made.noise(random, 1000)
    p = np.array([scan(made, directions, one, none, noise).p for one in made.noise(random, 300)])
    low, high = stats.binom(300, [0.05, 0.5]).interval(0.998)
    found = np.sum(p[:, None] <= [0.05, 0.5], axis=0)
    assert np.all((low <= found) & (found <= high))


def test_an_effect_is_seen_along_its_own_direction_unless_the_model_has_it(made: Problem) -> None:
    bank, none = bank_of(made, FEW), np.zeros((len(made.base), 0))
    noise = made.noise(np.random.default_rng(1), 400)
    effect = made.model([active("friction", half_width_deg=8)]) - made.base
    found = scan(made, bank.directions, effect, none, noise)
    assert bank.actives[found.best].name == "friction"
    assert found.p == 1 / 401 and found.largest == found.t[found.best] > found.usual > 1
    assert scan(made, effect[:, None], effect, effect[:, None], noise).best == -1
    weak = 0.9 * found.usual / found.largest * effect
    p = [scan(made, bank.directions, weak, none, noise, multiplier).p for multiplier in (1.0, 1.5)]
    assert p[0] < p[1] and p[0] < 0.2
    assert scan(made, bank.directions, -effect, none, noise).t[found.best] == pytest.approx(-found.largest)
