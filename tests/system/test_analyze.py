"""`benchlab analyze` from the outside: files, numbers, JSON, skipping, batches, interruption."""

import json
import os
import shutil
import subprocess
import sys
from pathlib import Path

import cv2
import h5py
import numpy as np
import pandas as pd
import pytest

from benchlab.io.run_file import read_run_file
from tests.system.patience import interrupted_at

sys.path.insert(0, str(Path(__file__).parent))
from conftest import ANGLES_DEG, FPS, draw_clip

COLUMNS = ["time_s", "curvature_per_mm", "angle_deg", "angle_sd_deg", "radius_mm", "fit_rms_px", "n_markers", "flag"]
SUMMARY = {"video", "frames", "frames_measured", "duration_s", "scale_mm_per_px", "max_angle_deg", "max_angle_sd_deg",
           "max_curvature_per_mm", "fit_rms_px", "warnings", "outputs"}  # fmt: skip


def test_a_clip_becomes_a_table_a_run_file_and_a_picture(benchlab, drawn_clip, tmp_path) -> None:
    done = benchlab("analyze", drawn_clip, "--out", tmp_path, "--json")
    assert done.code == 0, done.err
    (video,) = done.json["videos"]
    assert set(video) >= SUMMARY
    assert video["frames"] == video["frames_measured"] == len(ANGLES_DEG)
    assert video["duration_s"] == pytest.approx((len(ANGLES_DEG) - 1) / FPS, abs=1e-3)
    assert video["max_angle_deg"] == pytest.approx(100, abs=0.3)
    assert video["scale_mm_per_px"] == pytest.approx(180 / 300, rel=2e-3)
    assert any("assumed to span 180 mm" in w for w in video["warnings"])
    assert [Path(p).name for p in video["outputs"]] == ["trial.h5", "trial.csv", "trial.png"]

    table = pd.read_csv(tmp_path / "trial.csv")
    assert set(COLUMNS) <= set(table.columns)
    assert np.abs(table["angle_deg"] - ANGLES_DEG).max() < 0.4
    assert table["time_s"].iloc[-1] == pytest.approx((len(ANGLES_DEG) - 1) / FPS, abs=1e-3)
    assert (table["n_markers"] == 7).all()
    moved = table[table["angle_deg"] > 20]
    assert np.abs(moved["radius_mm"] * moved["curvature_per_mm"] - 1).max() < 1e-3
    assert np.abs(np.degrees(table["curvature_per_mm"] * 180) - table["angle_deg"]).max() < 1e-3

    run_file = read_run_file(tmp_path / "trial.h5")
    assert np.degrees(run_file.series.angle_rad) == pytest.approx(table["angle_deg"], abs=1e-3)
    assert run_file.provenance["sha256"] and not run_file.partial
    with h5py.File(tmp_path / "trial.h5") as file:
        assert file.attrs["default"] == "entry"
    picture = cv2.imread(str(tmp_path / "trial.png"))
    assert picture.shape[1] > 800 and picture.std() > 10


def test_every_fit_and_given_scale_agree(benchlab, drawn_clip, tmp_path) -> None:
    for fit in ("kasa", "pratt", "taubin", "hyper", "geometric"):
        done = benchlab(
            "analyze", drawn_clip, "--out", tmp_path / fit, "--fit", fit, "--scale-mm-per-px", "0.6", "--json"
        )
        (video,) = done.json["videos"]
        assert video["max_angle_deg"] == pytest.approx(100, abs=0.4), fit
        assert video["scale_mm_per_px"] == 0.6
        assert not any("assumed" in w for w in video["warnings"])


@pytest.mark.parametrize(
    "scale",
    [
        ("--reference-mm", "60", "--reference-px", "100,100,200,100"),
        ("--marker-span-mm", "180"),
    ],
)
def test_scale_from_a_reference_or_the_span(benchlab, drawn_clip, tmp_path, scale) -> None:
    done = benchlab("analyze", drawn_clip, "--out", tmp_path, *scale, "--json")
    assert done.json["videos"][0]["max_angle_deg"] == pytest.approx(100, abs=0.4)
    assert not any("assumed" in w for w in done.json["videos"][0]["warnings"])


def test_half_the_span_halves_the_scale_and_doubles_nothing_else(benchlab, drawn_clip, tmp_path) -> None:
    done = benchlab("analyze", drawn_clip, "--out", tmp_path, "--marker-span-mm", "90", "--json")
    assert done.json["videos"][0]["max_angle_deg"] == pytest.approx(200, abs=0.8)


def test_a_ramp_gives_the_angle_against_pressure(benchlab, drawn_clip, tmp_path) -> None:
    done = benchlab("analyze", drawn_clip, "--out", tmp_path, "--ramp", "0:0.35:1.1333", "--json")
    assert done.code == 0
    table = pd.read_csv(tmp_path / "trial.csv")
    start = 4 / FPS
    expected = np.interp(table["time_s"], [start, start + 1.1333], [0, 0.35])
    assert np.abs(table["pressure_MPa"] - expected).max() < 0.012
    done = benchlab("analyze", drawn_clip, "--out", tmp_path, "--ramp", "0:0.35:1.1333", "--sync", start)
    assert np.abs(pd.read_csv(tmp_path / "trial.csv")["pressure_MPa"] - expected).max() < 1e-4


def test_a_pressure_file_is_looked_up_and_shifted(benchlab, drawn_clip, tmp_path) -> None:
    log = tmp_path / "log.csv"
    log.write_text("Time (ms);Pressure (kPa)\n0;0\n200;0\n1333,333;350\n9000;350\n")
    done = benchlab("analyze", drawn_clip, "--out", tmp_path / "a", "--pressure", log, "--json")
    assert done.code == 0, done.err
    table = pd.read_csv(tmp_path / "a" / "trial.csv")
    expected = np.interp(table["time_s"], [0.2, 4 / 3], [0, 0.35])
    assert np.abs(table["pressure_MPa"] - expected).max() < 1e-4
    benchlab("analyze", drawn_clip, "--out", tmp_path / "b", "--pressure", log, "--sync", "onset")
    shifted = pd.read_csv(tmp_path / "b" / "trial.csv")["pressure_MPa"]
    expected = np.interp(table["time_s"], [4 / FPS, 4 / FPS + 1.13333], [0, 0.35])
    assert np.nanmax(np.abs(shifted - expected)) < 0.015


def test_stills_are_one_recording_in_natural_order(benchlab, tmp_path) -> None:
    film = draw_clip(tmp_path / "film.mp4", np.array([0.0, 30, 60, 90]), exposure_fraction=0.0)
    stills = tmp_path / "stills"
    stills.mkdir()
    video, i = cv2.VideoCapture(str(film)), 0
    while (read := video.read())[0]:
        cv2.imwrite(str(stills / f"p{8 + i}.png"), read[1])
        i += 1
    done = benchlab("analyze", stills, "--json", "--out", tmp_path / "out")
    assert done.code == 0, done.err
    table = pd.read_csv(tmp_path / "out" / "stills.csv")
    assert table["name"].tolist() == ["p8.png", "p9.png", "p10.png", "p11.png"]
    assert table["angle_deg"].to_numpy() == pytest.approx([0, 30, 60, 90], abs=0.6)
    assert table["time_s"].isna().all() and done.json["videos"][0]["duration_s"] is None
    timed = benchlab("analyze", stills, "--json", "--out", tmp_path / "timed", "--fps", "2")
    assert timed.json["videos"][0]["duration_s"] == 1.5


def test_other_colours(benchlab, tmp_path) -> None:
    for colour, rgb in (("green", (38, 150, 62)), ("blue", (36, 72, 190))):
        film = draw_clip(tmp_path / f"{colour}.mp4", np.linspace(0, 80, 12), marker_rgb=rgb)
        done = benchlab("analyze", film, "--colour", colour, "--json")
        assert done.json["videos"][0]["max_angle_deg"] == pytest.approx(80, abs=0.5), done.err


@pytest.mark.parametrize("angle", [200.0, 320.0])
def test_beyond_half_a_turn(benchlab, tmp_path, angle) -> None:
    film = draw_clip(tmp_path / "loop.mp4", np.linspace(20, angle, 40), base_px=(250.0, 130.0))
    done = benchlab("analyze", film, "--json")
    assert done.json["videos"][0]["max_angle_deg"] == pytest.approx(angle, abs=0.8)


def test_a_mirrored_picture_bends_the_same_way_and_flip_turns_it(benchlab, tmp_path) -> None:
    film = draw_clip(tmp_path / "up.mp4", bend_sign=-1, base_px=(140.0, 290.0))
    assert benchlab("analyze", film, "--json").json["videos"][0]["max_angle_deg"] == pytest.approx(100, abs=0.4)
    benchlab("analyze", film, "--flip")
    assert pd.read_csv(tmp_path / "up.csv")["angle_deg"].min() == pytest.approx(-100, abs=0.4)


def test_the_overlay_is_a_film_of_the_same_length(benchlab, drawn_clip, tmp_path) -> None:
    done = benchlab("analyze", drawn_clip, "--out", tmp_path, "--overlay", "--json")
    assert done.code == 0, done.err
    overlay = Path(done.json["videos"][0]["outputs"][-1])
    video, frames = cv2.VideoCapture(str(overlay)), 0
    while (read := video.read())[0]:
        frames, last = frames + 1, read[1]
    assert frames == len(ANGLES_DEG)
    original = cv2.VideoCapture(str(drawn_clip))
    assert np.abs(original.read()[1].astype(int) - last).max() > 60


def test_a_current_result_is_skipped_and_a_changed_one_made_again(benchlab, drawn_clip, tmp_path) -> None:
    clip = Path(shutil.copy(drawn_clip, tmp_path))
    first = benchlab("analyze", clip, "--json").json["videos"][0]
    again = benchlab("analyze", clip, "--json")
    assert again.json["videos"][0] == {**first, "status": "current"}
    assert "current, skipped" in again.err
    assert benchlab("analyze", clip, "--json", "--fit", "pratt").json["videos"][0]["status"] == "measured"
    draw_clip(clip, np.linspace(0, 50, 20))
    changed = benchlab("analyze", clip, "--json", "--fit", "pratt").json["videos"][0]
    assert changed["status"] == "measured" and changed["max_angle_deg"] == pytest.approx(50, abs=0.4)


def test_files_that_are_not_ours_are_not_replaced(benchlab, drawn_clip, tmp_path) -> None:
    clip = Path(shutil.copy(drawn_clip, tmp_path))
    log = tmp_path / "trial.csv"
    log.write_text("time_s,pressure_MPa\n0,0\n")
    refused = benchlab("analyze", clip)
    assert refused.code == 2 and "--overwrite" in refused.err and "trial.csv" in refused.err
    assert log.read_text().startswith("time_s,pressure_MPa") and not (tmp_path / "trial.h5").exists()
    assert benchlab("analyze", clip, "--overwrite").code == 0
    log.write_text("edited by hand")
    assert benchlab("analyze", clip, "--fit", "pratt").code == 2


def test_an_input_is_never_replaced(benchlab, drawn_clip, tmp_path) -> None:
    clip = Path(shutil.copy(drawn_clip, tmp_path))
    log = tmp_path / "trial.csv"
    log.write_text("time_s,pressure_MPa\n0,0\n9,0.3\n")
    refused = benchlab("analyze", clip, "--pressure", log, "--overwrite")
    assert refused.code == 2 and "would be replaced" in refused.err
    assert log.read_text().endswith("9,0.3\n")
    assert benchlab("analyze", clip, "--pressure", log, "--out", tmp_path / "out").code == 0


def test_a_batch_keeps_the_good_names_the_bad_and_resumes(benchlab, drawn_clip, tmp_path) -> None:
    films = tmp_path / "films"
    films.mkdir()
    for i in (1, 2, 10):
        shutil.copy(drawn_clip, films / f"s{i}.mp4")
    (films / "s3.mp4").write_bytes(b"")
    (films / "s4.mp4").write_text("time_s,pressure_MPa\n0,0\n" * 30)
    done = benchlab("analyze", films, "--out", tmp_path / "out", "--json")
    assert done.code == 4
    assert [Path(v["video"]).name for v in done.json["videos"]] == ["s1.mp4", "s2.mp4", "s10.mp4"]
    assert sorted(Path(f["file"]).name for f in done.json["failed"]) == ["s3.mp4", "s4.mp4"]
    assert "empty file" in done.err and "3 of 5 recordings analysed, 2 failed" in done.err
    shutil.copy(drawn_clip, films / "s3.mp4")
    again = benchlab("analyze", films, "--out", tmp_path / "out", "--json")
    assert {Path(v["video"]).name: v["status"] for v in again.json["videos"]} == {
        "s1.mp4": "current", "s2.mp4": "current", "s3.mp4": "measured", "s10.mp4": "current"}  # fmt: skip


def test_two_jobs_give_the_same_numbers(drawn_clip, tmp_path) -> None:
    for i in (1, 2, 3):
        shutil.copy(drawn_clip, tmp_path / f"s{i}.mp4")
    command = [sys.executable, "-m", "benchlab", "analyze", *sorted(tmp_path.glob("*.mp4")), "--json", "--jobs", "2"]
    done = subprocess.run(command, capture_output=True, text=True, check=True)
    videos = json.loads(done.stdout)["videos"]
    assert len(videos) == 3 and len({v["max_angle_deg"] for v in videos}) == 1


def test_an_interruption_keeps_what_was_measured(tmp_path) -> None:
    clip = draw_clip(tmp_path / "long.mp4", np.linspace(0, 90, 80))
    command = [*interrupted_at(50), "analyze", clip, "--json"]
    process = subprocess.run(command, capture_output=True, text=True, check=False)
    err = process.stderr
    assert process.returncode == 130, err
    (video,) = json.loads(process.stdout)["videos"]
    assert video["status"] == "partial" and 2 <= video["frames"] <= 51
    assert len(pd.read_csv(tmp_path / "long.csv")) == video["frames"]
    assert read_run_file(tmp_path / "long.h5").partial
    assert "PARTIAL" in err and "Traceback" not in err


def test_who_holds_the_lock_is_named_and_a_dead_holder_is_not_waited_for(benchlab, drawn_clip, tmp_path) -> None:
    lock = tmp_path / ".trial.lock"
    lock.write_text(f"process {os.getpid()} on {os.uname().nodename}")
    held = benchlab("analyze", drawn_clip, "--out", tmp_path)
    assert held.code == 2 and f"process {os.getpid()}" in held.err
    lock.write_text(f"process 999999999 on {os.uname().nodename}")
    assert benchlab("analyze", drawn_clip, "--out", tmp_path).code == 0
    assert not lock.exists()


def test_strict_turns_warnings_into_a_refusal(benchlab, drawn_clip, tmp_path) -> None:
    assert benchlab("analyze", drawn_clip, "--out", tmp_path, "--strict").code == 3
    assert benchlab("analyze", drawn_clip, "--out", tmp_path, "--strict", "--marker-span-mm", "180").code == 0


def test_a_body_that_rests_has_no_onset(benchlab, tmp_path) -> None:
    clip = draw_clip(tmp_path / "rest.mp4", np.full(25, 45.0))
    refused = benchlab("analyze", clip, "--ramp", "0:0.35:2.5")
    assert refused.code == 3 and "the angle moves by" in refused.err and "--sync" in refused.err
    late = benchlab("analyze", clip, "--ramp", "0:0.35:2.5", "--sync", "99", "--json")
    assert any("pressure does not change" in w for w in late.json["videos"][0]["warnings"])


def test_an_overlay_of_an_earlier_run_does_not_stay_beside_a_new_one(benchlab, drawn_clip, tmp_path) -> None:
    assert benchlab("analyze", drawn_clip, "--out", tmp_path, "--overlay").code == 0
    assert (tmp_path / "trial.overlay.mp4").exists()
    assert benchlab("analyze", drawn_clip, "--out", tmp_path, "--fit", "pratt").code == 0
    assert sorted(p.name for p in tmp_path.iterdir()) == ["trial.csv", "trial.h5", "trial.png"]


def test_markers_too_close_to_be_told_apart_leave_no_frame_unflagged(benchlab, tmp_path) -> None:
    clip = draw_clip(tmp_path / "dense.mp4", np.linspace(0, 100, 40), markers=24, marker_radius_px=6.0)
    done = benchlab("analyze", clip, "--json")
    if done.code == 3:
        assert "no actuator found" in done.err
        return
    table = pd.read_csv(clip.with_suffix(".csv"))
    wrong = (table["angle_deg"] - np.linspace(0, 100, 40)).abs() > 3
    assert not (wrong & table["flag"].isna()).any()
