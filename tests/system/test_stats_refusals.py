"""`benchlab stats` on tables that are damaged, ambiguous or asked for what they do not have."""

from pathlib import Path

import pytest

COLUMNS = ("--value", "angle_deg", "--group", "design")

GOOD = """design,sample,angle_deg
a,1,10.1
a,2,10.4
a,3,9.9
b,1,12.0
b,2,12.6
b,3,12.2
"""


def write(path: Path, text: str) -> Path:
    path.write_text(text, encoding="utf-8")
    return path


@pytest.fixture
def table(tmp_path: Path) -> Path:
    return write(tmp_path / "a.csv", GOOD)


@pytest.mark.parametrize(
    ("old", "new", "words"),
    [
        ("12.6", "12.6 deg", "a.csv, line 6, column angle_deg: unit in a cell: '12.6 deg'"),
        ("12.6", "high", "a.csv, line 6, column angle_deg: not a number: 'high'"),
        ("12.6", "1e999", "a.csv, line 6, column angle_deg: not a number: '1e999'"),
        ("12.6", "NaN", "1 row without a number (line 6 angle_deg: NaN)"),
        ("12.6", "-inf", "1 row without a number (line 6 angle_deg: -inf)"),
        ("12.6", "", "1 row without a number (line 6 angle_deg: empty)"),
        ("12.6", "----", "1 row without a number (line 6 angle_deg: ----)"),
        ("12.6", "12,6", "a.csv, line 6: row has 4 fields, header 3"),
        ("b,2,12.6", " ,2,12.6", "a.csv, line 6, column design: empty cell"),
        ("b,1,12.0\nb,2,12.6\nb,3,12.2\n", "", "1 group (samples: a 3): a comparison needs >= 2 groups"),
        ("a,2,10.4\na,3,9.9\nb,1,12.0\nb,2,12.6\n", "", "2 groups (samples: a 1, b 1): a comparison needs"),
        (GOOD[25:], "", "no data rows"),
    ],
)
def test_damaged_tables_are_refused_with_their_place(tmp_path: Path, benchlab, old: str, new: str, words: str) -> None:
    path = write(tmp_path / "a.csv", GOOD.replace(old, new))
    done = benchlab("stats", path, *COLUMNS)
    assert done.code == 3 and words in done.err and done.err.count("\n") == 1, done.err
    as_json = benchlab("stats", path, *COLUMNS, "--json")
    assert as_json.code == 3 and as_json.json["error"]["file"] == str(path)


def test_missing_values_are_left_out_only_when_asked_for(table: Path, benchlab) -> None:
    write(table, GOOD.replace("12.6", "NaN").replace("10.4", "inf"))
    done = benchlab("stats", table, *COLUMNS, "--leave-out-missing", "--json")
    assert done.code == 0 and [group["n"] for group in done.json["groups"]] == [2, 2]
    assert done.json["warnings"] == ["left out: 2 rows without a number (line 3 angle_deg: inf; line 6 angle_deg: NaN)"]


@pytest.mark.parametrize(
    ("options", "code", "words"),
    [
        (("--value", "angel_deg", "--group", "design"), 2, "no column 'angel_deg' for --value; did you mean 'angle_deg'?"),
        (("--value", "angle_deg", "--group", "designs"), 2, "did you mean 'design'? columns: design, sample, angle_deg"),
        (("--value", "angle_deg", "--group", "design", "--sample", "x"), 2, "no column 'x' for --sample; columns: design"),
        (("--value", "angle_deg", "--group", "angle_deg"), 2, "one column is named by two"),
        (("--value", "angle_deg", "--group", "design", "--group", "design"), 2, "--group names column 'design' twice"),
        (("--group", "design"), 2, "no --value; give --value COLUMN, or --mean, --sd and --n"),
        (("--group", "design", "--mean", "angle_deg"), 2, "no --sd and --n"),
        ((*COLUMNS, "--mean", "angle_deg"), 2, "are two kinds of table"),
        ((*COLUMNS, "--sample", "sample", "--rows-are-samples"), 2, "does not go with --rows-are-samples"),
        ((*COLUMNS, "--confidence", "95"), 2, "confidence 95 is not between 0.5 and 0.9999"),
        ((*COLUMNS, "--difference", "0"), 2, "not above 0"),
        ((*COLUMNS, "--out", "none/here"), 2, "no such folder"),
        ((*COLUMNS, "--out", "a.csv"), 2, "it is a file"),
        (("--value", "angle_deg"), 2, "Missing option '--group'"),
    ],
)  # fmt: skip
def test_usage(
    table: Path, benchlab, monkeypatch: pytest.MonkeyPatch, options: tuple[str, ...], code: int, words: str
) -> None:
    monkeypatch.chdir(table.parent)
    done = benchlab("stats", "a.csv", *options)
    assert done.code == code and words in done.err, done.err
    assert [path.name for path in table.parent.iterdir()] == ["a.csv"]


def test_two_columns_that_name_two_groups_alike(tmp_path: Path, benchlab) -> None:
    path = write(tmp_path / "a.csv", "x;y;v\na / b;c;1\na / b;c;2\na;b / c;3\na;b / c;5\n")
    done = benchlab("stats", path, "--value", "v", "--group", "x", "--group", "y")
    assert done.code == 3 and "line 4: two groups would both be called 'a / b / c'" in done.err


def test_two_columns_of_one_name(tmp_path: Path, benchlab) -> None:
    path = write(tmp_path / "a.csv", GOOD.replace("sample", "angle_deg"))
    assert "2 columns are named 'angle_deg'; rename one" in benchlab("stats", path, *COLUMNS).err


@pytest.mark.parametrize("delimiter", [";", "\t"])
def test_decimal_commas_are_read_exactly(table: Path, benchlab, delimiter: str) -> None:
    expected = benchlab("stats", table, *COLUMNS, "--json").json["anova"]
    write(table, GOOD.replace(",", delimiter).replace(".", ","))
    assert benchlab("stats", table, *COLUMNS, "--json").json["anova"] == expected
    write(table, GOOD.replace(",", delimiter).replace(".", ",").replace("12,6", "12.6"))
    assert "decimal points (line 6) and decimal commas (line 2)" in benchlab("stats", table, *COLUMNS).err
    write(table, f"design{delimiter}angle_deg\n" + "".join(f"{g}{delimiter}1,23{i}\n" for i, g in enumerate("aabb")))
    assert "could be decimal commas or thousands separators" in benchlab("stats", table, *COLUMNS).err


def test_a_table_is_not_replaced_by_its_own_results(tmp_path: Path, benchlab) -> None:
    path = write(tmp_path / "groups.csv", GOOD)
    done = benchlab("stats", path, *COLUMNS, "--out", tmp_path, "--overwrite")
    assert done.code == 2 and "is read here and would be replaced" in done.err and path.read_text() == GOOD


@pytest.mark.parametrize(
    ("row", "words"),
    [
        ("b,12,0.4,0", "line 3, column n: n is 0, not a count from 1"),
        ("b,12,0.4,2.5", "line 3, column n: n is 2.5"),
        ("b,12,0.4,1e12", "not a count from 1 to 1000000000"),
        ("b,12,-0.4,3", "line 3, column sd: sd is -0.4, below 0"),
        ("a,12,0.4,3", "group 'a' stands twice, in lines 2 and 3"),
        ("b,twelve,0.4,3", "line 3, column mean: not a number: 'twelve'"),
        ("b,,0.4,3", "1 row without a number (line 3 mean: empty)"),
    ],
)
def test_summaries_that_cannot_be(tmp_path: Path, benchlab, row: str, words: str) -> None:
    path = write(tmp_path / "a.csv", f"design,mean,sd,n\na,10,0.5,5\n{row}\n")
    done = benchlab("stats", path, "--group", "design", "--mean", "mean", "--sd", "sd", "--n", "n")
    assert done.code == 3 and words in done.err, done.err
