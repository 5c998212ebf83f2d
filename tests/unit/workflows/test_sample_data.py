"""The drawn sample clips: what is planned, what is written, and what lies in the repository."""

from __future__ import annotations

import csv
from pathlib import Path

import av
import numpy as np
import pytest

from benchlab.errors import InputError, UsageError
from benchlab.io.layup_file import DEFAULT_LAYUP, read_layup
from benchlab.io.recording import open_recording
from benchlab.io.sweep_file import read_sweep_file
from benchlab.simulation.actuator_response import Fixture
from benchlab.vision.synthetic import Scene, marker_truth
from benchlab.workflows import drawn_film, sample_data, sample_study
from benchlab.workflows.sample_data import PUBLISHED_DEG, make_sample_data, sample_clips, series_rows, truth_rows
from benchlab.workflows.sample_force import force_rows
from benchlab.workflows.simulated import Conditions
from benchlab.workflows.study_check import check_study
from benchlab.workflows.sweep import simulated_sweep

FOLDER = Path(__file__).resolve().parents[3] / "sample_data"
SMALL = Scene(width=320, height=180, length_px=150.0, base_px=(60.0, 40.0), marker_radius_px=4.0, body_width_px=14.0)


def rows_of(path: Path) -> list[dict[str, str]]:
    with path.open(encoding="utf-8", newline="") as file:
        return list(csv.DictReader(file))


def as_text(rows: list[dict[str, object]]) -> list[dict[str, str]]:
    return [{key: str(value) for key, value in row.items()} for row in rows]


def decoded(path: Path) -> list[np.ndarray]:
    with open_recording(path) as recording:
        return [frame.planes.luma.copy() for frame in recording if frame.planes is not None]


@pytest.fixture
def small(monkeypatch: pytest.MonkeyPatch) -> None:
    """Two frames a clip, of a picture of 320×180; two simulated pressures."""
    monkeypatch.setattr(sample_data, "FRAMES", 2)
    monkeypatch.setattr(sample_data, "_scene", lambda *_: SMALL)
    monkeypatch.setattr(sample_study, "PRESSURES_MPA", (0.0, 0.1))


def test_a_seed_stands_for_five_samples_of_each_published_design() -> None:
    clips = sample_clips(1)
    assert len(clips) == 25
    assert len({clip.file for clip in clips}) == 25
    assert clips[5].file == "videos/tw3_slw10_s1.mp4"
    assert clips == sample_clips(1)
    assert clips != sample_clips(2)
    for (tw, slw), (mean, sd) in PUBLISHED_DEG.items():
        angles = [
            np.rad2deg(clip.angle_rad)
            for clip in clips
            if (clip.design.window_width_mm, clip.design.strip_width_mm) == (tw, slw)
        ]
        assert len(set(angles)) == 5
        assert np.abs(np.array(angles) - mean).max() < 4 * sd


def test_over_many_seeds_the_angles_have_the_published_mean_and_spread() -> None:
    angles = np.rad2deg([[clip.angle_rad for clip in sample_clips(seed)[5:10]] for seed in range(60)]).ravel()
    assert angles.mean() == pytest.approx(125.7, abs=3 * 4.0 / np.sqrt(300))
    assert angles.std(ddof=1) == pytest.approx(4.0, rel=3 / np.sqrt(600))


@pytest.mark.parametrize("seed", [1, 2, 3])
def test_every_marker_of_every_clip_stays_wholly_in_the_picture(seed: int) -> None:
    for clip in sample_clips(seed):
        assert (marker_truth(clip.scene, clip.angles_rad()[::8]).visible == 1).all(), clip.file
        assert clip.scene.length_px * clip.scale_mm_per_px == pytest.approx(180)


def test_the_angle_rises_without_a_jump_from_zero_to_its_final_value() -> None:
    clip = sample_clips(1)[0]
    angles, pressure = clip.angles_rad(), sample_data.ramp(sample_data.times_s())
    assert angles[0] == 0
    assert angles[-1] == clip.angle_rad
    assert (np.diff(angles[8:83]) > 0).all()
    assert (angles[83:] == clip.angle_rad).all()
    assert pressure[:8].max() == 0
    assert (pressure[45], pressure[-1]) == (pytest.approx(0.35 * 1.25 / 2.5), 0.35)
    assert np.abs(np.diff(angles)).max() < 1.4 * clip.angle_rad / 75


def test_the_folder_holds_clips_tables_and_a_readme_that_say_they_are_drawn(small: None, tmp_path: Path) -> None:
    told: list[tuple[int, int | None]] = []
    written = make_sample_data(tmp_path / "new", 3, lambda done, total: told.append((done, total)))
    assert told == [(done, 50) for done in range(1, 51)]
    names = {path.relative_to(tmp_path / "new").as_posix() for path in written}
    assert names == {clip.file for clip in sample_clips(3)} | {
        "truth.csv",
        "truth_series.csv",
        "pressure_log.csv",
        "tensile_drawn.csv",
        "truth_force.csv",
        "study.yaml",
        "simulated.h5",
        "force/tw3_slw10_a1.csv",
        "force/tw3_slw10_a2.csv",
        "force/tw3_slw10_a3.csv",
        "explain/loops.csv",
        "explain/simulated.csv",
        "README.md",
    }
    assert {path for path in (tmp_path / "new").rglob("*") if path.is_file()} == set(written)
    with av.open(str(tmp_path / "new/videos/tw3_slw5_s1.mp4")) as film:
        assert film.metadata["title"] == "drawn by benchlab, not filmed"
        assert "drawn" in film.metadata["comment"]
    text = (tmp_path / "new/README.md").read_text(encoding="utf-8")
    assert text.startswith("# Sample data: drawn, not filmed")
    assert "--seed 3" in text
    assert rows_of(tmp_path / "new/truth.csv") == as_text(truth_rows(sample_clips(3)))
    assert len(rows_of(tmp_path / "new/truth_series.csv")) == 50


def test_a_clip_can_be_read_back_with_its_rate_and_colour(small: None, tmp_path: Path) -> None:
    clip = sample_clips(1)[0]
    sample_data.write_clip(tmp_path / "a.mp4", clip, np.random.default_rng(1))
    with open_recording(tmp_path / "a.mp4") as recording:
        frames = [(frame.time_s, frame.planes) for frame in recording]
    assert [time_s for time_s, _ in frames] == pytest.approx([0, 1 / 30])
    planes = frames[0][1]
    assert planes is not None
    assert (planes.matrix, planes.full_range, planes.chroma_offset) == ("bt709", False, (0.0, 0.5))


def test_the_same_seed_draws_the_same_film(small: None, tmp_path: Path) -> None:
    clip = sample_clips(1)[0]
    films = []
    for name, seed in (("a.mp4", 1), ("b.mp4", 1), ("c.mp4", 2)):
        sample_data.write_clip(tmp_path / name, clip, np.random.default_rng(seed))
        films.append((tmp_path / name).read_bytes())
    assert films[0] == films[1]
    assert films[0] != films[2]


def test_a_drawing_that_is_stopped_leaves_nothing(small: None, tmp_path: Path) -> None:
    def stop(done: int, total: int | None) -> None:
        raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        sample_data.write_clip(tmp_path / "a.mp4", sample_clips(1)[0], np.random.default_rng(1), stop)
    assert list(tmp_path.iterdir()) == []


def test_a_file_in_the_way_and_a_negative_seed_are_refused(tmp_path: Path) -> None:
    (tmp_path / "taken").write_text("x")
    with pytest.raises(InputError, match="cannot make this folder"):
        make_sample_data(tmp_path / "taken")
    with pytest.raises(UsageError, match="seed -1 is negative"):
        make_sample_data(tmp_path, -1)


def test_the_repository_holds_what_seed_1_stands_for() -> None:
    clips = sample_clips(1)
    assert rows_of(FOLDER / "truth.csv") == as_text(truth_rows(clips))
    assert rows_of(FOLDER / "truth_series.csv") == as_text(series_rows(clips))
    assert rows_of(FOLDER / "pressure_log.csv") == as_text(sample_data.log_rows())
    assert rows_of(FOLDER / "truth_force.csv") == as_text(force_rows(1))
    designs = sample_data._design_rows(clips)
    assert (FOLDER / "README.md").read_text(encoding="utf-8") == sample_data.readme(designs, sample_data.CONCAVITY, 1)
    assert {f"videos/{path.name}" for path in (FOLDER / "videos").glob("*.mp4") if ".overlay" not in path.name} == {
        clip.file for clip in clips
    }
    assert sum(path.stat().st_size for path in FOLDER.rglob("*") if path.is_file()) < 22e6
    assert (FOLDER / "truth_series.csv").stat().st_size < 300e3
    for clip in clips:
        with av.open(str(FOLDER / clip.file)) as film:
            assert film.metadata["title"] == drawn_film.TITLE
            stream = film.streams.video[0]
            assert (stream.width, stream.height, stream.frames) == (1920, 1080, 90)


def test_the_markers_of_a_clip_in_the_repository_are_where_the_truth_says() -> None:
    clip = sample_clips(1)[5]
    pictures = decoded(FOLDER / clip.file)
    truth = marker_truth(clip.scene, clip.angles_rad()).positions_px
    reach = int(clip.scene.marker_radius_px) + 6
    y, x = np.mgrid[-reach : reach + 1, -reach : reach + 1]
    errors = []
    for picture, places in list(zip(pictures, truth, strict=True))[::6]:
        for place in places:
            column, row = np.rint(place).astype(int)
            window = picture[row - reach : row + reach + 1, column - reach : column + reach + 1].astype(float)
            distance = np.hypot(x + column - place[0], y + row - place[1])
            dark = np.median(window[(distance > reach - 4) & (distance < reach - 1)]) - window
            dark[(distance > reach - 2) | (dark < 0.12 * dark.max())] = 0
            found = np.average(x, weights=dark) + column, np.average(y, weights=dark) + row
            errors.append(np.hypot(*(found - place)))
    assert np.mean(errors) < 0.06
    assert np.percentile(errors, 95) < 0.15


def test_the_texts_in_the_repository_are_those_that_the_command_writes() -> None:
    folder = Path(__file__).resolve().parents[3] / "sample_data"
    for name, text in sample_data.sample_texts(sample_clips(1), 1).items():
        content = text if isinstance(text, bytes) else text.encode()
        assert (folder / name).read_bytes() == content, f"{name}: run `benchlab sample-data`"


def test_the_study_in_the_repository_lacks_nothing() -> None:
    found = check_study(FOLDER / "study.yaml")
    assert found["missing"] == found["left_out"] == found["notes"] == []
    assert [(design["name"], design["n"], design["simulated"]) for design in found["designs"]] == [
        (f"tw{tw}_slw{slw}", 5, "found") for tw, slw in PUBLISHED_DEG
    ]
    assert [chosen["designs"] for chosen in found["sets"][:2]] == [
        ["tw3_slw5", "tw3_slw10", "tw3_slw20"],
        ["tw3_slw10", "tw9_slw10", "tw15_slw10"],
    ]


def test_the_simulation_in_the_repository_is_what_the_code_says() -> None:
    sweep = read_sweep_file(FOLDER / "simulated.h5")
    assert (FOLDER / "simulated.h5").stat().st_size < 100e3
    assert sweep.axes["tw_mm"] == (3, 9, 15) and sweep.axes["slw_mm"] == (5, 10, 20)
    axes = {**sweep.axes, "tw_mm": (3.0,), "slw_mm": (10.0,)}
    again = simulated_sweep(axes, Conditions(read_layup(DEFAULT_LAYUP), (0.0, 0.35), Fixture(), blocked=False))
    assert sweep.pressure_MPa[-1] == 0.35
    assert sweep.curves["angle_deg"][1, -1] == pytest.approx(again.curves["angle_deg"][0, -1], abs=1e-3)
    assert "/" not in sweep.provenance["argv"][0]
