"""All recordings of a study as values: drawn films of known angle, tables, run files; what fails, is left out, or is current."""

from __future__ import annotations

import math
import shutil
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import benchlab
from benchlab.errors import UsageError
from benchlab.io.study_file import read_study
from benchlab.io.study_values import StudyValues
from benchlab.io.video_writer import VideoWriter
from benchlab.vision.synthetic import Scene, draw_frames
from benchlab.workflows import study_recordings
from benchlab.workflows.study_values import collect

SCENE = Scene(width=480, height=270, markers=7, marker_radius_px=5.0, length_px=220.0, base_px=(110.0, 50.0), body_width_px=16.0,
              focal_px=700.0, noise_sd=1.0)  # fmt: skip
CYCLE = np.concatenate([np.zeros(4), np.linspace(0, 1, 12), np.ones(5), np.linspace(1, 0, 5)])
"""Share of the peak in each frame of a loading: rest, rise, hold, fall."""

PEAKS_DEG = (80.0, 82.0)
FPS = 30.0
PEAK_MPA = 0.35


def draw_film(path: Path, peaks_deg: tuple[float, ...] = PEAKS_DEG, seed: int = 5) -> Path:
    angles = np.radians(np.concatenate([peak * CYCLE for peak in peaks_deg]))
    with VideoWriter(path, SCENE.width, SCENE.height, fps=FPS, crf=16, preset="veryfast") as film:
        for planes in draw_frames(SCENE, angles, np.random.default_rng(seed)):
            film.write(planes)
    return path


def log_text(cycles: int = 2, peak_MPa: float = PEAK_MPA) -> str:
    pressure = np.concatenate([peak_MPa * CYCLE] * cycles)
    return "time_s,pressure_MPa\n" + "".join(f"{i / FPS:.5f},{p:.6f}\n" for i, p in enumerate(pressure))


@pytest.fixture(scope="module")
def films(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Two films of two cycles, and the log of their pressure."""
    folder = tmp_path_factory.mktemp("films")
    draw_film(folder / "a.mp4")
    draw_film(folder / "b.mp4", (60.0, 61.0), seed=6)
    (folder / "log.csv").write_text(log_text())
    return folder


@pytest.fixture
def bench(films: Path, tmp_path: Path) -> Path:
    """The same in a folder of the test's own."""
    return Path(shutil.copytree(films, tmp_path / "bench"))


def study_of(bench: Path, samples: str, more: str = "", name: str = "study.yaml") -> Path:
    """A study of the design `d` with these samples, `s1: a.mp4` a line, and the designs and keys of `more`."""
    lines = "".join(f"      {line}\n" for line in samples.strip().splitlines())
    text = "title: T\npressure_MPa: 0.35\nanalysis: {pressure: log.csv, marker_span_mm: 180}\n"
    (bench / name).write_text(f"{text}designs:\n  d:\n    samples:\n{lines}{more}")
    return bench / name


def collected(path: Path, **options: Any) -> StudyValues:
    return collect(read_study(path), path.parent / "out", **options)


def statuses(values: StudyValues) -> list[str]:
    return [r.status for d in values.designs for s in d.samples for r in s.recordings]


def test_the_angle_of_each_cycle_is_the_drawn_one(bench: Path) -> None:
    values = collected(study_of(bench, "s1: a.mp4\ns2: b.mp4"))
    (design,) = values.designs
    assert [[cycle.method for cycle in sample.cycles] for sample in design.samples] == [["held"] * 2] * 2
    for sample, drawn in zip(design.samples, (PEAKS_DEG, (60.0, 61.0))):
        found = np.array([cycle.angle_deg for cycle in sample.cycles])
        assert found == pytest.approx(drawn, abs=0.3)
        assert abs(found - drawn).max() < 4 * max(cycle.angle_sd_deg for cycle in sample.cycles)
        assert sample.angle_deg == pytest.approx(found.mean(), abs=1e-9)
    mean, spread = design.band_deg(len(values.curve_MPa))
    half = np.interp(0.175, values.curve_MPa, mean)
    assert half == pytest.approx((81 + 60.5) / 4, abs=0.5)
    assert mean[-1] == pytest.approx(design.angles_deg.mean(), abs=0.05)
    assert spread[-1] == pytest.approx(design.angles_deg.std(ddof=1), abs=0.05)
    assert values.failures == values.left_out == ()
    assert set(values.inputs) == {"study.yaml", "a.mp4", "b.mp4"}


def test_video_run_file_and_its_table_say_the_same(bench: Path) -> None:
    collected(study_of(bench, "s1: a.mp4"))
    for suffix in ("h5", "csv"):
        shutil.copy(bench / f"out/recordings/d/s1/a.{suffix}", bench / f"same.{suffix}")
    values = collected(study_of(bench, "video: a.mp4\nrun: same.h5\ntable: same.csv"))
    video, run, table = values.designs[0].samples
    assert statuses(values) == ["measured", "read", "read"]
    for other, least in ((run, 1e-9), (table, 2e-4)):
        assert [c.angle_deg for c in other.cycles] == pytest.approx([c.angle_deg for c in video.cycles], abs=least)
        assert [c.angle_sd_deg for c in other.cycles] == pytest.approx(
            [c.angle_sd_deg for c in video.cycles], abs=least
        )
        assert other.curve_deg(36) == pytest.approx(video.curve_deg(36), abs=2e-3, nan_ok=True)


def test_only_what_changed_is_analysed_again(bench: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    path = study_of(bench, "s1: a.mp4\ns2: b.mp4")
    told: list[tuple[int, int | None]] = []
    first = collected(path, progress=lambda done, total: told.append((done, total)))
    assert statuses(first) == ["measured", "measured"] and told == [(1, 2), (2, 2)]
    second = collected(path)
    assert statuses(second) == ["current", "current"]
    assert [s.cycles for s in second.designs[0].samples] == [s.cycles for s in first.designs[0].samples]
    other = "s1: a.mp4\ns2: {recordings: b.mp4, analysis: {fit: pratt}}"
    assert statuses(collected(study_of(bench, other))) == ["current", "measured"]
    draw_film(bench / "a.mp4", (70.0, 70.0))
    changed = collected(study_of(bench, other))
    assert statuses(changed) == ["measured", "current"]
    assert changed.designs[0].samples[0].angle_deg == pytest.approx(70, abs=0.3)
    (bench / "log.csv").write_text(log_text(peak_MPa=0.3505))
    study_of(bench, "s1: a.mp4\ns2: b.mp4")
    assert statuses(collected(path)) == ["measured", "measured"]
    monkeypatch.setattr(benchlab, "__version__", "0.0.test")
    assert statuses(collected(path)) == ["measured", "measured"]
    assert statuses(collected(path, overwrite=True)) == ["measured", "measured"]
    (bench / "study.yaml").write_text(path.read_text().replace("pressure_MPa: 0.35", "pressure_MPa: 0.2"))
    assert statuses(collected(path)) == ["current", "current"]


def test_a_bad_recording_is_listed_and_the_rest_goes_on(bench: Path) -> None:
    (bench / "text.mp4").write_text("no film")
    (bench / "cut.mp4").write_bytes((bench / "a.mp4").read_bytes()[:3000])
    (bench / "bad.h5").write_bytes(b"\x89HDF\r\n\x1a\n" + b"\0" * 100)
    samples = "gone: none.mp4\ntext: text.mp4\ncut: cut.mp4\nrun: bad.h5\nempty: []\ngood: [a.mp4, none.csv]"
    values = collected(study_of(bench, samples))
    (design,) = values.designs
    assert [sample.name for sample in design.counted] == ["good"]
    assert design.angles_deg == pytest.approx([81], abs=0.3)
    why = {(each.sample, each.recording): each.why for each in values.failures}
    assert set(why) == {
        ("gone", "none.mp4"), ("text", "text.mp4"), ("cut", "cut.mp4"), ("run", "bad.h5"), ("empty", ""), ("good", "none.csv"),
    }  # fmt: skip
    assert "no such file" in why["gone", "none.mp4"] and "text" in why["text", "text.mp4"]
    assert "no recording" in why["empty", ""]
    assert not any("\n" in each or "Traceback" in each for each in why.values())
    none = collected(study_of(bench, "gone: none.mp4", name="none.yaml"))
    assert [each.why for each in none.failures][-1] == "no sample of the design has a value"


def test_what_is_left_out_does_not_count_and_is_no_failure(bench: Path) -> None:
    samples = """
s1: [a.mp4, {file: b.mp4, left_out: camera moved}]
s2: {recordings: none.mp4, left_out: leaked}
s3: [{file: gone.mp4, left_out: never copied}, b2.mp4]
s4: {recordings: c.csv, left_out: cut askew}
"""
    (bench / "c.csv").write_text("cycle,angle_deg\n1,20\n")
    draw_film(bench / "b2.mp4", (60.0, 61.0), seed=7)
    values = collected(study_of(bench, samples))
    (design,) = values.designs
    assert [sample.name for sample in design.counted] == ["s1", "s3"]
    assert design.angles_deg == pytest.approx([81, 60.5], abs=0.3)
    assert values.failures == ()
    assert {(each.sample, each.recording, each.why) for each in values.left_out} == {
        ("s1", "b.mp4", "camera moved"), ("s2", "", "leaked"), ("s3", "gone.mp4", "never copied"),
        ("s4", "", "cut askew"),
    }  # fmt: skip
    left = values.designs[0].samples[0].recordings[1]
    assert left.cycles[0].angle_deg == pytest.approx(60, abs=0.3)


def test_after_ctrl_c_what_is_finished_is_current(bench: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    path = study_of(bench, "s1: a.mp4\ns2: b.mp4")

    def stop(done: int, total: int | None) -> None:
        raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        collected(path, progress=stop)
    assert statuses(collected(path)) == ["current", "measured"]

    kept = study_recordings.analyze
    seen: list[Path] = []

    def partial(source: Path, *rest: Any) -> dict[str, Any]:
        seen.append(source)
        return {**kept(source, *rest), "status": "partial"}

    monkeypatch.setattr(study_recordings, "analyze", partial)
    with pytest.raises(KeyboardInterrupt):
        collected(path)
    assert [source.name for source in seen] == ["a.mp4"]


def test_several_at_once_give_the_same(bench: Path) -> None:
    path = study_of(bench, "s1: a.mp4\ns2: b.mp4\ns3: none.mp4")
    one = collected(path)
    two = collected(path, jobs=2, overwrite=True)
    assert statuses(two) == ["measured", "measured", "failed"]
    assert [s.cycles for s in two.designs[0].samples] == [s.cycles for s in one.designs[0].samples]
    assert two.failures == one.failures and two.inputs == one.inputs


@pytest.mark.parametrize(
    ("analysis", "why"),
    [
        ("{pressure: null}", "its pressure is not known"),
        ("{ramp: '0:0.2:1', sync: 0}", "reaches 0.2 MPa at most, 0.35 MPa are wanted"),
        ("{pressure: none.csv}", "none.csv: no such file"),
        ("{reference_mm: 5}", "--reference-mm and --reference-px belong together"),
        ("{roi_px: [0, 0, 9000, 9000]}", "does not lie in the picture"),
    ],
)
def test_a_recording_without_its_pressure_or_with_settings_that_do_not_fit_says_why(
    bench: Path, analysis: str, why: str
) -> None:
    values = collected(study_of(bench, f"s1: {{recordings: a.mp4, analysis: {analysis}}}"))
    (cycle,) = values.designs[0].samples[0].recordings[0].cycles
    assert math.isnan(cycle.angle_deg) and why in cycle.flag
    assert any(why in each.why for each in values.failures)


def test_copies_are_named(bench: Path) -> None:
    shutil.copy(bench / "a.mp4", bench / "copy.mp4")
    values = collected(study_of(bench, "s1: a.mp4\ns2: copy.mp4\ns3: b.mp4"))
    copies = [each for each in values.warnings if "same content" in each.why]
    assert [(each.sample, each.why) for each in copies] == [("s2", "has the same content as a.mp4 of d s1")]


def test_one_table_may_serve_all_samples_and_is_no_copy(bench: Path) -> None:
    (bench / "all.csv").write_text("design,sample,cycle,angle_deg\nd,s1,1,50\nd,s1,2,52\nd,s2,1,60\ne,s1,1,9\n")
    values = collected(study_of(bench, "s1: all.csv\ns2: all.csv"))
    assert values.designs[0].angles_deg.tolist() == [51, 60]
    assert values.warnings == values.failures == ()
    (bench / "all.csv").write_text("cycle,angle_deg\n1,50\n2,52\n")
    values = collected(study_of(bench, "s1: all.csv\ns2: all.csv"))
    assert "no column `sample`" in values.failures[0].why and len(values.designs[0].counted) == 0
    assert collected(study_of(bench, "s1: all.csv")).designs[0].angles_deg.tolist() == [51]


def test_recordings_of_one_name_do_not_replace_each_other(bench: Path) -> None:
    (bench / "day2").mkdir()
    shutil.copy(bench / "b.mp4", bench / "day2/A.mp4")
    values = collected(study_of(bench, "s1: [a.mp4, day2/A.mp4]"))
    assert {path.name for path in (bench / "out/recordings/d/s1").glob("*.h5")} == {"a.h5", "A_2.h5"}
    assert values.designs[0].angles_deg == pytest.approx([(81 + 60.5) / 2], abs=0.3)
    assert statuses(collected(bench / "study.yaml")) == ["current", "current"]


def test_a_folder_that_cannot_be_written_to_is_usage(bench: Path) -> None:
    study = read_study(study_of(bench, "s1: a.mp4"))
    with pytest.raises(UsageError, match="no such folder"):
        collect(study, bench / "no" / "out")
    with pytest.raises(UsageError, match="cannot be used"):
        collect(study, bench / "a.mp4")
