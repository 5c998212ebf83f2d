"""Scales against closed forms and drawn noise."""

import numpy as np
import pytest

from benchlab.errors import InputError, UsageError
from benchlab.vision.scale import (
    scale_from_aruco,
    scale_from_corners,
    scale_from_reference,
    scale_from_span,
    scale_given,
)


def test_two_markers_are_averaged_when_they_have_one_size():
    square = np.array([(0, 0), (50, 0), (50, 50), (0, 50)], dtype=float)
    both = np.stack([square, 1.02 * square + 200])
    scale = scale_from_corners(both, 10.0)
    assert scale.mm_per_px == pytest.approx(10 / 50.5)
    assert scale.sd_mm_per_px / scale.mm_per_px == pytest.approx(0.5 / 50.5)
    with pytest.raises(InputError, match="must have one size"):
        scale_from_corners(np.stack([square, 1.5 * square]), 10.0)


def test_reference_and_its_uncertainty():
    scale = scale_from_reference(np.array([10.0, 20.0]), np.array([310.0, 420.0]), 100.0)
    assert scale.mm_per_px == pytest.approx(0.2)
    rng = np.random.default_rng(1)
    picks = rng.normal(loc=[[10, 20], [310, 420]], scale=0.5, size=(20000, 2, 2))
    drawn = 100.0 / np.linalg.norm(picks[:, 1] - picks[:, 0], axis=1)
    assert drawn.std() == pytest.approx(scale.sd_mm_per_px, rel=0.02)
    assert scale.source == "two picked points 500.0 px apart are 100 mm"
    assert not scale.assumed


def test_span_is_a_median_and_its_sd_that_of_white_noise():
    rng = np.random.default_rng(2)
    spans = 900 + 0.5 * rng.normal(size=(500, 400))
    scales = [scale_from_span(row, 180.0) for row in spans]
    values = np.array([s.mm_per_px for s in scales])
    assert values.mean() == pytest.approx(0.2, rel=1e-4)
    assert np.mean([s.sd_mm_per_px for s in scales]) == pytest.approx(values.std(), rel=0.15)
    assert scales[0].assumed
    assert scales[0].source == "markers assumed to span 180 mm (--length-mm)"
    assert scales[0].span_variation < 0.003


def test_span_with_stray_frames_and_missing_ones():
    spans = np.full(100, 900.0)
    spans[::10], spans[5::10] = np.nan, 5000.0
    scale = scale_from_span(spans, 180.0, assumed=False)
    assert scale.mm_per_px == pytest.approx(0.2)
    assert not scale.assumed
    assert scale.source == "markers span 180 mm"


def test_a_span_that_drifts_is_told_and_is_not_taken_for_many_measurements():
    drifting = scale_from_span(np.linspace(860, 940, 1000), 180.0)
    assert drifting.span_variation == pytest.approx(0.08, rel=1e-6)
    assert drifting.sd_mm_per_px > 0.01 * drifting.mm_per_px
    mixed = scale_from_span(np.random.default_rng(3).permutation(np.linspace(860, 940, 1000)), 180.0)
    assert mixed.sd_mm_per_px < 0.2 * drifting.sd_mm_per_px


def test_span_of_one_frame_and_of_none():
    alone = scale_from_span(np.array([900.0]), 180.0)
    assert (alone.mm_per_px, alone.sd_mm_per_px, alone.span_variation) == (0.2, 0.0, 0.0)
    nothing = scale_from_span(np.array([np.nan, np.nan]), 180.0)
    assert np.isnan(nothing.mm_per_px)
    assert nothing.source.endswith("but no frame shows both ends")


@pytest.mark.parametrize("value", [0, -0.2, float("nan"), float("inf"), 1000.1, 9e-7, 1e9])
def test_scales_out_of_range_are_refused_with_the_range(value):
    with pytest.raises(UsageError, match=r"mm/px, outside 1e-06 to 1000"):
        scale_given(value)


def test_the_ends_of_the_range_are_inside():
    assert scale_given(1000).mm_per_px == 1000
    assert scale_given(1e-6).source == "1e-06 mm/px was given"


@pytest.mark.parametrize("length", [0, -3, float("nan"), float("inf")])
def test_lengths_that_are_not_positive_are_refused(length):
    ends = np.array([0.0, 0.0]), np.array([100.0, 0.0])
    with pytest.raises(UsageError, match=r"reference length is .* not a positive number"):
        scale_from_reference(*ends, length)
    with pytest.raises(UsageError, match="span of the markers is"):
        scale_from_span(np.array([100.0]), length)
    with pytest.raises(UsageError, match="side of the ArUco marker is"):
        scale_from_aruco(np.zeros((10, 10), np.uint8), length)


def test_reference_points_that_coincide_are_refused():
    with pytest.raises(UsageError, match="are 5 px apart, fewer than 10"):
        scale_from_reference(np.array([3.0, 4.0]), np.array([0.0, 0.0]), 100.0)
    with pytest.raises(UsageError, match="nan px apart"):
        scale_from_reference(np.array([np.nan, 4.0]), np.array([0.0, 0.0]), 100.0)
    with pytest.raises(UsageError, match="outside 1e-06 to 1000"):
        scale_from_span(np.array([0.0]), 100.0)
