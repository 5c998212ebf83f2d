"""Intervals of effect sizes: published limits, and the distributions integrated in another way."""

import math
from decimal import Decimal

import numpy as np
import pytest
from scipy import integrate, special, stats

from benchlab.stats.effect_size import hedges_g
from benchlab.stats.groups import group_of
from benchlab.stats.noncentral import interval_of_delta, interval_of_lambda


def f_below(F: float, a: float, b: float, lam: float) -> float:
    """Noncentral F as a Poisson mixture of beta distributions, term by term."""
    j = np.arange(0, int(lam + 20 * math.sqrt(lam + 1) + 50))
    return float(np.sum(stats.poisson.pmf(j, lam / 2) * special.betainc(a / 2 + j, b / 2, a * F / (a * F + b))))


def t_below(t: float, df: float, delta: float) -> float:
    """Noncentral t as the integral over the scale, √(χ²/df)."""
    density = stats.chi(df, scale=1 / math.sqrt(df))
    centre = max(delta / t, 1e-3) if t else 1.0
    points = sorted({centre, 1.0})
    return float(
        integrate.quad(lambda s: special.ndtr(t * s - delta) * density.pdf(s), 0, 60, points=points, limit=400)[0]
    )


def test_limits_that_mbess_publishes() -> None:
    """R: MBESS::conf.limits.nct(ncp = 2.83, df = 126, conf.level = .95): 0.8337502, 4.815359."""
    assert interval_of_delta(2.83, 126, 0.95) == (pytest.approx(0.8337502, abs=1e-7), pytest.approx(4.815359, abs=1e-6))


@pytest.mark.parametrize(("F", "a", "b"), [(5.0, 2, 12), (529.46, 4, 20), (21.0, 8, 180), (0.9, 4, 20), (60.0, 1, 3)])
@pytest.mark.parametrize("confidence", [0.9, 0.95, 0.99])
def test_ends_of_lambda(F: float, a: float, b: float, confidence: float) -> None:
    low, high = interval_of_lambda(F, a, b, confidence)
    tail = (1 - confidence) / 2
    assert f_below(F, a, b, high) == pytest.approx(tail, rel=1e-6)
    if low == 0:
        assert special.fdtr(a, b, F) <= 1 - tail
    else:
        assert f_below(F, a, b, low) == pytest.approx(1 - tail, rel=1e-8)


@pytest.mark.parametrize(("t", "df"), [(0.0, 8.0), (0.4, 2.0), (3.0, 8.0), (27.0, 8.0), (12.0, 40.0)])
def test_ends_of_delta(t: float, df: float) -> None:
    low, high = interval_of_delta(t, df, 0.95)
    assert t_below(t, df, low) == pytest.approx(0.975, rel=1e-6)
    assert t_below(t, df, high) == pytest.approx(0.025, rel=1e-5)
    assert interval_of_delta(-t, df, 0.95) == pytest.approx((-high, -low))


def test_large_values_join_without_a_step() -> None:
    """On either side of where the numerator's own scatter is left out."""
    for below, above in (
        (interval_of_delta(999.9, 8, 0.95), interval_of_delta(1000.1, 8, 0.95)),
        (interval_of_lambda(249_999, 4, 20, 0.95), interval_of_lambda(250_001, 4, 20, 0.95)),
    ):
        assert above == pytest.approx(below, rel=3e-4) and above > below
    assert interval_of_delta(1e12, 8, 0.95)[0] == pytest.approx(
        1e9 * interval_of_delta(1001, 8, 0.95)[0] / 1.001, rel=1e-9
    )


def test_hedges_g_is_unbiased() -> None:
    """Mean over 4000 drawn pairs of five and five, two standard deviations apart: 2, where Cohen's d gives 2.2."""
    rng = np.random.default_rng(2)
    a, b = rng.normal(0, 1, (4000, 5)), rng.normal(2, 1, (4000, 5))
    found = [
        hedges_g(group_of("a", x, Decimal(0)), group_of("b", y, Decimal(0)), 0.95) for x, y in zip(a[:400], b[:400])
    ]
    assert np.mean([one.low <= 2 <= one.high for one in found if one]) == pytest.approx(0.95, abs=0.035)
    d = (b.mean(1) - a.mean(1)) / np.sqrt((a.var(1, ddof=1) + b.var(1, ddof=1)) / 2)
    ratio = found[0].g / d[0] if found[0] else 0.0
    assert (d * ratio).mean() == pytest.approx(2.0, abs=0.05) and d.mean() > 2.12


def test_none_without_scatter_or_freedom() -> None:
    flat, lone = group_of("a", np.array([1.0, 1.0, 1.0]), Decimal(0)), group_of("b", np.array([2.0]), Decimal(0))
    two = group_of("c", np.array([1.0, 2.0]), Decimal(0))
    assert hedges_g(flat, flat, 0.95) is None and hedges_g(two, lone, 0.95) is None
