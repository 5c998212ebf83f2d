"""Strict YAML: what is read, and what is refused with its line."""

import os
from pathlib import Path

import pytest
from pydantic import Field

from benchlab.errors import InputError, UsageError
from benchlab.io.yaml_file import MAX_BYTES, Document, read_document, write_document


class Layer(Document):
    thickness_mm: float = Field(gt=0)
    words: str = ""


class Shell(Document):
    name: str
    film: Layer
    angles: tuple[float, ...] = ()
    count: int = 1


GOOD = "name: a\nfilm:\n  thickness_mm: 3e-1\nangles: [1, 2.5]\n"


def write(folder: Path, text: str | bytes) -> Path:
    path = folder / "a.yaml"
    path.write_bytes(text if isinstance(text, bytes) else text.encode())
    return path


def test_reads_yaml_1_2_into_the_model(tmp_path: Path) -> None:
    for text in (GOOD, GOOD.replace("\n", "\r\n"), "\ufeff" + GOOD, GOOD.encode("utf-16")):
        shell = read_document(write(tmp_path, text), Shell)
        assert shell == Shell(name="a", film=Layer(thickness_mm=0.3), angles=(1.0, 2.5))
    assert read_document(write(tmp_path, GOOD.replace("name: a", "name: no")), Shell).name == "no"
    assert read_document(write(tmp_path, GOOD.replace("name: a", "name: 1:30")), Shell).name == "1:30"


@pytest.mark.parametrize(
    ("text", "words"),
    [
        (GOOD + "count: 1\ncount: 2\n", ["line 6", "duplicate", "count", "already on line 5"]),
        (GOOD + "coun: 1\n", ["line 5", "unknown key coun", "did you mean count?"]),
        (GOOD + "count: true\n", ["line 5", "count is true", "whole number"]),
        (GOOD + "count: '1'\n", ["line 5", 'count is "1"', "whole number"]),
        (GOOD + "count: 1.5\n", ["line 5", "count is 1.5"]),
        (GOOD.replace("3e-1", "-0.3"), ["line 3", "film.thickness_mm is -0.3", "more than 0"]),
        (GOOD.replace("3e-1", ".nan"), ["line 3", "film.thickness_mm is nan", "finite"]),
        (GOOD.replace("3e-1", ".inf"), ["line 3", "finite"]),
        (GOOD.replace("3e-1", "1e999"), ["line 3", "finite"]),
        (GOOD.replace("2.5", "x"), ["line 4", "angles[1]", '"x"', "number"]),
        (GOOD.replace("name: a", "name: 2026-01-01"), ["line 1", "name reads as a date", "quote"]),
        (GOOD.replace("name: a\n", ""), ["name is missing", "add `name:`"]),
        (GOOD.replace("  thickness_mm: 3e-1", "  words: b"), ["line 2", "thickness_mm is missing in film"]),
        (GOOD.replace("name: a", "name: &x a"), ["line 1", "anchors"]),
        (GOOD.replace("film:\n", "film:\n  <<: {words: a}\n"), ["line 3", "merge"]),
        (GOOD.replace("name: a", "name: !!python/object/apply:os.system ls"), ["line 1", "not YAML"]),
        ("%YAML 1.1\n---\n" + GOOD, ["line 2", "YAML 1.2"]),
        (GOOD + "---\n" + GOOD, ["line 5", "document"]),
        (GOOD.replace("  thickness", "\tthickness"), ["line 3", "not YAML"]),
        ("name: " + "[" * 5000, ["nested deeper"]),
        ("1: a\n", ["line 1", "key '1' is not text"]),
        ("[a]\n", ["the document is"]),
        ("# only a comment\n", ["no data"]),
        (b"name: \xff\xfe", ["UTF-8"]),
        ("name: a\x00b\n", ["not YAML"]),
        (GOOD + "count: !!int ''\n", ["not YAML"]),
    ],
)
def test_refuses_with_the_line(tmp_path: Path, text: str | bytes, words: list[str]) -> None:
    with pytest.raises(InputError) as caught:
        read_document(write(tmp_path, text), Shell)
    line = str(caught.value)
    assert "\n" not in line and "a.yaml" in line
    for word in words:
        assert word in line


def test_says_all_errors_at_once(tmp_path: Path) -> None:
    text = "name: 3\nfilm:\n  thickness_mm: -1\n  thicknes: 2\ncount: x\n"
    with pytest.raises(InputError, match="4 things are wrong") as caught:
        read_document(write(tmp_path, text), Shell)
    for word in ("line 1: name is 3", "line 3: film.thickness_mm is -1", "line 4: unknown key film.thicknes", "line 5"):
        assert word in str(caught.value)


def test_refuses_what_is_no_regular_small_file(tmp_path: Path) -> None:
    with pytest.raises(UsageError, match="no such file"):
        read_document(tmp_path / "none.yaml", Shell)
    with pytest.raises(InputError, match="limit"):
        read_document(write(tmp_path, b"#" * (MAX_BYTES + 1)), Shell)
    os.mkfifo(tmp_path / "pipe.yaml")
    with pytest.raises(InputError, match="regular"):
        read_document(tmp_path / "pipe.yaml", Shell)


def test_writes_what_it_reads_back(tmp_path: Path) -> None:
    document = {"name": "no: 1:30 µ", "film": {"thickness_mm": 1e-05, "words": "two\nlines"}, "angles": [1e22, 0.1]}
    write_document(tmp_path / "b.yaml", document, "Made by benchlab.\n\nTwo lines.")
    text = (tmp_path / "b.yaml").read_text()
    assert text.startswith("# Made by benchlab.\n#\n# Two lines.\nname:")
    shell = read_document(tmp_path / "b.yaml", Shell)
    assert shell.film.thickness_mm == 1e-05 and shell.angles == (1e22, 0.1) and shell.film.words == "two\nlines"
    assert shell.name == document["name"]
    with pytest.raises(ValueError, match="read back"):
        write_document(tmp_path / "c.yaml", {"x": float("nan")})
    assert [p.name for p in tmp_path.iterdir()] == ["b.yaml"]


@pytest.mark.parametrize(
    ("text", "told"),
    [
        (GOOD.replace("3e-1", "0,35"), ["line 3: film.thickness_mm: 0,35 has a decimal comma; write 0.35"]),
        (GOOD.replace("3e-1", "1,500"), ["line 3: film.thickness_mm: 1,500 has a comma; write 1.500, or 1500"]),
        ("name: a\nfilm: {thickness_mm: 0,35}\n", ["line 2: film.thickness_mm: 0,35 has a decimal comma; write 0.35"]),
        (
            "name: a\nfilm: {thickness_mm: -0,05, words: b}\nangles: [0,1, 2,50]\ncount: 1,5\nextra: {a: 0,35 m}\nthickness: 0,35 m\n",
            [
                "8 things are wrong",
                "line 2: film.thickness_mm: -0,05 has a decimal comma (write -0.05)",
                "line 2: film.thickness_mm is -0.05 (give more than 0)",
                "line 3: angles[0]: 0,1 has a decimal comma (write 0.1)",
                "line 3: angles[1]: 2,50 has a decimal comma (write 2.50)",
                "line 4: count: 1,5 has a decimal comma (write 1.5)",
                "line 5: extra.a: 0,35 m has a comma (write a point)",
                "line 6: unknown key thickness (write thickness_mm: 350)",
            ],
        ),
    ],
)
def test_decimal_commas_are_told_at_every_place(tmp_path: Path, text: str, told: list[str]) -> None:
    with pytest.raises(InputError) as caught:
        read_document(write(tmp_path, text), Shell)
    for words in told:
        assert words in str(caught.value).replace("a.yaml, ", "")


def test_lists_of_whole_numbers_and_text_with_commas_are_left_alone(tmp_path: Path) -> None:
    for written, read in (("[1,2]", (1, 2)), ("[1,2,3,4]", (1, 2, 3, 4)), ("[1, 2, 3, 4]", (1, 2, 3, 4))):
        assert read_document(write(tmp_path, GOOD.replace("[1, 2.5]", written)), Shell).angles == read
    text = "name: 0,35\nfilm: {thickness_mm: 1, words: 'a 0,35'}\n"
    assert read_document(write(tmp_path, text), Shell).name == "0,35"


@pytest.mark.parametrize(
    ("text", "told"),
    [
        ("name: a\nfilm: 5\n", "line 2: film is 5; write its keys below it, as `key: value`"),
        (GOOD + "count: 1.5\n", "line 5: count is 1.5; give a whole number"),
        (GOOD.replace("3e-1", "thin"), 'line 3: film.thickness_mm is "thin"; give a number'),
        (GOOD.replace("3e-1", ".nan"), "line 3: film.thickness_mm is nan; give a finite number"),
        (GOOD.replace("3e-1", "nan"), 'line 3: film.thickness_mm is "nan"; give a finite number'),
        (GOOD.replace("3e-1", "-inf"), 'line 3: film.thickness_mm is "-inf"; give a finite number'),
        (GOOD.replace("[1, 2.5]", "3"), "line 4: angles is 3; write a list, as [a, b]"),
        (GOOD.replace("name: a", "name: 5"), "line 1: name is 5; give text, in quotes if it looks like a number"),
    ],
)
def test_what_a_model_finds_wrong_is_told_in_plain_words(tmp_path: Path, text: str, told: str) -> None:
    with pytest.raises(InputError) as caught:
        read_document(write(tmp_path, text), Shell)
    assert str(caught.value).endswith(told)
