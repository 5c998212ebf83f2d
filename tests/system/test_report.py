"""`benchlab report` as a lab runs it, on a small study of drawn clips and tables."""

from __future__ import annotations

import csv
import json
import os
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

from benchlab.io.files import sha256
from tests.system.conftest import ANGLES_DEG, Done, draw_clip

STUDY = """title: Two designs, drawn
notes: Drawn data.
pressure_MPa: 0.3
analysis: {ramp: "0:0.3:1.1333", sync: 0.1667}
designs:
  wide:
    simulated: {angle_deg: 99, source: told for the test}
    samples: {s1: clip.mp4, s2: [wide.csv]}
  narrow:
    samples: {s1: {recordings: narrow_s1.csv}, s2: narrow_s2.csv, s3: {recordings: narrow_s3.csv, left_out: leaked at the seam}}
"""


def table(*angles: object) -> str:
    """Angles of cycles, as a lab has them from elsewhere."""
    return "cycle,angle_deg\n" + "".join(f"{cycle},{angle}\n" for cycle, angle in enumerate(angles, start=1))


@pytest.fixture(scope="module")
def drawn(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """One clip, up to 100° at 0.3 MPa, and four tables of angles."""
    folder = tmp_path_factory.mktemp("study")
    draw_clip(folder / "clip.mp4", np.concatenate([ANGLES_DEG, np.full(12, 100.0)]))
    for name, angles in {"wide": (103, 104), "narrow_s1": (50, 51), "narrow_s2": (53.5,), "narrow_s3": (20,)}.items():
        (folder / f"{name}.csv").write_text(table(*angles))
    (folder / "study.yaml").write_text(STUDY)
    return folder


@pytest.fixture
def study(drawn: Path, tmp_path: Path) -> Path:
    """A copy that a test may spoil."""
    for path in drawn.iterdir():
        if path.is_file():
            (tmp_path / path.name).write_bytes(path.read_bytes())
    return tmp_path


@pytest.fixture(scope="module")
def reported(drawn: Path) -> Path:
    """The report of the study, made once by the installed command."""
    out = drawn / "out"
    command = [sys.executable, "-m", "benchlab", "report", drawn, "--out", out, "--pdf"]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    assert done.stdout == "" and "\x1b" not in done.stderr
    assert "All designs. The designs differ" in done.stderr and f"wrote {out / 'report.html'}" in done.stderr
    return out


def test_what_is_written(reported: Path) -> None:
    found = json.loads((reported / "report.json").read_text())
    sums = found["provenance"]["outputs_sha256"]
    assert {
        "report.html",
        "report.pdf",
        "tables/values.csv",
        "tables/designs.csv",
        "figures/bars_all.svg",
        "figures/bars_all.png",
    } <= set(sums)
    assert all(sha256(reported / name) == digest for name, digest in sums.items())
    there = {path.relative_to(reported).as_posix() for path in reported.rglob("*") if path.is_file()}
    assert {name for name in there if not name.startswith("recordings/")} == {*sums, "report.json"}
    assert (reported / "report.pdf").read_bytes().startswith(b"%PDF")
    assert (reported / "recordings" / "wide" / "s1" / "clip.h5").is_file()


def test_the_numbers_are_those_of_the_recordings(reported: Path) -> None:
    found = json.loads((reported / "report.json").read_text())
    wide, narrow = found["designs"]
    assert wide["samples"][0]["angle_deg"] == pytest.approx(100.0, abs=0.3)
    assert wide["samples"][1]["angle_deg"] == 103.5
    assert (narrow["mean_deg"], narrow["n"]) == (52.0, 2)
    assert narrow["sd_deg"] == pytest.approx(3.0 / 2**0.5)
    assert wide["simulated_less_measured_deg"] == pytest.approx(99 - wide["mean_deg"])
    assert found["left_out"][0]["why"] == "leaked at the seam" and found["failures"] == []
    page = (reported / "report.html").read_text()
    assert (
        f'<td class="n">{wide["mean_deg"]:.1f}</td>' in page and "leaked at the seam" in page and "Drawn data." in page
    )


def test_the_table_of_values_can_be_compared_by_itself(reported: Path, benchlab: Callable[..., Done]) -> None:
    path = reported / "tables" / "values.csv"
    with path.open(newline="") as file:
        rows = list(csv.DictReader(file))
    assert len(rows) == 7
    assert [(row["angle_deg"], row["left_out_angle_deg"], row["note"]) for row in rows][-1] == (
        "",
        "20.0",
        "left out: leaked at the seam",
    )
    asked = ("stats", path, "--value", "angle_deg", "--group", "design", "--sample", "sample", "--json")
    done = benchlab(*asked)
    assert done.code == 3 and "--leave-out-missing" in done.err  # as docs/report.md says
    done = benchlab(*asked, "--leave-out-missing")
    (whole,) = [one for one in json.loads((reported / "report.json").read_text())["sets"] if one["name"] == "all"]
    assert done.code == 0, done.err
    assert done.json["anova"]["F"] == pytest.approx(whole["anova"]["F"], rel=1e-12)


def test_a_second_run_analyses_nothing_again(reported: Path, benchlab: Callable[..., Done]) -> None:
    run_file = reported / "recordings" / "wide" / "s1" / "clip.h5"
    before = run_file.stat().st_mtime_ns
    done = benchlab("report", reported.parent / "study.yaml", "--out", reported, "--json")
    assert done.code == 0 and done.json["designs"][0]["samples"][0]["recordings"][0]["status"] == "current"
    assert run_file.stat().st_mtime_ns == before
    assert not (reported / "report.pdf").exists()  # of the run before: it would tell of another report
    assert "report.json" in done.err and done.json["outputs"]


def test_a_bad_recording_is_listed_and_the_rest_goes_on(study: Path, benchlab: Callable[..., Done]) -> None:
    (study / "narrow_s2.csv").write_text(table("fifty"))
    (study / "wide.csv").unlink()
    done = benchlab("report", study, "--out", study / "out", "--json")
    assert done.code == 4
    assert {(one["sample"], one["recording"]) for one in done.json["failures"]} == {
        ("s2", "wide.csv"),
        ("s2", "narrow_s2.csv"),
    }
    assert "failed: narrow s2, narrow_s2.csv" in done.err and "2 without a value" in done.err
    page = (study / "out" / "report.html").read_text()
    assert "Failed or missing: 2." in page and "no such file" in page
    (study / "narrow_s2.csv").write_text(table(53.5))
    (study / "wide.csv").write_text(table(103, 104))
    assert benchlab("report", study, "--out", study / "out").code == 0


def test_everything_failed_is_a_report_too(study: Path, benchlab: Callable[..., Done]) -> None:
    for path in [*study.glob("*.csv"), study / "clip.mp4"]:
        path.unlink()
    done = benchlab("report", study, "--out", study / "out", "--json", "--pdf")
    assert done.code == 4 and len(done.json["failures"]) >= 4
    assert "no sample has a value" in (study / "out" / "report.html").read_text()


def test_files_of_others_stay(study: Path, benchlab: Callable[..., Done]) -> None:
    out = study / "out"
    (out / "tables").mkdir(parents=True)
    (out / "tables" / "designs.csv").write_text("mine")
    done = benchlab("report", study, "--out", out)
    assert done.code == 2 and "designs.csv" in done.err and "--overwrite" in done.err
    assert (out / "tables" / "designs.csv").read_text() == "mine" and not (out / "report.html").exists()
    assert benchlab("report", study, "--out", out, "--overwrite").code == 0
    (out / "report.html").write_text("edited by hand")
    done = benchlab("report", study, "--out", out)
    assert done.code == 2 and "report.html" in done.err
    assert (out / "report.html").read_text() == "edited by hand"


def test_a_report_json_of_others_vouches_for_nothing(study: Path, benchlab: Callable[..., Done]) -> None:
    out = study / "out"
    out.mkdir()
    victim = study / "study.yaml"
    claim = {"schema": "benchlab.study_report/1", "provenance": {"outputs_sha256": {"../study.yaml": sha256(victim)}}}
    (out / "report.json").write_text(json.dumps(claim))
    assert benchlab("report", study, "--out", out).code == 2
    assert victim.read_text() == STUDY


def test_a_file_of_the_study_is_never_replaced(study: Path, benchlab: Callable[..., Done]) -> None:
    out = study / "out"
    (out / "tables").mkdir(parents=True)
    (study / "wide.csv").rename(out / "tables" / "values.csv")
    (study / "study.yaml").write_text(STUDY.replace("wide.csv", "out/tables/values.csv"))
    before = (out / "tables" / "values.csv").read_bytes()
    done = benchlab("report", study, "--out", out, "--overwrite")
    assert done.code == 2 and "is read by this" in done.err
    assert (out / "tables" / "values.csv").read_bytes() == before


@pytest.mark.parametrize("spelled", [".", "out/..", "link"])
def test_the_folder_of_the_study_is_no_place_for_its_report(
    study: Path, benchlab: Callable[..., Done], spelled: str
) -> None:
    (study / "out").mkdir()
    (study / "link").symlink_to(study, target_is_directory=True)
    before = sorted(study.iterdir())
    for asked in (study, study / "study.yaml"):
        done = benchlab("report", asked, "--out", study / spelled, "--overwrite")
        assert done.code == 2 and "is the folder of the study" in done.err and "report" in done.err
    assert sorted(study.iterdir()) == before


def test_interrupted_it_keeps_what_is_done(
    study: Path, benchlab: Callable[..., Done], monkeypatch: pytest.MonkeyPatch
) -> None:
    from benchlab.workflows import study_values

    def interrupt(*_: object) -> None:
        raise KeyboardInterrupt

    with monkeypatch.context() as patched:
        patched.setattr(study_values, "_assembled", interrupt)
        done = benchlab("report", study, "--out", study / "out")
    assert done.code == 130 and "are kept" in done.err and not (study / "out" / "report.html").exists()
    again = benchlab("report", study, "--out", study / "out", "--json")
    assert again.json["designs"][0]["samples"][0]["recordings"][0]["status"] == "current"


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (["--confidence", "95"], "confidence"),
        (["--confidence", "nan"], "finite"),
        (["--difference-deg", "-5"], "above 0"),
        (["--jobs", "0"], "jobs"),
    ],
)
def test_options_out_of_range_are_refused_before_anything_is_done(
    study: Path, benchlab: Callable[..., Done], arguments: list[str], said: str
) -> None:
    done = benchlab("report", study, "--out", study / "out", *arguments)
    assert done.code == 2 and said in done.err and not (study / "out").exists()


def test_what_is_no_study(tmp_path: Path, benchlab: Callable[..., Done]) -> None:
    assert benchlab("report", tmp_path, "--out", tmp_path / "out").code == 2
    (tmp_path / "study.yaml").write_text("title: x\npressure_MPa: 0.3\ndesigns: {}\n")
    done = benchlab("report", tmp_path, "--out", tmp_path / "out", "--json")
    assert done.code == 3 and done.json["error"]["where"] and not (tmp_path / "out").exists()


def test_strict_takes_warnings_for_errors(study: Path, benchlab: Callable[..., Done]) -> None:
    (study / "wide.csv").write_bytes((study / "narrow_s1.csv").read_bytes())  # the same content twice
    assert benchlab("report", study, "--out", study / "out").code == 0
    done = benchlab("report", study, "--out", study / "out", "--strict")
    assert done.code == 3 and "same content" in done.err


@pytest.mark.skipif(os.name != "posix", reason="pipes of a POSIX shell")
def test_a_reader_that_leaves_early_is_no_error(reported: Path) -> None:
    command = f"'{sys.executable}' -m benchlab report '{reported.parent}' --out '{reported}' --json | head -c 20"
    done = subprocess.run(["bash", "-o", "pipefail", "-c", command], capture_output=True, text=True, check=False)
    assert done.returncode == 0 and "Traceback" not in done.stderr
