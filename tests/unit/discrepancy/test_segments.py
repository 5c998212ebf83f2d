import numpy as np
import pytest

from benchlab.discrepancy.segments import segments_of

NOISES = pytest.mark.parametrize("noise_MPa", [0.0, 0.001])


def drawn(corners_s: list[float], corners_MPa: list[float], noise_MPa: float) -> tuple[np.ndarray, np.ndarray]:
    time_s = np.arange(0, corners_s[-1] + 1e-9, 0.05)
    random = np.random.default_rng(1)
    return time_s, np.interp(time_s, corners_s, corners_MPa) + noise_MPa * random.standard_normal(len(time_s))


@NOISES
def test_cycles_and_a_hold_are_cut_at_their_turns(noise_MPa: float) -> None:
    corners_s = [0.0, 10, 20, 25, 30, 40, 50]
    time_s, pressure_MPa = drawn(corners_s, [0, 0.3, 0, 0.2, 0.2, 0.35, 0], noise_MPa)
    found = segments_of(time_s, pressure_MPa)
    assert [s.direction for s in found] == ["loading", "unloading", "loading", "hold", "loading", "unloading"]
    assert [s.cycle for s in found] == [1, 1, 2, 2, 2, 2]
    assert [time_s[s.last] for s in found] == pytest.approx(corners_s[1:], abs=0.3)
    rates = [s.rate_MPa_s for s in found]
    assert rates == pytest.approx([0.03, 0.03, 0.04, np.nan, 0.015, 0.035], rel=0.05, nan_ok=True)


def test_a_short_stop_at_the_top_is_a_turn_and_one_without_pressure_is_rest() -> None:
    found = segments_of(*drawn([0, 10, 10.5, 20, 30], [0, 0.3, 0.3, 0, 0], 0.0))
    assert [s.direction for s in found] == ["loading", "unloading", "rest"]
    assert found[0].last == found[1].first


def test_without_a_change_of_pressure_there_is_nothing_and_without_time_one_piece() -> None:
    assert segments_of(np.arange(5.0), np.full(5, 0.2)) == []
    assert [s.direction for s in segments_of(np.zeros(5), np.linspace(0, 0.3, 5))] == ["all"]


def test_noise_at_a_blunt_corner_makes_no_pieces() -> None:
    """Half-second ramps behind a lag of 0.06 s, seen 30 times a second with 1 kPa of noise: the same pieces in each of 40 runs."""
    fine_s = np.arange(0, 14.0001, 0.001)
    asked = np.interp(fine_s, [0, 0.5, 1.0, 1.5, 6.0, 6.5, 8.5, 11, 13.5], [0, 0.33, 0, 0.33, 0.33, 0, 0, 0.33, 0])
    shown = asked.copy()
    for i in range(1, len(shown)):
        shown[i] = shown[i - 1] + (asked[i] - shown[i - 1]) * 0.001 / 0.06
    time_s = np.arange(0, 14, 1 / 30)
    seen = set()
    for seed in range(40):
        noise = 0.001 * np.random.default_rng(seed).standard_normal(len(time_s))
        found = segments_of(time_s, np.interp(time_s, fine_s, shown) + noise)
        seen.add(tuple(s.direction for s in found))
    ramps = ("loading", "unloading", "loading", "hold", "unloading", "rest", "loading", "unloading")
    assert {pieces[:8] for pieces in seen} == {ramps} and {pieces[8:] for pieces in seen} <= {(), ("rest",)}


def test_small_steps_of_a_staircase_are_steps() -> None:
    corners_s = [0.0, 0.5, *(t for n in range(1, 13) for t in (5.0 * n, 5.0 * n + 0.5))]
    levels = [0.0, *(0.025 * n for n in range(1, 13) for _ in (0, 1)), 0.325]
    found = segments_of(*drawn(corners_s, levels, 0.0))
    held = [s.end_MPa for s in found if s.direction == "hold"]
    assert held == pytest.approx(np.arange(1, 13) * 0.025, abs=0.01) and len(found) == 25
