"""Units and the header cells they are written in."""

import doctest

import pytest

import benchlab.units
from benchlab.errors import InputError
from benchlab.units import known_unit, parse_column, to_mm, to_MPa, to_s


def test_the_examples_in_the_docstrings_hold():
    result = doctest.testmod(benchlab.units)
    assert result.attempted == 6
    assert result.failed == 0


@pytest.mark.parametrize(
    ("value", "unit", "expected"),
    [
        (0.35, "MPa", 0.35),
        (350, "kPa", 0.35),
        (350_000, "Pa", 0.35),
        (3500, "hPa", 0.35),
        (3.5, "bar", 0.35),
        (3500, "mbar", 0.35),
        (50.763208, "psi", 0.35),
        (50.763208, "psig", 0.35),
    ],
)
def test_one_pressure_written_eight_ways_is_one_pressure(value, unit, expected):
    assert to_MPa(value, unit) == pytest.approx(expected, rel=1e-8)


def test_powers_of_ten_do_not_round():
    assert float(to_MPa(350, "kPa")) == 0.35
    assert float(to_s(7, "ms")) == 0.007
    assert float(to_mm(12.7, "cm")) == 127.0


def test_arrays_keep_their_shape():
    assert to_MPa([[1.0, 2.0]], "bar").tolist() == [[0.1, 0.2]]


@pytest.mark.parametrize(("convert", "unit"), [(to_MPa, "mm"), (to_MPa, "mPa"), (to_s, "kPa"), (to_mm, "furlong")])
def test_the_wrong_unit_is_refused_and_the_right_ones_named(convert, unit):
    with pytest.raises(InputError, match=r"is not a unit of .*; use one of"):
        convert(1.0, unit)


@pytest.mark.parametrize(
    ("cell", "expected"),
    [
        ("Pressure (kPa)", ("Pressure", "kPa")),
        ("pressure_kPa", ("pressure", "kPa")),
        ("p [bar]", ("p", "bar")),
        ("p{psi}", ("p", "psi")),
        ("t/s", ("t", "s")),
        ("Time ms", ("Time", "ms")),
        ("pressure in MPa", ("pressure", "MPa")),
        ("pressure_in_kPa", ("pressure_in", "kPa")),
        ("Time, min", ("Time", "min")),
        ("  time_s ", ("time", "s")),
        ("PRESSURE_PSI", ("PRESSURE", "psi")),
        ("pressure_mpa", ("pressure", "MPa")),
        ("psi", ("", "psi")),
        ("Pressure", ("Pressure", None)),
        ("Pressure ()", ("Pressure", None)),
        ("Pressure (mmHg)", ("Pressure", "mmHg")),
        ("pressure_mPa", ("pressure_mPa", None)),
        ("Depth [μm]", ("Depth", "µm")),
        ("s", ("s", None)),
        ("", ("", None)),
    ],
)
def test_header_cells(cell, expected):
    assert parse_column(cell) == expected


def test_millipascal_and_megabar_are_not_guessed_at():
    assert known_unit("mPa") is None
    assert known_unit("Mbar") is None
    assert known_unit("S") is None
