"""Encodings: by mark, by grammar, by words; what is no text; characters that were cut."""

from pathlib import Path

import pytest

from benchlab.errors import InputError
from benchlab.io.encoding import check_text, decoded, unicode_encoding

FILE = Path("a.csv")
POLISH = "Długość próbki;25,0\nObciążenie;1\n"


@pytest.mark.parametrize("name", ["utf-8", "utf-8-sig", "utf-16", "utf-16-le", "utf-16-be", "utf-32", "cp1250"])
def test_one_text_in_many_encodings(name: str) -> None:
    found = decoded(FILE, POLISH.encode(name))
    assert (found.data.decode(), found.doubt) == (POLISH, None)
    assert found.encoding == name
    assert decoded(FILE, POLISH.encode(name), encoding=name).data.decode() == POLISH


def test_plain_ascii_is_called_so() -> None:
    assert decoded(FILE, b"a,b\n1,2\n").encoding == "ascii"
    assert decoded(FILE, b"\xef\xbb\xbfa,b\n").data == b"a,b\n"


@pytest.mark.parametrize(
    ("text", "name"),
    [
        ("Prüfgeschwindigkeit;5\n", "cp1252"),
        ("Spannung;5;N/mm²\n", "cp1252"),
        ("Tensión máxima;5\n", "cp1252"),
        ("Šířka vzorek tloušťka;5\n", "cp1250"),
        ("试样;时间;力\n", "gbk"),
        ("試験力;変位\n", "cp932"),
        ("하중;변위;시간\n", "cp949"),
        ("Нагрузка;время\n", "cp1251"),
        ("Extensión;Número\n", "mac_roman"),
    ],
)
def test_words_tell_code_pages(text: str, name: str) -> None:
    found = decoded(FILE, text.encode(name))
    assert (found.encoding, found.data.decode(), found.doubt) == (name, text, None)


def test_no_word_is_a_doubt_not_an_error() -> None:
    found = decoded(FILE, b"1,2\n\xc4\xd6x,5\n")
    assert found.encoding == "cp1252" and found.doubt is not None and "--encoding settles it" in found.doubt


@pytest.mark.parametrize("name", ["utf-8", "utf-16", "utf-16-le"])
def test_a_last_character_that_was_cut_is_left_out(name: str) -> None:
    found = decoded(FILE, (POLISH + "ąę").encode(name)[:-1])
    assert found.data.decode() == POLISH + "ą"


def test_damage_in_the_middle_is_not_hidden() -> None:
    with pytest.raises(InputError, match="line 1: not utf-16 text"):
        decoded(FILE, POLISH.encode("utf-16")[:20] + b"\x00\xd8" * 9 + POLISH.encode("utf-16")[20:])


def test_numbers_that_look_like_wide_text_are_none() -> None:
    assert unicode_encoding(b"12,3\n4,5\n") is None
    assert unicode_encoding(b"\x00\x00\x00\x00") is None
    assert unicode_encoding("1,2".encode("utf-16-be")) == "utf-16-be"


@pytest.mark.parametrize(
    ("head", "words"),
    [
        (b"PK\x03\x04", "an Excel file or a zip archive"),
        (b"\x89HDF\r\n", "an HDF5 file"),
        (b"....ftypmp42", "a video"),
        (b"\xef\xbb\xbf <HTML>", "a web page"),
    ],
)
def test_what_is_no_text(head: bytes, words: str) -> None:
    with pytest.raises(InputError, match=f"this is {words}, not a text table"):
        check_text(FILE, head)
