"""`benchlab stats` from end to end: tables of samples, cycles and summaries; what is refused, and what is told."""

import csv
import json
import re
import subprocess
import sys
from pathlib import Path
from typing import Any

import cv2
import pytest

from benchlab.io.published import published_angles

ROOT = Path(__file__).resolve().parents[2]
TRUTH = ROOT / "sample_data" / "truth.csv"
COLUMNS = ("--value", "angle_deg", "--group", "design")

GOOD = """design,sample,angle_deg
a,1,10.1
a,2,10.4
a,3,9.9
b,1,12.0
b,2,12.6
b,3,12.2
"""
CYCLES = "design,sample,cycle,angle_deg\n" + "".join(
    f"{d},s{s},{c},{10 * i + s + c / 10:.1f}\n" for i, d in enumerate("ab") for s in range(1, 4) for c in range(1, 5)
)


def write(path: Path, text: str) -> Path:
    path.write_text(text, encoding="utf-8")
    return path


@pytest.fixture
def table(tmp_path: Path) -> Path:
    return write(tmp_path / "a.csv", GOOD)


def test_the_sample_table(benchlab) -> None:
    done = benchlab("stats", TRUTH, *COLUMNS, "--sample", "sample", "--json")
    assert done.code == 0, done.err
    found = done.json
    assert found["anova"]["df"] == [4, 20] and len(found["tukey"]) == len(found["games_howell"]) == 10
    assert [group["n"] for group in found["groups"]] == [5] * 5 and found["components"]["cycle"] is None
    assert benchlab("stats", TRUTH, *COLUMNS, "--json").json["anova"] == found["anova"]  # no sample has two rows


def test_the_papers_table(benchlab) -> None:
    """Table I as it is shipped: two columns name a design, and three designs were not measured."""
    table = ROOT / "benchlab" / "published" / "paper_angles.csv"
    names = (
        "--group",
        "tw_mm",
        "--group",
        "slw_mm",
        "--mean",
        "measured_angle_deg",
        "--sd",
        "measured_sd_deg",
        "--n",
        "samples",
    )
    refused = benchlab("stats", table, *names)
    assert refused.code == 3 and "3 rows without a number (line 5 samples: empty; line 9" in refused.err
    done = benchlab("stats", table, *names, "--leave-out-missing", "--json")
    assert done.code == 0 and done.json["warnings"][0].startswith("left out: 3 rows")
    anova, welch = done.json["anova"], done.json["welch"]
    assert (round(anova["F"], 2), anova["df"], round(anova["eta_squared"], 3)) == (529.46, [4, 20], 0.991)
    assert anova["p"] == pytest.approx(5.6e-20, rel=0.02)
    assert (round(welch["F"], 1), round(welch["df"][1], 2)) == (439.5, 9.75)
    assert round(done.json["repeatability"]["s_r"], 2) == 2.96 and round(done.json["repeatability"]["r"], 1) == 8.3
    assert done.json["groups"][0]["name"] == "3 / 5"


def test_the_papers_slw_set_on_the_terminal(tmp_path: Path, benchlab) -> None:
    rows = [p for p in published_angles() if p.tw_mm == 3 and p.samples]
    text = "".join(f"{p.slw_mm:g},{p.measured_angle_deg},{p.measured_sd_deg},{p.samples}\n" for p in rows)
    path = write(tmp_path / "slw.csv", "slw_mm,mean,sd,n\n" + text)
    done = benchlab("stats", path, "--group", "slw_mm", "--mean", "mean", "--sd", "sd", "--n", "n")
    assert done.code == 0 and done.err == ""
    (pair,) = [line for line in done.out.splitlines() if line.startswith("10 − 5")]
    assert "2.2e-5" in pair and pair.split().count("***") == 1
    assert done.out.splitlines()[2].startswith("The groups differ: F(2, 12) = ")


def test_cycles_are_nested_and_samples_counted_once(tmp_path: Path, benchlab) -> None:
    path = write(tmp_path / "a.csv", CYCLES)
    done = benchlab("stats", path, *COLUMNS, "--sample", "sample", "--json")
    assert done.code == 0, done.err
    assert [(g["n"], g["cycles"]) for g in done.json["groups"]] == [(3, 12), (3, 12)]
    assert done.json["anova"]["df"] == [1, 4] and done.json["components"]["method"] == "EMS"
    text = benchlab("stats", path, *COLUMNS, "--sample", "sample").out
    assert (
        "cycles of a sample (s_r)" in text
        and "one cycle of any sample (s_R)" in text
        and "Each sample counts once" in text
    )


def test_cycles_are_not_taken_for_samples(tmp_path: Path, benchlab) -> None:
    path = write(tmp_path / "a.csv", CYCLES)
    done = benchlab("stats", path, *COLUMNS)
    assert done.code == 3 and "sample 's1' of 'a' stands in lines 2, 3, 4, …" in done.err and "--sample" in done.err
    told = benchlab("stats", path, *COLUMNS, "--rows-are-samples", "--json")
    assert told.code == 0 and told.json["anova"]["df"] == [1, 22] and "as was asked for" in told.json["warnings"][0]
    assert benchlab("stats", path, *COLUMNS, "--rows-are-samples", "--strict").code == 3
    bare = write(tmp_path / "b.csv", CYCLES.replace(",sample,", ",number,"))
    done = benchlab("stats", bare, *COLUMNS)
    assert done.code == 3 and "column 'cycle' says that rows are cycles" in done.err


def test_a_row_that_stands_twice(tmp_path: Path, benchlab) -> None:
    path = write(tmp_path / "a.csv", CYCLES + "b,s3,4,13.4\n")
    done = benchlab("stats", path, *COLUMNS, "--sample", "sample")
    assert done.code == 3 and "line 26: cycle 4 of sample s3 of b stands twice, in lines 25 and 26" in done.err
    path = write(tmp_path / "b.csv", GOOD + "b,3,12.3\n")
    done = benchlab("stats", path, *COLUMNS, "--sample", "sample", "--json")
    assert done.code == 0 and "sample '3' of 'b' stands in lines 7 and 8: taken as cycles" in done.json["warnings"][0]


def test_a_large_offset_costs_nothing_and_is_told(table: Path, benchlab) -> None:
    expected = benchlab("stats", table, *COLUMNS, "--json").json["anova"]["F"]
    write(
        table,
        GOOD.replace(",10.", ",1000000000010.").replace(",9.", ",1000000000009.").replace(",12.", ",1000000000012."),
    )
    done = benchlab("stats", table, *COLUMNS, "--json")
    assert done.json["anova"]["F"] == pytest.approx(expected, rel=1e-14)
    assert "only 4 digits of the values' differences are left by float64" in done.json["warnings"][0]


def test_names_of_all_kinds(tmp_path: Path, benchlab) -> None:
    names = ["$x_{$", "<script>alert(1)</script>", "a\x1b[31mred", "x" * 5000, "=cmd|calc", " slw5", "slw5", "SLW5"]
    path = tmp_path / "a.csv"
    with path.open("w", encoding="utf-8", newline="") as file:
        rows = csv.writer(file)
        rows.writerow(["design", "angle_deg"])
        rows.writerows([name, f"{i + j / 10:.1f}"] for i, name in enumerate(names) for j in (1, 2, 4))
    done = benchlab("stats", path, *COLUMNS, "--out", tmp_path / "out")
    assert done.code == 0, done.err
    assert "\x1b" not in done.out + done.err and "a\\x1b[31mred" in done.out
    assert max(len(line) for line in done.out.splitlines()) < 400 and "…" in done.out
    assert "differ only in blanks around them are taken as one: 'slw5'" in done.err
    assert "look alike and are taken as two: 'slw5' and 'SLW5'" in done.err
    document = json.loads((tmp_path / "out" / "comparison.json").read_text(encoding="utf-8"))
    found = [group["name"] for group in document["groups"]]
    assert found == [*names[:5], "slw5", "SLW5"] and document["groups"][5]["n"] == 6
    text = (tmp_path / "out" / "groups.csv").read_text(encoding="utf-8")
    assert "'=cmd|calc," in text
    svg = (tmp_path / "out" / "bars.svg").read_text(encoding="utf-8")
    assert "\x1b" not in svg and "<script" not in svg


def test_five_hundred_groups_stay_readable(tmp_path: Path, benchlab) -> None:
    text = "".join(f"g{i},{i % 7 + j / 10:.1f}\n" for i in range(500) for j in (1, 2, 4))
    path = write(tmp_path / "a.csv", "design,angle_deg\n" + text)
    done = benchlab("stats", path, *COLUMNS, "--out", tmp_path / "out")
    assert done.code == 0 and "… and 460 more" in done.out and len(done.out.splitlines()) < 90
    assert "124750 pairs of 500 groups are not compared" in done.err
    assert sum(1 for _ in (tmp_path / "out" / "groups.csv").open()) == 501
    assert not (tmp_path / "out" / "pairs.csv").exists() and "pairs.csv" not in done.err
    assert cv2.imread(str(tmp_path / "out" / "bars.png")).shape[0] < 3000


def test_small_probabilities_are_not_told_as_zero(tmp_path: Path, benchlab) -> None:
    path = write(tmp_path / "a.csv", GOOD.replace(",12.", ",9912."))
    done = benchlab("stats", path, *COLUMNS)
    (pair,) = [line for line in done.out.splitlines() if line.startswith("b − a")]
    assert "< 1e-13" in pair
    assert benchlab("stats", path, *COLUMNS, "--json").json["tukey"][0]["p_below"] == 1e-13


def test_constant_values_give_a_statement_and_no_number(tmp_path: Path, benchlab) -> None:
    path = write(tmp_path / "a.csv", "design,angle_deg\na,5\na,5\nb,5\nb,5\n")
    done = benchlab("stats", path, *COLUMNS, "--out", tmp_path / "out")
    assert done.code == 0 and "No test: no group has any scatter, and all values are equal." in done.out
    assert "inf" not in done.out and "nan" not in done.out.lower()


def test_everything_is_written_and_nothing_replaced(table: Path, benchlab) -> None:
    out = table.parent / "out"
    done = benchlab("stats", table, *COLUMNS, "--difference", "1", "--out", out, "--json")
    assert done.code == 0, done.err
    names = {path.name for path in out.iterdir()}
    assert names == {Path(path).name for path in done.json["outputs"]} and len(names) == 11
    assert json.loads((out / "comparison.json").read_text(encoding="utf-8")) == done.json
    with (out / "pairs.csv").open(encoding="utf-8") as file:
        (row,) = csv.DictReader(file)
    (pair,) = done.json["tukey"]
    assert (row["a"], row["b"], float(row["difference_angle_deg"])) == ("a", "b", pair["difference"])
    assert float(row["tukey_p"]) == pair["p"]
    assert [float(row[f"hedges_g{end}"]) for end in ("", "_low", "_high")] == [
        pair[f"g{end}"] for end in ("", "_low", "_high")
    ]
    with (out / "groups.csv").open(encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    for row, group in zip(rows, done.json["groups"], strict=True):
        assert [float(row[f"{key}_angle_deg"]) for key in ("mean", "sd", "low", "high")] == [
            group[k] for k in ("mean", "sd", "low", "high")
        ]
    for name in ("bars.png", "intervals.png"):
        picture = cv2.imread(str(out / name))
        assert picture.shape[1] > 300 and picture.std() > 15
    before = {path.name: path.read_bytes() for path in out.iterdir()}
    again = benchlab("stats", table, *COLUMNS, "--out", out)
    assert again.code == 2 and "exists; choose another --out, or replace it with --overwrite" in again.err
    assert {path.name: path.read_bytes() for path in out.iterdir()} == before
    write(table, GOOD.replace("12.6", "12").replace("12.2", "12").replace("10.4", "10.1").replace("9.9", "10.1"))
    assert benchlab("stats", table, *COLUMNS, "--out", out, "--overwrite").code == 0
    assert names - {path.name for path in out.iterdir()} == {
        "power.csv"
    }  # nothing scatters: no power, and none left over


def test_json_is_one_document_also_with_warnings(tmp_path: Path, benchlab) -> None:
    path = write(tmp_path / "a.csv", GOOD + "c,1,12.4\n")
    done = benchlab("stats", path, *COLUMNS, "--json")
    document: Any = done.json
    assert document["warnings"] and "warning: one sample in c" in done.err
    assert document["games_howell"][1]["reason"] == "one sample in c" and document["games_howell"][1]["p"] is None
    assert document["welch"]["left_out"] == ["c"] and document["columns"] == {"group": ["design"], "value": "angle_deg"}
    assert len(document["provenance"]["sha256"]) == 64


def test_a_narrow_terminal(benchlab, monkeypatch: pytest.MonkeyPatch) -> None:
    """80 columns: both tests of each pair fit; effect sizes are said to be elsewhere."""
    for name, value in (("FORCE_COLOR", "1"), ("NO_COLOR", "1"), ("COLUMNS", "80"), ("TERM", "xterm")):
        monkeypatch.setenv(name, value)
    done = benchlab("stats", TRUTH, *COLUMNS)
    text = re.sub(r"\x1b\[[0-9;]*m", "", done.out)
    (head,) = [line for line in text.splitlines() if line.startswith("pair ")]
    assert head.split() == ["pair", "difference", "Tukey", "HSD", "p", "Games–Howell", "p"] and len(head) <= 80
    assert "(on a wider terminal, with --json or --out also: Hedges' g, interval)" in text


def test_a_reader_that_leaves_is_no_bug(tmp_path: Path) -> None:
    path = tmp_path / "a.csv"
    path.write_text("group,value\n" + "".join(f"{g},{v}\n" for g in "abcdefgh" for v in range(5)))
    command = (
        f"'{sys.executable}' -m benchlab stats '{path}' --value value --group group | head -1; exit ${{PIPESTATUS[0]}}"
    )
    done = subprocess.run(["bash", "-c", command], capture_output=True, text=True, check=False)
    assert done.returncode == 0 and "8 groups" in done.stdout
