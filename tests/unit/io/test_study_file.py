"""What a study file comes to: paths, settings of each recording, shells, sets."""

import re
from pathlib import Path

import pytest
from pydantic import BaseModel

from benchlab.actuator import ShellDesign
from benchlab.io.study_file import Study, read_study
from benchlab.io.study_schema import StudyDocument
from benchlab.io.study_values import StudySet
from tests.unit.io.studies import GOOD, write_study

FORCE = """
    force:
      files: [f/a1.csv, {file: f/a2.csv, actuator: second, cycles: 3, pressure: log.csv, left_out: slipped}]
      steps_MPa: [0.035, 0.07]
      cycles: 5
"""


def settings(study: Study, design: int = 0, sample: int = 0, recording: int = 0) -> dict[str, object]:
    return study.designs[design].samples[sample].recordings[recording].analysis


@pytest.mark.parametrize(
    "text",
    [GOOD, GOOD.replace("\n", "\r\n"), "\ufeff" + GOOD, GOOD.encode("utf-16"), GOOD.replace("0.35\n", "3.5e-1\n")],
    ids=["plain", "CRLF", "BOM", "UTF-16", "exponent"],
)
def test_reads_a_study(tmp_path: Path, text: str | bytes) -> None:
    study = read_study(write_study(tmp_path, text))
    assert (study.title, study.pressure_MPa, study.hold_tolerance_MPa) == ("A study", 0.35, 0.0035)
    assert [design.name for design in study.designs] == ["tw3_slw5", "tw3_slw10"]
    assert study.designs[0].shell == ShellDesign(5, 3) and study.designs[1].shell == ShellDesign(10, 3)
    second = study.designs[0].samples[1]
    assert [(r.file, r.path, r.kind) for r in second.recordings] == [
        ("a2.mp4", tmp_path / "a2.mp4", "video"),
        ("a2b.mp4", tmp_path / "a2b.mp4", "video"),
    ]
    assert settings(study) == {"ramp": "0:0.35:2.5", "length_mm": 180.0}


def test_words_that_other_yaml_turns_into_numbers_stay_words(tmp_path: Path) -> None:
    study = read_study(write_study(tmp_path, GOOD.replace("A study", "1:30").replace("s1: b1.mp4", "no: off")))
    (sample,) = study.designs[1].samples
    assert (study.title, sample.name, sample.recordings[0].file) == ("1:30", "no", "off")


def test_the_set_of_all_designs_comes_last_unless_one_is_it(tmp_path: Path) -> None:
    both = ("tw3_slw5", "tw3_slw10")
    assert read_study(write_study(tmp_path)).sets == (StudySet("slw", "slw", both),)
    text = GOOD.replace("slw: [tw3_slw5, tw3_slw10]", "one: {designs: [tw3_slw5], title: One, x: slw_mm}")
    assert read_study(write_study(tmp_path, text)).sets == (
        StudySet("one", "One", ("tw3_slw5",), "slw_mm"),
        StudySet("all", "All designs", both),
    )


def test_what_is_nearer_to_a_recording_wins(tmp_path: Path) -> None:
    text = GOOD.replace('"0:0.35:2.5"}', '"0:0.35:2.5", markers: 10, reference_mm: 50, lens: lens.json}')
    text = text.replace(
        "      s1: b1.mp4",
        "      s1:\n        analysis: {markers: null, pressure: logs/p.csv, reference_px: [1, 2, 3, 4]}\n"
        "        recordings: [b1.mp4, {file: b2.mp4, analysis: {ramp: '0:0.1:1', marker_span_mm: 170, length_mm: 90}}]",
    ).replace("    shell: tw3_slw10", "    shell: {tw_mm: 3, slw_mm: 10, length_mm: 120}\n    analysis: {fast: true}")
    study = read_study(write_study(tmp_path, text))
    lens = str(tmp_path / "lens.json")
    shared = {"ramp": "0:0.35:2.5", "markers": 10, "reference_mm": 50, "lens": lens, "length_mm": 180}
    assert settings(study) == shared
    assert settings(study, 1) == {
        "reference_mm": 50, "reference_px": [1, 2, 3, 4], "lens": lens, "pressure": str(tmp_path / "logs/p.csv"),
        "length_mm": 120, "fast": True,
    }  # fmt: skip
    assert settings(study, 1, 0, 1) == {
        "ramp": "0:0.1:1",
        "marker_span_mm": 170,
        "lens": lens,
        "length_mm": 90,
        "fast": True,
    }


def test_a_table_may_serve_several_samples(tmp_path: Path) -> None:
    text = GOOD.replace("a1.mp4", "all.csv").replace("b1.mp4", "all.csv")
    study = read_study(write_study(tmp_path, text))
    assert study.designs[0].samples[0].recordings[0].kind == "table"


def test_left_out_notes_and_simulated(tmp_path: Path) -> None:
    text = GOOD.replace(
        "s1: b1.mp4",
        "s1: {recordings: {file: b1.h5, left_out: blurred}, left_out: leaked, notes: cut by hand}\n"
        "    simulated: {angle_deg: 130.2, source: Table I}\n    notes: the paper's",
    ).replace("    shell: {", "    simulated: sim/r.h5\n    shell: {")
    first, second = read_study(write_study(tmp_path, text)).designs
    (sample,) = second.samples
    assert (sample.left_out, sample.notes, second.notes) == ("leaked", "cut by hand", "the paper's")
    assert (sample.recordings[0].left_out, sample.recordings[0].kind) == ("blurred", "run")
    assert first.simulated is not None and second.simulated is not None
    assert (first.simulated.path, first.simulated.file) == (tmp_path / "sim/r.h5", "sim/r.h5")
    assert (second.simulated.path, second.simulated.angle_deg, second.simulated.source) == (None, 130.2, "Table I")


def test_force_files_take_what_their_list_says_unless_they_say_it(tmp_path: Path) -> None:
    study = read_study(write_study(tmp_path, GOOD.replace("      s1: b1.mp4", "      s1: b1.mp4" + FORCE)))
    first, second = study.designs[1].force
    assert (first.file, first.path, first.actuator, first.left_out) == ("f/a1.csv", tmp_path / "f/a1.csv", "a1", "")
    assert first.settings == {"steps_MPa": [0.035, 0.07], "cycles": 5}
    assert (second.actuator, second.left_out) == ("second", "slipped")
    assert second.settings == {"steps_MPa": [0.035, 0.07], "cycles": 3, "pressure": tmp_path / "log.csv"}


def test_a_shell_may_be_a_design_file(tmp_path: Path) -> None:
    (tmp_path / "mine.yaml").write_text("strip_width_mm: 7\nwindow_width_mm: 4\n")
    text = GOOD.replace("shell: tw3_slw10", "shell: mine.yaml")
    assert read_study(write_study(tmp_path, text)).designs[1].shell == ShellDesign(7, 4)


def keys_of(model: type[BaseModel]) -> set[str]:
    schema = model.model_json_schema()
    return {name for part in (schema, *schema["$defs"].values()) for name in part.get("properties", {})}


def test_the_guide_explains_every_key_and_its_example_is_read(tmp_path: Path) -> None:
    guide = (Path(__file__).resolve().parents[3] / "docs" / "studies.md").read_text(encoding="utf-8")
    explained = set(re.findall(r"`([a-zA-Z_]+):?`", guide.partition("### The study")[2]))
    assert keys_of(StudyDocument) <= explained, keys_of(StudyDocument) - explained
    (example,) = re.findall(r"```yaml\n(.*?)```", guide, re.DOTALL)
    study = read_study(write_study(tmp_path, example))
    glued, welded = study.designs
    assert [len(sample.recordings) for sample in glued.samples] == [1, 2, 2, 1]
    assert glued.samples[2].recordings[0].analysis == {
        "pressure": str(tmp_path / "logs/bench.csv"), "sync": "onset", "marker_span_mm": 180, "length_mm": 180,
        "markers": 9, "roi_px": [100, 50, 1200, 800],
    }  # fmt: skip
    assert welded.shell == ShellDesign(10, 3) and welded.simulated is not None and welded.simulated.angle_deg == 130.2
    assert [r.kind for s in welded.samples for r in s.recordings] == ["run", "table", "table"]
    assert [(f.actuator, f.settings.get("columns")) for f in glued.force] == [
        ("tw3_slw5_a1", None), ("second", "time_s,extension_mm,force_N"),
    ]  # fmt: skip
    assert study.sets[0].x == "slw_mm" and len(study.sets) == 1
