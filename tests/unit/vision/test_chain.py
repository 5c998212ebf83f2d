"""Rows of spots on known arcs, with clutter; the finder must return exactly the row, in order."""

import numpy as np
import pytest

from benchlab.vision.chain import find_chain
from benchlab.vision.markers import CANDIDATE


def spots(xy: np.ndarray, area: float | np.ndarray = 250.0, hue: float = 1.8) -> np.ndarray:
    table = np.zeros(len(xy), CANDIDATE)
    table["xy"], table["area_px2"], table["hue_rad"] = xy, area, hue
    table["contrast"], table["roundness"], table["isolation"] = 100, 0.95, 0.95
    return table


def arc(angle_deg: float, n: int, length: float = 900.0) -> np.ndarray:
    along = np.linspace(0, length, n)
    if angle_deg == 0:
        return np.stack([300 + along, np.full(n, 400.0)], axis=1)
    kappa = np.radians(angle_deg) / length
    return np.stack([300 + np.sin(kappa * along) / kappa, 400 + (1 - np.cos(kappa * along)) / kappa], axis=1)


@pytest.mark.parametrize("n", [4, 5, 10, 16])
@pytest.mark.parametrize("angle_deg", [0, 5, 60, 126, 200])
def test_a_row_is_found_whole_and_in_order(n: int, angle_deg: float) -> None:
    shuffled = np.random.default_rng(n).permutation(n)
    chain = find_chain(spots(arc(angle_deg, n)[shuffled]))
    assert chain is not None
    found = shuffled[list(chain.order)]
    assert found.tolist() in ([*range(n)], [*range(n)][::-1])


@pytest.mark.parametrize("seed", range(20))
def test_random_clutter_of_the_same_look_does_not_join(seed: int) -> None:
    rng = np.random.default_rng(seed)
    row = arc(rng.uniform(0, 180), 10)
    clutter = rng.uniform((0, 0), (1900, 1000), (8, 2))
    far = np.hypot(*(clutter[:, None] - row[None]).T).min(axis=0) > 60
    chain = find_chain(spots(np.concatenate([row, clutter[far]])))
    assert chain is not None
    assert set(range(10)) <= set(chain.order)
    assert len(chain.order) <= 11  # a spot that happens to carry the row on cannot be told in one picture


def test_other_sizes_and_colours_are_not_taken() -> None:
    row, beside = arc(40, 6), np.add(arc(40, 6), (75, 60))
    mixed = np.concatenate([spots(row), spots(beside, area=900.0), spots(beside + 40, hue=0.2)])
    chain = find_chain(mixed)
    assert chain is not None
    assert sorted(chain.order) in ([*range(6)], [*range(6, 12)], [*range(12, 18)])


def test_a_known_count_is_kept_or_refused() -> None:
    row = spots(arc(90, 8))
    chain = find_chain(row, count=8)
    assert chain is not None and len(chain.order) == 8
    assert find_chain(row, count=9) is None
    assert find_chain(row[:2]) is None
