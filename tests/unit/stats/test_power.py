"""Power against R's published examples, statsmodels, and simulation."""

import math

import numpy as np
import pytest
from scipy import stats
from statsmodels.stats.power import FTestAnovaPower

from benchlab.stats.power import MOST_SAMPLES, anova_power, find_power, pair_power


def difference(f: float, groups: int) -> float:
    """Of two extreme means, in standard deviations, for Cohen's f with all others midway: f² = difference²/(2·groups)."""
    return f * math.sqrt(2 * groups)


def test_as_r_prints_it() -> None:
    """R: pwr.anova.test(f = 0.28, k = 4, n = 20): 0.5149793; pwr.anova.test(k = 5, f = .25, power = .8): n 39.15340;
    power.anova.test(groups = 4, n = 5, between.var = 1, within.var = 3): 0.3535594; power.t.test(n = 20, delta = 1): 0.8689528."""
    assert anova_power(difference(0.28, 4), 20, 4, 0.05) == pytest.approx(0.5149793, abs=6e-8)
    assert anova_power(difference(0.25, 5), 39.15340, 5, 0.05) == pytest.approx(0.8, abs=1e-6)
    assert anova_power(difference(math.sqrt(3 * 1 / 4 / 3), 4), 5, 4, 0.05) == pytest.approx(0.3535594, abs=6e-8)
    assert pair_power(1.0, 20, 2, 0.05) == pytest.approx(0.8689528, abs=6e-8)


def test_samples_as_r_finds_them() -> None:
    """R: power.t.test(power = .90, delta = 1): n 22.02110; power.anova.test(groups = 4, between.var = 1, within.var = 3, power = .80):
    n 11.92613. Whole samples: 23 and 12."""
    of_pair = find_power(1.0, 5, 2, 0.05, 1.0).pair.samples
    assert of_pair is not None and of_pair[1] == 23
    of_anova = find_power(math.sqrt(3), 5, 4, 0.05, math.sqrt(3) * difference(0.5, 4)).anova.samples
    assert of_anova is not None and of_anova[0] == 12


@pytest.mark.parametrize(("groups", "n"), [(3, 5), (5, 8), (9, 4)])
def test_as_statsmodels_finds_it(groups: int, n: int) -> None:
    reference = FTestAnovaPower().power(effect_size=0.5, nobs=groups * n, alpha=0.05, k_groups=groups)
    assert anova_power(difference(0.5, groups), n, groups, 0.05) == pytest.approx(reference, rel=1e-8)


def test_as_drawn_studies_show_it() -> None:
    """20,000 studies of four groups of five, two of them 2.5 standard deviations apart: Tukey's test of that pair, and the F test."""
    rng = np.random.default_rng(0)
    values = rng.normal(0, 1, (20_000, 4, 5)) + np.array([-1.25, 1.25, 0, 0])[:, None]
    s = np.sqrt(values.var(axis=2, ddof=1).mean(axis=1))
    q = (values[:, 1].mean(1) - values[:, 0].mean(1)) / (s / math.sqrt(5))
    seen = np.mean(q > stats.studentized_range.isf(0.05, 4, 16))
    assert pair_power(2.5, 5, 4, 0.05) == pytest.approx(seen, abs=0.01)
    seen = np.mean(stats.f_oneway(*values.swapaxes(0, 1), axis=1).pvalue < 0.05)
    assert anova_power(2.5, 5, 4, 0.05) == pytest.approx(seen, abs=0.01)


@pytest.mark.parametrize("groups", [2, 5, 40, 500])
def test_the_smallest_difference_is_seen_with_its_power(groups: int) -> None:
    found = find_power(2.0, 5, groups, 0.05)
    assert found.anova.power is None and found.pair.samples is None
    for share, of_anova, of_pair in zip((0.8, 0.9), found.anova.smallest, found.pair.smallest):
        assert anova_power(of_anova / 2, 5, groups, 0.05) == pytest.approx(share, abs=1e-6)
        assert pair_power(of_pair / 2, 5, groups, 0.05) == pytest.approx(share, abs=1e-6)


def test_the_number_of_samples_is_the_smallest_that_does() -> None:
    found = find_power(1.0, 5, 5, 0.05, 1.5)
    for test, power in ((found.anova, anova_power), (found.pair, pair_power)):
        assert test.samples is not None
        for share, n in zip((0.8, 0.9), test.samples):
            assert n is not None and power(1.5, n, 5, 0.05) >= share > power(1.5, n - 1, 5, 0.05)


def test_what_no_study_can_see_has_no_number() -> None:
    found = find_power(1.0, 5, 3, 0.05, 1e-4)
    assert found.anova.samples == (None, None) and MOST_SAMPLES == 1_000_000
    huge = find_power(1.0, 5, 3, 0.05, 1e6)
    assert huge.anova.power == pytest.approx(1) and huge.pair.samples == (2, 2)
