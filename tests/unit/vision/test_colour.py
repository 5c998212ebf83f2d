"""Chroma directions against the definitions of BT.601 and BT.709."""

import math

import numpy as np
import pytest

from benchlab.errors import UsageError
from benchlab.vision.colour import COLOURS, LUMA_WEIGHTS, chroma, colour_plane, marker_colour
from benchlab.vision.picture import Planes


@pytest.mark.parametrize("matrix", LUMA_WEIGHTS)
@pytest.mark.parametrize("name", COLOURS)
def test_a_named_colour_is_the_strongest_in_its_own_plane(name: str, matrix: str) -> None:
    levels = {other: 128 + 224 * np.array(chroma(rgb, matrix)) for other, rgb in COLOURS.items()}
    cb, cr = np.rint(np.array(list(levels.values()))).astype(np.uint8).T
    planes = Planes(np.zeros((1, len(cb)), np.uint8), cb[None], cr[None], matrix=matrix)
    plane = colour_plane(planes, marker_colour(name, matrix))[0]
    own = plane[list(COLOURS).index(name)]
    assert own > 180
    assert own >= plane.max() - 12  # red and orange, green and cyan lie close together


def test_bt709_red_and_grey() -> None:
    assert chroma((1, 0, 0), "bt709") == pytest.approx((-0.2126 / 1.8556, 0.5), abs=1e-9)
    assert chroma((0.4, 0.4, 0.4), "bt709") == pytest.approx((0, 0), abs=1e-12)
    assert marker_colour("red", "bt601").hue_rad == pytest.approx(math.atan2(0.5, -0.299 / 1.772))


def test_an_unknown_colour_names_the_known_ones() -> None:
    with pytest.raises(UsageError, match="'mauve'"):
        marker_colour("mauve", "bt709")
