"""Tables as values: held, passed on the way up, not reached, or stated."""

import math
from pathlib import Path

import numpy as np
import pytest

from benchlab.workflows.study_readings import Readings, Target, read_table

TARGET = Target.of(0.3, 0.003)


def read(folder: Path, text: str, target: Target = TARGET) -> Readings:
    (folder / "t.csv").write_text(text)
    return read_table(folder / "t.csv", "d", "s1", target)


def trace(rows: list[tuple[float, float]]) -> str:
    return "pressure_MPa,angle_deg\n" + "".join(f"{p},{a}\n" for p, a in rows)


def test_a_held_pressure_gives_the_mean_over_the_hold(tmp_path: Path) -> None:
    found = read(tmp_path, trace([(0, 0), (0.15, 30), (0.299, 58), (0.3, 60), (0.301, 62), (0, 5)]))
    (cycle,) = found.cycles
    assert (cycle.cycle, cycle.angle_deg, cycle.method, cycle.peak_MPa) == (1, 60, "held", 0.301)
    assert found.curve_deg[0] == 0 and found.curve_deg[-1] == 60
    assert np.interp(0.075, TARGET.curve_MPa, found.curve_deg) == pytest.approx(15, abs=0.5)


def test_a_passed_pressure_is_interpolated_on_the_way_up_alone(tmp_path: Path) -> None:
    found = read(tmp_path, trace([(0, 0), (0.2, 40), (0.4, 80), (0.2, 50), (0, 9)]))
    assert [(c.angle_deg, c.method) for c in found.cycles] == [(60, "interpolated")]


def test_several_cycles_in_one_trace_and_as_stated(tmp_path: Path) -> None:
    one, two = (
        [(0, 0), (0.15, 30), (0.3, 60), (0.3, 60), (0.3, 60)],
        [(0, 4), (0.15, 34), (0.3, 64), (0.3, 64), (0.3, 64)],
    )
    found = read(tmp_path, trace([*one, *two]))
    assert [(c.cycle, c.angle_deg) for c in found.cycles] == [(1, 60), (2, 64)]
    rows = "".join(f"{n},{p},{a}\n" for n, part in ((7, one), (8, two)) for p, a in part)
    stated = read(tmp_path, "cycle,pressure_MPa,angle_deg\n" + rows)
    assert [(c.cycle, c.angle_deg) for c in stated.cycles] == [(7, 60), (8, 64)]
    np.testing.assert_allclose(stated.curve_deg, found.curve_deg, atol=1e-9)


def test_a_pressure_that_is_not_reached_gives_no_value_and_says_so(tmp_path: Path) -> None:
    (cycle,) = read(tmp_path, trace([(0, 0), (0.25, 50), (0, 0)])).cycles
    assert math.isnan(cycle.angle_deg) and "does not reach 0.3 MPa" in cycle.flag
    (cycle,) = read(tmp_path, trace([(0, 0), (0.1, 50), (0, 0)])).cycles
    assert math.isnan(cycle.angle_deg) and "reaches 0.1 MPa at most" in cycle.flag
    one, two = [(0, 0), (0.3, 60), (0.3, 60), (0.3, 60)], [(0, 0), (0.25, 50)]
    first, second = read(tmp_path, trace([*one, *two])).cycles
    assert first.angle_deg == 60 and math.isnan(second.angle_deg)


def test_without_a_pressure_rows_are_cycles_as_stated(tmp_path: Path) -> None:
    found = read(tmp_path, "angle_deg,angle_sd_deg\n50,0.1\n,0.1\n52,0.2\n")
    assert [(c.cycle, c.angle_sd_deg, c.method, c.flag) for c in found.cycles if c.known] == [
        (1, 0.1, "table", ""), (3, 0.2, "table", ""),
    ]  # fmt: skip
    assert found.cycles[1].flag == "no angle in the table"
    assert np.isnan(found.curve_deg).all()


def test_a_table_of_frames_uses_sure_frames_and_says_where_it_could_not(tmp_path: Path) -> None:
    head = "frame,time_s,angle_deg,angle_sd_deg,curvature_per_mm,curvature_sd_per_mm,radius_mm,n_markers,fit_rms_px,pressure_MPa,flag\n"
    rows = [
        (0, 0, 0, ""),
        (1, 0.15, 30, ""),
        (2, 0.3, 60, ""),
        (3, 0.3, 60, ""),
        (4, 0.3, 90, "poor fit"),
        (5, 0.3, 60, "markers left out"),
    ]
    text = head + "".join(f"{i},{i / 30},{a},0.1,0,0,0,7,0.1,{p},{flag}\n" for i, p, a, flag in rows)
    (cycle,) = read(tmp_path, text).cycles
    assert (cycle.angle_deg, cycle.flag, cycle.method) == (60, "", "held")
    text = head + "".join(
        f"{i},{i / 30},{a},0.1,0,0,0,7,0.1,{p},{'poor fit' if p == 0.3 else ''}\n" for i, p, a, _ in rows
    )
    (cycle,) = read(tmp_path, text).cycles
    assert (cycle.angle_deg, cycle.flag) == (67.5, "poor fit")
    (cycle,) = read(
        tmp_path,
        text.replace(",pressure_MPa", "")
        .replace("7,0.1,0.3,", "7,0.1,")
        .replace("7,0.1,0.15,", "7,0.1,")
        .replace("7,0.1,0,", "7,0.1,"),
    ).cycles
    assert cycle.flag == "its pressure is not known"
