import numpy as np
import pytest

from benchlab.discrepancy.identify import Identified, identify
from tests.unit.discrepancy.drawn import active, few, problem


def found_in(*actives, also_deg: float = 0.0) -> Identified:  # type: ignore[no-untyped-def]
    made = problem(3, actives, also_deg=also_deg)
    return identify(made, few(), np.random.default_rng(1))


def test_where_nothing_is_hidden_nothing_is_named() -> None:
    found = found_in()
    assert (found.verdict, found.best.actives) == ("agree", ())


@pytest.mark.parametrize("hidden", [active("friction", half_width_deg=4), active("softening")], ids=lambda a: a.name)
def test_one_effect_is_named(hidden) -> None:  # type: ignore[no-untyped-def]
    found = found_in(hidden)
    assert (found.verdict, found.best.names) == ("named", (hidden.name,))
    assert found.share > 0.9 and found.p_left > 0.01


def test_two_that_cannot_be_told_apart_at_one_length_are_both_in_the_set() -> None:
    found = found_in(active("end_caps", cap_mm=6))
    misfit = {one.names: one.misfit for one in found.rivals}
    assert found.verdict == "ambiguous" and {("end_caps",), ("camera_scale",)} <= set(misfit)
    assert misfit["end_caps",] == pytest.approx(misfit["camera_scale",], abs=0.1)


def test_a_wiggle_that_no_effect_makes_is_not_named() -> None:
    assert found_in(also_deg=3.0).verdict == "unexplained"


def test_two_effects_are_both_found() -> None:
    found = found_in(active("friction", half_width_deg=4), active("pressure_offset", offset_MPa=0.01))
    assert set(found.best.names) == {"friction", "pressure_offset"}


def test_a_second_effect_may_be_small_beside_the_first_where_it_is_most_of_what_is_left() -> None:
    """Friction moves the means by a seventh of the gap that a gauge makes which is 0.04 MPa off."""
    found = found_in(active("friction", half_width_deg=4), active("pressure_offset", offset_MPa=0.04))
    assert set(found.best.names) == {"friction", "pressure_offset"}
    made = problem(3, found.best.actives)
    first = tuple(one for one in found.best.actives if one.name == "pressure_offset")
    moved = made.mean_over_samples(made.cells(found.best.actives) - made.cells(first))
    gap = made.mean_over_samples(made.cells(found.best.actives) - made.base_cells)
    assert np.sqrt(np.mean(moved**2) / np.mean(gap**2)) < 0.2


def test_a_loop_that_is_small_beside_a_large_course_is_found() -> None:
    hidden = [active("camera_scale", factor=1.3), active("friction", half_width_deg=2.5)]
    made = problem(9, hidden, designs=4, samples=5)
    gap = made.in_parts(made.mean_over_samples(made.features.value - made.base_cells))[0]
    assert gap[2] < 0.1 * np.hypot(gap[0], gap[1])  # of the whole gap, the loops are little
    found = identify(made, few("camera_scale", "friction", "viscoelasticity", "softening"), np.random.default_rng(1))
    assert ("camera_scale", "friction") in {tuple(sorted(one.names)) for one in found.rivals}
