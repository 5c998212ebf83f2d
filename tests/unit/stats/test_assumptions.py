"""Levene and Shapiro–Wilk against scipy."""

from decimal import Decimal

import numpy as np
import pytest
from scipy import stats

from benchlab.stats.assumptions import look_at_assumptions
from benchlab.stats.groups import groups_of_summaries
from tests.unit.stats.samples import INSECT_SPRAYS, PLANT_GROWTH, grouped


@pytest.mark.parametrize("data", [PLANT_GROWTH, INSECT_SPRAYS], ids=["PlantGrowth", "InsectSprays"])
def test_as_scipy_finds_them(data: dict[str, str]) -> None:
    rows = [np.array(values.split(), float) for values in data.values()]
    found = look_at_assumptions(grouped(data))
    levene = stats.levene(*rows, center="median")
    assert pytest.approx(levene.statistic) == found.levene.F and found.levene.p == pytest.approx(levene.pvalue)
    shapiro = stats.shapiro(np.concatenate([row - row.mean() for row in rows]))
    assert pytest.approx(shapiro.statistic) == found.shapiro.W and found.shapiro.p == pytest.approx(shapiro.pvalue)


def test_plant_growth_as_r_prints_it() -> None:
    """R: car::leveneTest(weight ~ group, PlantGrowth): F 1.1192, p 0.3412; shapiro.test(residuals(aov(...))): W 0.96607, p 0.4379."""
    found = look_at_assumptions(grouped(PLANT_GROWTH))
    assert (round(found.levene.F or 0, 4), round(found.levene.p or 0, 4)) == (1.1192, 0.3412)
    assert (round(found.shapiro.W or 0, 5), round(found.shapiro.p or 0, 4)) == (0.96607, 0.4379)


def test_what_cannot_be_looked_at_says_why() -> None:
    known = groups_of_summaries(["a", "b"], [5, 5], [Decimal(1), Decimal(2)], [0.5, 0.5])
    assert (
        look_at_assumptions(known).levene.reason
        == look_at_assumptions(known).shapiro.reason
        == "needs the values themselves"
    )
    flat = look_at_assumptions(grouped({"a": "1 1", "b": "2 2"}))
    assert flat.levene.reason and flat.shapiro.reason == "no scatter"
    pairs = look_at_assumptions(grouped({"a": "1 2", "b": "4 5"}))
    assert "do not scatter" in (pairs.levene.reason or "") and pairs.levene.F is None
