"""The story for the terminal: the verdict first, with numbers of the explanation; nothing is said that is not known."""

from __future__ import annotations

from dataclasses import replace

import pytest

from benchlab.discrepancy.explanation import VERDICTS, Estimate, Gap, Region
from benchlab.report.explain.words import SIMULATED, parameter_text, parameter_words, told, verdict_words
from tests.unit.report import explanations
from tests.unit.report.explanations import NAN


def test_agree() -> None:
    assert verdict_words(explanations.agreeing()) == (
        "Simulation and measurement agree: measured and simulated bending angle θ differ by 0.3° (root mean square), no more than the "
        "scatter of 25 samples explains (p = 0.47)."
    )


def test_named() -> None:
    assert verdict_words(explanations.explanation()) == (
        "The simulation lacks friction (p = 0.0002). With it the gap falls from 4.9° to 1.3° on samples that the fit has not seen; 1.2° is "
        "what samples of one design scatter by."
    )
    two = explanations.explanation(effects=(explanations.FRICTION, explanations.SOFTENING))
    assert "lacks friction and softening (p = 0.0002). With them the gap" in verdict_words(two)


def test_ambiguous() -> None:
    text = verdict_words(explanations.ambiguous())
    assert (
        "these data cannot tell 3 explanations apart: friction and softening; viscoelasticity and seam margin; regulator lag."
        in text
    )
    assert "is off by 4.8° (root mean square, p = 0.0002)" in text and "With the best of them the gap falls" in text


def test_unexplained() -> None:
    assert verdict_words(explanations.unexplained()).endswith("and no effect of the vocabulary explains it.")
    nearest = replace(explanations.unexplained(), effects=(explanations.FRICTION,), gap=explanations.GAP)
    assert "explains it: friction comes nearest, and the gap falls from 4.9° to 1.3°" in verdict_words(nearest)


def test_what_is_only_described_says_so_and_has_no_p() -> None:
    found = explanations.alone()
    region = Region("mine", "angle_deg", "unloading", None, None, (0.1, 0.3), 4.0, NAN)
    lines = told(replace(found, where=(region,)))
    assert lines[0].startswith(
        "Measured and simulated bending angle θ differ by 2.4° (root mean square). Whether that is more than samples"
    )
    assert any(line.startswith("  mine bends 4.0° more than simulated from 0.10 to 0.30 MPa") for line in lines)
    assert not any("p =" in line or "nan" in line or "data of the fit" in line for line in lines)


def test_the_rate_of_false_names_is_nominal() -> None:
    assert (
        "  nominal rate of false names 3 %: of studies in which nothing is missing, to which the rules are calibrated"
        in told(explanations.explanation())
    )


def test_without_held_out_samples_it_says_so() -> None:
    bare = explanations.explanation(gap=Gap(4.8, 0.72, NAN, NAN, NAN, NAN))
    text = verdict_words(bare)
    assert "from 4.8° to 0.7° on the data of the fit (nothing could be held out)." in text
    assert "held-out" not in "\n".join(told(bare)) and "floor" not in "\n".join(told(bare))


def test_of_a_table_of_means_designs_are_held_out() -> None:
    designs = tuple(one for one in explanations.held_out() if one.kind == "design")
    table = replace(explanations.published(), held_out=designs, gap=Gap(5.1, 2.6, 5.2, 3.1, 2.96, NAN))
    assert "from 5.2° to 3.1° on designs that the fit has not seen" in verdict_words(table)
    assert "  on held-out designs 5.2° → 3.1°" in told(table)
    assert "; 3.0° is the standard error of the means." in verdict_words(table)
    assert any(line.startswith("  standard error 3.0°: of the means") for line in told(table))
    assert not any("noise floor" in line for line in told(table))


def test_a_gap_that_does_not_shrink_is_not_said_to_fall() -> None:
    worse = explanations.explanation(gap=replace(explanations.GAP, heldout_after=5.2))
    assert "does not fall: it goes from 4.9° to 5.2°" in verdict_words(worse)


@pytest.mark.parametrize("kind", explanations.ALL)
def test_nothing_unknown_is_printed_and_no_head_stands_alone(kind: str) -> None:
    found = explanations.ALL[kind]()
    lines = told(found)
    assert lines[found.simulated] == verdict_words(found) and (lines[0] == SIMULATED) == found.simulated
    assert not [line for line in lines if "nan" in line.lower().split() or "–" in line or "None" in line]
    heads = [i for i, line in enumerate(lines) if line.endswith(":") and not line.startswith(" ")]
    assert heads and all(lines[i + 1].startswith("  ") for i in heads)


def test_every_verdict_has_words() -> None:
    assert {explanations.ALL[kind]().verdict for kind in explanations.ALL} == set(VERDICTS)


def test_parameters_with_intervals_units_and_what_bounds_them() -> None:
    lines = told(explanations.explanation())
    assert "    half_width_deg = 5.21 deg (95 % 4.40 to 6.10): half width of the loop at full pressure" in lines
    assert (
        "    growth = 1 (not bounded by the data, at a bound of the effect): growth of the width with pressure" in lines
    )
    assert any(line.endswith("read the numbers as those of an equivalent effect") for line in lines)


@pytest.mark.parametrize(
    ("low", "high", "text"),
    [(0.0912, 0.1088, ("0.1000", "0.0912 to 0.1088")), (0.05, NAN, ("0.1", "at least 0.05")), (NAN, 0.2, ("0.1", "at most 0.2")),
     (NAN, NAN, ("0.1", "not bounded by the data"))],
)  # fmt: skip
def test_intervals(low: float, high: float, text: tuple[str, str]) -> None:
    assert parameter_text(Estimate(0.1, low, high, "s")) == text


@pytest.mark.parametrize("high", [0.0, 1e-14])
def test_an_interval_without_width_at_a_bound_says_nothing(high: float) -> None:
    stuck = Estimate(0.0, 0.0, high, "1/min", "fall", at_bound=True)
    assert parameter_words("fall_per_min", stuck) == (
        "fall_per_min = 0 1/min (not determined: it stays at a bound of the effect): fall"
    )
    assert parameter_text(replace(stuck, at_bound=False)) == ("0", "not determined")


def test_the_next_experiment_has_its_command_and_a_text_has_no_path() -> None:
    lines = told(explanations.ambiguous())
    assert "  benchlab run next.yaml --out results" in lines and "  first: Turn the mounting by 180°." in lines
    assert "  separates friction | viscoelasticity, expected to lie 4.2 standard deviations apart at least" in lines
    spaced = replace(explanations.NEXT, protocol="my results/next.yaml", expected_sd=NAN)
    lines = told(explanations.explanation(next_experiment=spaced))
    assert "  benchlab run 'my results/next.yaml' --out results" in lines
    assert "  separates friction | viscoelasticity" in lines
    assert "  benchlab run next.yaml --out results" in told(explanations.published())


def test_far_apart_is_said_without_a_number() -> None:
    far = replace(explanations.NEXT, expected_sd=450.0)
    [line] = [line for line in told(explanations.explanation(next_experiment=far)) if line.startswith("  separates")]
    assert line.endswith("expected to lie clearly apart (more than 10 standard deviations)")


def test_the_best_of_several_is_not_told_as_the_cause() -> None:
    assert "What (best fit of those that are left, not known to be the cause):" in told(explanations.ambiguous())
    assert "What:" in told(explanations.explanation())


def test_measured_designs_that_are_left_out_stand_in_the_verdict() -> None:
    plain, one = explanations.explanation(), explanations.explanation(left_out={"Delta": "no simulated curve"})
    measured = len(set(plain.curves.design.tolist())) + 1
    added = f" 1 of {measured} measured designs is left out: Delta, no simulated curve."
    assert verdict_words(one) == verdict_words(plain) + added


def test_what_cannot_be_separated_is_said() -> None:
    assert any(
        "cannot be separated on this bench: no protocol within" in line for line in told(explanations.unexplained())
    )


def test_control_characters_are_escapes() -> None:
    found = explanations.explanation(warnings=("\x1b[31mred\nline",), remainder=("bell\x07",))
    assert not [line for line in told(found) if any(ord(c) < 32 for c in line)]
