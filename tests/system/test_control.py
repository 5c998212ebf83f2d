"""`benchlab control` from end to end: the commands of its guide in order, what they find, and what is refused."""

from __future__ import annotations

import csv
import json
import re
import shlex
from dataclasses import replace
from pathlib import Path

import cv2
import numpy as np
import pytest

from benchlab.bench import Bench
from benchlab.cli.app import run
from benchlab.control.pi import PI
from benchlab.devices.twin.bench import twin_bench
from benchlab.devices.twin.twin import Twin
from benchlab.errors import UsageError
from benchlab.io.bench_file import read_bench_file, write_bench_file
from benchlab.io.control_file import ControlFile, read_control
from benchlab.io.drive_file import read_drive_file, write_drive_file
from benchlab.io.twin_file import read_twin
from benchlab.workflows.control_flex import _starts
from benchlab.workflows.driven import read_driven

ROOT = Path(__file__).resolve().parents[2]
GUIDE = (ROOT / "docs" / "control.md").read_text(encoding="utf-8")
COMMANDS = [line for line in "\n".join(re.findall(r"```sh\n(.*?)```", GUIDE, re.DOTALL)).splitlines() if line]


@pytest.fixture(scope="module")
def guided(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The folder of results that the guide's commands leave."""
    folder = tmp_path_factory.mktemp("guide")
    (folder / "results").mkdir()
    with pytest.MonkeyPatch.context() as patch:
        patch.chdir(folder)
        for command in COMMANDS:
            with pytest.raises(SystemExit) as ended:
                run(shlex.split(command)[1:])
            assert ended.value.code == 0, command
    return folder / "results"


def test_the_guide_goes_through_all_three_commands() -> None:
    assert [command for name in ("flex", "tune", "track") for command in COMMANDS if f"control {name}" in command]
    assert len(COMMANDS) == 7


def test_what_was_watched_after_the_vent_is_not_looked_at(guided: Path) -> None:
    run = read_driven(guided / "steps.h5")
    assert len(run.column("time_s")) == run.header["plan"]["ticks"] < len(run.journal.samples)


def test_the_flex_line_is_the_twins(guided: Path) -> None:
    file, true = read_bench_file(guided / "bench.yaml"), twin_bench().flex
    found = file.bench.flex
    assert found is not None and true is not None
    assert found.gain == pytest.approx(true.gain, rel=1e-3) and found.of(2.0) == pytest.approx(true.of(2.0), abs=0.1)
    assert 0.05 < found.sd < 0.3
    assert "flex.h5" in file.flex_from and "simulated" in file.flex_from
    assert file.readings  # those of the regulator are kept
    assert cv2.imread(str(guided / "bench.flex.png")) is not None


def test_gains_keep_their_margins_and_lag_is_that_of_the_twin(guided: Path) -> None:
    control = read_control(guided / "control.yaml")
    assert control.feed_forward and control.rate_Hz == 100 and "steps.h5" in control.source
    assert all(margins.max_sensitivity <= 1.6001 for _, _, margins in control.points)
    assert len(control.points) == 20 and {round(pressure, 4) for pressure, _, _ in control.points} >= {0.0175, 0.3325}
    assert 0.03 < control.lead_s < 0.12  # regulator 0.03 s, the line about as much


def test_the_sine_is_tracked_better_than_in_the_paper(guided: Path) -> None:
    found = json.loads((guided / "sine.tracking.json").read_text(encoding="utf-8"))
    for seen in ("measured", "true"):
        assert found[seen]["r_squared"] > 0.995 and found[seen]["rmse_deg"] < 2.0
    assert found["simulated"] and found["control"]["feed_forward"]
    samples = read_drive_file(guided / "sine.h5").samples
    closed = np.isfinite(samples["reference_deg"]) & (samples["time_s"] >= 10)
    error = (samples["reference_deg"] - samples["angle_deg"])[closed]
    assert found["measured"]["rmse_deg"] == pytest.approx(np.sqrt(np.mean(error**2)), rel=1e-9)
    true_deg = np.genfromtxt(guided / "sine.truth.csv", delimiter=",", names=True, skip_header=1)["angle_deg"]
    off = (samples["reference_deg"] - true_deg)[closed]
    assert found["true"]["rmse_deg"] == pytest.approx(np.sqrt(np.mean(off**2)), rel=1e-4)
    assert cv2.imread(str(guided / "sine.tracking.png")) is not None


def test_what_is_printed(guided: Path, benchlab, tmp_path: Path) -> None:
    tuned = benchlab("control", "tune", guided / "steps.h5", "--out", tmp_path / "c.yaml", "--json")
    assert tuned.code == 0 and "gain margin" in tuned.err and "wrote" in tuned.err
    assert tuned.json["kp_MPa_per_deg"] == pytest.approx(read_control(tmp_path / "c.yaml").kp_MPa_per_deg, rel=1e-5)
    assert tuned.json["feed_forward"] is False and len(tuned.json["plants"]) == 20
    flexed = benchlab(
        "control", "flex", guided / "flex.h5", "--angle", guided / "flex.truth.csv", "--calibration", guided / "bench.yaml",
        "--out", tmp_path / "b.yaml", "--json",
    )  # fmt: skip
    assert flexed.code == 0 and "lack of fit F(" in flexed.err and flexed.json["holds"] == len(flexed.json["points"])
    assert flexed.json["gain_deg_per_V"]["low"] < twin_bench().flex.gain < flexed.json["gain_deg_per_V"]["high"]
    tracked = benchlab("control", "track", guided / "sine.h5", "--out", tmp_path / "t", "--settle-s", 10, "--json")
    assert tracked.code == 0 and tracked.json["true"] is None and "against the flex sensor: R² 0.99" in tracked.err
    assert re.search(r"(late|ahead) by \d+ ms; tip", tracked.err) and "-" not in tracked.err.splitlines()[0]
    assert "offset −66.6" in flexed.err


def test_angles_on_another_clock_are_moved_onto_the_runs(guided: Path, benchlab, tmp_path: Path) -> None:
    """The truth again, as an instrument saw it that was switched on a second late."""
    with (guided / "flex.truth.csv").open(encoding="utf-8") as file:
        assert next(file).startswith("# simulated")
        rows = [(float(row["time_s"]) - 1.0, row["angle_deg"]) for row in csv.DictReader(file)]
    late = tmp_path / "late.csv"
    lines = [f"{time:.4f},{angle}" for time, angle in rows if time > 0]
    late.write_text("\n".join(["time_s,angle_deg", *lines]) + "\n", encoding="utf-8")
    call = ("control", "flex", guided / "flex.h5", "--angle", late, "--calibration", guided / "bench.yaml", "--json")
    right = benchlab(*call, "--out", tmp_path / "right.yaml", "--angle-starts-s", 1)
    assert right.json["gain_deg_per_V"]["value"] == pytest.approx(twin_bench().flex.gain, rel=1e-3)
    assert right.json["angle_starts_by"] == "as told" and right.json["angle_starts_s"] == 1


def test_a_bench_file_of_another_bench_is_told(guided: Path, benchlab, tmp_path: Path) -> None:
    other = tmp_path / "other.yaml"
    file = read_bench_file(guided / "bench.yaml")
    write_bench_file(other, replace(file, bench=replace(file.bench, name="left", flex=None), flex_from=""))
    done = benchlab("control", "flex", guided / "flex.h5", "--angle", guided / "flex.truth.csv", "--calibration", other)
    assert done.code == 0 and "the run was made on bench bench, and the file is of bench left" in done.err


def test_a_flex_line_that_is_replaced_in_place_is_told(guided: Path, benchlab, tmp_path: Path) -> None:
    bench, file = tmp_path / "mine.yaml", read_bench_file(guided / "bench.yaml")
    write_bench_file(bench, replace(file, bench=replace(file.bench, flex=None), flex_from=""))
    call = (
        "control",
        "flex",
        guided / "flex.h5",
        "--angle",
        guided / "flex.truth.csv",
        "--calibration",
        bench,
        "--json",
    )
    first = benchlab(*call)
    assert first.code == 0 and "mine.yaml had no flex line, and has this one now" in first.err
    again = benchlab(*call, "--overwrite")
    assert (
        again.code == 0 and "mine.yaml had 66.67" in again.err and "−66.67" in again.err and "from flex.h5" in again.err
    )
    assert again.json["replaced"]["gain_deg_per_V"] == pytest.approx(first.json["gain_deg_per_V"]["value"], rel=1e-6)
    elsewhere = benchlab(*call, "--out", tmp_path / "other.yaml")
    assert elsewhere.code == 0 and elsewhere.json["replaced"] is None


def test_wrong_input_is_told_before_a_file_that_exists(guided: Path, benchlab, tmp_path: Path) -> None:
    flex = ("control", "flex", guided / "flex.h5", "--calibration", guided / "bench.yaml", "--angle")
    other = benchlab(*flex, guided / "sine.truth.csv")
    assert other.code == 3 and "does not grow with the pressure" in other.err
    track = benchlab("control", "track", guided / "sine.h5", "--out", guided, "--truth", guided / "flex.truth.csv")
    assert track.code == 3 and "is not the truth of sine.h5" in track.err and "give sine.truth.csv" in track.err
    with (guided / "sine.truth.csv").open(encoding="utf-8") as file:
        next(file)
        rows = [(float(row["time_s"]), row["angle_deg"]) for row in csv.DictReader(file)]
    for name, after_s, words in (("late", 0.6, "0.6 s later"), ("short", 0.0, "it covers 58 % of the run's time")):
        kept = rows[: 3001 if name == "short" else None]
        text = "\n".join(["time_s,angle_deg", *(f"{time + after_s:.4f},{angle}" for time, angle in kept)])
        (tmp_path / f"{name}.csv").write_text(text + "\n", encoding="utf-8")
        done = benchlab("control", "track", guided / "sine.h5", "--out", tmp_path, "--truth", tmp_path / f"{name}.csv")
        assert done.code == 3 and words in done.err, done.err


def test_a_film_begins_at_the_one_trigger_of_its_run(guided: Path) -> None:
    run_of = read_driven(guided / "flex.h5")
    (tick,) = [event["tick"] for event in run_of.journal.events if event["kind"] == "trigger"]
    expected = float(run_of.column("time_s")[tick])
    assert _starts(run_of, Path("film.h5"), None) == (expected, "the run's trigger of the camera")
    assert _starts(run_of, Path("film.h5"), 2.5)[0] == 2.5 and _starts(run_of, Path("truth.csv"), None)[0] == 0
    untriggered = replace(run_of, journal=replace(run_of.journal, events=()))
    with pytest.raises(UsageError, match="0 triggers of the camera"):
        _starts(untriggered, Path("film.h5"), None)


def test_what_cannot_work_is_refused_and_nothing_is_written(guided: Path, benchlab, tmp_path: Path) -> None:
    flex = ("control", "flex", guided / "flex.h5", "--calibration", guided / "bench.yaml", "--angle")
    again = benchlab(*flex, guided / "flex.truth.csv")
    assert again.code == 2 and "exists" in again.err and "--overwrite" in again.err
    (guided / "bench.flex.png").rename(guided / "elsewhere.png")
    again = benchlab(*flex, guided / "flex.truth.csv")
    (guided / "elsewhere.png").rename(guided / "bench.flex.png")
    assert again.code == 2 and "bench.yaml: exists" in again.err  # a flex line is not replaced unasked
    none = benchlab(*flex, tmp_path / "no.csv", "--out", tmp_path / "a.yaml")
    assert none.code == 2 and "no such file" in none.err
    wrong = benchlab(*flex, guided / "flex.csv.gz", "--out", tmp_path / "a.yaml")
    assert wrong.code == 2
    open_loop = benchlab("control", "track", guided / "steps.h5", "--out", tmp_path)
    assert open_loop.code == 3 and "no step of this run is closed-loop" in open_loop.err
    closed = benchlab("control", "tune", guided / "sine.h5", "--out", tmp_path / "d.yaml")
    assert closed.code == 3 and "sine.h5" in closed.err
    late = benchlab("control", "track", guided / "sine.h5", "--out", tmp_path, "--settle-s", 1000)
    assert late.code == 3 and "sine.h5" in late.err and "settling" in late.err
    fast = benchlab("control", "tune", guided / "steps.h5", "--out", tmp_path / "d.yaml", "--closed-loop-s", 0.0001)
    assert fast.code == 3 and "gives Ms" in fast.err
    text = benchlab("control", "track", guided / "bench.yaml", "--out", tmp_path)
    assert text.code == 3 and "bench.yaml" in text.err
    assert benchlab("control", "tune", guided / "steps.h5", "--out", tmp_path / "d.txt").code == 2
    for option, value in (("--max-sensitivity", 1), ("--closed-loop-s", -1)):
        done = benchlab("control", "tune", guided / "steps.h5", "--out", tmp_path / "d.yaml", option, value)
        assert done.code == 2 and f"{option} is {value}" in done.err
    for option, value in (("--settle-s", -1), ("--length-mm", 0)):
        done = benchlab("control", "track", guided / "sine.h5", "--out", tmp_path, option, value)
        assert done.code == 2 and f"{option} is {value}" in done.err
    assert not list(tmp_path.iterdir())


def test_a_run_without_flex_line_has_no_angle_to_tune_from(guided: Path, benchlab, tmp_path: Path) -> None:
    journal = read_drive_file(guided / "steps.h5")
    journal.header["bench"]["flex"] = None
    journal.samples["angle_deg"] = np.nan
    write_drive_file(tmp_path / "blind.h5", journal)
    blind = benchlab("control", "tune", tmp_path / "blind.h5", "--out", tmp_path / "c.yaml")
    assert blind.code == 3 and "without a calibrated flex sensor" in blind.err


def test_the_truth_of_a_real_bench_is_not_taken(guided: Path, benchlab, tmp_path: Path) -> None:
    journal = read_drive_file(guided / "sine.h5")
    journal.header["bench_kind"] = "serial"
    journal.header["device"] = {"kind": "serial"}
    write_drive_file(tmp_path / "real.h5", journal)
    done = benchlab("control", "track", tmp_path / "real.h5", "--out", tmp_path, "--truth", guided / "sine.truth.csv")
    assert done.code == 3 and "nobody knows the truth" in done.err
    assert benchlab("control", "track", tmp_path / "real.h5", "--out", tmp_path).code == 0


def test_the_computed_gain_margin_is_that_of_the_twin(guided: Path) -> None:
    """Held at 20°, where the gain is largest, the loop is quiet at 0.85 of its gain margin and swings at 1.25."""
    control, bench = read_control(guided / "control.yaml"), read_bench_file(guided / "bench.yaml").bench
    margin = min(margins.gain_margin for pressure, _, margins in control.points if 0.04 < pressure < 0.07)
    quiet, swinging = (_swing_deg(control, bench, share * margin) for share in (0.85, 1.25))
    assert quiet < 0.5 and swinging > 2.0


def _swing_deg(control: ControlFile, bench: Bench, factor: float) -> float:
    """Standard deviation of the true angle while 20° are held with gains so many times as large."""
    twin = Twin(read_twin(None), bench)
    pi = PI(factor * control.kp_MPa_per_deg, factor * control.ki_MPa_per_deg_s, bench.ceiling_MPa)
    twin.arm()
    pressure, flex = 0.0, bench.flex
    assert flex is not None
    for tick in range(600):
        angle = flex.of(twin.exchange(tick * 0.01, pressure).flex_V)
        reference = min(20.0, 0.1 * tick)
        pressure = pi.pressure_MPa(reference, reference, angle, 0.01)
    return float(twin.truth.angle_deg[400:].std())
