import numpy as np

from benchlab.deck.grid import halved, lines, quadrilaterals


def test_lines_keep_borders_and_size() -> None:
    found = lines([0.0, 5.0, 20.0, 5.0], 1.7)
    assert {0.0, 5.0, 20.0} <= set(found.tolist()) and np.diff(found).max() <= 1.7 and (np.diff(found) > 0).all()


def test_quadrilaterals_cover_the_grid_once() -> None:
    quads, u, v = quadrilaterals(3, 2)
    assert quads.shape == (6, 8) and len(np.unique(quads)) == len(u) == 7 * 5 - 6
    x, y = halved(np.arange(4.0))[u[quads]], halved(np.arange(3.0))[v[quads]]
    np.testing.assert_allclose(x[:, 4:], (x[:, :4] + np.roll(x[:, :4], -1, axis=1)) / 2)  # middles lie between corners
    np.testing.assert_allclose(y[:, 4:], (y[:, :4] + np.roll(y[:, :4], -1, axis=1)) / 2)
