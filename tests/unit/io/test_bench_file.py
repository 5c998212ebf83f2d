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
    calibration_warnings,
    is_simulated,
    read_bench,
    read_bench_file,
    write_bench_file,
)
from tests.benches import readings_of, write_bench

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
READINGS = readings_of(BENCH)
TEXT = """name: left bench
date: '2026-05-31'
gauge: WIKA CPG1500
supply_V: 5.0
regulator: {gain_MPa_per_V: 0.096, offset_MPa: 0.0}
readings:
- {volts: 0.5, pressure_MPa: 0.048}
- {volts: 1.0, pressure_MPa: 0.096}
- {volts: 2.0, pressure_MPa: 0.192}
- {volts: 3.0, pressure_MPa: 0.288}
"""
BY_HAND = """name: left bench
date: '2026-05-31'
source: data sheet of the ITV1030
supply_V: 5.0
regulator: {gain_MPa_per_V: 0.1, offset_MPa: 0.0}
"""


def test_what_is_written_reads_back(tmp_path: Path) -> None:
    path = tmp_path / "bench.yaml"
    file = BenchFile(BENCH, READINGS, "run 12, video")
    write_bench_file(path, file, "made by a test")
    assert read_bench_file(path) == file
    assert read_bench(path) == BENCH
    write_bench(path, BENCH)
    assert read_bench(path) == BENCH


def test_without_monitor_flex_and_sd(tmp_path: Path) -> None:
    path = tmp_path / "bench.yaml"
    path.write_text(TEXT)
    bench = read_bench(path)
    assert bench.calibrated and bench.monitor is None and bench.flex is None and math.isnan(bench.regulator.sd)
    assert bench.limit_MPa == 0.35 and bench.ceiling_code == 2986 and bench.reference_counts is None
    write_bench(path, bench)
    assert read_bench(path).regulator.gain == 0.096 and math.isnan(read_bench(path).regulator.sd)


EDITED = [
    ("gain_MPa_per_V: 0.096", "gain_MPa_per_V: 0.07, sd_MPa: 1", "give 0.005 or less"),
    ("gain_MPa_per_V: 0.096", "gain_MPa_per_V: 0.09, sd_MPa: 0.005", "edited by hand"),
    ("gain_MPa_per_V: 0.096", "gain_MPa_per_V: 0.05", "label"),
    ("offset_MPa: 0.0", "offset_MPa: -0.001", "edited by hand"),
    ("- {volts: 3.0, pressure_MPa: 0.288}\n", "", "too few"),
    ("supply_V: 5.0", "supply_V: 5.0\nlimit_MPa: 0.4", "limit_reason"),
    ("supply_V: 5.0", "supply_V: 5.0\nlimit_MPa: 0.6\nlimit_reason: stronger", "full_scale_MPa"),
    ("supply_V: 5.0", "supply_V: 5.0\nfull_scale_MPa: 0.9", "label"),
    ("supply_V: 5.0", "supply_V: 5.0\nsource: data sheet", "both"),
    ("pressure_MPa: 0.288", "pressure_MPa: 0.2", "edited|R²|others"),
]


@pytest.mark.parametrize(("old", "new", "named"), EDITED)
def test_what_was_edited_is_refused_whatever_the_file_says_of_itself(
    tmp_path: Path, old: str, new: str, named: str
) -> None:
    path = tmp_path / "bench.yaml"
    assert TEXT.count(old) == 1
    path.write_text(TEXT.replace(old, new))
    with pytest.raises(InputError, match=named) as refused:
        read_bench(path)
    assert "take the readings out" not in str(refused.value)


def test_readings_may_not_be_taken_out(tmp_path: Path) -> None:
    path = tmp_path / "bench.yaml"
    path.write_text(TEXT.partition("readings")[0])
    with pytest.raises(InputError, match="no `readings`"):
        read_bench(path)


def test_a_line_that_was_not_measured_says_its_source_and_is_not_calibrated(tmp_path: Path) -> None:
    path = tmp_path / "bench.yaml"
    path.write_text(BY_HAND)
    bench = read_bench(path)
    assert not bench.calibrated and bench.ceiling_MPa < 0.33
    (told,) = calibration_warnings(bench, datetime.date(2026, 5, 31))
    assert "'data sheet of the ITV1030', not measured" in told
    write_bench_file(path, BenchFile(bench))
    assert read_bench(path) == bench


def test_a_supply_that_was_edited_is_not_the_one_of_the_readings(tmp_path: Path) -> None:
    path = tmp_path / "bench.yaml"
    write_bench(path, replace(BENCH, reference_counts=None))
    path.write_text(path.read_text().replace("supply_V: 4.93", "supply_V: 4.7"))
    with pytest.raises(InputError, match=r"4\.930 V of supply"):
        read_bench(path)


def test_a_limit_above_the_papers_is_told_with_its_reason(tmp_path: Path) -> None:
    path = tmp_path / "bench.yaml"
    write_bench(path, replace(BENCH, limit_MPa=0.4, limit_reason="three layers of film"))
    (told,) = calibration_warnings(read_bench(path), datetime.date(2026, 5, 31))
    assert "LIMIT 0.4 MPa" in told and "three layers of film" in told


def test_no_file_is_a_bench_that_nobody_calibrated() -> None:
    assert not read_bench(None).calibrated
    assert read_bench(None).ceiling_MPa < 0.35


@pytest.mark.parametrize(
    ("old", "new", "line", "named"),
    [
        ("gain_MPa_per_V", "gain_kPa_per_V", "line 5", "unknown key"),
        ("gain_MPa_per_V: 0.096", "gain_MPa_per_V: 96.0", "line 5, left bench", "gain"),
        ("gain_MPa_per_V: 0.096", "gain_MPa_per_V: -0.096", "left bench", "gain"),
        ("gain_MPa_per_V: 0.096", "gain_MPa_per_V: .nan", "line 5", "finite number"),
        ("supply_V: 5.0", "supply_V: 3.3", "line 4, left bench", "supply_V"),
        ("supply_V: 5.0", "supply_V: five", "line 4", "supply_V"),
        ("supply_V: 5.0", "supply_V: 5.0\nreference_counts: 120.0", "left bench", "reference_counts"),
        ("supply_V: 5.0", "supply_V: 4.5\nreference_counts: 225.0", "left bench", "reference_counts"),
        ("supply_V: 5.0\n", "", "", "supply_V"),
        ("gauge: WIKA CPG1500\n", "", "", "gauge"),
        ("'2026-05-31'", "'31.05.2026'", "", "2026-05-31"),
        ("'2026-05-31'", "2026-05-31", "line 2", "quote it"),
        ("'2026-05-31'", "'2026-02-30'", "line 2", "date"),
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


@pytest.mark.parametrize(("old", "new"), [("0.0962", "0.0932"), ("0.12\n", "0.11\n")], ids=["regulator", "monitor"])
def test_a_line_that_was_edited_does_not_go_through_its_readings(tmp_path: Path, old: str, new: str) -> None:
    path = tmp_path / "bench.yaml"
    write_bench_file(path, BenchFile(replace(BENCH, flex=None), READINGS))
    assert path.read_text().count(f"gain_MPa_per_V: {old}") == 1
    path.write_text(path.read_text().replace(f"gain_MPa_per_V: {old}", f"gain_MPa_per_V: {new}"))
    with pytest.raises(InputError, match="edited by hand"):
        read_bench(path)


def test_an_uncalibrated_bench_has_no_file(tmp_path: Path) -> None:
    with pytest.raises(ValueError, match="without readings"):
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
    assert "0.320 MPa" in calibration_warnings(Bench("new"), datetime.date(2026, 5, 31))[0]


def test_a_twin_s_calibration_is_known_by_its_gauge() -> None:
    assert is_simulated(replace(BENCH, gauge="simulated gauge of the twin")) and not is_simulated(BENCH)
