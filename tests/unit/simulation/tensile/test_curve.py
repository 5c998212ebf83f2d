"""The loading curve of a test: cycles, break, slack and limits, each said."""

import numpy as np
import pytest

from benchlab.errors import InputError
from benchlab.simulation.tensile.curve import loading_curve


def neo_hooke(stretch: np.ndarray) -> np.ndarray:
    return 0.8 * (stretch - stretch**-2)


UP = np.linspace(1.0, 3.0, 201)


def test_a_plain_test_is_left_as_it_is() -> None:
    curve = loading_curve(UP, neo_hooke(UP))
    np.testing.assert_array_equal(curve.stretch, UP)
    assert curve.notes == ()


def test_cycles_give_their_first_loading() -> None:
    stretch = np.concatenate([UP[:101], UP[100::-1], UP])
    curve = loading_curve(stretch, neo_hooke(stretch))
    np.testing.assert_array_equal(curve.stretch, UP[:101])
    assert curve.notes == (
        "it unloads at stretch 2 (later it goes to 3): only the first loading is used, 101 of 403 points",
    )


def test_the_curve_ends_at_the_break() -> None:
    stretch = np.concatenate([UP, [3.0, 3.005, 3.01]])
    curve = loading_curve(stretch, np.concatenate([neo_hooke(UP), [1.0, 0.2, 0.0]]))
    assert len(curve.stretch) == 201 and "falls by 100 % after its largest, 2.311 MPa at stretch 3" in curve.notes[0]
    gentle = loading_curve(stretch, np.concatenate([neo_hooke(UP), [2.2, 2.1, 2.0]]))
    assert len(gentle.stretch) == 204 and gentle.notes == ()


def test_slack_is_taken_out_and_stretches_count_from_the_taut_length() -> None:
    taut = np.linspace(1.0, 3.0, 801)
    machine = np.concatenate([np.linspace(1.0, 1.0799, 40), 1.08 * taut])
    curve = loading_curve(machine, np.concatenate([np.zeros(40), neo_hooke(taut)]))
    assert "taut at 7.9 % strain" in curve.notes[0]
    np.testing.assert_allclose(neo_hooke(curve.stretch), curve.stress_MPa, atol=2e-3 * curve.stress_MPa.max())
    assert loading_curve(machine, machine - 1, remove_slack=False).notes == ()


def test_a_preload_is_said() -> None:
    assert "not zero: was the load tared" in loading_curve(UP, neo_hooke(UP) + 0.2).notes[0]


def test_max_stretch() -> None:
    curve = loading_curve(UP, neo_hooke(UP), max_stretch=1.5)
    assert curve.stretch[-1] == 1.5 and curve.notes == ("stretches above 1.5 are left out: 51 of 201 points are used",)


@pytest.mark.parametrize(
    ("stretch", "stress", "words"),
    [
        (UP, -neo_hooke(UP), "falls as the stretch grows"),
        (UP[::-1], neo_hooke(UP), "1 points in the first loading"),
        (UP - 2, neo_hooke(UP), "a stretch of -1"),
        (1 + UP / 1000, UP, "pulls by 1 %"),
        (UP, np.zeros(201), "pulls by 1 %"),
        (UP[:4], UP[:4], "4 points"),
    ],
)
def test_what_is_no_tensile_test_is_refused(stretch: np.ndarray, stress: np.ndarray, words: str) -> None:
    with pytest.raises(InputError, match=words):
        loading_curve(stretch, stress)


def test_a_limit_that_leaves_nothing_is_refused() -> None:
    with pytest.raises(InputError, match="--max-stretch"):
        loading_curve(UP, neo_hooke(UP), max_stretch=1.02)
