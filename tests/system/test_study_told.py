"""What `benchlab study` says of names that cannot be, of pressures that nothing told, and of what a report wrote."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest


def test_new_goes_on_without_files_whose_names_cannot_be_those_of_designs(bench: Path, benchlab: Callable) -> None:
    (bench / "Beta <script>_s1.csv").write_text("cycle,angle_deg\n1,5\n")
    (bench / f"{'x' * 81}_s1.csv").write_text("cycle,angle_deg\n1,6\n")
    done = benchlab("study", "new", bench, "--json")
    assert done.code == 0 and [design["name"] for design in done.json["designs"]] == ["tw3_slw5", "tw3_slw10"]
    assert "not in it: Beta <script>_s1.csv: a design cannot be called 'Beta <script>' (name it in 1 to 80" in done.err
    assert [each["why"].endswith("; rename the file") for each in done.json["unused"]] == [True, True]
    assert "#   Beta <script>_s1.csv: a design cannot" in (bench / "study.yaml").read_text()
    for path in (*bench.glob("tw*"), bench / "study.yaml"):
        path.unlink()
    done = benchlab("study", "new", bench)
    assert done.code == 3 and "Beta <script>_s1.csv: a design cannot be called" in done.err
    assert "rename the file" in done.err and "line" not in done.err and not (bench / "study.yaml").exists()


@pytest.mark.parametrize(
    ("options", "comment", "words", "source"),
    [
        ([], "; this is the default, nothing told it", "0.35 MPa, which is the default (--pressure-MPa)\n", "default"),
        (["--pressure-MPa", "0.35"], "", "0.35 MPa\n", "option"),
        (["--ramp", "0:0.2:2"], "", "0.2 MPa, the largest of --ramp\n", "ramp"),
        (["--ramp", "0:0.4:2", "--pressure-MPa", "0.35"], "", "0.35 MPa\n", "option"),
    ],
)
def test_new_says_where_the_pressure_of_comparison_is_from(
    bench: Path, benchlab: Callable, options: list[str], comment: str, words: str, source: str
) -> None:
    done = benchlab("study", "new", bench, *options, "--json")
    assert done.json["pressure_MPa_from"] == source and f"compared at {words}" in done.err
    (line,) = [line for line in (bench / "study.yaml").read_text().splitlines() if line.startswith("pressure_MPa")]
    assert ("default" in line) == bool(comment) and f"at which the designs are compared{comment}" in line


def test_check_says_which_angles_are_taken_on_the_makers_word(bench: Path, benchlab: Callable) -> None:
    (bench / "study.yaml").write_text("""\
title: T
pressure_MPa: 0.35
designs:
  a: {samples: {s1: tw3_slw5_s1.csv, s2: tw3_slw5_s2.csv, s3: {recordings: tw3_slw10_s2.csv, left_out: leaked}}}
  b: {samples: {s1: tw3_slw10_s1.csv, s2: told.csv, s3: told_2.csv}}
""")
    told = "cycle,pressure_MPa,angle_deg\n1,0,0\n1,0.35,{}\n"
    for name, angle in (("told", 40), ("told_2", 41)):
        (bench / f"{name}.csv").write_text(told.format(angle))
    word = "of angles without a pressure: the angles are taken as those at 0.35 MPa, on the maker's word"
    done = benchlab("study", "check", bench, "--json")
    assert done.code == 0, done.err
    assert f"note: 3 tables {word}" in done.err
    assert "complete: all other recordings reach 0.35 MPa as far as is told" in done.err
    assert [r["without_pressure"] for s in done.json["designs"][1]["samples"] for r in s["recordings"]] == [
        True,
        False,
        False,
    ]
    for name, angle in (("told", 40), ("told_2", 41)):
        (bench / f"{name}.csv").write_text(f"cycle,angle_deg\n1,{angle}\n")
    done = benchlab("study", "check", bench)
    assert (
        done.code == 0 and f"note: 5 tables {word}" in done.err and done.err.endswith("complete: nothing is missing\n")
    )
    for index, path in enumerate(bench.glob("*.csv")):
        path.write_text(told.format(40 + index))
    done = benchlab("study", "check", bench)
    assert "word" not in done.err and "complete: all recordings reach 0.35 MPa as far as is told" in done.err


def test_new_passes_over_what_a_report_wrote_and_no_more(bench: Path, benchlab: Callable) -> None:
    assert benchlab("study", "new", bench).code == 0
    alone = benchlab("study", "new", bench, "--overwrite", "--json").json["designs"]
    assert benchlab("report", bench, "--out", bench / "out").code == 0
    for path in (bench / "out").iterdir():  # as if it had been written beside the tables
        path.rename(bench / path.name)
    (bench / "out").rmdir()
    found = benchlab("study", "new", bench, "--overwrite", "--json").json
    assert found["designs"] == alone
    written = {each["file"] for each in found["unused"] if each["why"] == "written by a report of benchlab"}
    assert {"tables", "figures"} <= written <= {"tables", "figures", "recordings"}
