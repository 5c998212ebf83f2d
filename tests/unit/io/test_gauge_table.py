"""Tables of gauge readings: units, order, and what is refused."""

import math
from pathlib import Path

import pytest

from benchlab.errors import InputError
from benchlab.io.gauge_table import read_gauge_table


def test_kPa_become_MPa_and_the_order_says_what_was_rising(tmp_path: Path) -> None:
    path = tmp_path / "readings.csv"
    path.write_text("volts,pressure_kPa,monitor_V\n1.0,96,1.8\n2.0,192.5,\n1.0,97,1.81\n")
    readings = read_gauge_table(path)
    assert [r.pressure_MPa for r in readings] == [0.096, 0.1925, 0.097]
    assert [r.rising for r in readings] == [True, True, False]
    assert readings[0].monitor_V == 1.8 and math.isnan(readings[1].monitor_V)


def test_a_german_spreadsheet(tmp_path: Path) -> None:
    path = tmp_path / "readings.csv"
    path.write_bytes("Spannung [V];Druck [bar]\r\n1,0;0,96\r\n2,0;1,92\r\n".encode("utf-16"))
    assert [r.pressure_MPa for r in read_gauge_table(path)] == pytest.approx([0.096, 0.192])


@pytest.mark.parametrize(
    ("text", "named"),
    [
        ("volts,pressure\n1,2\n", "no unit"),
        ("pressure_kPa,monitor_V\n1,2\n", "no column of volts"),
        ("volts,pressure_kPa,pressure_bar\n1,2,3\n", "two columns of pressure"),
        ("volts,pressure_kPa,colour\n1,2,3\n", "unknown"),
        ("volts,pressure_kPa\n1,\n", "line 2"),
        ("volts,pressure_kPa\n1,x\n", "not a number"),
        ("volts,pressure_kPa\n1000,96\n", "volts go from"),
        ("volts,pressure_N\n1,96\n", "not a unit of pressure"),
    ],
)
def test_what_is_no_table_of_readings_is_refused(tmp_path: Path, text: str, named: str) -> None:
    path = tmp_path / "readings.csv"
    path.write_text(text)
    with pytest.raises(InputError, match=named):
        read_gauge_table(path)
