"""Words for what tests found: stars, probabilities, and the verdict."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

from benchlab.stats.anova import OneWay, Welch
from benchlab.stats.names import shown
from benchlab.stats.pairs import Pair
from benchlab.stats.studentized_range import FLOOR

if TYPE_CHECKING:
    from benchlab.stats.comparison import Comparison

STARS = ((1e-5, "****"), (1e-4, "***"))
"""As the captions of the paper's Figs 6 and 7 define them; it defines no others."""

STARS_LEGEND = "*** p < 0.0001, **** p < 0.00001"

_SMALLEST = 1e-300
_MOST_TOLD = 10


def stars(p: float | None) -> str:
    """The paper's stars of a probability; none from 0.0001 on.

    >>> stars(2.2e-5), stars(1e-7), stars(0.003)
    ('***', '****', '')
    """
    return "" if p is None else next((mark for limit, mark in STARS if p < limit), "")


def p_text(p: float | None, floor: float = FLOOR) -> str:
    """A probability in two digits; below the floor only that it is below.

    >>> p_text(2.2114e-5), p_text(0.04), p_text(3e-15), p_text(5.6e-20, floor=0.0), p_text(None)
    ('2.2e-5', '0.04', '< 1e-13', '5.6e-20', 'not defined')
    """
    if p is None:
        return "not defined"
    floor = max(floor, _SMALLEST)
    return f"< {_short(floor)}" if p < floor else _short(p)


def p_equals(p: float | None, floor: float = FLOOR) -> str:
    """`p = 0.04` or `p < 1e-13`.

    >>> p_equals(0.04), p_equals(0.0)
    ('p = 0.04', 'p < 1e-13')
    """
    text = p_text(p, floor)
    return f"p {text}" if p is None or text.startswith("<") else f"p = {text}"


def _short(p: float) -> str:
    mantissa, _, exponent = f"{p:.2g}".partition("e")
    return f"{mantissa}e{int(exponent)}" if exponent else mantissa


def verdict(found: Comparison) -> str:
    """The first sentence that a reader looks for.

    >>> from benchlab.stats.comparison import compare_summaries
    >>> verdict(compare_summaries(["a", "b"], [5, 5], [1.0, 2.0], [0.5, 0.5]))
    'The groups differ: F(1, 8) = 10, p = 0.013 (Welch agrees: F(1, 8) = 10, p = 0.013).'
    """
    anova = found.anova
    if anova.F is None:
        return f"No test: {anova.reason}."
    differ = _below(anova.p, found.alpha)
    head = "The groups differ" if differ else "No difference between the groups is shown"
    return f"{head}: {_test(anova.F, anova.df, anova.p)} ({_of_welch(found.welch, differ, found.alpha)})."


def disagreements(
    anova: OneWay, welch: Welch, tukey: Sequence[Pair], games_howell: Sequence[Pair], confidence: float
) -> list[str]:
    """Where the classical tests and those for unequal variances come to different answers at 1 − confidence."""
    alpha = 1 - confidence
    told = []
    if anova.p is not None and welch.p is not None and _below(anova.p, alpha) != _below(welch.p, alpha):
        told.append(
            f"the classical ANOVA ({p_equals(anova.p, 0)}) and Welch's ({p_equals(welch.p, 0)}) disagree at {alpha:.3g}"
        )
    for one, other in zip(tukey, games_howell):
        if one.p is not None and other.p is not None and _below(one.p, alpha) != _below(other.p, alpha):
            pair = f"{shown(one.a)} and {shown(one.b)}"
            told.append(
                f"{pair}: Tukey ({p_equals(one.p)}) and Games–Howell ({p_equals(other.p)}) disagree at {alpha:.3g}"
            )
    return told[:_MOST_TOLD] + [f"and {len(told) - _MOST_TOLD} more pairs disagree"] * (len(told) > _MOST_TOLD)


def _of_welch(welch: Welch, differ: bool, alpha: float) -> str:
    if welch.F is None or welch.df is None:
        return f"Welch {welch.reason}"
    agrees = _below(welch.p, alpha) == differ
    return f"Welch {'agrees' if agrees else 'DISAGREES'}: {_test(welch.F, welch.df, welch.p)}"


def _test(F: float, df: tuple[float, float], p: float | None) -> str:
    return f"F({_df(df[0])}, {_df(df[1])}) = {F:.4g}, {p_equals(p, 0)}"


def _df(value: float) -> str:
    return f"{value:.0f}" if abs(value - round(value)) < 1e-9 else f"{value:.2f}"


def _below(p: float | None, alpha: float) -> bool:
    return p is not None and p < alpha
