"""Tensile files as machines and spreadsheets write them: one test written many ways is one test; refusals; real files."""

from pathlib import Path

import numpy as np
import pytest

from benchlab.errors import BenchlabError, InputError, UsageError
from benchlab.io.tensile import SpecimenSize, read_tensile

SIZE = SpecimenSize(2.0, 10.0, 50.0)
EXTENSION_MM = np.array([0.0, 5.0, 10.0, 20.0, 30.0, 40.0, 50.0])
FORCE_N = np.array([0.0, 2.5, 4.5, 8.0, 11.0, 1013.5, 1016.25])
STRETCH, STRESS = 1 + EXTENSION_MM / 50, FORCE_N / 20


def table(*columns: np.ndarray, delimiter: str = ",", quote: str = "", comma: bool = False, digits: int = 5) -> str:
    def cell(value: float) -> str:
        text = f"{value:.{digits}f}"
        return quote + (text.replace(".", ",") if comma else text) + quote

    return "".join(delimiter.join(map(cell, row)) + "\n" for row in zip(*columns))


TIME = np.arange(7) / 10
BLUEHILL = 'General : Date,"1/2/2020, 5 PM"\nSpecimen : Thickness,"2.00000",mm\nSpecimen : Width,"10.00000",mm\nLength,"50.0",mm\n\n'
GERMAN = 'Texteingaben : Probe;"x"\n\nZeit;Traversenweg;Last\n(sec);(mm);(kN)\n'
WAYS = {
    "bluehill": (BLUEHILL + "Time,Extension,Load\n(s),(mm),(N)\n" + table(TIME, EXTENSION_MM, FORCE_N, quote='"'), None),
    "thousands": ("Extension,Load\n(mm),(N)\n" + table(EXTENSION_MM, FORCE_N, quote='"').replace('"1013.', '"1,013.'), None),
    "german": (GERMAN + table(TIME, EXTENSION_MM, FORCE_N / 1000, delimiter=";", comma=True, digits=7), None),
    "imperial": ("Extension (in),Load (lbf)\n" + table(EXTENSION_MM / 25.4, FORCE_N / 4.4482216152605, digits=12), None),
    "kgf": ("Extensión,Carga\n(mm),(kgf)\n" + table(EXTENSION_MM, FORCE_N / 9.80665, digits=12), None),
    "stretch": ("stretch,stress_MPa\n" + table(STRETCH, STRESS), None),
    "percent": ("Time;Tensile strain (%);Tensile stress (kPa)\n" + table(TIME, 100 * STRETCH - 100, 1000 * STRESS, delimiter=";"), None),
    "ratio": ("Tensile strain,Tensile stress\n(mm/mm),(N/mm^2)\n" + table(STRETCH - 1, STRESS), None),
    "blanks": (table(STRESS, STRETCH, delimiter="   "), "stress_MPa,stretch"),
    "headless": (table(FORCE_N, TIME, EXTENSION_MM, delimiter="\t"), "force_N,-,extension_mm"),
    "unnamed": ("Stretch,Stress\n" + table(STRETCH, STRESS), "stretch,stress_MPa"),
}  # fmt: skip


@pytest.mark.parametrize("encoding", ["utf-8", "utf-8-sig", "utf-16", "latin-1"])
@pytest.mark.parametrize("way", WAYS)
def test_one_test_written_many_ways_is_one_test(tmp_path: Path, way: str, encoding: str) -> None:
    text, columns = WAYS[way]
    path = tmp_path / "a.csv"
    path.write_bytes(text.replace("\n", "\r\n").encode(encoding))
    test = read_tensile(path, SpecimenSize() if way == "bluehill" else SIZE, columns)
    np.testing.assert_allclose(test.stretch, STRETCH, atol=1e-6)
    np.testing.assert_allclose(test.stress_MPa, STRESS, atol=1e-6)


def test_the_size_in_the_file_is_said_and_options_go_before_it(tmp_path: Path) -> None:
    path = tmp_path / "a.csv"
    path.write_text(WAYS["bluehill"][0])
    assert "from the file: gauge 50 mm, thickness 2 mm, width 10 mm" in read_tensile(path).notes
    assert read_tensile(path, SpecimenSize(4.0)).stress_MPa[1] == pytest.approx(STRESS[1] / 2)


def test_true_stress_becomes_nominal_and_true_strain_a_stretch(tmp_path: Path) -> None:
    path = tmp_path / "a.csv"
    head = "True Strain;True Stress (MPa);Engineering Strain;Engineering Stress (MPa)\n"
    path.write_text(head + table(np.log(STRETCH), STRESS * STRETCH, STRETCH - 1, STRESS, delimiter=";", digits=9))
    for true in (False, True):
        test = read_tensile(path, true_stress=true)
        np.testing.assert_allclose(test.stretch, STRETCH, atol=1e-8)
        np.testing.assert_allclose(test.stress_MPa, STRESS, atol=1e-7)
        assert ("true stress, divided by the stretch" in test.notes[-1]) == true
    only = tmp_path / "b.csv"
    only.write_text("strain,True stress (MPa)\n" + table(STRETCH - 1, STRESS * STRETCH))
    with pytest.raises(UsageError, match="--stress true"):
        read_tensile(only)


def test_options_of_length_choose_between_strain_and_extension(tmp_path: Path) -> None:
    path = tmp_path / "a.csv"
    path.write_text("Extension,Strain 1,Stress\n(mm),(%),(MPa)\n" + table(EXTENSION_MM, 90 * (STRETCH - 1), STRESS))
    assert read_tensile(path).stretch[-1] == pytest.approx(1.9)
    assert read_tensile(path, SpecimenSize(gauge_mm=50)).stretch[-1] == pytest.approx(2.0)


def test_rows_that_are_cut_or_empty_are_left_out_and_said(tmp_path: Path) -> None:
    path = tmp_path / "a.csv"
    path.write_text("stretch,x,stress_MPa\n" + table(STRETCH, STRETCH, STRESS) + "2.1,2.1,\n2.2,2")
    test = read_tensile(path)
    assert len(test.stretch) == 7
    assert test.notes[:2] == (
        "the last row (line 10) is cut and was left out",
        "1 rows with an empty cell are left out",
    )


GOOD = "stretch,stress_MPa\n" + table(STRETCH, STRESS)
MIXED = "stretch;stress_MPa\n1,000;0,1\n1.1;0,2\n" + table(STRETCH, STRESS, delimiter=";", comma=True)
TRIPLES = "stretch;stress_MPa\n" + table(STRETCH, STRESS + 1, delimiter=";", comma=True, digits=3)


@pytest.mark.parametrize(
    ("text", "options", "words"),
    [
        ("Extension (mm),Load (N)\n" + table(EXTENSION_MM, FORCE_N), {"size": SpecimenSize(2, 10)}, "give --gauge-mm"),
        ("Extension (mm),Load (N)\n" + table(EXTENSION_MM, FORCE_N), {"size": SpecimenSize(gauge_mm=9)}, "give --thickness-mm and --width"),
        (table(STRETCH, STRESS), {}, "2 columns without names or units; say what"),
        ("Stretch,Stress\n" + table(STRETCH, STRESS), {}, "no columns of .*it has Stretch, Stress; say what"),
        (GOOD, {"columns": "stretch"}, "names 1 columns, the table has 2"),
        (GOOD, {"columns": "stretch,load"}, "'load' is not a column"),
        (GOOD, {"columns": "stretch,stress"}, "'stress' is not a column"),
        (GOOD, {"columns": "stretch,-"}, "names no stress, force"),
        (GOOD.replace("stress", "Flexure stress"), {}, "not a tensile test"),
        ("e (mm),d (mm),f (MPa)\n" + table(STRETCH, STRETCH, STRESS), {"size": SIZE}, "2 columns of extension: 'e .* choose with"),
        (GOOD.replace("1.20000,0.22500", "1.20000,Overload"), {}, r"line 4: 'Overload' is not a number"),
        (GOOD + "\nstretch,stress_MPa\n" + table(STRETCH, STRESS), {}, "2 tables of numbers .from lines 2, 11"),
        (GOOD.replace("1.20000,0.22500", "1.20000,0,22500"), {}, "line 4: row has 3 fields"),
        (MIXED, {}, "decimal points .* and decimal commas"),
        (TRIPLES, {}, "line 2: '1,000' could be 1.000 or 1000; .* for decimals or for thousands"),
        ("a,b\n1,2\n", {}, "1 rows of numbers"),
        ("only words\n", {}, "no data rows: no line with two numbers in it"),
        ("", {}, "empty file"),
        ("PK\x03\x04", {}, "an Excel file"),
    ],
)  # fmt: skip
def test_refusals_say_the_remedy(tmp_path: Path, text: str, options: dict, words: str) -> None:
    path = tmp_path / "a.csv"
    path.write_text(text)
    with pytest.raises(BenchlabError, match=words) as caught:
        read_tensile(path, **options)
    assert "\n" not in str(caught.value)


def test_a_size_must_be_positive() -> None:
    with pytest.raises(UsageError, match="--gauge-mm is 0"):
        SpecimenSize(gauge_mm=0)


REAL = {  # rows, stretch at the end, nominal stress at the end (MPa), by hand from the first and last lines of the files
    "materials/TRACER*": (None, "stretch,stress_MPa", 21, 7.512, 5.5639),
    "materials/*Meunier*": (None, "stress_MPa,stretch", 33, 2.17, 0.7972),
    "materials/*Ecoflex*": (None, None, 705, 17.06818, 1.35949),
    "materials/*RUN_2*": (SpecimenSize(3, 13, 100), "extension_mm,force_N", 1000, 6.93, 96.3 / 39),
    "materials/*RUN_3*": (SpecimenSize(3, 13, 100), "force_N,extension_mm", 64126, 7.66, 108 / 39),
    "instron/AS627*": (SpecimenSize(1, 1, 50), None, 202, 1 + 6.67 / 50, 22370),
    "instron/Aschen*": (SpecimenSize(1, 1, 50), None, 1983, None, None),
    "instron/*VHB*": (SpecimenSize(1, 1, 50), None, 1007, None, None),
    "instron/luk*": (SpecimenSize(1, 1, 25), None, 460, None, None),
    "instron/zeus*": (SpecimenSize(1, 10, 100), None, 40625, 1 + 338.53391 / 100, 26.23922 * 9.80665 / 10),
    "instron/*taco_test*": (SpecimenSize(1, 1, 100), None, 465, 1.5324432, 621.70209),
}


@pytest.mark.parametrize("pattern", REAL)
def test_real_files(real_folder: Path, pattern: str) -> None:
    size, columns, rows, stretch, stress = REAL[pattern]
    (path,) = real_folder.glob(pattern)
    test = read_tensile(path, size, columns)
    assert len(test.stretch) == rows
    if stretch is not None:
        assert (test.stretch[-1], test.stress_MPa[-1]) == pytest.approx((stretch, stress), rel=1e-6)


@pytest.mark.parametrize(
    ("pattern", "words"),
    [("aznxed*", "line 1: no row of numbers"), ("DVLevine*", "not a tensile test"), ("xjill*", "4 tables")],
)
def test_real_files_that_are_refused(real_folder: Path, pattern: str, words: str) -> None:
    (path,) = (real_folder / "instron").glob(pattern)
    with pytest.raises(InputError, match=words):
        read_tensile(path, SIZE)
