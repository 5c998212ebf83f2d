from dataclasses import replace

import numpy as np
import pytest
from scipy import stats

from benchlab.discrepancy.problem import off
from tests.unit.discrepancy.drawn import problem


def test_whitening_makes_the_covariance_of_a_sample_one() -> None:
    made = problem(1, designs=2, protocol=("slow", "hold"))
    mine = np.flatnonzero(made.features.sample == 1)
    own = made.features.feature[mine]
    place = np.searchsorted(made.scatter.features_of[0], own)
    number = np.bincount(made.features.feature)[own]
    covariance = made.scatter.covariance[0][np.ix_(place, place)] + np.diag(number * made.systematic[own] ** 2)
    cells = np.zeros((len(made.features.value), len(mine)))
    cells[mine] = covariance
    half = made.whiten(cells)[mine]
    cells[mine] = half.T
    assert made.whiten(cells)[mine] == pytest.approx(np.eye(len(mine)), abs=1e-7)


def test_t_of_drawn_scatter_exceeds_its_quantile_as_often_as_it_should() -> None:
    made = problem(2, designs=2, protocol=("slow",))
    random = np.random.default_rng(3)
    direction = made.whiten(made.features.value)[:, None]
    t = np.array([made.t_values(direction, noise)[0] for noise in made.noise(random, 600)])
    assert 0.02 < np.mean(t > stats.t.ppf(0.95, made.freedom)) < 0.08
    assert abs(np.mean(t)) < 4 * np.std(t) / np.sqrt(600)


def test_what_the_tangent_spans_is_gone_and_the_rest_stays() -> None:
    random = np.random.default_rng(1)
    directions, tangent = random.standard_normal((20, 3)), random.standard_normal((20, 2))
    assert tangent.T @ off(directions, tangent) == pytest.approx(np.zeros((2, 3)), abs=1e-12)
    assert off(tangent, tangent) == pytest.approx(0, abs=1e-12)
    assert off(directions, np.zeros((20, 0))) is directions


def test_means_over_samples_and_their_error_are_the_direct_ones() -> None:
    made = problem(4, designs=2, protocol=("slow",))
    values, feature = made.features.value, made.features.feature
    direct = [values[feature == f].mean() for f in range(len(made.features.features))]
    assert made.mean_over_samples(values) == pytest.approx(direct, rel=1e-12)
    sd = np.concatenate([np.sqrt(np.diag(c)) for c in made.scatter.covariance])
    assert made.error_of_means == pytest.approx(np.sqrt(np.mean(sd**2 / 4)), rel=1e-9)
    assert replace(made, features=made.features.only(made.features.sample > 0)).samples == made.samples - 1
