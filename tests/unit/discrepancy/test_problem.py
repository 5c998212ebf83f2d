from dataclasses import replace

import numpy as np
import pytest
from scipy import sparse, stats

from benchlab.discrepancy.parts import parts_of
from benchlab.discrepancy.problem import Problem, off
from tests.unit.discrepancy.drawn import active, problem


def test_whitening_makes_the_covariance_of_a_sample_one() -> None:
    made = problem(1, designs=2, protocol=("slow", "hold"))
    mine = np.flatnonzero(made.features.sample == 1)
    own = made.features.feature[mine]
    place = np.searchsorted(made.scatter.features_of[0], own)
    number = np.bincount(made.features.feature)[own]
    error = made.systematic.toarray()[own]
    covariance = made.scatter.covariance[0][np.ix_(place, place)] + np.sqrt(np.outer(number, number)) * (
        error @ error.T
    )
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


def test_drawn_scatter_is_larger_or_smaller_as_its_estimate_is_uncertain() -> None:
    made = problem(1, designs=2, protocol=("slow",))
    made.__dict__["systematic"] = sparse.csr_array((len(made.features.features),) * 2)
    noise = made.noise(np.random.default_rng(5), 2000)
    size = np.mean(noise**2, axis=1)  # of C independent cells: f/χ²_f, but for their own 2/C
    cells = noise.shape[1]
    assert stats.kstest(made.freedom / size, lambda x: stats.chi2.cdf(x, made.freedom)).pvalue > 0.01
    usual = stats.f(cells, made.freedom)  # the ratio of two means of squares
    assert stats.kstest(size, usual.cdf).pvalue > 0.01
    assert np.mean(size) == pytest.approx(made.freedom / (made.freedom - 2), rel=0.1)


def dense(made: Problem, scatter: float = 1.0) -> np.ndarray:
    """(C, C): covariance of the whitened cells, from the whole matrix: `scatter` times that between samples, and the systematic error."""
    features = made.features
    covariance = np.zeros((len(features.value), len(features.value)))
    for sample, design in enumerate(features.sample_design):
        mine = np.flatnonzero(features.sample == sample)
        place = np.searchsorted(made.scatter.features_of[design], features.feature[mine])
        covariance[np.ix_(mine, mine)] = scatter * made.scatter.covariance[design][np.ix_(place, place)]
    error = made.systematic.toarray()[features.feature]
    covariance += error @ error.T
    whiten = made.whiten(np.eye(len(features.value)))
    return np.asarray(whiten @ covariance @ whiten.T)


def test_errors_of_the_scores_are_those_of_the_whole_covariance() -> None:
    made = problem(1, [active("camera_scale", factor=1.3)], designs=2, protocol=("slow",))
    random = np.random.default_rng(6)
    directions = np.column_stack([made.base, random.standard_normal((len(made.base), 3))])
    whole = np.sqrt(np.einsum("ck,cd,dk->k", directions, dense(made), directions))
    noise = random.standard_normal((5, len(made.base)))
    assert made.largest_t_of_noise(directions, noise) == pytest.approx((noise @ directions / whole).max(axis=1))
    meat = made.scatter_meat(directions) + made.systematic_meat(directions)
    assert meat == pytest.approx(directions.T @ dense(made) @ directions)


def test_drawn_noise_has_the_scatter_and_the_systematic_error_that_all_samples_share() -> None:
    made = problem(1, [active("camera_scale", factor=1.3)], designs=2, samples=8, protocol=("up",))
    directions = np.column_stack([made.base, np.random.default_rng(6).standard_normal((len(made.base), 3))])
    scores = made.noise(np.random.default_rng(7), 6000) @ directions
    expected = directions.T @ dense(made, made.freedom / (made.freedom - 2)) @ directions
    without = directions.T @ dense(made, 0.0) @ directions
    assert np.var(scores, axis=0) == pytest.approx(np.diag(expected), rel=0.1)
    assert without[0, 0] > 0.3 * expected[0, 0]  # along the base it is a good part


def test_the_systematic_error_is_a_tenth_of_a_gap_and_next_to_none_without() -> None:
    made = problem(3, [active("camera_scale", factor=1.3)], designs=2, protocol=("slow",))
    base_deg = made.mean_over_samples(made.cells(()))
    course, _, loops = parts_of(made.features)
    sd = made.systematic.toarray() @ np.ones(len(base_deg))  # alike in all features: no loop
    assert sd == pytest.approx(0.1 * (1 - 1 / 1.3) * np.sqrt(np.mean(base_deg**2)), rel=0.03)
    assert (
        np.abs(made.systematic @ loops).max() < 0.1 * np.abs(made.systematic @ course).max()
    )  # what has no loop may not be wrong in one
    alike = replace(made, features=replace(made.features, value=made.cells(())))
    assert alike.systematic.toarray() == pytest.approx(
        4e-4 * base_deg.max() * np.eye(len(base_deg)), rel=1e-6, abs=1e-9
    )


def test_the_error_of_loops_is_a_fifth_of_them() -> None:
    made = problem(3, [active("friction", width_share=0.3)], designs=2, protocol=("slow",))
    gap = made.mean_over_samples(made.features.value) - made.mean_over_samples(made.base_cells)
    loops = parts_of(made.features)[2]
    scale = 0.2 * np.sqrt(np.mean((loops @ gap) ** 2))
    unit = loops @ np.random.default_rng(1).standard_normal(len(gap))
    assert made.systematic @ unit == pytest.approx(scale * unit, rel=0.05)


def test_a_quantity_that_is_left_out_has_no_gap() -> None:
    made = problem(3, [active("camera_scale", factor=1.3)], designs=2, protocol=("slow",))
    none = replace(made, features=made.features.only(np.zeros(len(made.features.value), dtype=bool)))
    assert none.in_parts(np.ones(len(made.features.features))) == pytest.approx(np.zeros((1, 3)))
