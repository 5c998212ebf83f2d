"""Names of recordings: what a pattern reads from them, which common one is chosen, and which sets are proposed."""

import pytest

from benchlab.actuator import ShellDesign
from benchlab.errors import InputError, UsageError
from benchlab.workflows.study_pattern import COMMON, NamePattern, choose_pattern
from benchlab.workflows.study_sets import proposed_sets


@pytest.mark.parametrize(
    ("pattern", "name", "parts"),
    [
        ("{design}_s{sample}", "tw3_slw10_s1", ("tw3_slw10", "s1", "")),
        ("{design}_s{sample}", "videos/TW3_SLW10_S12", ("TW3_SLW10", "s12", "")),
        ("{design}_s{sample}", "tw3_slw10", None),
        ("{design}_s{sample}", "tw3_slw10_sleft", None),
        ("{design}_s{sample}_c{cycle}", "a_s1_c3", ("a", "s1", "3")),
        ("{design}_{sample}", "a_b_2b", ("a_b", "s2b", "")),
        ("{design}-{sample}{anything}", "a-b-3 take two", ("a-b", "s3", "")),
        ("{design}/{sample}", "x/a/B2", ("a", "B2", "")),
        ("{design}/s{sample}", "s1", None),
        ("run ({sample}) of {design}", "run (4) of a+b", ("a+b", "s4", "")),
    ],
)
def test_reads_names(pattern: str, name: str, parts: tuple[str, str, str] | None) -> None:
    found = NamePattern(pattern).read(name)
    assert (found and (found.design, found.sample, found.cycle)) == parts


@pytest.mark.parametrize(
    "pattern", ["", "{design}", "{sample}", "{design}{sample}{sample}", "{design}{sample}{}", "{design}{Sample}"]
)
def test_refuses_patterns_that_are_none(pattern: str) -> None:
    with pytest.raises(UsageError, match="write it as"):
        NamePattern(pattern)


def test_the_common_pattern_that_fits_most_is_chosen() -> None:
    assert choose_pattern(["tw3_slw5_s1", "tw3_slw5_s2", "notes_2"]).text == "{design}_s{sample}"
    assert choose_pattern(["tw3-slw5-s1", "tw3-slw5-s2"]).text == "{design}-s{sample}"
    assert choose_pattern(["a_s1_c1", "a_s1_c2"]).text == "{design}_s{sample}_c{cycle}"
    assert choose_pattern(["a/s1", "b/s1"]).text == "{design}/s{sample}"
    assert choose_pattern(["glove_1", "glove_2"]).text == "{design}_{sample}"
    with pytest.raises(InputError, match="'DSC1', 'DSC2', 'DSC3', \\.\\.\\."):
        choose_pattern(["DSC1", "DSC2", "DSC3", "DSC4"])
    assert all(NamePattern(text) for text in COMMON)


def test_sets_have_one_dimension_that_varies() -> None:
    paper = {f"tw{tw}_slw{slw}": ShellDesign(slw, tw) for tw, slw in ((3, 5), (3, 10), (3, 20), (9, 10), (15, 10))}
    tw, slw = proposed_sets(paper)
    assert (slw.name, slw.title, slw.designs, slw.x) == (
        "slw",
        "Strip width, tw 3 mm",
        ("tw3_slw5", "tw3_slw10", "tw3_slw20"),
        "slw_mm",
    )
    assert (tw.name, tw.title, tw.designs, tw.x) == (
        "tw",
        "Window width, slw 10 mm",
        ("tw3_slw10", "tw9_slw10", "tw15_slw10"),
        "tw_mm",
    )
    grid = {f"{tw}{slw}": ShellDesign(slw, tw) for tw in (3, 9) for slw in (5, 10)}
    assert [chosen.name for chosen in proposed_sets(grid)] == ["tw_at_slw5", "tw_at_slw10", "slw_at_tw3", "slw_at_tw9"]
    assert proposed_sets({"a": ShellDesign(5, 3), "b": ShellDesign(10, 9)}) == ()
    assert proposed_sets({"a": ShellDesign(5, 3), "b": ShellDesign(5, 3)}) == ()
    assert proposed_sets({}) == ()
