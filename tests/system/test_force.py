"""`benchlab force` from end to end: the drawn records of sample_data, a real one, and what is refused or doubted."""

from __future__ import annotations

import csv
import json
import re
from pathlib import Path

import cv2
import numpy as np
import pytest

from benchlab.force.synthetic import draw_trace
from benchlab.io.force_file import read_force_file

SAMPLES = Path(__file__).resolve().parents[2] / "sample_data"
FILES = sorted((SAMPLES / "force").glob("*.csv"))
STEPS = ("--steps-MPa", "0.035:0.35:0.035", "--cycles", 5)
LEVELS = np.repeat([0.1, 0.2, 0.3], 2)
THREE = ("--steps-MPa", "0.1,0.2,0.3", "--cycles", 2)


def rows_of(path: Path) -> list[dict[str, str]]:
    with path.open(encoding="utf-8", newline="") as file:
        return list(csv.DictReader(file))


def trace(seed: int = 0, levels: np.ndarray = LEVELS, slope: float = 100.0, **options):
    rng = np.random.default_rng(seed)
    return draw_trace((slope * levels).tolist(), levels.tolist(), rng, noise_N=0.03, rate_Hz=50, **options)


def write(path: Path, columns: dict[str, np.ndarray], preamble: str = "") -> Path:
    rows = "".join(",".join(f"{value:.4f}" for value in row) + "\n" for row in zip(*columns.values()))
    path.write_text(preamble + ",".join(columns) + "\n" + rows)
    return path


def write_force(path: Path, drawn, force: np.ndarray | None = None) -> Path:
    return write(path, {"time_s": drawn.time_s, "force_N": drawn.force_N if force is None else force})


def test_three_drawn_actuators_in_three_dialects_give_the_line_that_they_were_drawn_from(
    tmp_path: Path, benchlab
) -> None:
    done = benchlab("force", *FILES, *STEPS, "--out", tmp_path / "out", "--json")
    assert done.code == 0, done.err
    found = done.json["blocked_force"]
    truth: dict[str, list[float]] = {}
    for row in rows_of(SAMPLES / "truth_force.csv"):
        truth.setdefault(Path(row["file"]).stem, []).append(float(row["peak_N"]))
    names = [path.stem for path in FILES]
    assert found["actuators"] == names == list(truth)
    true = np.array([np.reshape(truth[name], (10, 5)).mean(axis=1) for name in names])
    mean = np.array([[one["mean_N"] for one in row["by_actuator"]] for row in found["pressures"]]).T
    assert np.abs(mean - true).max() < 0.08
    assert [row["pressure_MPa"] for row in found["pressures"]] == pytest.approx(0.035 * np.arange(1, 11))
    assert [row["n"] for row in found["pressures"]] == [3] * 10
    assert found["largest"]["mean_N"] == pytest.approx(true[:, -1].mean(), abs=0.06)
    assert found["largest"]["sd_N"] == pytest.approx(true[:, -1].std(ddof=1), abs=0.06)
    line = found["line"]
    assert line["slope_N_per_MPa"]["low"] < 37.72 / 0.35 < line["slope_N_per_MPa"]["high"]
    assert line["linearity"]["df"] == [8, 16]
    assert line["linearity"]["p"] > 0.05
    assert found["lever_arm_mm"] is None
    assert any("drawn by benchlab, not measured" in text for text in found["origin"])


def test_what_is_written_and_told(tmp_path: Path, benchlab) -> None:
    out = tmp_path / "out"
    done = benchlab("force", *FILES, *STEPS, "--lever-arm-mm", 7.5, "--out", out, "--json")
    assert {path.name for path in out.iterdir()} == {
        *(f"{path.stem}{end}" for path in FILES for end in ("_force.csv", "_force.h5", "_peaks.csv")),
        *(f"blocked_force{end}" for end in (".csv", ".json", ".png", ".svg")),
    }
    assert sorted(done.json["outputs"]) == sorted(str(path) for path in out.iterdir())
    for word in (
        "37.06",
        "1.09",
        "lack of fit F(8, 16)",
        "lever arm of the fixture: 7.5 mm",
        "50 cycles by rises and falls",
        "wrote",
    ):
        assert word in done.err
    peaks = rows_of(out / "tw3_slw10_a2_peaks.csv")
    assert [float(row["pressure_MPa"]) for row in peaks] == pytest.approx(np.repeat(0.035 * np.arange(1, 11), 5))
    assert all(
        float(r["peak_N"]) == pytest.approx(float(r["raw_peak_N"]) - float(r["baseline_N"]), abs=0.2) for r in peaks
    )
    assert float(peaks[0]["baseline_N"]) == pytest.approx(-0.6, abs=0.02)
    table = rows_of(out / "blocked_force.csv")
    assert [float(row["mean_N"]) for row in table] == pytest.approx(
        [r["mean_N"] for r in done.json["blocked_force"]["pressures"]]
    )
    assert float(table[0]["line_low_N"]) < float(table[0]["line_N"]) < float(table[0]["line_high_N"])
    stored = json.loads((out / "blocked_force.json").read_text())
    assert stored["line"] == done.json["blocked_force"]["line"] and stored["lever_arm_mm"] == 7.5
    assert stored["versions"]["benchlab"] and stored["argv"]
    export = read_force_file(out / "tw3_slw10_a3_force.h5")
    assert export.tests[0].columns["force_N"].max() == pytest.approx(done.json["files"][2]["columns"]["force_N"]["max"])
    assert cv2.imread(str(out / "blocked_force.png")).shape[1] == 960
    assert (out / "blocked_force.svg").read_text().startswith("<?xml")


def test_json_of_a_file_is_as_promised(tmp_path: Path, benchlab) -> None:
    done = benchlab("force", FILES[1], "--out", tmp_path, "--json")
    assert done.code == 0
    (one,) = done.json["files"]
    assert {"file", "rows", "specimens", "columns", "sample_rate_Hz", "inferred", "preamble", "warnings"} <= set(one)
    assert one["columns"]["time_s"]["min"] == 0 and one["columns"]["force_N"]["max"] == pytest.approx(37.3, abs=0.5)
    assert one["sample_rate_Hz"] == pytest.approx(20)
    assert done.json["blocked_force"] is None and not (tmp_path / "blocked_force.csv").exists()
    assert len(one["actuators"][0]["peaks"]) == 50
    assert "50 cycles" in done.err


def test_a_column_of_pressure_or_a_log_gives_the_same_as_stated_steps(tmp_path: Path, benchlab) -> None:
    drawn = trace(offset_N=1.0)
    write(
        tmp_path / "with.csv",
        {"Time (s)": drawn.time_s, "Load (N)": drawn.force_N, "Pressure (kPa)": 1000 * drawn.pressure_MPa},
    )
    write_force(tmp_path / "without.csv", drawn)
    log = write(tmp_path / "log.csv", {"time_s": drawn.time_s, "pressure_kPa": 1000 * drawn.pressure_MPa})
    found = [
        benchlab("force", tmp_path / "with.csv", "--out", tmp_path / "a", "--json"),
        benchlab("force", tmp_path / "without.csv", "--pressure", log, "--out", tmp_path / "b", "--json"),
        benchlab("force", tmp_path / "without.csv", *THREE, "--out", tmp_path / "c", "--json"),
    ]
    assert [done.code for done in found] == [0, 0, 0], found[1].err
    for done in found:
        means = [row["mean_N"] for row in done.json["blocked_force"]["pressures"]]
        assert means == pytest.approx([10, 20, 30], abs=0.06)
        pressures = [row["pressure_MPa"] for row in done.json["blocked_force"]["pressures"]]
        assert pressures == pytest.approx([0.1, 0.2, 0.3], abs=1e-4)
    assert "by the file's column of pressure" in found[0].err and "log.csv" in found[1].err
    assert found[0].json["blocked_force"]["line"]["linearity"] is None


def test_a_log_on_another_clock_is_doubted(tmp_path: Path, benchlab) -> None:
    drawn = trace()
    force = write_force(tmp_path / "force.csv", drawn)
    for shift_s, doubted in ((0.0, False), (0.2, False), (-1.2, True), (2.2, True), (9.0, True)):
        log = write(tmp_path / "log.csv", {"time_s": drawn.time_s - shift_s, "pressure_MPa": drawn.pressure_MPa})
        done = benchlab("force", force, "--pressure", log, "--out", tmp_path / "out", "--overwrite", "--json")
        assert done.code == 0, done.err
        assert any("do their clocks agree?" in text for text in done.json["files"][0]["warnings"]) == doubted


def test_a_vacuum_and_a_pressure_at_rest_tell_no_cycles(tmp_path: Path, benchlab) -> None:
    drawn = trace()
    force = write_force(tmp_path / "force.csv", drawn)
    for pressure, words in (
        (-drawn.pressure_MPa, "goes below its rest, to -0.3 MPa"),
        (0 * drawn.pressure_MPa, "does not rise and fall"),
    ):
        columns = {"time_s": drawn.time_s, "pressure_MPa": pressure}
        refused = benchlab(
            "force", force, "--pressure", write(tmp_path / "log.csv", columns), "--out", tmp_path / "out"
        )
        if "rest, to" in words:
            assert refused.code == 3  # below what a gauge can show
        both = write(tmp_path / "both.csv", {**columns, "force_N": drawn.force_N})
        done = benchlab("force", both, "--out", tmp_path / "out", "--overwrite", "--json")
        assert done.code == 0 and done.json["blocked_force"] is None
        assert words in done.json["files"][0]["warnings"][0]
        assert len(done.json["files"][0]["actuators"][0]["peaks"]) == 6


def test_each_file_may_have_its_own_log_and_name(tmp_path: Path, benchlab) -> None:
    files, logs = [], []
    for name, levels in (("a", LEVELS), ("b", LEVELS[::-1])):
        drawn = trace(levels=levels)
        files.append(write_force(tmp_path / f"{name}.csv", drawn))
        logs += [
            "--pressure",
            write(tmp_path / f"log_{name}.csv", {"time_s": drawn.time_s, "pressure_MPa": drawn.pressure_MPa}),
        ]
    done = benchlab(
        "force", *files, *logs, "--actuator", "left", "--actuator", "right", "--out", tmp_path / "out", "--json"
    )
    assert done.json["blocked_force"]["actuators"] == ["left", "right"]
    assert [row["mean_N"] for row in done.json["blocked_force"]["pressures"]] == pytest.approx([10, 20, 30], abs=0.06)
    assert benchlab("force", *files, *logs[:2], *logs[:2], *logs[:2]).code == 2
    assert benchlab("force", *files, "--actuator", "left").code == 2


def test_a_wrong_count_of_cycles_is_refused_with_both_numbers_and_nothing_is_written(tmp_path: Path, benchlab) -> None:
    done = benchlab(
        "force", FILES[0], "--steps-MPa", "0.035:0.35:0.035", "--cycles", 6, "--out", tmp_path / "out", "--json"
    )
    assert done.code == 3
    assert re.search(
        r"tw3_slw10_a1\.csv: 50 whole cycles found, and 10 steps of 6 cycles are 60: peaks at 2(\.\d+)? s", done.err
    )
    assert "--pressure" in done.json["error"]["hint"]
    assert not (tmp_path / "out").exists()


def test_a_cut_cycle_is_left_out_and_told(tmp_path: Path, benchlab) -> None:
    cut = write_force(tmp_path / "cut.csv", trace(cut_s=(0.0, 2.2)))
    done = benchlab("force", cut, *THREE, "--out", tmp_path)
    assert done.code == 3 and "5 whole cycles found" in done.err and "1 more are cut" in done.err


def test_bad_files_are_listed_and_do_not_stop_the_rest(tmp_path: Path, benchlab) -> None:
    (tmp_path / "empty.csv").write_text("time_s,force_N\n")
    (tmp_path / "clip.csv").write_bytes((SAMPLES / "videos" / "tw3_slw5_s1.mp4").read_bytes()[:4000])
    done = benchlab(
        "force", *FILES, tmp_path / "empty.csv", tmp_path / "clip.csv", *STEPS, "--out", tmp_path / "out", "--json"
    )
    assert done.code == 4
    assert [Path(error["file"]).name for error in done.json["failed"]] == ["empty.csv", "clip.csv"]
    assert done.json["blocked_force"]["actuators"] == [path.stem for path in FILES]
    assert "no data rows" in done.err and "3 of 5 files read, 2 failed" in done.err
    alone = benchlab("force", tmp_path / "clip.csv", "--out", tmp_path / "out2", "--json")
    assert alone.code == 3 and "video" in alone.err and alone.json["error"]["code"] == 3


def test_a_folder_stands_for_the_exports_in_it(tmp_path: Path, benchlab) -> None:
    done = benchlab("force", SAMPLES / "force", *STEPS, "--out", tmp_path, "--json")
    assert done.json["blocked_force"]["actuators"] == [path.stem for path in FILES]
    (tmp_path / "none").mkdir()
    empty = benchlab("force", tmp_path / "none")
    assert empty.code == 2 and "no export in this folder" in empty.err


# The rows of bad inputs about what a force means.


def test_76_columns_are_known_by_name_and_unit_not_by_place(tmp_path: Path, benchlab) -> None:
    drawn = trace()
    turned = write(tmp_path / "turned.csv", {"Load (lbf)": drawn.force_N / 4.4482216152605, "Pressure (psi)": drawn.pressure_MPa / 0.006894757,
                                             "Time (s)": drawn.time_s})  # fmt: skip
    done = benchlab("force", turned, "--out", tmp_path, "--json")
    assert [row["mean_N"] for row in done.json["blocked_force"]["pressures"]] == pytest.approx([10, 20, 30], abs=0.06)


def test_77_time_that_goes_back_is_sorted_only_when_asked(tmp_path: Path, benchlab) -> None:
    drawn = trace()
    time = drawn.time_s.copy()
    time[[500, 900]] = time[[900, 500]]
    back = write(tmp_path / "back.csv", {"time_s": time, "force_N": drawn.force_N})
    found = {}
    for option in ("--overwrite", "--sort-time"):
        done = benchlab("force", back, option, "--out", tmp_path / option.strip("-"), "--json")
        assert done.code == 0
        times = [float(row["time_s"]) for row in rows_of(tmp_path / option.strip("-") / "back_force.csv")]
        found[option] = np.array_equal(times, np.sort(times)), " ".join(done.json["files"][0]["warnings"])
    assert not found["--overwrite"][0] and "--sort-time" in found["--overwrite"][1]
    assert found["--sort-time"][0] and "sorted" in found["--sort-time"][1]


def test_78_negative_forces_are_refused_until_negate_says_what_they_mean(tmp_path: Path, benchlab) -> None:
    down = write_force(tmp_path / "down.csv", trace(), -trace().force_N)
    refused = benchlab("force", down, *THREE, "--out", tmp_path / "out")
    assert (
        refused.code == 2 and "the force goes down in its cycles, to -30" in refused.err and "--negate" in refused.err
    )
    told = benchlab("force", down, "--out", tmp_path / "out", "--json")
    assert told.code == 0 and "--negate" in told.json["files"][0]["warnings"][0]
    assert told.json["files"][0]["columns"]["force_N"]["min"] == pytest.approx(-30, abs=0.2)
    turned = benchlab("force", down, *THREE, "--negate", "--out", tmp_path / "out2", "--json")
    assert turned.json["blocked_force"]["largest"]["mean_N"] == pytest.approx(30, abs=0.06)


def test_79_a_load_cell_at_its_limit_gives_lower_bounds(tmp_path: Path, benchlab) -> None:
    drawn = trace()
    clipped = write_force(tmp_path / "clipped.csv", drawn, np.minimum(drawn.force_N, 25.0))
    done = benchlab("force", clipped, *THREE, "--out", tmp_path / "out", "--json")
    assert done.code == 0
    assert "peaks are clipped at 25.00 N in cycles 5, 6" in done.json["files"][0]["warnings"][0]
    last = done.json["blocked_force"]["largest"]
    assert (last["lower_bound"], last["mean_N"]) == (True, pytest.approx(25, abs=0.06))
    assert "≥ 25.0" in done.err
    assert done.json["blocked_force"]["line"]["pressures_MPa"] == [0.1, 0.2]
    assert [row["lower_bound"] for row in rows_of(tmp_path / "out" / "clipped_peaks.csv")] == ["0"] * 4 + ["1"] * 2
    assert benchlab("force", clipped, *THREE, "--out", tmp_path / "out2", "--strict").code == 3


def test_80_an_offset_is_taken_off_and_stated(tmp_path: Path, benchlab) -> None:
    off = write_force(tmp_path / "off.csv", trace(offset_N=-7.0, drift_N_per_s=0.01))
    done = benchlab("force", off, *THREE, "--out", tmp_path / "out", "--json")
    assert done.json["blocked_force"]["largest"]["mean_N"] == pytest.approx(30, abs=0.06)
    zero = done.json["files"][0]["actuators"][0]["baseline"]
    assert (zero["first_N"], zero["slope_N_per_s"]) == (pytest.approx(-7, abs=0.03), pytest.approx(0.01, abs=0.001))
    assert re.search(r"zero -(7|6\.9\d) N, drifting \+0\.(59|6|61) N/min, taken off", done.err), done.err


def test_81_constant_zero_is_no_contact(tmp_path: Path, benchlab) -> None:
    drawn = trace()
    zero = write_force(tmp_path / "zero.csv", drawn, 0 * drawn.time_s)
    done = benchlab("force", zero, *THREE, "--out", tmp_path / "out", "--json")
    assert done.code == 0 and "no contact seen" in done.json["files"][0]["warnings"][0]
    assert [row["mean_N"] for row in done.json["blocked_force"]["pressures"]] == [0, 0, 0]
    assert done.json["blocked_force"]["line"] is None and "all forces are zero" in done.err
    with_other = benchlab(
        "force", zero, write_force(tmp_path / "good.csv", drawn), *THREE, "--out", tmp_path / "out2", "--json"
    )
    assert with_other.json["blocked_force"]["actuators"] == ["good"]
    assert any("zero: no contact seen" in text for text in with_other.json["blocked_force"]["warnings"])


def test_a_copy_a_same_name_and_a_file_in_the_way_are_refused(tmp_path: Path, benchlab) -> None:
    copy = tmp_path / "copy.csv"
    copy.write_bytes(FILES[0].read_bytes())
    done = benchlab("force", FILES[0], copy, *STEPS, "--out", tmp_path / "out")
    assert done.code == 2 and "same content as tw3_slw10_a1.csv" in done.err
    (tmp_path / "sub").mkdir()
    same = tmp_path / "sub" / FILES[0].name
    same.write_text("x")
    assert "would both be written" in benchlab("force", FILES[0], same, "--out", tmp_path / "out").err
    (tmp_path / "tw3_slw10_a1_force.csv").write_text("mine")
    done = benchlab("force", FILES[0], "--out", tmp_path)
    assert done.code == 2 and "exists" in done.err
    assert (tmp_path / "tw3_slw10_a1_force.csv").read_text() == "mine"
    assert benchlab("force", FILES[0], "--out", tmp_path, "--overwrite").code == 0


@pytest.mark.parametrize(
    ("options", "words"),
    [
        (("--cycles", 5), "--steps-MPa"),
        (("--steps-MPa", "0:0.3:0.1"), "do not grow from above 0"),
        (("--steps-MPa", "x"), "is not a number"),
        (("--lever-arm-mm", 0), "--lever-arm-mm is 0"),
        (("--pressure", "nowhere.csv"), "no such file"),
    ],
)
def test_options_out_of_range_are_usage(options: tuple[object, ...], words: str, tmp_path: Path, benchlab) -> None:
    done = benchlab("force", FILES[0], *options, "--out", tmp_path)
    assert done.code == 2 and words in done.err
    assert list(tmp_path.iterdir()) == []


def test_a_name_is_shown_as_text_and_written_so_that_no_spreadsheet_runs_it(tmp_path: Path, benchlab) -> None:
    name = "=cmd|calc $x_{$ \x1b[31m"
    done = benchlab("force", FILES[0], *STEPS, "--actuator", name, "--out", tmp_path)
    assert done.code == 0 and "\x1b[31m" not in done.err
    assert rows_of(tmp_path / "tw3_slw10_a1_peaks.csv")[0]["actuator"].startswith("'=cmd")
    assert "\x1b" not in (tmp_path / "blocked_force.svg").read_text()


def test_steps_of_time_that_are_uneven_are_told(tmp_path: Path, benchlab) -> None:
    path = tmp_path / "a.csv"
    times = [0.0, 0.1, 0.2, 0.3, 0.4, 5.4, 5.5, 5.6]
    path.write_text("Time (s),Load (N)\n" + "".join(f"{t:.1f},{t + 1:.2f}\n" for t in times))
    assert "8 rows, 10 readings/s (uneven: steps of 0.1 to 5 s)" in benchlab("force", path, "--out", tmp_path).err


def test_a_real_record_of_a_muscle(real_folder: Path, tmp_path: Path, benchlab) -> None:
    """15,000 rows at about 530 readings a second: one loading from 7 to 627 kPa and back to 76 kPa, both in steps, with 323 N at most
    and 15 N left in the end: it never comes to rest unloaded."""
    (path,) = (real_folder / "actuators").glob("Agile*")
    table = np.loadtxt(path, delimiter=",")
    assert table.shape == (15000, 4)
    unnamed = benchlab("force", path, "--out", tmp_path)
    assert unnamed.code == 2 and "--columns" in unnamed.err
    done = benchlab(
        "force", path, "--columns", "force_N,pressure_kPa,time_s,-", "--actuator", "muscle", "--out", tmp_path, "--json"
    )
    assert done.code == 0, done.err
    (one,) = done.json["files"]
    assert one["rows"] == 15000 and one["sample_rate_Hz"] == pytest.approx(500)
    assert one["time_step_s"] == pytest.approx(
        {"min": 0.001, "median": 0.002, "max": float(np.diff(table[:, 2]).max())}
    )
    ranges = {name: (r["min"], r["max"]) for name, r in one["columns"].items()}
    assert ranges["force_N"] == (table[:, 0].min(), table[:, 0].max()) == (0.8277, 323.24)
    assert ranges["pressure_MPa"] == pytest.approx((0.0074146, 0.62662))
    assert ranges["time_s"] == (0.0, 28.189)
    assert any("time stands still" in text for text in one["warnings"])
    (peak,) = one["actuators"][0]["peaks"]
    assert peak["raw_N"] == 323.24 and not peak["cut"]
    held = table[(table[:, 1] > 0.97 * 626.62), 1] / 1000
    assert peak["pressure_MPa"] == pytest.approx(np.median(held), abs=0.01)
    assert any("is the force unloaded where its zero is taken?" in text for text in one["warnings"])
    assert "a line needs two pressures, and 1 can be used" in done.json["blocked_force"]["line_reason"]
    written = read_force_file(next(tmp_path.glob("*.h5"))).tests[0].columns
    assert written["pressure_MPa"] == pytest.approx(table[:, 1] / 1000)


def test_steps_in_kPa_are_refused(tmp_path: Path, benchlab) -> None:
    done = benchlab("force", FILES[0], "--steps-MPa", "35:350:35", "--cycles", 5, "--out", tmp_path)
    assert done.code == 2 and "350 kPa is 0.35" in done.err and not list(tmp_path.iterdir())


def test_one_record_exported_twice_in_two_units_is_one_actuator(tmp_path: Path, benchlab) -> None:
    force = [abs(10 * (i % 20) / 20) for i in range(100)]
    for name, unit, factor in (("newton", "N", 1.0), ("kilo", "kN", 1e-3)):
        rows = "".join(f"{i / 10:.1f},{value * factor:.5f}\n" for i, value in enumerate(force))
        (tmp_path / f"{name}.csv").write_text(f"Time (s),Load ({unit})\n{rows}")
    done = benchlab("force", tmp_path / "newton.csv", tmp_path / "kilo.csv", "--out", tmp_path / "out")
    assert done.code == 2 and "has the readings of newton.csv" in done.err
