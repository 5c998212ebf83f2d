"""Bench files: what is written reads back; what would make pressure out of a mistake is refused."""

import datetime
import math
from dataclasses import replace
from pathlib import Path

import pytest

from benchlab.bench import Bench, Line
from benchlab.errors import InputError, UsageError
from benchlab.io.bench_file import (
    BenchFile,
    GaugeReading,
    calibration_warnings,
    is_simulated,
    read_bench,
    read_bench_file,
    write_bench,
    write_bench_file,
)

BENCH = Bench(
    "left bench",
    Line(0.0962, -0.0004, 0.0005),
    Line(0.12, -0.121, 0.001),
    Line(41.5, -60.2, 0.8),
    limit_MPa=0.30,
    supply_V=4.93,
    reference_counts=228.4,
    gauge="WIKA CPG1500, 0 to 10 bar",
    date="2026-05-31",
    calibrated=True,
)
READINGS = tuple(
    GaugeReading(volts, 0.0962 * volts - 0.0004, (0.0962 * volts + 0.1206) / 0.12, rising)
    for volts, rising in ((0.5, True), (1.5, True), (3.0, True), (1.5, False))
)
TEXT = """name: left bench
date: '2026-05-31'
gauge: WIKA CPG1500
supply_V: 5.0
regulator: {gain_MPa_per_V: 0.096, offset_MPa: 0.0}
"""


def test_what_is_written_reads_back(tmp_path: Path) -> None:
    path = tmp_path / "bench.yaml"
    file = BenchFile(BENCH, READINGS, "run 12, video")
    write_bench_file(path, file, "made by a test")
    assert read_bench_file(path) == file
    assert read_bench(path) == BENCH
    write_bench(path, BENCH)
    assert read_bench(path) == BENCH


def test_without_monitor_flex_readings_and_sd(tmp_path: Path) -> None:
    path = tmp_path / "bench.yaml"
    path.write_text(TEXT)
    bench = read_bench(path)
    assert bench.calibrated and bench.monitor is None and bench.flex is None and math.isnan(bench.regulator.sd)
    assert bench.limit_MPa == 0.35 and bench.ceiling_code == 2986 and bench.reference_counts is None
    write_bench(path, bench)
    assert read_bench(path).regulator.gain == 0.096 and math.isnan(read_bench(path).regulator.sd)


def test_no_file_is_a_bench_that_nobody_calibrated() -> None:
    assert not read_bench(None).calibrated
    assert read_bench(None).ceiling_MPa < 0.35


@pytest.mark.parametrize(
    ("old", "new", "line", "named"),
    [
        ("gain_MPa_per_V", "gain_kPa_per_V", "line 5", "unknown key"),
        ("0.096", "96.0", "left bench", "gain"),
        ("0.096", "-0.096", "left bench", "gain"),
        ("0.096", ".nan", "line 5", "finite number"),
        ("supply_V: 5.0", "supply_V: 3.3", "left bench", "supply_V"),
        ("supply_V: 5.0", "supply_V: five", "line 4", "supply_V"),
        ("supply_V: 5.0", "supply_V: 5.0\nreference_counts: 120.0", "left bench", "reference_counts"),
        ("supply_V: 5.0", "supply_V: 4.5\nreference_counts: 225.0", "left bench", "reference_counts"),
        ("supply_V: 5.0\n", "", "", "supply_V"),
        ("gauge: WIKA CPG1500\n", "", "", "gauge"),
        ("'2026-05-31'", "'31.05.2026'", "", "2026-05-31"),
        ("'2026-05-31'", "2026-05-31", "line 2", "quote it"),
        ("'2026-05-31'", "'2026-02-30'", "", "date"),
        ("supply_V: 5.0", "supply_V: 5.0\nlimit_MPa: 35", "left bench", "limit_MPa"),
        ("supply_V: 5.0", "supply_V: 5.0\nsupply_V: 4.0", "line 5", "duplicate"),
        ("supply_V: 5.0", "supply_V: 5.0\nflex: {gain_deg_per_V: 1.0, offset_deg: 0.0}", "line 5", "from"),
    ],
)
def test_mistakes_are_refused_with_their_place(tmp_path: Path, old: str, new: str, line: str, named: str) -> None:
    path = tmp_path / "bench.yaml"
    assert old in TEXT
    path.write_text(TEXT.replace(old, new))
    with pytest.raises(InputError) as refused:
        read_bench(path)
    assert str(path) in str(refused.value) and line in str(refused.value) and named in str(refused.value)


@pytest.mark.parametrize(("old", "new"), [("0.0962", "0.0862"), ("0.12\n", "0.11\n")], ids=["regulator", "monitor"])
def test_a_line_that_was_edited_does_not_go_through_its_readings(tmp_path: Path, old: str, new: str) -> None:
    path = tmp_path / "bench.yaml"
    write_bench_file(path, BenchFile(replace(BENCH, flex=None), READINGS))
    assert path.read_text().count(f"gain_MPa_per_V: {old}") == 1
    path.write_text(path.read_text().replace(f"gain_MPa_per_V: {old}", f"gain_MPa_per_V: {new}"))
    with pytest.raises(InputError, match="edited by hand"):
        read_bench(path)


def test_an_uncalibrated_bench_has_no_file(tmp_path: Path) -> None:
    with pytest.raises(ValueError, match="without a calibration"):
        write_bench(tmp_path / "bench.yaml", Bench("new"))
    assert not list(tmp_path.iterdir())
    with pytest.raises(UsageError, match="no such file"):
        read_bench(tmp_path / "bench.yaml")


@pytest.mark.parametrize(
    ("date", "told"),
    [
        ("2026-05-31", ""),
        ("2025-06-02", ""),
        ("2025-05-30", "366 days ago"),
        ("2026-06-02", "in the future"),
        ("", "when"),
    ],
)
def test_the_age_of_a_calibration_is_told(date: str, told: str) -> None:
    warnings = calibration_warnings(replace(BENCH, date=date), datetime.date(2026, 5, 31))
    assert [told in w for w in warnings] == ([True] if told else [])


def test_no_calibration_is_told_with_what_it_costs() -> None:
    assert "0.333 MPa" in calibration_warnings(Bench("new"), datetime.date(2026, 5, 31))[0]


def test_a_twin_s_calibration_is_known_by_its_gauge() -> None:
    assert is_simulated(replace(BENCH, gauge="simulated gauge of the twin")) and not is_simulated(BENCH)
