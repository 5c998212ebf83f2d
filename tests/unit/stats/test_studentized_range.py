"""The studentized range against Student's t, published tables, and scipy."""

import math

import numpy as np
import pytest
from scipy import special, stats

from benchlab.stats.studentized_range import StudentizedRange


@pytest.mark.parametrize("df", [1.0, 1.3, 2.0, 4.0, 20.0, 300.0])
@pytest.mark.parametrize("alpha", [0.2, 0.05, 1e-3, 1e-4])
def test_two_groups_are_students_t(df: float, alpha: float) -> None:
    """q = √2·|t|. Also at one degree of freedom and 1e-4, where scipy 1.17's own sf gives 2e-14 for 1e-4."""
    t = special.stdtrit(df, 1 - alpha / 2)
    found = StudentizedRange(2)
    assert found.beyond(np.array([math.sqrt(2) * t]), np.array([df])).item() == pytest.approx(alpha, rel=1e-8)
    assert found.critical(alpha, np.array([df])).item() == pytest.approx(math.sqrt(2) * t, rel=1e-8)


@pytest.mark.parametrize(
    ("k", "df", "alpha", "table"),
    [(3, 10, 0.05, 3.88), (5, 20, 0.05, 4.23), (10, 60, 0.05, 4.65), (3, 10, 0.01, 5.27), (4, 5, 0.01, 7.80), (20, 5, 0.05, 8.21)],
)  # fmt: skip
def test_table_of_harter(k: int, df: int, alpha: float, table: float) -> None:
    """Harter 1960 (Ann. Math. Stat. 31:1122), as textbooks print it with two decimals. R: qtukey(1 - alpha, k, df)."""
    assert StudentizedRange(k).critical(alpha, np.array([float(df)])).item() == pytest.approx(table, abs=5.1e-3)


@pytest.mark.parametrize(("k", "df"), [(3, 1.7), (5, 7.3), (12, 40.0), (40, 160.0)])
def test_as_scipy_integrates_it(k: int, df: float) -> None:
    q = np.array([0.3, 1.0, 3.0, 6.0, 11.0])
    found = StudentizedRange(k).beyond(q, np.full(5, df))
    assert found == pytest.approx([stats.studentized_range.sf(x, k, df) for x in q], rel=1e-7, abs=1e-11)


def test_shapes_ends_and_order() -> None:
    found = StudentizedRange(4)
    q = np.linspace(0, 60, 1203).reshape(3, 401)
    p = found.beyond(q, np.full(q.shape, 8.0))
    assert p.shape == q.shape and p[0, 0] == pytest.approx(1.0, abs=1e-12)
    assert (np.diff(p.ravel()) <= 1e-14).all() and p.min() >= 0
    assert found.beyond(np.array([1e9]), np.array([30.0])).item() < 1e-13
