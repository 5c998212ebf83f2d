"""The inverse curve and the feed-forward on it."""

import numpy as np
import pytest

from benchlab.control.controller import controller_of
from benchlab.control.feed_forward import FeedForward, InverseCurve
from benchlab.control.pi import PI
from benchlab.errors import InputError
from tests.pace import best_cpu_s, slowness

PRESSURE = np.linspace(0.0, 0.35, 15)
ANGLE = 130 * np.tanh(PRESSURE / 0.2) / np.tanh(1.75)


def test_the_inverse_of_a_known_curve() -> None:
    inverse = InverseCurve(PRESSURE, ANGLE)
    wanted = np.linspace(0, 0.35, 200)
    found = [inverse(130 * np.tanh(p / 0.2) / np.tanh(1.75)) for p in wanted]
    assert found == pytest.approx(wanted, abs=5e-4)
    assert [inverse(angle) for angle in ANGLE] == pytest.approx(PRESSURE, abs=1e-12)
    assert np.all(np.diff(found) > 0) and inverse.clamped == 0


def test_a_curve_that_begins_above_nothing_gets_its_first_point() -> None:
    inverse = InverseCurve([0.1, 0.2, 0.3], [40.0, 80.0, 120.0])
    assert [inverse(angle) for angle in (0.0, 20.0, 100.0)] == pytest.approx([0.0, 0.05, 0.25]) and inverse.clamped == 0


def test_beyond_the_curve_it_gives_its_ends_and_counts() -> None:
    inverse = InverseCurve(PRESSURE, ANGLE, ceiling_MPa=0.2)
    assert inverse(-5.0) == 0 and inverse(500.0) == pytest.approx(0.2) and inverse.clamped == 2
    assert inverse(130.0) == pytest.approx(0.2)  # the part beyond the ceiling is not used


@pytest.mark.parametrize(
    ("pressure", "angle", "named"),
    [
        ([0.0, 0.1, 0.2, 0.3], [0.0, 50.0, 49.0, 60.0], "between 0.1 and 0.2 MPa: the angle"),
        ([0.0, 0.1, 0.1, 0.3], [0.0, 50.0, 55.0, 60.0], "between 0.1 and 0.1 MPa: the pressure"),
        ([0.0, 0.1], [0.0, np.nan], "not numbers"),
        ([0.0], [0.0], "two points"),
        ([0.0, 0.1], [0.0], "one angle a pressure"),
    ],
)
def test_curves_that_have_no_inverse_are_refused_with_the_place(pressure, angle, named) -> None:
    with pytest.raises(InputError) as refused:
        InverseCurve(pressure, angle)
    assert named in str(refused.value)


def test_a_curve_that_turns_only_beyond_the_ceiling_will_do() -> None:
    assert InverseCurve([0.0, 0.1, 0.2, 0.3], [0.0, 50.0, 80.0, 70.0], ceiling_MPa=0.2)(80.0) == pytest.approx(0.2)


def test_with_the_true_curve_the_pi_has_nothing_to_do() -> None:
    """A plant that is the curve itself, without lag: started where the reference starts, the error stays nothing."""
    drive = FeedForward(PI(1e-3, 1e-2, ceiling_MPa=0.35), InverseCurve(PRESSURE, ANGLE))
    reference = 60 + 40 * np.sin(np.arange(0, 10, 0.01))
    inverse = InverseCurve(PRESSURE, ANGLE)
    drive.start(inverse(reference[0]))
    found = [drive.pressure_MPa(r, r, r, 0.01) for r in reference]
    assert found == pytest.approx([inverse(r) for r in reference], abs=1e-12)
    assert drive.limited == 0


def test_the_preview_is_what_goes_through_the_curve() -> None:
    drive = FeedForward(PI(0.0, 0.0, ceiling_MPa=0.35), InverseCurve(PRESSURE, ANGLE), lead_s=0.1)
    drive.start(0.0)
    drive.pressure_MPa(0.0, 0.0, 0.0, 0.01)
    assert drive.pressure_MPa(0.0, ANGLE[5], 0.0, 0.01) == pytest.approx(PRESSURE[5])
    assert drive.lead_s == 0.1


def test_controller_of() -> None:
    assert isinstance(controller_of(1e-3, 1e-2, 0.35), PI)
    assert isinstance(controller_of(1e-3, 1e-2, 0.35, True, 0.1, (PRESSURE, ANGLE)), FeedForward)
    with pytest.raises(InputError, match="needs a response curve"):
        controller_of(1e-3, 1e-2, 0.35, feed_forward=True)
    with pytest.raises(InputError, match="lead"):
        controller_of(1e-3, 1e-2, 0.35, True, -0.1, (PRESSURE, ANGLE))


def test_it_takes_less_than_50_microseconds_a_call() -> None:
    drive = controller_of(1e-3, 1e-2, 0.35, True, 0.1, (PRESSURE, ANGLE))
    drive.start(0.0)

    def calls() -> None:
        for i in range(2000):
            drive.pressure_MPa(60.0, 61.0, 59.0 + i % 3, 0.01)

    assert best_cpu_s(calls, 5) / 2000 < 50e-6 * slowness()
