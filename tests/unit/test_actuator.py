"""The design's equations against the paper's numbers, and designs that cannot be made."""

import math

import pytest

from benchlab.actuator import ShellDesign
from benchlab.errors import UsageError


@pytest.mark.parametrize(("tw", "real", "whole"), [(3, 35.6, 35), (9, 16.18, 16), (15, 10.47, 10)])
def test_windows_of_the_published_designs(tw: float, real: float, whole: int) -> None:
    design = ShellDesign(strip_width_mm=10, window_width_mm=tw)
    assert design.window_count == pytest.approx(real, abs=0.005) and design.whole_windows == whole
    assert design.diameter_mm * math.pi == pytest.approx(40)
    used = whole * (tw + 2) + 2 + 2 * design.end_margin_mm
    assert used == pytest.approx(180)


@pytest.mark.parametrize(
    ("change", "words"),
    [
        ({"window_width_mm": 0}, ["window_width_mm (tw) is 0", "positive"]),
        ({"window_width_mm": -3}, ["window_width_mm (tw) is -3", "positive"]),
        ({"rib_width_mm": 0}, ["rib_width_mm (fw) is 0", "positive"]),
        ({"length_mm": math.nan}, ["length_mm (al) is nan", "positive"]),
        ({"perimeter_mm": math.inf}, ["perimeter_mm (slw + wl) is inf", "positive"]),
        ({"strip_width_mm": 40}, ["strip_width_mm (slw) is 40", "perimeter_mm of 40", "narrower"]),
        ({"strip_width_mm": 55.5}, ["strip_width_mm (slw) is 55.5", "perimeter_mm of 40"]),
        ({"window_width_mm": 177}, ["window_width_mm (tw) is 177", "180", "room for 176", "narrower"]),
        ({"length_mm": 3}, ["window_width_mm (tw) is 3", "room for 0", "longer"]),
    ],
)
def test_impossible_designs_name_value_limit_and_remedy(change: dict[str, float], words: list[str]) -> None:
    with pytest.raises(UsageError) as caught:
        ShellDesign(**{"strip_width_mm": 10, "window_width_mm": 3, **change})
    line = str(caught.value)
    assert "\n" not in line
    for word in words:
        assert word in line


def test_one_window_may_fill_the_actuator() -> None:
    assert ShellDesign(strip_width_mm=10, window_width_mm=176).whole_windows == 1
