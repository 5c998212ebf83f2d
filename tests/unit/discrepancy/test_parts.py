import numpy as np
import pytest

from benchlab.discrepancy.parts import PARTS, parts_of
from tests.unit.discrepancy.drawn import problem


def test_the_parts_add_up_and_none_is_in_another() -> None:
    features = problem(1, designs=2, protocol=("slow", "hold")).features
    parts = [part.toarray() for part in parts_of(features)]
    assert len(parts) == len(PARTS)
    assert sum(parts) == pytest.approx(np.eye(len(features.features)), abs=1e-12)
    for i, one in enumerate(parts):
        assert one == pytest.approx(one.T, abs=1e-12)
        for j, other in enumerate(parts):
            assert one @ other == pytest.approx(one if i == j else 0 * one, abs=1e-12)


def test_a_function_of_pressure_is_all_course_and_a_sign_of_the_direction_all_loop() -> None:
    features = problem(1, designs=2, protocol=("slow",)).features
    rows = features.features
    level = np.array([float(row.bin) for row in rows])
    way = np.array([1.0 if row.direction == "loading" else -1.0 for row in rows])
    both = np.array([sum(a.bin == b.bin and a.design == b.design for a in rows) == 2 for b in rows])
    course, kinds, loops = parts_of(features)
    assert course @ level == pytest.approx(level)
    assert kinds @ level == pytest.approx(0 * level)
    assert (loops @ (way * both))[both] == pytest.approx(way[both])


def test_what_differs_between_kinds_of_run_is_neither_course_nor_loop() -> None:
    features = problem(1, designs=1, protocol=("slow", "hold")).features
    kind = np.array([float(row.kind) for row in features.features])
    course, kinds, loops = parts_of(features)
    assert loops @ kind == pytest.approx(0 * kind, abs=1e-12)
    assert course @ kind + kinds @ kind == pytest.approx(kind)
    assert np.abs(kinds @ kind).max() > 0.3
