import numpy as np
import pytest

from benchlab.discrepancy.features import Feature, Features
from benchlab.discrepancy.scatter import scatter_of
from tests.unit.discrepancy.drawn import Scattered, problem


def one_feature(values: list[list[float]]) -> Features:
    """One interval of each design, measured on several samples."""
    design = np.repeat(np.arange(len(values)), [len(v) for v in values])
    return Features(
        features=tuple(Feature(d, 0, 0, "angle_deg", 1, "loading", 0, 0.1, 0.3, 1.0, 0.5) for d in range(len(values))),
        kinds=(),
        sample_names=tuple(map(str, range(len(design)))),
        sample_design=design,
        sample=np.arange(len(design)),
        feature=design,
        value=np.concatenate(values),
        count=np.full(len(design), 4.0),
        of_point={"angle_deg": np.zeros((1, 1), int)},
    )


def test_of_one_feature_it_is_the_classical_variance() -> None:
    values = [98.0, 104.0, 101.0, 95.0, 103.0]
    found = scatter_of(one_feature([values]))
    assert found.covariance[0][0, 0] == pytest.approx(np.var(values, ddof=1), rel=0.01)
    assert found.freedom == 4


def test_designs_are_pooled_by_their_degrees_of_freedom() -> None:
    values = [[98.0, 104.0, 101.0], [99.0, 102.0, 103.0, 100.0, 97.0]]
    found = scatter_of(one_feature(values))
    pooled = sum(np.var(v, ddof=1) * (len(v) - 1) for v in values) / 6
    assert [c[0, 0] for c in found.covariance] == pytest.approx([pooled, pooled], rel=0.02)
    assert found.freedom == 6


def test_drawn_components_come_back_from_many_samples() -> None:
    scatter = Scattered(gain=0.03, pressure_MPa=0.0, run_deg=0.5, white_deg=0.2)
    found = problem(5, designs=2, samples=40, protocol=("slow", "fast"), scatter=scatter).scatter
    sizes = found.components["angle_deg"]
    assert sizes["gain"] == pytest.approx(0.03, rel=0.25)
    assert sizes["run offset"] == pytest.approx(0.5, rel=0.25)
    assert sizes["white"] == pytest.approx(0.2, rel=0.25)
    assert sizes["loop"] < 0.003 and sizes["pressure"] < 0.002
