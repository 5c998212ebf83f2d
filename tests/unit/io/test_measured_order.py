"""Rows of several runs that nothing tells apart are refused; a clock may be set back a little, and named runs come in any order."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pandas
import pytest

from benchlab.discrepancy.measured import Measured
from benchlab.errors import InputError
from benchlab.io.measured_frame import RunName
from benchlab.io.measured_table import read_measured


def run(seconds: float = 20.0, late_s: float = 0.0, angle: float = 100.0) -> pandas.DataFrame:
    """Up and down in 40 rows."""
    time = np.linspace(0, seconds, 40)
    pressure = 0.35 * (1 - abs(2 * time / seconds - 1))
    return pandas.DataFrame(
        {"design": "a", "time_s": time + late_s, "pressure_MPa": pressure, "angle_deg": angle * pressure}
    )


def read(folder: Path, table: pandas.DataFrame, name: RunName | None = None) -> Measured:
    path = folder / "m.csv"
    table.to_csv(path, index=False)
    found = read_measured([path], named={path: name} if name else None)
    assert isinstance(found, Measured)
    return found


SEVERAL = pandas.concat([run(), run(late_s=0.1, angle=110)])


def test_runs_one_after_the_other_without_a_name_are_refused(tmp_path: Path) -> None:
    with pytest.raises(InputError) as refused:
        read(tmp_path, SEVERAL)
    assert "m.csv, line 42: time of run m of a s1 goes back from 20 s to 0.1 s, 1 time in all" in str(refused.value)
    assert (
        "no column sample and no column run (but time_s, pressure_MPa, angle_deg, design): add it where these are several runs"
        in str(refused.value)
    )


@pytest.mark.parametrize(
    "several", [pandas.concat([run(), run(7, 0.1)]), pandas.concat([run(), run(late_s=0.1, angle=150)])]
)
def test_runs_that_take_turns_in_the_order_of_time_are_refused(tmp_path: Path, several: pandas.DataFrame) -> None:
    """Of two protocols the pressure goes to and fro, of one protocol the angle."""
    with pytest.raises(
        InputError, match=r"(pressure_MPa|angle_deg) of run m of a s1 goes to and fro from row to row .* no column run"
    ):
        read(tmp_path, several.sort_values("time_s").assign(sample="s1"))


def test_rows_that_say_their_run_may_come_in_any_order(tmp_path: Path) -> None:
    named = SEVERAL.assign(sample="s1", run=np.repeat(["r1", "r2"], 40)).sample(frac=1, random_state=1)
    assert [len(one.time_s) for one in read(tmp_path, named).runs] == [40, 40]


def test_time_that_begins_again_within_a_named_run_is_refused(tmp_path: Path) -> None:
    with pytest.raises(InputError, match="does time begin again in each cycle"):
        read(tmp_path, SEVERAL.assign(sample="s1", run="r1"))


@pytest.mark.parametrize("name", [None, RunName("a", "s1")])
def test_a_clock_that_is_set_back_a_little_is_told(tmp_path: Path, name: RunName | None) -> None:
    table = run()
    table.loc[20:, "time_s"] -= 0.6
    (words,) = [words for words in read(tmp_path, table, name).warnings if "time goes back" in words]
    assert words.endswith("in line 22: rows are taken in the order of their time")


def test_a_file_whose_name_says_the_sample_is_one_run_in_any_order(tmp_path: Path) -> None:
    mixed = run().sample(frac=1, random_state=1)
    assert len(read(tmp_path, mixed, RunName("a", "s1")).runs[0].time_s) == 40
    with pytest.raises(InputError, match="give its rows in the order of time"):
        read(tmp_path, mixed)


def test_equal_rows_are_one_run_still(tmp_path: Path) -> None:
    assert len(read(tmp_path, pandas.concat([run(), run()])).runs[0].time_s) == 40


def test_noise_about_a_standstill_is_no_other_run(tmp_path: Path) -> None:
    rng = np.random.default_rng(1)
    for level in (0.0, 0.2):
        still = run().assign(
            pressure_MPa=level + 0.002 * rng.standard_normal(40), angle_deg=10 + rng.standard_normal(40)
        )
        assert len(read(tmp_path, still).runs) == 1


def test_runs_with_equal_times_are_refused_with_the_column_that_is_missing(tmp_path: Path) -> None:
    with pytest.raises(InputError, match=r"two rows with other values at .* there is no column design \(but time_s, "):
        read(tmp_path, pandas.concat([run(), run(angle=150)]).drop(columns="design").assign(sample="s1", run="r1"))
