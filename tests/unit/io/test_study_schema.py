"""What a study file may say: each thing that is wrong with its line, its key and the remedy."""

import time
from pathlib import Path

import pytest

from benchlab.errors import InputError, UsageError
from benchlab.io.analysis_ranges import RANGES
from benchlab.io.study_file import read_study
from tests.pace import slowness
from tests.unit.io.studies import GOOD, write_study

RAMP = 'ramp: "0:0.35:2.5"'
SHELL = "{tw_mm: 3, slw_mm: 5}"
SET = "slw: [tw3_slw5, tw3_slw10]"
LAST = "s1: b1.mp4"


@pytest.mark.parametrize(
    ("old", "new", "words"),
    [
        # what YAML itself may hold
        ("title: A study", "title: !!python/object/apply:os.system [ls]", ["line 1", "not YAML", "tag"]),
        (LAST, "s1: !include ../../etc/passwd", ["line 13", "not YAML", "!include"]),
        ("title: A study", "title: &a [*a, *a]", ["line 1", "anchors and aliases"]),
        (SHELL, "{<<: {tw_mm: 3}, slw_mm: 5}", ["line 6", "merge keys"]),
        (LAST, "s1: " + "[" * 5000, ["line 13", "nested deeper than 32"]),
        ("pressure_MPa: 0.35", "pressure_MPa: 0.35\npressure_MPa: 0.3", ["line 3", "duplicate", "already on line 2"]),
        ("      s2:", "      s1:", ["line 9", "duplicate key designs.tw3_slw5.samples.s1", "already on line 8"]),
        ("    samples:\n      s1: b1", "\tsamples:\n      s1: b1", ["line 12", "not YAML"]),
        (LAST, "1: b1.mp4", ["line 13", "key '1' is not text", "quote it"]),
        # numbers as typed
        ("0.35\n", ".nan\n", ["line 2", "pressure_MPa is nan", "finite"]),
        ("0.35\n", ".inf\n", ["line 2", "finite"]),
        ("0.35\n", "900\n", ["line 2", "pressure_MPa is 900", "10 or less"]),
        ("0.35\n", "-1\n", ["line 2", "pressure_MPa is -1", "more than 0"]),
        ("0.35\n", "no\n", ["line 2", 'pressure_MPa is "no"', "number"]),
        ("0.35\n", "1:30\n", ["line 2", 'pressure_MPa is "1:30"', "number"]),
        ("0.35\n", "'0.35'\n", ["line 2", 'pressure_MPa is "0.35"', "number"]),
        ("title: A study", "title: 010", ["line 1", "title is 10", "text"]),
        # keys
        ("title: A study\n", "", ["title is missing", "add `title:`"]),
        (LAST, LAST + "\n    sample: {s1: c.mp4}", ["line 14", "unknown key designs.tw3_slw10.sample", "did you mean samples"]),
        (RAMP, "markes: 7", ["line 3", "unknown key analysis.markes", "did you mean markers"]),
        # settings of the analysis
        (RAMP, "markers: 2", ["line 3", "analysis.markers is 2", "from 3 to 60"]),
        (RAMP, "length_mm: -3", ["line 3", "analysis.length_mm is -3"]),
        (RAMP, "colour: pink", ["line 3", "pink", "give one of red, orange"]),
        (RAMP, "fit: round", ["line 3", "round", "'taubin'"]),
        (RAMP, "ramp: 0:0.35:-1", ["line 3", "analysis.ramp", "pressure ramp of -1 s"]),
        (RAMP, "ramp: 0:350:2.5", ["line 3", "350 kPa would be 0.35"]),
        (RAMP, RAMP + ", pressure: log.csv", ["line 3", "pressure and ramp both tell the pressure"]),
        (RAMP, "aruco_mm: 3, marker_span_mm: 180", ["line 3", "both tell the scale"]),
        (RAMP, "sync: soon", ["line 3", 'analysis.sync is "soon"']),
        (LAST, "s1: [{file: b1.h5, analysis: {markers: 7}}]", ["line 13", "b1.h5", "read as it is"]),
        # designs
        (SHELL, "{tw_mm: 3, slw_mm: 50}", ["line 6", "designs.tw3_slw5.shell", "leaves no window"]),
        (SHELL, "{tw_mm: 3}", ["line 6", "give at least tw_mm and slw_mm"]),
        (SHELL, "{named: tw3_slw5, tw_mm: 3}", ["line 6", "either a name or dimensions"]),
        ("shell: tw3_slw10", "shell: tw3_slw100", ["designs.tw3_slw10.shell", "tw3_slw100", "leaves no window"]),
        ("shell: tw3_slw10", "shell: none.yaml", ["designs.tw3_slw10.shell", "none.yaml", "no such design file"]),
        ("  tw3_slw10:\n", "  TW3_slw5:\n", ["line 10", "same folder as 'tw3_slw5'"]),
        ("      s2:", "      S1:", ["line 9", "samples.S1", "same folder as 's1'"]),
        ("      s2:", "      caf\u00e9: c.mp4\n      cafe\u0301:", ["line 10", "same folder as 'caf\u00e9'"]),
        ("      s2:", "      ../s2:", ["line 9", "without / "]),
        ("      s2:", "      .s2:", ["line 9", "no dot at its ends"]),
        ("      s2:", f"      {'x' * 81}:", ["line 9", "1 to 80 characters"]),
        # samples and recordings
        (LAST, "s1:", ["line 13", "samples.s1 is null", "give recordings"]),
        (LAST, "s1: 5", ["line 13", "samples.s1 is 5", "give recordings"]),
        (LAST, "s1: ''", ["line 13", "at least 1 letter"]),
        (LAST, "s1: {recordings: b1.mp4, left_out: ' '}", ["line 13", "left_out", "say why"]),
        (LAST, "s1: {recordings: b1.mp4, left_out: true}", ["line 13", "left_out is true"]),
        ("b1.mp4", "a1.mp4", ["line 13", "a recording of tw3_slw5 s1 already"]),
        ("a2b.mp4", "x/.././a2.mp4", ["line 9", "samples.s2[1]", "a recording of tw3_slw5 s2 already"]),
        ("[a2.mp4, a2b.mp4]", "[a2.csv, a2.csv]", ["line 9", "a recording of tw3_slw5 s2 already"]),
        # sets
        (SET, "slw: [tw3_slw5, tw3_slw1]", ["line 15", "sets.slw[1]", "did you mean tw3_slw10?"]),
        (SET, "slw: [tw3_slw5, tw3_slw5]", ["line 15", "sets.slw[1]", "stands twice in this set"]),
        (SET, "slw: []", ["line 15", "sets.slw"]),
        (SET, "all: [tw3_slw5]", ["line 15", "every study has this set"]),
        (SET, "slw: {designs: [tw3_slw5], x: slw}", ["line 15", "sets.slw.x", "'slw_mm'"]),
        # simulated and force
        (LAST, LAST + "\n    simulated: {angle_deg: 3}", ["line 14", "say where the angle is from"]),
        (LAST, LAST + "\n    simulated: {angle_deg: 3, source: a, file: b.h5}", ["line 14", "either a file or angle_deg"]),
        (LAST, LAST + "\n    force: [a.csv, x/a.csv]", ["line 14", '"a"', "an actuator of tw3_slw10 already"]),
        (LAST, LAST + "\n    force: {files: [a.csv], steps_MPa: [0.1, 50]}", ["line 14", "steps_MPa[1] is 50"]),
        (LAST, LAST + "\n    force: {files: [a.csv], cycles: 0}", ["line 14", "force.cycles is 0"]),
    ],
)  # fmt: skip
def test_refuses_with_line_key_and_remedy(tmp_path: Path, old: str, new: str, words: list[str]) -> None:
    assert old in GOOD
    with pytest.raises(InputError) as caught:
        read_study(write_study(tmp_path, GOOD.replace(old, new)))
    said = str(caught.value)
    assert "study.yaml" in said and "\n" not in said
    for word in words:
        assert word in said


def test_says_all_that_is_wrong_at_once_each_with_its_line(tmp_path: Path) -> None:
    text = GOOD.replace("0.35\n", "-1\n").replace(RAMP, "markers: 2, colour: pink").replace(SHELL, "{tw_mm: 3}")
    with pytest.raises(InputError, match="4 things are wrong") as caught:
        read_study(write_study(tmp_path, text))
    places = (
        "line 2: pressure_MPa",
        "line 3: analysis.markers",
        "line 3: analysis.colour",
        "line 6: designs.tw3_slw5.shell",
    )
    for words in places:
        assert words in str(caught.value)
    text = GOOD.replace(SET, "slw: [a, b]").replace("b1.mp4", "a1.mp4").replace("      s2:", "      S1:")
    with pytest.raises(InputError, match="4 things are wrong"):
        read_study(write_study(tmp_path, text))


def test_a_bomb_of_aliases_is_refused_at_once(tmp_path: Path) -> None:
    levels = "".join(f"{b}: &{b} [{', '.join(['*' + a] * 9)}]\n" for a, b in zip("abcdefgh", "bcdefghi"))
    started = time.process_time()
    with pytest.raises(InputError, match="line 1: anchors and aliases"):
        read_study(write_study(tmp_path, "a: &a [x]\n" + levels + GOOD))
    assert time.process_time() - started < slowness()


@pytest.mark.parametrize("name", RANGES)
def test_the_ranges_are_those_of_the_analysis(tmp_path: Path, name: str) -> None:
    low, high = RANGES[name]
    for value, fits in ((low, True), (high, True), (low - 1, False), (high * 2 + 1, False)):
        text = int(value) if float(value).is_integer() else value
        path = write_study(tmp_path, GOOD.replace(RAMP, f"{name}: {text}"))
        if fits:
            assert read_study(path).designs[0].samples[0].recordings[0].analysis[name] == value
        else:
            with pytest.raises(InputError, match=f"analysis.{name}"):
                read_study(path)


def test_a_missing_file_is_usage(tmp_path: Path) -> None:
    with pytest.raises(UsageError, match="no such file"):
        read_study(tmp_path / "none.yaml")
    with pytest.raises(UsageError, match=r"study\.yaml: no such file"):
        read_study(tmp_path)
