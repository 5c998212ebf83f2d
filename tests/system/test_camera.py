"""What a camera does to a picture must not change the angle: turned, squeezed and bent pictures, rulers and second rows."""

import json
import sys
from fractions import Fraction
from pathlib import Path

import cv2
import numpy as np
import pandas as pd
import pytest

sys.path.insert(0, str(Path(__file__).parent))
from conftest import SMALL, draw_clip

from benchlab.io.planes import planes_to_bgr
from benchlab.io.run_file import read_run_file
from benchlab.vision.synthetic import draw_frames

BENT_DEG = np.linspace(0, 100, 16)


@pytest.fixture(scope="module")
def pictures() -> list[np.ndarray]:
    """RGB pictures of a small actuator bending to 100°."""
    frames = draw_frames(SMALL, np.radians(BENT_DEG), np.random.default_rng(5))
    return [np.ascontiguousarray(planes_to_bgr(planes)[..., ::-1]) for planes in frames]


def angles(done) -> np.ndarray:
    assert done.code == 0, done.err
    return pd.read_csv(Path(done.json["videos"][0]["outputs"][1]))["angle_deg"].to_numpy()


@pytest.mark.parametrize("turn", [90, 180, 270])
def test_a_rotation_tag_turns_the_picture_and_not_the_angle(benchlab, make_clip, pictures, turn) -> None:
    clip = make_clip(
        "t.mp4", size=(640, 360), frames=16, draw=lambda i: pictures[i], rotation_ccw_deg=turn, options={"crf": "12"}
    )
    done = benchlab("analyze", clip, "--json")
    assert angles(done) == pytest.approx(BENT_DEG, abs=0.6)
    first = read_run_file(clip.with_suffix(".h5")).series.markers_px[0, 0]
    base = np.array(SMALL.base_px)
    expected = {90: (base[1], 639 - base[0]), 180: (639 - base[0], 359 - base[1]), 270: (359 - base[1], base[0])}[turn]
    assert first == pytest.approx(expected, abs=0.5)


def test_a_squeezed_picture_is_stretched(benchlab, make_clip, pictures) -> None:
    squeezed = [cv2.resize(p, (320, 360), interpolation=cv2.INTER_AREA) for p in pictures]
    clip = make_clip(
        "t.mp4", size=(320, 360), frames=16, draw=lambda i: squeezed[i], aspect=Fraction(2), options={"crf": "12"}
    )
    assert angles(benchlab("analyze", clip, "--json")) == pytest.approx(
        BENT_DEG, abs=1.5
    )  # the markers are 3 samples wide


def test_an_aruco_marker_gives_the_scale(benchlab, tmp_path, pictures) -> None:
    marker = cv2.aruco.generateImageMarker(cv2.aruco.getPredefinedDictionary(cv2.aruco.DICT_4X4_50), 7, 60)
    picture = pictures[-1].copy()
    picture[230:320, 30:120] = 235
    picture[245:305, 45:105] = marker[..., None]
    cv2.imwrite(str(tmp_path / "a.png"), picture[..., ::-1])
    done = benchlab("analyze", tmp_path / "a.png", "--aruco-mm", "36", "--json")
    assert done.code == 0, done.err
    assert done.json["videos"][0]["scale_mm_per_px"] == pytest.approx(0.6, rel=0.01)
    assert done.json["videos"][0]["max_angle_deg"] == pytest.approx(100, abs=1.5)
    cv2.imwrite(str(tmp_path / "b.png"), pictures[-1][..., ::-1])
    missing = benchlab("analyze", tmp_path / "b.png", "--aruco-mm", "36")
    assert missing.code == 3 and "ArUco" in missing.err


def test_a_second_actuator_asks_for_a_region(benchlab, tmp_path, pictures) -> None:
    cv2.imwrite(str(tmp_path / "two.png"), np.vstack([pictures[3], pictures[-1]])[..., ::-1])
    both = benchlab("analyze", tmp_path / "two.png", "--json")
    assert any("second row" in w for w in both.json["videos"][0]["warnings"])
    for top, angle in ((0, BENT_DEG[3]), (360, 100)):
        one = benchlab("analyze", tmp_path / "two.png", "--roi", f"0,{top},640,360", "--json")
        assert one.json["videos"][0]["max_angle_deg"] == pytest.approx(angle, abs=0.8)
        assert not any("second row" in w for w in one.json["videos"][0]["warnings"])


def test_a_calibrated_lens_takes_the_distortion_out(benchlab, tmp_path) -> None:
    lens = {"lens_k1": -0.25, "lens_k2": 0.05, "focal_px": 520.0}
    clip = draw_clip(tmp_path / "bent.mp4", BENT_DEG, **lens)
    file = tmp_path / "lens.json"
    file.write_text(json.dumps({"schema": "benchlab-lens", "version": 1, "matrix": [[520.0, 0, 319.5], [0, 520.0, 179.5], [0, 0, 1]],
                                "distortion": [-0.25, 0.05, 0, 0, 0], "width": 640, "height": 360, "rms_px": 0.1, "pictures_used": 9,
                                "warnings": []}))  # fmt: skip
    scale = ("--scale-mm-per-px", "0.6", "--json")
    off = np.abs(angles(benchlab("analyze", clip, *scale, "--out", tmp_path / "a")) - BENT_DEG).max()
    right = np.abs(angles(benchlab("analyze", clip, *scale, "--lens", file, "--out", tmp_path / "b")) - BENT_DEG).max()
    assert off > 2 and right < 0.5
    file.write_text('{"schema": "benchlab-lens"}')
    assert benchlab("analyze", clip, "--lens", file).code == 3
