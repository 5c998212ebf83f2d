"""Repeatability, reproducibility, h and k against the worked example of ASTM E691, glucose in serum."""

import math

import numpy as np
import pytest

from benchlab.stats.comparison import compare
from benchlab.stats.consistency import h_critical, k_critical
from benchlab.stats.measurements import measurements_of
from benchlab.stats.repeatability import FACTOR, Repeatability
from tests.unit.stats.samples import PLANT_GROWTH, glucose, measured

# E691, table of precision statistics: material, s_r, s_R, r, R (2.8 s)
PUBLISHED = {
    "A": (1.0632, 1.0632, 2.98, 2.98),
    "B": (1.4949, 1.5796, 4.19, 4.42),
    "D": (2.6251, 3.3657, 7.35, 9.42),
    "E": (3.9350, 4.1923, 11.02, 11.74),
}


@pytest.fixture(scope="module")
def found() -> Repeatability:
    return compare(glucose()).repeatability


def test_precision_of_each_material(found: Repeatability) -> None:
    assert [design.name for design in found.designs] == list(PUBLISHED)
    for design in found.designs:
        s_r, s_R, r, R = PUBLISHED[design.name]
        assert (design.s_r, design.s_R) == (pytest.approx(s_r, abs=6e-5), pytest.approx(s_R, abs=6e-5))
        assert (design.r, design.R) == (pytest.approx(r, abs=6e-3), pytest.approx(R, abs=6e-3))


def test_h_and_k_of_each_laboratory(found: Repeatability) -> None:
    """E691's example: k of laboratory 2 for material E is 2.33, beyond the critical 2.06; laboratory 4's h for B is 1.85, within 2.15."""
    cells = {(cell.level, cell.laboratory): cell for cell in found.cells}
    assert len(cells) == 32
    of_2, of_4 = cells["E", "lab 2"], cells["B", "lab 4"]
    assert (round(of_2.k or 0, 2), round(of_2.k_critical or 0, 2), of_2.outside) == (2.33, 2.06, True)
    assert (round(of_4.h or 0, 2), round(of_4.h_critical or 0, 2), of_4.outside) == (1.85, 2.15, False)
    assert [key for key, cell in cells.items() if cell.outside] == [("E", "lab 2")]


def test_h_and_k_come_from_their_definitions(found: Repeatability) -> None:
    for material in PUBLISHED:
        cells = [cell for cell in found.cells if cell.level == material]
        h, k = np.array([cell.h for cell in cells]), np.array([cell.k for cell in cells])
        assert h.sum() == pytest.approx(0, abs=1e-9) and (h**2).sum() == pytest.approx(7)  # p − 1
        assert (k**2).sum() == pytest.approx(8)  # p, with as many replicates in each


def test_critical_values_of_e691() -> None:
    """E691, table of critical values at 0.5 %: h for p laboratories; k for 3 with 2 replicates, and for 8 with 3."""
    assert [round(h_critical(p), 2) for p in (3, 5, 8, 10, 30)] == [1.15, 1.74, 2.15, 2.29, 2.64]
    assert round(k_critical(1, 2), 2) == 1.72 and round(k_critical(2, 14), 2) == 2.06


def test_critical_values_are_exceeded_once_in_200() -> None:
    """60,000 drawn levels of six laboratories with three replicates."""
    rows = np.random.default_rng(0).normal(0, 1, (60_000, 6, 3))
    mean, variance = rows.mean(2), rows.var(2, ddof=1)
    h = (mean[:, 0] - mean.mean(1)) / mean.std(1, ddof=1)
    k = np.sqrt(variance[:, 0] / variance.mean(1))
    assert np.mean(np.abs(h) > h_critical(6)) == pytest.approx(0.005, abs=0.0011)
    assert np.mean(k > k_critical(2, 10)) == pytest.approx(0.005, abs=0.0011)


def test_samples_without_cycles_are_the_replicates() -> None:
    found = compare(measured(PLANT_GROWTH)).repeatability
    assert found.replicate == "sample" and found.pooled.s_R is None and found.pooled.R is None
    assert found.pooled.s_r == pytest.approx(math.sqrt(10.49209 / 27), rel=1e-6)
    assert found.pooled.r == pytest.approx(2.8 * math.sqrt(10.49209 / 27), rel=1e-6)


def test_two_results_differ_by_less_than_the_limit_in_95_of_100() -> None:
    """2.8 is 1.96·√2, rounded as ISO 5725-6 rounds it."""
    rng = np.random.default_rng(0)
    apart = np.abs(np.subtract(*rng.normal(0, 1, (2, 200_000))))
    assert np.mean(apart < FACTOR) == pytest.approx(0.952, abs=0.002)


def test_one_reading_of_any_sample_scatters_by_s_R() -> None:
    rng = np.random.default_rng(4)
    sample = rng.normal(0, 2, (1, 400, 1)).repeat(4, axis=2)
    rows = np.concatenate([sample + rng.normal(0, 1, (1, 400, 4)) for _ in range(1)])
    names = ["a"] * 800 + ["b"] * 800
    samples = np.repeat(np.arange(400), 4).astype(str).tolist()
    found = compare(measurements_of(names, rows.ravel().tolist(), samples)).repeatability
    assert found.pooled.s_r == pytest.approx(1.0, rel=0.05)
    assert found.pooled.s_R == pytest.approx(math.sqrt(5), rel=0.08)
