"""One test recorded many ways is one test: languages, encodings, separators, decimal signs, units, preambles."""

from pathlib import Path

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from benchlab.errors import InputError, UsageError
from benchlab.io.machine_export import ExportOptions, read_machine_export
from tests.unit.io.exports import LANGUAGES, LENGTHS, UNITS, check, read, recording

HEAD = "Time,Extension,Load\n(s),(mm),(N)\n"
ROWS = "0.01,1.0,2.5\n0.02,1.1,2.75\n0.03,1.2,3.0\n"


@pytest.mark.parametrize("line_end", ["\n", "\r\n", "\r"])
@pytest.mark.parametrize(("language", "encoding"), [(name, e) for name, made in LANGUAGES.items() for e in made[4]])
def test_languages_and_encodings(tmp_path: Path, language: str, encoding: str, line_end: str) -> None:
    text = recording(language, ";", ",", '"' * (language == "polish")).replace("\n", line_end)
    export = read(tmp_path / "a.csv", text, encoding=encoding)
    check(export)
    assert export.preamble[LANGUAGES[language][3]] == "A1"
    assert LANGUAGES[language][1] in export.inferred["extension_mm"]
    assert not export.warnings


@pytest.mark.parametrize("units", ["row", "header", "none"])
@pytest.mark.parametrize(
    ("separator", "decimal", "quote"),
    [(",", ".", ""), (",", ".", '"'), (",", ",", '"'), (";", ",", ""), (";", ".", ""), ("\t", ",", ""), ("\t", ".", '"'), ("|", ".", "")],
)  # fmt: skip
@pytest.mark.parametrize("preamble", [True, False])
def test_separators_and_signs(
    tmp_path: Path, separator: str, decimal: str, quote: str, units: str, preamble: bool
) -> None:
    text = recording("english", separator, decimal, quote, units, preamble=preamble)
    if units == "none":
        with pytest.raises(UsageError, match="no unit of 'Load'; give --force-unit"):
            read(tmp_path / "a.csv", text)
    export = read(tmp_path / "a.csv", text, ExportOptions(force_unit="N" if units == "none" else None))
    check(export)
    names = {",": "comma", ";": "semicolon", "\t": "tab", "|": "bar"}
    assert export.inferred["separator"] == names[separator]
    assert export.inferred["decimal"] == {".": "point", ",": "comma"}[decimal]
    assert ("a unit that the file does not give" in export.inferred["time_s"]) == (units == "none")
    said = [warning.split(": ")[1].split(";")[0] for warning in export.warnings]
    unknown = ["column 'Time' has no unit and was read in s", "column 'Extension' has no unit and was read in mm"]
    assert said == (unknown if units == "none" else [])


@pytest.mark.parametrize("force", UNITS)
@pytest.mark.parametrize("length", LENGTHS)
@pytest.mark.parametrize("units", ["row", "header"])
def test_units(tmp_path: Path, force: str, length: str, units: str) -> None:
    export = read(tmp_path / "a.csv", recording(units=units, force=force, length=length))
    check(export)
    assert export.inferred["force_N"] == f"column 3, 'Load ({force})', in {force}"


def test_columns_of_blanks(tmp_path: Path) -> None:
    text = recording(separator="  ", units="header", preamble=False).replace(" (", "_").replace(")", "")
    check(read(tmp_path / "a.txt", text))


def test_an_encoding_that_no_word_tells_is_a_warning(tmp_path: Path) -> None:
    path = tmp_path / "a.csv"
    path.write_bytes(b"Kunde,\xc4\xd6 GmbH\n" + (HEAD + ROWS).encode())
    (warning,) = read_machine_export(path).warnings
    assert "read as cp1252, as in 'Kunde,ÄÖ GmbH'; --encoding settles it" in warning
    settled = read_machine_export(path, ExportOptions(encoding="cp1251"))
    assert not settled.warnings and settled.preamble == {"Kunde": "ДЦ GmbH"}
    with pytest.raises(UsageError, match="--encoding: 'klingon' is not known"):
        read_machine_export(path, ExportOptions(encoding="klingon"))
    with pytest.raises(InputError, match="line 1: not utf-8"):
        read_machine_export(path, ExportOptions(encoding="utf-8"))


@settings(
    max_examples=80,
    deadline=None,
    derandomize=True,
    suppress_health_check=[HealthCheck.function_scoped_fixture, HealthCheck.too_slow],
)
@given(
    values=st.lists(st.tuples(*[st.floats(-1e7, 1e7)] * 2), min_size=3, max_size=30),
    separator=st.sampled_from([",", ";", "\t", "|"]),
    comma=st.booleans(),
    quote=st.booleans(),
)
def test_any_numbers_come_back(
    tmp_path: Path, values: list[tuple[float, float]], separator: str, comma: bool, quote: bool
) -> None:
    def cell(value: float) -> str:
        text = f"{value:.17e}".replace(".", "," if comma else ".")
        return f'"{text}"' if quote or (comma and separator == ",") else text

    text = f"Load (N){separator}Extension (mm)\n" + "".join(f"{cell(a)}{separator}{cell(b)}\n" for a, b in values)
    (test,) = read(tmp_path / "a.csv", text).tests
    found = list(zip(test.columns["force_N"].tolist(), test.columns["extension_mm"].tolist()))
    assert found == values
