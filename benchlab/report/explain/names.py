"""What the lines of a figure are called, and the mark of simulated data."""

from __future__ import annotations

from benchlab.discrepancy.explanation import Explanation
from benchlab.report.explain.words import set_words
from benchlab.report.wording import drawable


def names_of(explanation: Explanation) -> tuple[str, str]:
    """Of measured values, and of the model with what was named."""
    found = set_words([found.name for found in explanation.effects]) if explanation.effects else "the best fit"
    return "“measured”, simulated" if explanation.simulated else "measured", drawable(f"with {found}", 40)


def mark_of(explanation: Explanation) -> str:
    """In a word, for titles and figures; "" where the data were measured."""
    return "simulated data" * explanation.simulated
