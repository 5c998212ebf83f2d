"""Rows of the bad-input list that concern `benchlab analyze`: one clear line, the right exit code, nothing left behind."""

import os
import subprocess
import sys
from pathlib import Path

import numpy as np
import pandas as pd
import pytest

sys.path.insert(0, str(Path(__file__).parent))
from conftest import SMALL, draw_clip

ROOT = os.geteuid() == 0 if hasattr(os, "geteuid") else False


def refused(done, code: int, *words: str) -> None:
    """One line on standard error with these words, no traceback, and this exit code."""
    lines = [line for line in done.err.splitlines() if line.startswith("benchlab: ")]
    assert done.code == code, done.err
    assert len(lines) == 1, done.err
    for word in words:
        assert word in lines[0], lines[0]
    assert "Traceback" not in done.err


def nothing_left(folder: Path, *but: str) -> None:
    assert sorted(p.name for p in folder.iterdir()) == sorted(but)


@pytest.mark.parametrize("name", ["missing.mp4", "http://example.org/a.mp4", "concat:a.mp4|b.mp4", "rtsp://x/y", "-"])
def test_what_is_no_file_is_never_opened(benchlab, tmp_path, monkeypatch, name) -> None:
    monkeypatch.chdir(tmp_path)
    refused(benchlab("analyze", "--", name), 2, "no such file")
    nothing_left(tmp_path)


def test_a_pipe_is_refused_at_once(benchlab, tmp_path) -> None:
    os.mkfifo(tmp_path / "pipe.mp4")
    refused(benchlab("analyze", tmp_path / "pipe.mp4"), 3, "not a regular file")  # whoever opens it waits for ever
    refused(benchlab("analyze", "/dev/zero"), 3, "not a regular file")


def test_a_folder_without_films(benchlab, tmp_path) -> None:
    (tmp_path / "x.mp4").mkdir()
    refused(benchlab("analyze", tmp_path / "x.mp4"), 3, "no video and no picture")


@pytest.mark.parametrize(
    ("content", "words"),
    [
        (b"", ("empty file", "copy finished")),
        (b"\0\0\0\x20ftypisom\0\0\2\0isomiso2avc1mp41" + b"\0" * 60, ()),
        (np.random.default_rng(0).bytes(200_000), ("not a video",)),
        (bytes(200_000), ("not a video",)),
        (b"time_s,pressure_MPa\n" + b"0.1,0.2\n" * 500, ("looks like text",)),
        (b"ffconcat version 1.0\nfile other.mp4\n", ()),
        (b"#EXTM3U\n#EXT-X-TARGETDURATION:10\n#EXTINF:9,\nhttp://example.org/a.ts\n", ()),
    ],
    ids=["empty", "header", "random", "zeros", "csv", "ffconcat", "playlist"],
)
def test_what_is_no_film(benchlab, tmp_path, content, words) -> None:
    path = tmp_path / "trial.mp4"
    path.write_bytes(content)
    done = benchlab("analyze", path, "--json")
    refused(done, 3, "trial.mp4", *words)
    error = done.json["error"]
    assert error["code"] == 3 and error["file"] == str(path) and set(error) >= {"where", "hint"}
    nothing_left(tmp_path, "trial.mp4")


def test_a_cut_film_says_how_much_is_left_and_can_be_used(benchlab, tmp_path) -> None:
    whole = draw_clip(tmp_path / "whole.mp4", np.linspace(0, 90, 60))
    moved = tmp_path / "cut.mkv"
    subprocess.run([sys.executable, "-c", _REMUX, whole, moved], check=True)
    data = moved.read_bytes()
    moved.write_bytes(data[: len(data) // 2])
    out = tmp_path / "out"
    out.mkdir()
    refused(benchlab("analyze", moved, "--out", out), 3, "decoded", "--allow-partial")
    nothing_left(out)
    done = benchlab("analyze", moved, "--out", out, "--allow-partial", "--json")
    assert done.code == 0, done.err
    assert 10 < done.json["videos"][0]["frames_measured"] < 60
    assert done.json["videos"][0]["warnings"]


_REMUX = """
import sys, av
with av.open(sys.argv[1]) as a, av.open(sys.argv[2], "w") as b:
    source = a.streams.video[0]; target = b.add_stream_from_template(source)
    for packet in a.demux(source):
        if packet.dts is not None:
            packet.stream = target; b.mux(packet)
"""


def test_sound_alone(benchlab, make_clip) -> None:
    import av

    path = make_clip("both.mp4", frames=5, audio=True)
    sound = path.with_name("sound.mp4")
    with av.open(str(path)) as a, av.open(str(sound), "w") as b:
        source = a.streams.audio[0]
        target = b.add_stream_from_template(source)
        for packet in a.demux(source):
            if packet.dts is not None:
                packet.stream = target
                b.mux(packet)
    refused(benchlab("analyze", sound), 3, "audio only")


def test_a_film_under_another_name_works(benchlab, drawn_clip, tmp_path) -> None:
    path = tmp_path / "trial.jpg"
    path.write_bytes(drawn_clip.read_bytes())
    assert benchlab("analyze", path).code == 0


@pytest.mark.parametrize("level", [0, 128, 255])
def test_nothing_to_see_is_not_zero_degrees(benchlab, make_clip, tmp_path, level) -> None:
    clip = make_clip("flat.mp4", draw=lambda i: np.full((64, 96, 3), level, np.uint8))
    refused(benchlab("analyze", clip), 3, "no actuator found in any of 30 frames")
    nothing_left(tmp_path, "flat.mp4")


def test_noise_is_not_an_actuator(benchlab, make_clip) -> None:
    rng = np.random.default_rng(2)
    clip = make_clip("noise.mp4", size=(320, 240), draw=lambda i: rng.integers(0, 256, (240, 320, 3), dtype=np.uint8))
    refused(benchlab("analyze", clip), 3, "no actuator found")


def test_one_frame_gives_its_one_value(benchlab, tmp_path) -> None:
    clip = draw_clip(tmp_path / "one.mp4", np.array([40.0]))
    done = benchlab("analyze", clip, "--json")
    assert done.code == 0
    assert done.json["videos"][0]["max_angle_deg"] == pytest.approx(40, abs=0.5)
    assert "1 frame: no curvature against time" in done.json["videos"][0]["warnings"]


def test_an_actuator_that_leaves_the_view(benchlab, tmp_path) -> None:
    gone = np.full(20, 80.0)
    clip = tmp_path / "leaves.mp4"
    from benchlab.io.video_writer import VideoWriter
    from benchlab.vision.synthetic import Scene, draw_frames

    empty = Scene(**{**vars(SMALL), "base_px": (140.0, 900.0)})
    with VideoWriter(clip, 640, 360, fps=30, crf=16) as writer:
        for scene, angles in ((SMALL, np.linspace(0, 80, 30)), (empty, gone)):
            for planes in draw_frames(scene, np.radians(angles), np.random.default_rng(1)):
                writer.write(planes)
    done = benchlab("analyze", clip, "--json")
    assert done.json["videos"][0]["frames_measured"] == 30
    assert any("20 of 50 frames could not be measured" in w for w in done.json["videos"][0]["warnings"])
    table = pd.read_csv(clip.with_suffix(".csv"))
    assert table["angle_deg"][30:].isna().all() and (table["flag"][30:] == "no markers").all()
    refused(benchlab("analyze", clip, "--max-missing", "0.1", "--overwrite"), 3, "40%", "--max-missing")


def test_a_frozen_camera_is_told(benchlab, tmp_path) -> None:
    clip = draw_clip(tmp_path / "frozen.mp4", np.concatenate([np.linspace(0, 60, 20), np.full(60, 60.0)]), noise_sd=0.0)
    done = benchlab("analyze", clip, "--json")
    assert any("frames identical for" in w for w in done.json["videos"][0]["warnings"])


@pytest.mark.parametrize("value", ["0", "-1", "nan", "inf", "1e9", "abc"])
def test_a_scale_out_of_range(benchlab, drawn_clip, tmp_path, value) -> None:
    done = benchlab("analyze", drawn_clip, "--out", tmp_path, f"--scale-mm-per-px={value}")
    assert done.code == 2 and "scale" in done.err and "Traceback" not in done.err
    nothing_left(tmp_path)


@pytest.mark.parametrize("roi", ["600,300,100,100", "10,10,0,50", "10,10,-5,50", "5,5"])
def test_a_region_outside_the_picture(benchlab, drawn_clip, tmp_path, roi) -> None:
    done = benchlab("analyze", drawn_clip, "--out", tmp_path, f"--roi={roi}")
    assert done.code == 2 and "Traceback" not in done.err
    assert "640x360" in done.err or "LEFT,TOP,WIDTH,HEIGHT" in done.err


@pytest.mark.parametrize(
    "options",
    [
        ("--markers", "2"), ("--length-mm", "0"), ("--length-mm", "nan"), ("--threshold", "300"), ("--colour", "mauve"), ("--fit", "ellipse"),
        ("--ramp", "0:0.35"), ("--ramp", "0:350:2.5"), ("--ramp", "0:nan:2"), ("--sync", "1"), ("--max-missing", "2"), ("--fps", "0"),
        ("--reference-mm", "10"), ("--reference-px", "1,2,3,4"), ("--scale-mm-per-px", "0.2", "--aruco-mm", "20"), ("--stream", "4"),
        ("--reference-mm", "10", "--reference-px", "5,5,5,5"), ("--ramp", "0:0.35:2.5", "--pressure", "x.csv"), ("--nonsense",),
        ("--pressure", "missing.csv"), ("--lens", "missing.json"), ("--sync", "soon", "--ramp", "0:0.35:2.5"), ("--jobs", "0"),
    ],
    ids=" ".join,
)  # fmt: skip
def test_options_that_cannot_be(benchlab, drawn_clip, tmp_path, options) -> None:
    done = benchlab("analyze", drawn_clip, "--out", tmp_path, *options)
    assert done.code == 2, done.err
    assert "Traceback" not in done.err and done.err.strip()
    nothing_left(tmp_path)


@pytest.mark.parametrize(
    "name",
    ["größe µ 试验.mp4", "with space 'quoted' \"twice\".mp4", "new\nline.mp4", "-dash.mp4", "f%03d.mp4", "$x_{$.mp4", "<img src=x onerror=alert(1)>.mp4",
     "\x1b[31mred.mp4", "n" * 200 + ".mp4"],
    ids=["unicode", "quotes", "newline", "dash", "percent", "math", "html", "escape", "long"],
)  # fmt: skip
def test_odd_names_work_and_are_shown_harmlessly(benchlab, drawn_clip, tmp_path, monkeypatch, name) -> None:
    monkeypatch.chdir(tmp_path)
    Path(name).write_bytes(drawn_clip.read_bytes())
    done = benchlab("analyze", "--json", "--", name)
    assert done.code == 0, done.err
    assert done.json["videos"][0]["video"] == name
    assert "\x1b" not in done.err and "new\nline" not in done.err
    assert Path(name).with_suffix(".csv").exists()


def test_inputs_that_would_overwrite_each_other(benchlab, drawn_clip, tmp_path) -> None:
    for folder in ("a", "b"):
        (tmp_path / folder).mkdir()
        (tmp_path / folder / "trial.mp4").write_bytes(drawn_clip.read_bytes())
    films = [tmp_path / "a" / "trial.mp4", tmp_path / "b" / "trial.mp4"]
    refused(benchlab("analyze", *films, "--out", tmp_path), 2, "two inputs", "trial.h5")
    refused(benchlab("analyze", films[0], films[0]), 2, "given twice")


def test_output_folders(benchlab, drawn_clip, tmp_path) -> None:
    refused(benchlab("analyze", drawn_clip, "--out", tmp_path / "no" / "such"), 2, "no such folder")
    (tmp_path / "file").write_text("x")
    assert benchlab("analyze", drawn_clip, "--out", tmp_path / "file").code == 2
    if not ROOT:
        (tmp_path / "shut").mkdir(mode=0o500)
        refused(benchlab("analyze", drawn_clip, "--out", tmp_path / "shut"), 2, "read-only")


def test_a_full_disk_leaves_the_old_result(drawn_clip, tmp_path) -> None:
    film = tmp_path / "trial.mp4"
    film.write_bytes(drawn_clip.read_bytes())
    command = [sys.executable, "-m", "benchlab", "analyze", film]
    subprocess.run(command, check=True, capture_output=True)
    before = {p.name: p.read_bytes() for p in tmp_path.iterdir()}
    limited = "import resource,runpy,sys\nresource.setrlimit(resource.RLIMIT_FSIZE,(2000,2000))\nimport signal\n" \
              "signal.signal(signal.SIGXFSZ,signal.SIG_IGN)\nsys.argv=sys.argv[1:]\nrunpy.run_module('benchlab',run_name='__main__')"  # fmt: skip
    done = subprocess.run(
        [sys.executable, "-c", limited, *command[2:], "--fit", "pratt"], capture_output=True, text=True, check=False
    )
    assert done.returncode == 3 and "could not be written" in done.stderr, done.stderr
    assert {p.name: p.read_bytes() for p in tmp_path.iterdir()} == before


def test_a_reader_that_goes_away_is_no_error(drawn_clip, tmp_path) -> None:
    command = f"{sys.executable} -m benchlab analyze {drawn_clip} --out {tmp_path} --json | true"
    done = subprocess.run(["bash", "-c", command], capture_output=True, text=True, check=False)
    assert "Traceback" not in done.stderr and "BrokenPipe" not in done.stderr


@pytest.mark.parametrize(
    "environment",
    [{"PYTHONIOENCODING": "cp1252"}, {"LANG": "de_DE.UTF-8", "LC_ALL": "de_DE.UTF-8"}, {"NO_COLOR": "1"}, {"TERM": "dumb"}, {"HOME": "/proc/1/nowhere"}],
    ids=["cp1252", "german", "no-color", "dumb", "no-home"],
)  # fmt: skip
def test_odd_surroundings(drawn_clip, tmp_path, environment) -> None:
    path = tmp_path / "試験.mp4"
    path.write_bytes(drawn_clip.read_bytes())
    done = subprocess.run([sys.executable, "-m", "benchlab", "analyze", path, "--json"], capture_output=True, check=False,
                          env={**os.environ, **environment})  # fmt: skip
    assert done.returncode == 0, done.stderr
    assert b"\x1b[" not in done.stderr and b"Traceback" not in done.stderr
    assert (
        "," in path.with_suffix(".csv").read_text().splitlines()[1]
        and pd.read_csv(path.with_suffix(".csv"))["angle_deg"].max() > 99
    )


def test_a_bug_says_that_it_is_one(benchlab, drawn_clip, tmp_path, monkeypatch) -> None:
    monkeypatch.setattr("benchlab.workflows.analyze.measure", lambda *_: 1 / 0)
    done = benchlab("analyze", drawn_clip, "--out", tmp_path, "--json")
    refused(done, 1, "bug in benchlab", "--debug")
    assert done.json["error"]["code"] == 1
    nothing_left(tmp_path)
