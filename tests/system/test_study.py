"""`benchlab study new` and `benchlab study check`, as they are called."""

from __future__ import annotations

import os
import shutil
from collections.abc import Callable
from pathlib import Path

import pytest

from benchlab.io.study_file import read_study
from benchlab.io.study_values import StudySet
from tests.conftest import write_clip

SAMPLE = Path(__file__).resolve().parents[2] / "sample_data"


def test_new_makes_the_study_of_the_sample_data_but_for_its_words(tmp_path: Path, benchlab: Callable) -> None:
    shutil.copytree(SAMPLE, tmp_path / "sample_data", ignore=shutil.ignore_patterns("*.overlay.mp4"))
    folder = tmp_path / "sample_data"
    (folder / "study.yaml").unlink()
    done = benchlab("study", "new", folder, "--ramp", "0:0.35:2.5")
    assert done.code == 0 and done.out == ""
    made, given = read_study(folder / "study.yaml"), read_study(SAMPLE / "study.yaml")
    assert made.title == "sample_data" and made.pressure_MPa == 0.35
    assert [(d.name, d.shell, [(s.name, [r.file for r in s.recordings]) for s in d.samples]) for d in made.designs] == [
        (d.name, d.shell, [(s.name, [r.file for r in s.recordings]) for s in d.samples]) for d in given.designs
    ]
    assert [d.simulated and d.simulated.file for d in made.designs] == ["simulated.h5"] * 5
    assert [[f.file for f in d.force] for d in made.designs] == [[f.file for f in d.force] for d in given.designs]
    assert set(made.sets) == set(given.sets)
    text = (folder / "study.yaml").read_text()
    for word in ("proposed", "# Not in this study:", "truth.csv", "tensile_drawn.csv", "steps_MPa"):
        assert word in text
    for word in (
        "25 recordings named {design}_s{sample}",
        "proposed set slw",
        "not in it: truth.csv",
        "3 force files",
        "wrote",
    ):
        assert word in done.err
    assert "truth_series.csv" in done.err and "README" not in done.err
    assert text.count("ramp:") == 1 and len(text.splitlines()) < 80


def test_new_gives_the_same_file_twice_and_replaces_none_unasked(bench: Path, benchlab: Callable) -> None:
    assert benchlab("study", "new", bench).code == 0
    first = (bench / "study.yaml").read_bytes()
    assert b"pressure is not known" not in first  # tables tell their own
    done = benchlab("study", "new", bench)
    assert done.code == 2 and "--overwrite" in done.err
    assert benchlab("study", "new", bench, "--overwrite").code == 0
    assert (bench / "study.yaml").read_bytes() == first
    assert [p.name for p in bench.iterdir() if p.name.startswith(".")] == []
    assert benchlab("study", "new", bench, "--out", bench / "none" / "of" / "s.yaml").code == 2


def test_new_says_what_it_does_not_know(bench: Path, benchlab: Callable) -> None:
    write_clip(bench / "tw3_slw10_s3.mp4", frames=3)
    done = benchlab("study", "new", bench, "--title", "Two: designs", "--pressure-MPa", 0.2, "--json")
    assert done.json["title"] == "Two: designs" and done.json["pressure_known"] is False
    assert "the pressure is not known" in done.err
    assert done.json["designs"][0]["shell"]["strip_width_mm"] == 5
    assert done.json["designs"][0]["samples"] == {"s1": ["tw3_slw5_s1.csv"], "s2": ["tw3_slw5_s2.csv"]}
    study = read_study(bench / "study.yaml")
    assert (study.title, study.pressure_MPa) == ("Two: designs", 0.2)
    assert study.sets == (StudySet("slw", "Strip width", ("tw3_slw5", "tw3_slw10"), "slw_mm"),)
    assert "# The pressure is not known yet" in (bench / "study.yaml").read_text()


def test_new_reads_names_by_a_pattern_of_the_user(tmp_path: Path, benchlab: Callable) -> None:
    for name in ("day 1/glove-1_run2", "day 1/glove-1_run10", "day 2/glove-B_run1", "day 2/mitten-2_run1", "day 2/odd"):
        path = tmp_path / "bench" / f"{name}.csv"
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text("cycle,angle_deg\n1,50\n2,51\n")
    log = tmp_path / "log.csv"
    log.write_text("time_s,pressure_MPa\n0,0\n1,0.3\n")
    done = benchlab(
        "study",
        "new",
        tmp_path / "bench",
        "--pattern",
        "{anything}/{design}-{sample}_run{cycle}",
        "--pressure",
        log,
        "--json",
    )
    assert done.code == 0
    glove, mitten = read_study(tmp_path / "bench/study.yaml").designs
    assert [[r.file for r in s.recordings] for s in glove.samples] == [
        ["day 2/glove-B_run1.csv"],
        ["day 1/glove-1_run2.csv", "day 1/glove-1_run10.csv"],
    ]
    assert [s.name for s in glove.samples] == ["B", "s1"]
    assert (glove.shell, mitten.shell) == (None, None)
    assert done.json["unused"] == [
        {"file": "day 2/odd.csv", "why": "its name does not fit {anything}/{design}-{sample}_run{cycle}"}
    ]
    assert "s1 has 2 recordings: day 1/glove-1_run2.csv, day 1/glove-1_run10.csv" in done.err
    assert "pressure: ../log.csv" in (tmp_path / "bench/study.yaml").read_text()


@pytest.mark.parametrize(
    ("options", "code", "words"),
    [
        (["--pattern", "{design}"], 2, "{sample} is not in it"),
        (["--pattern", "{design}_{sample}_{design}"], 2, "{design} is twice in it"),
        (["--pattern", "{design}_{smaple}"], 2, "{smaple} is not known"),
        (["--pattern", "{design}/run{sample}"], 3, "no recording is named as"),
        (["--ramp", "0:0.35"], 2, "ramp"),
        (["--ramp", "0:0.2:2", "--pressure-MPa", "0.3"], 2, "--ramp ends at 0.2"),
        (["--pressure-MPa", "0"], 2, "--pressure-MPa is 0"),
        (["--pressure-MPa", "nan"], 2, "not a finite number"),
        (["--pressure", "none.csv"], 2, "no such file"),
        (["--ramp", "0:0.35:2", "--pressure", "none.csv"], 2, "both tell the pressure"),
    ],
)
def test_new_refuses_what_cannot_be_meant_and_writes_nothing(
    bench: Path, benchlab: Callable, options: list[str], code: int, words: str
) -> None:
    done = benchlab("study", "new", bench, *options)
    assert done.code == code and words in done.err and "Traceback" not in done.err
    assert not (bench / "study.yaml").exists()


def test_new_refuses_folders_that_are_none_or_hold_none(bench: Path, tmp_path: Path, benchlab: Callable) -> None:
    (tmp_path / "empty").mkdir()
    assert benchlab("study", "new", tmp_path / "none").code == 2
    assert benchlab("study", "new", bench / "tw3_slw5_s1.csv").code == 2
    done = benchlab("study", "new", tmp_path / "empty", "--json")
    assert done.code == 3 and done.json["error"]["what"] == "holds no recording"
    for name in ("film", "other", "third"):
        (tmp_path / "empty" / f"{name}.csv").write_text("cycle,angle_deg\n1,5\n")
    done = benchlab("study", "new", tmp_path / "empty")
    assert done.code == 3 and "'film', 'other', 'third'" in done.err and "--pattern" in done.err
    (bench / "TW3_slw5_s3.csv").write_text("cycle,angle_deg\n1,5\n")
    done = benchlab("study", "new", bench)
    assert done.code == 3 and "same folder as" in done.err and not (bench / "study.yaml").exists()


def test_new_takes_each_recording_once_and_results_not_at_all(bench: Path, benchlab: Callable) -> None:
    write_clip(bench / "tw3_slw5_s1.mp4", frames=3)
    (bench / "tw3_slw10_s3").mkdir()
    for index in range(2):
        shutil.copy(SAMPLE.parent / "docs/images/see.png", bench / "tw3_slw10_s3" / f"{index}.png")
    (bench / "tw3_slw10_s2.h5").write_bytes(b"\x89HDF\r\n\x1a\n")
    (bench / ".hidden_s1.csv").write_text("cycle,angle_deg\n1,5\n")
    odd = bench / os.fsdecode(b"tw3_slw5_\xff_s9.csv")
    odd.write_text("cycle,angle_deg\n1,5\n")
    done = benchlab("study", "new", bench, "--json")
    assert done.code == 0
    five, ten = done.json["designs"]
    assert five["samples"]["s1"] == ["tw3_slw5_s1.mp4"] and ten["samples"]["s3"] == ["tw3_slw10_s3"]
    why = {each["file"]: each["why"] for each in done.json["unused"]}
    assert "taken for its analysis" in why["tw3_slw5_s1.csv"]
    assert "damaged" in why["tw3_slw10_s2.h5"] or "not" in why["tw3_slw10_s2.h5"]
    assert "its name is not text" in why.values() and len(why) <= 4


def test_check_of_the_sample_study_is_complete(benchlab: Callable) -> None:
    done = benchlab("study", "check", SAMPLE / "study.yaml", "--json")
    assert done.code == 0 and done.json["missing"] == []
    assert [design["n"] for design in done.json["designs"]] == [5] * 5
    assert "complete" in done.err and "tw3_slw10   3 × 10" in done.err
    assert benchlab("study", "check", SAMPLE).code == 0


def test_check_lists_all_that_is_missing_at_once(bench: Path, benchlab: Callable) -> None:
    shutil.copy(bench / "tw3_slw5_s1.csv", bench / "copy.csv")
    write_clip(bench / "film.mp4", frames=3)
    write_clip(bench / "low.mp4", frames=4)
    os.mkfifo(bench / "pipe.mp4")
    (bench / "study.yaml").write_text("""\
title: T
pressure_MPa: 0.35
designs:
  a:
    shell: tw3_slw5
    simulated: none.h5
    samples: {s1: tw3_slw5_s1.csv, s2: copy.csv, s3: film.mp4, s4: pipe.mp4, s5: {recordings: none.mp4, left_out: leaked}}
    force: [none.csv]
  b:
    samples: {s1: tw3_slw10_s1.csv, s2: [], s3: {recordings: low.mp4, analysis: {ramp: '0:0.1:1'}}}
  c:
    samples: {s1: {recordings: [tw3_slw10_s2.csv, gone.mp4]}}
sets:
  one: [a, b]
""")
    done = benchlab("study", "check", bench / "study.yaml", "--json")
    assert done.code == 4
    missing = {(each["what"], each["why"].split(":")[0].split(";")[0]) for each in done.json["missing"]}
    for what, why in [
        ("a s3, film.mp4", "its pressure is not known"),
        ("a s4, pipe.mp4", "not a regular file"),
        ("a", "no simulated angle"),
        ("a none, none.csv", "no such file"),
        ("b s2", "the sample has no recording"),
        ("b s3, low.mp4", "its pressure reaches 0.1 MPa at most, 0.35 MPa are wanted"),
        ("b", "1 samples that count, a comparison takes 2 at least"),
        ("c s1, gone.mp4", "no such file"),
        ("c", "1 samples that count, a comparison takes 2 at least"),
        ("a s2, copy.csv", "has the same content as tw3_slw5_s1.csv of a s1"),
    ]:
        assert (what, why) in missing, (what, why)
    assert done.json["left_out"] == [{"what": "a s5", "why": "leaked"}]
    assert [design["n"] for design in done.json["designs"]] == [2, 1, 1]
    notes = " ".join(each["why"] for each in done.json["notes"])
    assert "in no set of its own" in notes and "unlike numbers of samples (a 2, b 1, c 1)" in notes
    assert "s1 s2 s3! s4! s5-" in done.err and f"{len(done.json['missing'])} things are missing" in done.err


def test_check_of_a_file_that_is_wrong_or_not_there(tmp_path: Path, benchlab: Callable) -> None:
    (tmp_path / "s.yaml").write_text("title: T\npressure_MPa: -1\ndesign: {}\n")
    done = benchlab("study", "check", tmp_path / "s.yaml", "--json")
    assert done.code == 3 and "line 2" in done.err and done.json["error"]["code"] == 3
    assert benchlab("study", "check", tmp_path / "none.yaml").code == 2


@pytest.mark.parametrize("word", ["new", "check"])
def test_help_teaches(word: str, benchlab: Callable) -> None:
    done = benchlab("study", word, "--help")
    assert done.code == 0 and "Example" in done.out and f"benchlab study {word} " in done.out


def test_new_lists_many_files_shortly(bench: Path, benchlab: Callable) -> None:
    for index in range(30):
        (bench / f"log{index}.csv").write_text("time_s,pressure_MPa\n0,0\n")
    done = benchlab("study", "new", bench)
    assert done.err.count("not in it: ") == 20 and "and 10 more not in it" in done.err
    assert (bench / "study.yaml").read_text().count("#   log") == 30


def test_new_finds_run_files_simulations_and_force_files_by_content(
    bench: Path, drawn_clip: Path, benchlab: Callable, tmp_path: Path
) -> None:
    assert benchlab("analyze", drawn_clip, "--ramp", "0:0.35:1", "--out", tmp_path / "runs").code == 0
    for suffix in ("h5", "csv", "png"):
        shutil.copy(tmp_path / f"runs/trial.{suffix}", bench / f"tw3_slw5_s3.{suffix}")
    done = benchlab("simulate", "--tw-mm", 3, "--slw-mm", 5, "--pressure-MPa", "0.1,0.35", "--out", bench / "sim")
    assert done.code == 0
    (bench / "force").mkdir()
    for name in ("tw3_slw5_a1", "tw3_slw10_s1", "tw9_slw5_a1", "odd"):
        shutil.copy(SAMPLE / "force/tw3_slw10_a1.csv", bench / "force" / f"{name}.csv")
    (bench / "out/recordings/tw3_slw5/s9").mkdir(parents=True)
    for name in ("report.json", "report.html"):
        (bench / "out" / name).write_text("{}")
    (bench / "out/recordings/tw3_slw5/s9/tw3_slw5_s9.csv").write_text("cycle,angle_deg\n1,5\n")
    found = benchlab("study", "new", bench, "--json").json
    five, ten = found["designs"]
    assert five["samples"]["s3"] == ["tw3_slw5_s3.h5"] and found["pressure_known"]
    assert five["simulated"].startswith("sim/") and five["simulated"].endswith(".h5") and ten["simulated"] is None
    assert (five["force"], ten["force"]) == (["force/tw3_slw5_a1.csv"], ["force/tw3_slw10_s1.csv"])
    why = {each["file"]: each["why"] for each in found["unused"]}
    assert why["out/recordings"] == "written by a report of benchlab"
    assert "taken for its table" in why["tw3_slw5_s3.csv"]
    assert why["force/tw9_slw5_a1.csv"] == "a force file of tw9_slw5, of which there is no recording"
    assert "not named as a force file" in why["force/odd.csv"]

    text = (bench / "study.yaml").read_text()
    (bench / "study.yaml").write_text(
        text.replace("    shell: {tw_mm: 3, slw_mm: 5}", "    shell: {tw_mm: 3, slw_mm: 6}")
    )
    missing = benchlab("study", "check", bench, "--json").json["missing"]
    assert any("was simulated with slw_mm 5, the design in the study has 6" in each["why"] for each in missing)
    assert any("no pressure of its cycles is known" in each["why"] for each in missing)
