"""Tables, recordings and studies as measured runs."""

import shutil
from pathlib import Path

import numpy as np
import pytest

from benchlab.discrepancy.measured import Measured, Summary
from benchlab.errors import BenchlabError, InputError, UsageError
from benchlab.io.drive_file import write_drive_file
from benchlab.io.journal import read_journal
from benchlab.io.run_file import write_run_file
from benchlab.workflows.explain_read import read_explained
from tests.unit.io.journals import header_of, samples_of, write_journal
from tests.unit.io.test_run_file import ABOUT, bend

TABLE = "time_s,pressure_MPa,angle_deg\n0,0,0\n1,0.1,20\n2,0.2,45\n"


def film(folder: Path, name: str, title: str = "") -> Path:
    path = folder / f"{name}.h5"
    write_run_file(path, bend(), **{**ABOUT, "recording": {"title": title}})
    return path


def drive(folder: Path, name: str, **options: object) -> Path:
    journal = read_journal(write_journal(folder / f"{name}.journal", **options))  # type: ignore[arg-type]
    write_drive_file(folder / f"{name}.h5", journal)
    return folder / f"{name}.h5"


def table(folder: Path, name: str, text: str = TABLE) -> Path:
    path = folder / name
    path.write_text(text)
    return path


def names(found: Measured | Summary) -> list[tuple[str, str, str]]:
    assert isinstance(found, Measured)
    return [(run.design, run.sample, run.run) for run in found.runs]


def test_recordings_are_named_by_their_files(tmp_path: Path) -> None:
    paths = [film(tmp_path, "tw3_slw10_s2"), film(tmp_path, "tw3_slw10_s1"), drive(tmp_path, "tw9_slw10_s1")]
    found = read_explained(paths)
    assert names(found) == [
        ("tw3_slw10", "s1", "tw3_slw10_s1"),
        ("tw3_slw10", "s2", "tw3_slw10_s2"),
        ("tw9_slw10", "s1", "tw9_slw10_s1"),
    ]
    assert isinstance(found, Measured) and list(found.runs[2].values) == ["flex_V"] and not found.simulated
    assert any(words.startswith("tw3_slw10_s1.h5: ") and "without a pressure" in words for words in found.warnings)


def test_a_pattern_names_tables_too(tmp_path: Path) -> None:
    paths = [film(tmp_path, "day1-glove-B"), table(tmp_path, "day2-glove-A.csv")]
    found = read_explained(paths, pattern="{anything}-{design}-{sample}")
    assert names(found) == [("glove", "A", "day2-glove-A"), ("glove", "B", "day1-glove-B")]
    with pytest.raises(InputError, match=r"its name does not fit '\{design\}_s\{sample\}'"):
        read_explained(paths, pattern="{design}_s{sample}")
    with pytest.raises(InputError, match="no common pattern fits"):
        read_explained([film(tmp_path, "first")])


def test_a_twin_is_simulated(tmp_path: Path) -> None:
    assert read_explained([drive(tmp_path, "a_s1", header=header_of(samples_of(), "twin"))]).simulated  # type: ignore[union-attr]
    filmed = film(tmp_path, "b_s1", "camera of a simulated bench (twin)")
    assert read_explained([filmed]).simulated  # type: ignore[union-attr]


def test_a_replay_is_no_measurement(tmp_path: Path) -> None:
    replay = drive(tmp_path, "a_s1", header=header_of(samples_of(), "replay"))
    found = read_explained([replay, film(tmp_path, "b_s1")])
    assert names(found) == [("b", "s1", "b_s1")] and any("a_s1.h5 left out: a replay" in w for w in found.warnings)


def test_tables_alone_need_no_names(tmp_path: Path) -> None:
    assert names(read_explained([table(tmp_path, "any.csv")])) == [("unnamed", "s1", "any")]
    means = table(tmp_path, "means.csv", "design,pressure_MPa,mean,sd,n\na,0.3,50,1,5\n")
    assert isinstance(read_explained([means]), Summary)
    with pytest.raises(UsageError, match="a table of means beside runs"):
        read_explained([film(tmp_path, "a_s1"), means])


STUDY = """\
title: A study
pressure_MPa: 0.2
designs:
  tw3_slw10:
    shell: {tw_mm: 3, slw_mm: 10}
    samples:
      s1: [one.h5, two.h5]
      s2: table.csv
      s3: {recordings: [shared.csv], left_out: torn}
  glove:
    samples:
      s1: [shared.csv, broken.h5]
      s2:
        - {file: aborted.h5, counts: the first cycle is whole}
        - aborted2.h5
        - {file: more.h5, left_out: bubble in the line}
"""


def study(folder: Path) -> Path:
    film(folder, "one")
    drive(folder, "two")
    table(folder, "table.csv")
    rows = "design,sample,pressure_kPa,angle_deg\ntw3_slw10,s3,0,0\nglove,s1,0,1\nglove,s1,100,31\n"
    table(folder, "shared.csv", rows)
    table(folder, "broken.h5", "not HDF5")
    drive(folder, "aborted", stop=None)
    drive(folder, "aborted2", stop=None)
    return table(folder, "study.yaml", STUDY)


def test_a_study_gives_the_runs_of_its_recordings(tmp_path: Path) -> None:
    found = read_explained([study(tmp_path)])
    assert names(found) == [
        ("glove", "s1", "shared"),
        ("glove", "s2", "aborted"),
        ("tw3_slw10", "s1", "one"),
        ("tw3_slw10", "s1", "two"),
        ("tw3_slw10", "s2", "table"),
    ]
    assert isinstance(found, Measured)
    assert found.runs[0].values["angle_deg"].tolist() == [1, 31] and found.runs[4].values["angle_deg"].tolist() == [
        0,
        20,
        45,
    ]
    told = [words for words in found.warnings if "left out" in words]
    for file, why in (
        ("shared.csv", "torn"),
        ("more.h5", "bubble in the line"),
        ("broken.h5", ""),
        ("aborted2.h5", "the run was not completed: no record of its end; say `counts:`"),
    ):
        assert any(words.startswith(f"{file} left out: {why}") for words in told), file
    assert names(read_explained([tmp_path])) == names(found)


def test_a_study_stands_alone(tmp_path: Path) -> None:
    path = study(tmp_path)
    with pytest.raises(UsageError, match="a study beside other files"):
        read_explained([path, tmp_path / "one.h5"])
    (tmp_path / "empty").mkdir()
    with pytest.raises(UsageError, match=r"a folder without study\.yaml"):
        read_explained([tmp_path / "empty"])
    bare = table(tmp_path, "bare.yaml", "title: t\npressure_MPa: 0.2\ndesigns: {a: {samples: {s1: broken.h5}}}\n")
    with pytest.raises(InputError, match=r"no run can be read: broken\.h5 left out"):
        read_explained([bare])


def test_the_videos_of_a_study_are_analysed(tmp_path: Path) -> None:
    sample = Path(__file__).resolve().parents[3] / "sample_data" / "videos" / "tw3_slw10_s1.mp4"
    shutil.copy(sample, tmp_path / "a.mp4")
    text = (
        'title: t\npressure_MPa: 0.35\nanalysis: {ramp: "0:0.35:2.5", marker_span_mm: 180}\n'
        "designs: {tw3_slw10: {shell: tw3_slw10, samples: {s1: a.mp4, s2: none.mp4}}}\n"
    )
    path = table(tmp_path, "study.yaml", text)
    with pytest.raises(UsageError, match="has videos; say where their analyses go, with --out"):
        read_explained([path])
    seen: list[tuple[int, int | None]] = []
    found = read_explained([path], out=tmp_path / "out", progress=lambda *at: seen.append(at))
    assert names(found) == [("tw3_slw10", "s1", "a")] and seen == [(1, 2), (2, 2)]
    assert isinstance(found, Measured) and found.runs[0].pressure_MPa.max() == pytest.approx(0.35)
    assert 110 < np.nanmax(found.runs[0].values["angle_deg"]) < 140
    assert any(words.startswith("none.mp4 left out: ") for words in found.warnings)


def test_what_is_not_there(tmp_path: Path) -> None:
    with pytest.raises(BenchlabError, match="no such file"):
        read_explained([tmp_path / "none.csv"])
    with pytest.raises(BenchlabError, match="no such file"):
        read_explained([tmp_path / "none.yaml"])
