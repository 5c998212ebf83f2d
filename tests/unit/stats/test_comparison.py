"""A whole comparison: what it warns of, what it refuses, and its document."""

import json
from decimal import Decimal

import numpy as np
import pytest

from benchlab.errors import InputError, UsageError
from benchlab.stats.comparison import Comparison, compare, compare_summaries
from benchlab.stats.measurements import measurements_of
from benchlab.stats.wording import verdict
from tests.unit.stats.samples import INSECT_SPRAYS, MOSQUITO_WINGS, measured, nested


def of(text: str, **options: float) -> Comparison:
    """`a: 1 2, b: 3 4`"""
    return compare(measured(dict(part.strip().split(": ") for part in text.split(","))), **options)


@pytest.mark.parametrize("text", ["a: 1 2 3", "a: 1, b: 2", "a: 1, b: 2 3 4", "a: 1, b: 2, c: 3"])
def test_too_few_groups_or_samples_are_refused(text: str) -> None:
    with pytest.raises(InputError, match="a comparison needs >= 2 groups with >= 2 samples"):
        of(text)


@pytest.mark.parametrize(
    ("text", "words"), [("a: 2 2, b: 2 2", "all values are equal"), ("a: 2 2, b: 3 3", "differ: exactly")]
)
def test_no_scatter_gives_an_exact_statement(text: str, words: str) -> None:
    found = of(text)
    assert words in verdict(found) and found.power is None and found.anova.F is None
    assert any("are these measured values?" in warning for warning in found.warnings)
    assert json.loads(json.dumps(found.as_json(), allow_nan=False))["anova"]["p"] is None


def test_unbalanced_groups_name_the_method() -> None:
    (warning,) = [w for w in of("a: 1 2 3 4 5 6 7, b: 2 3 4").warnings if "unbalanced" in w]
    assert "Tukey–Kramer" in warning and "type II and III" in warning and "3 to 7" in warning


def test_names_that_look_alike_are_two_and_told() -> None:
    found = of("slw5: 1 2, SLW5: 3 4, 1: 5 6, 1.0: 7 8")
    assert len(found.groups) == 4
    assert found.warnings[0] == "groups look alike and are taken as two: 'slw5' and 'SLW5'; '1' and '1.0'"
    rows = measurements_of(list("aabb"), [1, 2, 3, 4], ["s1", "S1", "x", "y"])
    assert compare(rows).warnings[0] == "samples of a look alike and are taken as two: 's1' and 'S1'"


def test_long_names_are_cut_in_words_and_whole_in_the_document() -> None:
    name = "x" * 5000
    found = compare(measurements_of([name] * 2 + ["b"] * 3, [2, 2, 3, 5, 4]))
    assert all(len(warning) < 300 for warning in found.warnings)
    assert found.as_json()["groups"][0]["name"] == name
    with pytest.raises(InputError) as refused:
        compare(measurements_of([name, "b"], [1, 2]))
    assert len(str(refused.value)) < 300


def test_five_hundred_groups() -> None:
    rng = np.random.default_rng(0)
    names = [f"g{i}" for i in range(500) for _ in range(2)]
    found = compare(measurements_of(names, rng.normal(0, 1, 1000).tolist()))
    assert found.tukey == () and found.anova.df == (499, 500)
    assert "124750 pairs of 500 groups are not compared: choose up to 40 groups" in found.warnings


def test_disagreeing_tests_are_told_both() -> None:
    """One group scatters twenty times as much: the pooled variance hides what the two others show."""
    found = compare_summaries(["a", "b", "c"], [5, 5, 5], [10.0, 11.5, 10.7], [0.3, 0.3, 6.0])
    assert verdict(found).startswith(
        "No difference between the groups is shown: F(2, 12) = 0.2336, p = 0.8 (Welch DISAGREES: F(2, 7.12)"
    )
    assert "the classical ANOVA (p = 0.8) and Welch's (p = 0.0004) disagree at 0.05" in found.warnings
    assert any(w.startswith("a and b: Tukey (p = 0.78) and Games–Howell") for w in found.warnings)
    assert any("between groups came out negative" in w for w in found.warnings)
    agreed = compare_summaries(["a", "b"], [5, 5], [10.0, 11.5], [0.3, 0.3])
    assert (
        verdict(agreed).startswith("The groups differ") and "Welch agrees" in verdict(agreed) and agreed.warnings == ()
    )


def test_cycles_are_counted_and_told() -> None:
    found = compare(nested(MOSQUITO_WINGS))
    assert found.cycles == (8, 8, 8) and [group.n for group in found.groups] == [4, 4, 4]
    assert found.as_json()["groups"][0]["cycles"] == 8 and found.as_json()["repeatability"]["laboratory"] == "sample"
    uneven = nested(
        {**MOSQUITO_WINGS, "cage 3": {"f1": "56.6", "f2": "77.8 79.2", "f3": "69.9 69.2", "f4": "62.1 64.5"}}
    )
    assert any("1 to 2 cycles a sample" in warning for warning in compare(uneven).warnings)


def test_summaries_give_what_their_values_give() -> None:
    whole = of(", ".join(f"{k}: {v}" for k, v in INSECT_SPRAYS.items()), difference=3.0)
    brief = compare_summaries(
        [g.name for g in whole.groups], [g.n for g in whole.groups], [g.mean for g in whole.groups],
        [g.sd or 0 for g in whole.groups], difference=3.0,
    )  # fmt: skip
    for key in ("anova", "welch", "tukey", "games_howell", "power", "components"):
        assert flat(brief.as_json()[key]) == pytest.approx(flat(whole.as_json()[key]), rel=1e-9, abs=1e-12)


def test_document_has_the_shape_that_is_promised() -> None:
    document = of("a: 1 2 3, b: 3 4 6").as_json()
    assert {"F", "df", "p", "eta_squared"} <= set(document["anova"]) and document["anova"]["df"] == [1, 4]
    assert {"a", "b", "difference", "low", "high", "p"} <= set(document["tukey"][0])
    assert set(document["groups"][0]) >= {"name", "n", "mean", "sd"} and document["tukey"][0]["difference"] > 0
    assert {"welch", "games_howell", "components", "warnings", "verdict", "repeatability", "power"} <= set(document)


@pytest.mark.parametrize(
    ("options", "words"),
    [({"confidence": 1.0}, "confidence 1 is not between"), ({"confidence": 0.2}, "confidence 0.2"), ({"difference": 0.0}, "not above 0"),
     ({"difference": float("inf")}, "not above 0")],
)  # fmt: skip
def test_options_out_of_range(options: dict[str, float], words: str) -> None:
    with pytest.raises(UsageError, match=words):
        of("a: 1 2, b: 3 4", **options)


@pytest.mark.parametrize(("n", "sd"), [(0, 1.0), (3, -1.0), (3, float("nan"))])
def test_impossible_summaries_are_refused(n: int, sd: float) -> None:
    with pytest.raises(InputError, match="n is at least 1, an SD at least 0"):
        compare_summaries(["a", "b"], [5, n], [Decimal(1), Decimal(2)], [1.0, sd])
    with pytest.raises(InputError, match="stands twice"):
        compare_summaries(["a", "a"], [5, 5], [1.0, 2.0], [1.0, 1.0])


def flat(value: object) -> list[float]:
    """Every number in a document, in its order."""
    if isinstance(value, dict):
        return [x for one in value.values() for x in flat(one)]
    if isinstance(value, list):
        return [x for one in value for x in flat(one)]
    return [float(value)] if isinstance(value, int | float) and not isinstance(value, bool) else []


def test_groups_unlike_in_size() -> None:
    """Power takes the harmonic mean of 2, 3 and 6; a group of one sample is told and left out of what needs two."""
    found = of("a: 1 2, b: 3 4 6, c: 5 6 7 5 8 6")
    assert found.power is not None and found.power.n == pytest.approx(3.0)
    lone = of("a: 1 2, b: 3 4 6, c: 5")
    assert "one sample in c: left out of Welch's ANOVA and Games–Howell, which need two" in lone.warnings
