"""The painter: nearer faces cover, sides have their colours, sizes are true."""

from __future__ import annotations

import numpy as np
import pytest

from benchlab.report.painter import Faces, View, paint

FRONT = View.of((0, 0, 1), (0, 1, 0))


def square(side: float, z: float, colour: tuple[float, float, float], facing: float = 1.0) -> Faces:
    corners = np.array([[[-1, -1, 0], [1, -1, 0], [1, 1, 0], [-1, 1, 0]]]) * side / 2 + [0, 0, z]
    inner = np.array([[0.0, 0.0, 1.0]])
    return Faces(corners, np.array([[0.0, 0.0, facing]]), np.array([colour]), inner, np.zeros((1, 4), dtype=bool))


def test_the_nearer_face_covers_and_lengths_are_true() -> None:
    near, far = square(4.0, 1.0, (1, 0, 0)), square(10.0, -1.0, (0, 1, 0))
    for faces in (near.joined(far), far.joined(near)):
        painting = paint(faces, FRONT, (304, 204))
        assert painting.px_per_mm == pytest.approx(20)
        rgba = painting.rgba.astype(int)
        green = (rgba[..., 1] > 100) & (rgba[..., 3] == 255)
        red = (rgba[..., 0] > 100) & (rgba[..., 1] < 60)
        assert red.sum() == pytest.approx(80**2, rel=0.04)
        assert green.sum() == pytest.approx(200**2 - 80**2, rel=0.02)
        assert (rgba[:, :40, 3] == 0).all()


def test_the_back_of_a_face_has_the_inner_colour_and_is_left_out_of_closed_surfaces() -> None:
    turned = square(4.0, 0.0, (1, 0, 0), facing=-1.0)
    rgba = paint(turned, FRONT, (50, 50)).rgba[25, 25].astype(int)
    assert rgba[2] > 100 and rgba[0] < 50
    assert len(turned.towards(FRONT).corners_mm) == 0


def test_faces_turned_to_the_light_are_brighter() -> None:
    towards, away = square(2.0, 0.0, (0.5, 0.5, 0.5)), square(2.0, 0.0, (0.5, 0.5, 0.5))
    away = Faces(away.corners_mm, np.array([[0.6, -0.7, 0.39]]), away.outer, away.inner, away.lines)
    assert paint(towards, FRONT, (20, 20)).rgba[10, 10, 0] > paint(away, FRONT, (20, 20)).rgba[10, 10, 0] + 20
