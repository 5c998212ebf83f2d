"""Lenses found again from drawn chessboards, and lens files that are refused."""

import json
from functools import cache

import cv2
import numpy as np
import pytest

from benchlab.errors import InputError, UsageError
from benchlab.vision.lens import Lens, calibrate, find_chessboard

WIDTH, HEIGHT = 960, 640
TRUE = Lens(
    matrix=np.array([[900.0, 0, 471.3], [0, 905.0, 325.8], [0, 0, 1]]),
    distortion=np.array([-0.22, 0.08, 0.0008, -0.0005, 0.0]),
    width=WIDTH,
    height=HEIGHT,
    rms_px=0.1,
    pictures_used=10,
)
BOARD = (9, 6)
SQUARE_MM = 20.0


def poses(count, tilt=0.45, seed=3):
    """Turns and places of boards that between them fill the picture."""
    rng = np.random.default_rng(seed)
    for i in range(count):
        turn = cv2.Rodrigues(np.append(rng.uniform(-tilt, tilt, 2), rng.uniform(-0.3, 0.3)))[0]
        far = rng.uniform(300, 420)
        aim = np.array([(i % 4 - 1.5) * 0.16, (i // 4 % 3 - 1) * 0.11, 1.0]) * far
        yield turn, aim - turn @ (np.array([4.0, 2.5, 0]) * SQUARE_MM)


def inner_corners(turn, place, lens=TRUE):
    """(54, 2) px of the corners of a board as the lens sees them."""
    board = np.zeros((54, 3))
    board[:, :2] = SQUARE_MM * np.mgrid[0:9, 0:6].T.reshape(-1, 2)
    seen = board @ turn.T + place
    straight = seen[:, :2] / seen[:, 2:] * lens.matrix[[0, 1], [0, 1]] + lens.matrix[:2, 2]
    return lens.distort(straight)


@cache
def rays():
    """(2·HEIGHT, 2·WIDTH, 3) directions of 2 × 2 rays through every pixel, from the lens's own inverse."""
    x, y = ((np.arange(2 * size) - 0.5) / 2 for size in (WIDTH, HEIGHT))
    straight = TRUE.undistort(np.stack(np.meshgrid(x, y), axis=-1))
    plane = (straight - TRUE.matrix[:2, 2]) / TRUE.matrix[[0, 1], [0, 1]]
    return np.concatenate([plane, np.ones((2 * HEIGHT, 2 * WIDTH, 1))], axis=-1)


def draw_chessboard(turn, place):
    """(HEIGHT, WIDTH) grey picture: every pixel is the mean of 2 × 2 rays, each traced to the board's plane."""
    onto_board = np.linalg.inv(np.column_stack([turn[:, 0], turn[:, 1], place]))
    hit = rays() @ onto_board.T
    u, v = (hit[..., i] / hit[..., 2] / SQUARE_MM for i in (0, 1))
    # brightness changes smoothly over an edge, as wide as a ray is from the next
    edge = 0.03
    checks = np.tanh(np.sin(np.pi * u) / edge / np.pi) * np.tanh(np.sin(np.pi * v) / edge / np.pi)
    on_board = (u > -1) & (u < 9) & (v > -1) & (v < 6)
    fine = np.where(on_board, 125 - 95 * checks, 220.0)
    return fine.reshape(HEIGHT, 2, WIDTH, 2).mean(axis=(1, 3)).round().astype(np.uint8)


def picture_grid():
    return np.stack(np.meshgrid(np.linspace(0, WIDTH - 1, 25), np.linspace(0, HEIGHT - 1, 17)), axis=-1)


def test_a_lens_is_found_again_from_drawn_pictures():
    found = [find_chessboard(draw_chessboard(*pose), BOARD) for pose in poses(12)]
    seen = [(c, p) for c, p in zip(found, poses(12), strict=True) if c is not None]
    assert len(seen) >= 9
    for corners, pose in seen:
        truth = inner_corners(*pose)
        nearest = np.linalg.norm(corners[:, None] - truth[None], axis=2).min(axis=1)
        assert np.median(nearest) < 0.1
        assert nearest.max() < 0.5
    lens = calibrate(found, BOARD, SQUARE_MM, (WIDTH, HEIGHT))
    assert lens.rms_px < 0.1
    assert lens.warnings == ()
    assert lens.pictures_used == len(seen)
    np.testing.assert_allclose(lens.matrix[[0, 1], [0, 1]], (900, 905), rtol=0.005)
    off = np.hypot(*np.moveaxis(lens.undistort(picture_grid()) - TRUE.undistort(picture_grid()), -1, 0))
    assert np.median(off) < 0.1
    assert off[2:-2, 2:-2].max() < 0.4
    assert off.max() < 2  # no board reaches into the outermost corners


def test_undistort_undoes_distort_over_the_picture_and_straightens_lines():
    grid = picture_grid()
    np.testing.assert_allclose(TRUE.distort(TRUE.undistort(grid)), grid, atol=1e-8)
    np.testing.assert_allclose(TRUE.undistort(TRUE.distort(grid)), grid, atol=1e-8)
    expected = cv2.undistortPoints(grid.reshape(-1, 1, 2), TRUE.matrix, TRUE.distortion, P=TRUE.matrix)
    # OpenCV's five rounds of fixed-point steps are themselves off by some hundredths of a px at the corners
    np.testing.assert_allclose(TRUE.undistort(grid).reshape(-1, 2), expected.reshape(-1, 2), atol=0.2)
    line = np.stack([np.linspace(40, 900, 30), np.linspace(30, 200, 30)], axis=-1)
    bent = TRUE.distort(line)
    assert np.abs(np.polyval(np.polyfit(*bent.T, 1), bent[:, 0]) - bent[:, 1]).max() > 2
    back = TRUE.undistort(bent)
    assert np.abs(np.polyval(np.polyfit(*back.T, 1), back[:, 0]) - back[:, 1]).max() < 1e-8


def test_undistort_keeps_shape_and_missing_points():
    points = np.full((4, 5, 2), np.nan)
    points[1, 2] = (100.0, 50.0)
    straight = TRUE.undistort(points)
    assert straight.shape == (4, 5, 2)
    assert np.isfinite(straight).all(axis=-1).sum() == 1
    assert TRUE.undistort(np.zeros((0, 2))).shape == (0, 2)


def test_the_centre_stays_and_a_lens_without_distortion_changes_nothing():
    np.testing.assert_allclose(TRUE.undistort(np.array([471.3, 325.8])), (471.3, 325.8), atol=1e-9)
    plain = Lens(TRUE.matrix, np.zeros(5), WIDTH, HEIGHT, 0.0, 3)
    np.testing.assert_allclose(plain.undistort(picture_grid()), picture_grid(), atol=1e-10)


def test_a_lens_scales_with_the_picture():
    assert TRUE.for_size(WIDTH, HEIGHT) is TRUE
    double = TRUE.for_size(2 * WIDTH, 2 * HEIGHT)
    assert (double.width, double.height, double.rms_px) == (2 * WIDTH, 2 * HEIGHT, 0.2)
    # pixel (x, y) of the small picture covers the pixels around (2x + 0.5, 2y + 0.5) of the large one
    np.testing.assert_allclose(double.undistort(2 * picture_grid() + 0.5), 2 * TRUE.undistort(picture_grid()) + 0.5)
    with pytest.raises(InputError, match=r"calibrated on 960×640 pictures, not 1920×1080, which has another shape"):
        TRUE.for_size(1920, 1080)
    with pytest.raises(InputError, match="not 640×960"):
        TRUE.for_size(HEIGHT, WIDTH)


def test_exact_corners_give_the_lens_back():
    sets = [inner_corners(*pose) for pose in poses(12)]
    lens = calibrate([*sets, None, np.zeros((3, 2))], BOARD, SQUARE_MM, (WIDTH, HEIGHT))
    assert lens.pictures_used == 12
    assert lens.rms_px < 1e-3
    np.testing.assert_allclose(lens.matrix, TRUE.matrix, atol=0.05)
    np.testing.assert_allclose(lens.distortion, TRUE.distortion, atol=1e-3)
    few = calibrate(sets[:5], BOARD, SQUARE_MM, (WIDTH, HEIGHT))
    assert few.distortion[4] == 0
    np.testing.assert_allclose(few.distortion[:2], TRUE.distortion[:2], atol=1e-3)


def test_doubts_are_told():
    noisy = [
        inner_corners(*p) + np.random.default_rng(i).normal(scale=2, size=(54, 2)) for i, p in enumerate(poses(12))
    ]
    assert any("the boards fit to 2." in w for w in calibrate(noisy, BOARD, SQUARE_MM, (WIDTH, HEIGHT)).warnings)
    turn, place = next(poses(1))
    few = [inner_corners(turn, np.add(place, (0, 0, z))) for z in (300, 320, 340)]
    doubts = calibrate(few, BOARD, SQUARE_MM, (WIDTH, HEIGHT)).warnings
    assert any("of the picture (below 50%): reach into its corners" in w for w in doubts)


def test_boards_held_flat_leave_the_focal_length_open():
    flat = [
        inner_corners(np.eye(3), np.array([x, y, z])) for x, y, z in [(-90, -60, 260), (-60, -50, 300), (-99, -30, 340)]
    ]
    rough = [c + np.random.default_rng(i).normal(scale=0.1, size=c.shape) for i, c in enumerate(flat)]
    doubts = calibrate(rough, BOARD, SQUARE_MM, (WIDTH, HEIGHT)).warnings
    assert any("tilted by at most 0° to each other (below 15°)" in d for d in doubts)


@pytest.mark.parametrize("boards", [0, 1, 2])
def test_fewer_than_three_boards_are_refused(boards):
    sets = [inner_corners(*pose) for pose in poses(boards)] + [None] * 4
    with pytest.raises(
        InputError, match=f"a 9×6 chessboard is whole in {boards} of {boards + 4} pictures, 3 are needed"
    ):
        calibrate(sets, BOARD, SQUARE_MM, (WIDTH, HEIGHT))


def test_boards_and_squares_that_cannot_be_are_refused():
    with pytest.raises(UsageError, match="2×6 inner corners is too small"):
        calibrate([], (2, 6), SQUARE_MM, (WIDTH, HEIGHT))
    for square in (0.0, -1.0, float("nan")):
        with pytest.raises(UsageError, match="side of a square is"):
            calibrate([], BOARD, square, (WIDTH, HEIGHT))


def test_no_chessboard_is_none():
    assert find_chessboard(np.full((200, 300), 128, np.uint8)) is None
    assert find_chessboard(np.random.default_rng(1).integers(0, 256, (200, 300)).astype(np.uint8)) is None


def test_a_lens_comes_back_from_json_exactly():
    doubtful = Lens(TRUE.matrix, TRUE.distortion, WIDTH, HEIGHT, 0.25, 12, ("a doubt",))
    back = Lens.from_json(json.loads(json.dumps(doubtful.as_json())))
    np.testing.assert_array_equal(back.matrix, TRUE.matrix)
    np.testing.assert_array_equal(back.distortion, TRUE.distortion)
    assert (back.width, back.height, back.rms_px, back.pictures_used) == (WIDTH, HEIGHT, 0.25, 12)
    assert back.warnings == ("a doubt",)


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"schema": "other"}, "not a lens file"),
        ({"version": 2}, "version: lens version 2, this benchlab reads 1"),
        ({"version": True}, "lens version True"),
        ({"focal": 3}, "focal: key 'focal' is unknown"),
        ({"matrix": None}, "matrix: not 3×3 number"),
        ({"matrix": [[1, 0, 0], [0, 1], [0, 0, 1]]}, "matrix: not 3×3 number"),
        ({"matrix": [[0, 0, 5], [0, 900, 5], [0, 0, 1]]}, "matrix: not of the form"),
        ({"matrix": [[900, 1, 5], [0, 900, 5], [0, 0, 1]]}, "matrix: not of the form"),
        ({"distortion": [0, 0, 0, 0]}, "distortion: not 5 number"),
        ({"distortion": [0, 0, 0, 0, "0"]}, "distortion: '0' is not a number within"),
        ({"distortion": [0, 0, 0, 0, float("nan")]}, "distortion: 'nan' is not a number within"),
        ({"distortion": [0, 0, 0, 0, True]}, "distortion: 'True' is not a number within"),
        ({"distortion": [0, 0, 0, 0, 10**400]}, "distortion: '1000.*is not a number within"),
        ({"distortion": {"k1": 0}}, "distortion: not 5 number"),
        ({"width": 0}, "width: 0 is not a whole number from 1"),
        ({"width": 960.5}, "width: 960.5 is not a whole number"),
        ({"height": True}, "height: True is not"),
        ({"rms_px": -0.1}, "rms_px: -0.1 px is negative"),
        ({"rms_px": [0.1]}, "rms_px: not one number"),
        ({"pictures_used": 1}, "pictures_used: 1 is not a whole number from 3"),
        ({"warnings": "none"}, "warnings: not a list of texts"),
        ({"warnings": [1]}, "warnings: not a list of texts"),
    ],
)
def test_lens_files_that_are_not_right_are_refused(change, message):
    with pytest.raises(InputError, match=message):
        Lens.from_json(TRUE.as_json() | change)


def test_missing_keys_and_other_data_are_refused():
    data = TRUE.as_json()
    del data["distortion"]
    with pytest.raises(InputError, match="key 'distortion' is missing"):
        Lens.from_json(data)
    for other in (None, [], "benchlab-lens", {}, 3):
        with pytest.raises(InputError, match="not a lens file"):
            Lens.from_json(other)
