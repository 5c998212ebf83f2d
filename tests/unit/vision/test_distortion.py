"""Brown's model against OpenCV's projection, its derivatives against differences, its inverse against itself."""

import cv2
import numpy as np
import pytest

from benchlab.vision.distortion import bent, straightened

LENSES = {
    "none": np.zeros(5),
    "phone": np.array([0.12, -0.35, 0.0007, -0.0004, 0.2]),
    "barrel": np.array([-0.28, 0.09, 0.001, 0.002, -0.01]),
    "pincushion": np.array([0.2, 0.05, -0.001, 0.0005, 0.0]),
}
GRID = np.stack(np.meshgrid(np.linspace(-0.8, 0.8, 21), np.linspace(-0.45, 0.45, 13)), axis=-1)


@pytest.mark.parametrize("name", LENSES)
def test_bent_is_what_opencv_projects(name):
    space = np.concatenate([GRID.reshape(-1, 2), np.ones((GRID.size // 2, 1))], axis=1)
    expected, _ = cv2.projectPoints(space, np.zeros(3), np.zeros(3), np.eye(3), LENSES[name])
    np.testing.assert_allclose(bent(GRID, LENSES[name])[0].reshape(-1, 2), expected.reshape(-1, 2), atol=1e-14)


@pytest.mark.parametrize("name", LENSES)
def test_slopes_are_the_derivatives(name):
    slopes = bent(GRID, LENSES[name])[1]
    for axis in (0, 1):
        step = 1e-6 * np.eye(2)[axis]
        difference = (bent(GRID + step, LENSES[name])[0] - bent(GRID - step, LENSES[name])[0]) / 2e-6
        np.testing.assert_allclose(slopes[..., axis], difference, atol=1e-8)


@pytest.mark.parametrize("name", LENSES)
def test_straightened_undoes_bent(name):
    np.testing.assert_allclose(straightened(bent(GRID, LENSES[name])[0], LENSES[name]), GRID, atol=1e-12)


def test_places_beyond_the_fold_are_nan_and_do_not_disturb_the_others():
    folding = np.array([-0.5, 0, 0, 0, 0])  # r − r³/2 has its largest value 0.544 at r = 0.816
    points = np.array([(0.3, 0.0), (0.6, 0.0), (np.nan, 0.1), (0.0, 0.54)])
    found = straightened(points, folding)
    assert np.isfinite(found).all(axis=1).tolist() == [True, False, False, True]
    np.testing.assert_allclose(bent(found[[0, 3]], folding)[0], points[[0, 3]], atol=1e-12)
    assert found[3, 1] < 0.817
