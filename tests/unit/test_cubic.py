"""The interpolant of single floats against scipy's of arrays."""

import numpy as np
import pytest
from scipy.interpolate import PchipInterpolator

from benchlab.cubic import Cubic

X = np.array([0.0, 0.1, 0.15, 0.3, 0.35])
Y = np.array([0.0, 40.0, 41.0, 100.0, 100.0])


def test_values_and_slopes_are_scipy_s() -> None:
    found, exact = Cubic(X, Y), PchipInterpolator(X, Y)
    at = np.linspace(0, 0.35, 200)
    assert [found.value(x) for x in at] == pytest.approx(exact(at), abs=1e-12)
    assert [found.slope(x) for x in at] == pytest.approx(exact.derivative()(at), abs=1e-9)


def test_it_is_monotone_and_ends_at_its_ends() -> None:
    found = Cubic(X, Y)
    values = [found.value(x) for x in np.linspace(0, 0.35, 5000)]
    assert np.diff(values).min() >= -1e-12 and max(values) <= 100 + 1e-12
    assert found.value(9.0) == pytest.approx(100) and found.value(-1.0) == 0.0
