"""Numbers as a report shows them."""

import math

import pytest

from benchlab.report.rounding import count, decimals_of, digits, number, words


@pytest.mark.parametrize(
    ("uncertainty", "decimals"),
    [(2.96, 1), (0.994, 2), (0.996, 1), (9.94, 1), (9.96, 0), (99.6, 0), (1e-30, 12), (0.0, 2), (math.nan, 2)],
)
def test_an_uncertainty_has_two_digits(uncertainty: float, decimals: int) -> None:
    assert decimals_of(uncertainty) == decimals


def test_a_number_keeps_its_value_and_loses_its_noise_in_words() -> None:
    cell = number(-1.0 / 3, 2)
    assert cell.value == -1.0 / 3 and cell.text == "−0.33"
    assert number(-0.04, 1).text == "0.0"


@pytest.mark.parametrize("value", [None, math.nan, math.inf, -math.inf])
def test_what_is_not_known_is_a_dash_and_no_number(value: float | None) -> None:
    assert number(value) == digits(value) == (None, "–")


def test_digits() -> None:
    given = (529.4567, 5294.567, 0.00012345, 1.5e-9, -12.0, 1e9)
    assert [digits(x).text for x in given] == ["529", "5290", "0.000123", "1.5e−09", "−12", "1e+09"]


def test_count_and_words() -> None:
    assert count(None).text == "–" and count(0).text == "0"
    cell = words("a\x1b[31m" + "b" * 100, 20)
    assert cell.value == "a\x1b[31m" + "b" * 100 and "\x1b" not in cell.text and len(cell.text) == 20
