"""`benchlab explain` from files to files: what is written, what is refused, and the published table."""

from __future__ import annotations

import csv
import json
import os
import re
import subprocess
import sys
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from benchlab.io.model_file import read_model
from benchlab.io.protocol_file import read_protocol
from benchlab.workflows.sample_explain import measured_rows, simulated_rows

ROOT = Path(__file__).resolve().parents[2]
PAPER = ROOT / "benchlab" / "published" / "paper_angles.csv"
Rows = list[dict[str, Any]]


@pytest.fixture(scope="session")
def cache(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Simulated curves of these tests; BENCHLAB_CACHE of whoever runs them is used again where it is set."""
    return Path(os.environ.get("BENCHLAB_CACHE") or tmp_path_factory.mktemp("curves"))


@pytest.fixture(autouse=True)
def kept(cache: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("BENCHLAB_CACHE", str(cache))


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    """With loops.csv, a small part of the sample study, and simulated.csv."""
    rows = [
        row for row in measured_rows(1) if row["design"] != "wide" and row["sample"] != "s4" and row["run"] == "fast"
    ]
    write(tmp_path / "loops.csv", rows)
    write(tmp_path / "simulated.csv", simulated_rows())
    return tmp_path


def write(path: Path, rows: Rows) -> Path:
    with path.open("w", encoding="utf-8", newline="") as file:
        table = csv.DictWriter(file, list(rows[0]))
        table.writeheader()
        table.writerows(rows)
    return path


def read(path: Path) -> Rows:
    with path.open(encoding="utf-8", newline="") as file:
        return list(csv.DictReader(file))


def changed(path: Path, change: Callable[[Rows], Rows]) -> Path:
    return write(path, change(read(path)))


def test_a_study_becomes_a_page_numbers_and_a_model(folder: Path, benchlab: Any) -> None:
    out = folder / "out"
    given = (folder / "loops.csv", "--simulation", folder / "simulated.csv", "--out", out, "--json")
    done = benchlab("explain", *given)
    assert done.code == 0, done.err
    answer = done.json
    assert answer["verdict"] == "named" and [effect["name"] for effect in answer["effects"]] == ["friction"]
    assert answer["gap_quantity"] == "angle_deg"
    assert "The simulation lacks friction" in done.err and "Simulated data" in done.err
    assert sorted(path.name for path in out.iterdir()) == [
        "explain.json",
        "explain.png",
        "figures",
        "model.yaml",
        "report.html",
        "tables",
    ]
    assert json.loads((out / "explain.json").read_text(encoding="utf-8")) | {"outputs": 0} == answer | {"outputs": 0}
    assert {Path(path) for path in answer["outputs"]} == {path for path in out.rglob("*") if path.is_file()}
    model = read_model(out / "model.yaml")
    assert [effect.name for effect in model.effects] == ["friction"] and model.provenance.simulated
    assert {one.file for one in model.provenance.measured} == {"loops.csv", "simulated.csv"}
    page = (out / "report.html").read_text(encoding="utf-8")
    assert "SIMULATED" in page.upper() and "friction" in page

    again = benchlab("explain", folder / "loops.csv", "--model", out / "model.yaml", "--json")
    assert again.code == 0, again.err
    assert again.json["verdict"] == "agree" and again.json["model"] is None
    assert again.json["gap"]["rmse_before"] == pytest.approx(answer["gap"]["rmse_after"], rel=1e-3)


def test_files_of_others_stay(folder: Path, benchlab: Any) -> None:
    out = folder / "out"
    out.mkdir()
    (out / "model.yaml").write_text("mine", encoding="utf-8")
    done = benchlab("explain", folder / "loops.csv", "--simulation", folder / "simulated.csv", "--out", out)
    assert done.code == 2 and "--overwrite" in done.err
    assert [path.name for path in out.iterdir()] == ["model.yaml"] and (out / "model.yaml").read_text() == "mine"


def test_threads_change_nothing(folder: Path) -> None:
    def with_threads(count: int) -> dict[str, Any]:
        names = ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS")
        command = [sys.executable, "-m", "benchlab", "explain", "loops.csv", "--simulation", "simulated.csv", "--json"]
        environment = {**os.environ, **dict.fromkeys(names, str(count))}
        done = subprocess.run(command, cwd=folder, env=environment, capture_output=True, text=True, check=True)
        found: dict[str, Any] = json.loads(done.stdout)
        return found

    one, two = with_threads(1), with_threads(2)
    assert one["verdict"] == two["verdict"] == "named" and one["rivals"] == two["rivals"]
    assert one["gap"] == pytest.approx(two["gap"], rel=1e-6)
    for name, number in one["effects"][0]["parameters"].items():
        assert two["effects"][0]["parameters"][name]["value"] == pytest.approx(number["value"], rel=1e-6)


def backwards(rows: Rows) -> Rows:
    """One run of two readings changed places in the file, as a clock that is set back writes them."""
    rows[40]["time_s"], rows[41]["time_s"] = rows[41]["time_s"], rows[40]["time_s"]
    return rows


def renamed(rows: Rows, **names: str) -> Rows:
    return [{names.get(name, name): value for name, value in row.items()} for row in rows]


BAD: dict[str, tuple[Callable[[Rows], Rows], str]] = {
    "no overlap of designs": (
        lambda rows: [{**row, "design": "x" + row["design"]} for row in rows],
        "none of the measured designs is simulated",
    ),
    "no overlap of pressures": (
        lambda rows: [{**row, "pressure_MPa": str(float(row["pressure_MPa"]) + 0.6)} for row in rows],
        "no measured value lies where there is a simulated curve",
    ),
    "a few readings": (lambda rows: rows[:12], "readings cannot carry a verdict"),
    "no unit": (lambda rows: renamed(rows, pressure_MPa="pressure"), "no unit"),
    "two units": (lambda rows: [{**row, "angle_rad": "1"} for row in rows], "angle"),
    "no angle": (lambda rows: [{**row, "angle_deg": ""} for row in rows], "loops.csv: no number in column angle_deg"),
    "no time": (lambda rows: [{**row, "time_s": ""} for row in rows], "loops.csv: no number in column time_s"),
    "words": (lambda rows: [{**row, "angle_deg": "much"} for row in rows], "loops.csv, line 2, column angle_deg: "),
    "radians": (
        lambda rows: [{**row, "angle_deg": float(row["angle_deg"]) / 57.3} for row in rows],
        " of the simulated one, as rad for deg makes it; name the column with its unit",
    ),
    "megapascals called kilopascals": (
        lambda rows: renamed(rows, pressure_MPa="pressure_kPa"),
        "the largest pressure is 0.00035 MPa, below 0.001 MPa",
    ),
    "no design": (
        lambda rows: [{k: v for k, v in row.items() if k != "design"} for row in rows if row["design"] == "middle"],
        "add a column design, with names of those that are simulated: middle, narrow, wide; the columns are sample, run, cycle",
    ),
}


@pytest.mark.parametrize("name", BAD)
def test_what_is_refused(name: str, folder: Path, benchlab: Any) -> None:
    change, words = BAD[name]
    changed(folder / "loops.csv", change)
    done = benchlab(
        "explain", folder / "loops.csv", "--simulation", folder / "simulated.csv", "--out", folder / "out", "--json"
    )
    assert done.code == 3 and words in done.err, done.err
    assert done.json["error"]["code"] == 3
    assert not (folder / "out").exists()


def test_time_that_goes_back_is_told(folder: Path, benchlab: Any) -> None:
    changed(folder / "loops.csv", backwards)
    done = benchlab("explain", folder / "loops.csv", "--simulation", folder / "simulated.csv", "--strict", "--json")
    assert done.code == 3 and done.json["verdict"] == "named"
    assert any("back" in words for words in done.json["warnings"])


@pytest.mark.parametrize(
    ("options", "words"),
    [
        ((), "no dimensions are known of middle, narrow"),
        (("--simulation", "simulated.csv", "--model", "beam"), "--simulation and --model"),
        (("--simulation", "gone.csv"), "gone.csv"),
        (("--samples", "3"), "--samples is given without --loop"),
        (("--loop", "--out", "out"), "MEASURED is given beside --loop"),
        (("--simulation", "simulated.csv", "--seed", "-1"), "--seed"),
    ],
)
def test_usage(
    options: tuple[str, ...], words: str, folder: Path, benchlab: Any, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(folder)
    done = benchlab("explain", "loops.csv", *options)
    assert done.code == 2 and words in done.err


def names_in(answer: dict[str, Any]) -> Iterator[str]:
    """Every effect that is named or left."""
    yield from (effect["name"] for effect in answer["effects"])
    yield from (name for rival in answer["rivals"] for name in rival)


@pytest.fixture(scope="session")
def fem(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The published simulated angles under names without dimensions: no cell has to be solved for them."""
    rows = [
        {"design": f"d{n}", "pressure_MPa": row["pressure_MPa"], "angle_deg": row["fem_angle_deg"]}
        for n, row in enumerate(paper())
    ]
    return write(tmp_path_factory.mktemp("fem") / "fem.csv", rows)


def paper() -> Rows:
    with PAPER.open(encoding="utf-8") as file:
        return list(csv.DictReader(line for line in file if not line.startswith("#")))


def test_the_published_table_has_a_gap_whose_cause_it_cannot_tell(fem: Path, tmp_path: Path, benchlab: Any) -> None:
    columns = {
        "pressure_MPa": "pressure_MPa",
        "angle_mean_deg": "measured_angle_deg",
        "angle_sd_deg": "measured_sd_deg",
        "n": "samples",
    }
    rows = [
        {"design": f"d{n}", **{ours: row[theirs] for ours, theirs in columns.items()}} for n, row in enumerate(paper())
    ]
    means = write(tmp_path / "means.csv", [row for row in rows if row["n"]])
    done = benchlab("explain", means, "--simulation", fem, "--out", tmp_path / "out", "--json")
    assert done.code == 0, done.err
    answer = done.json
    assert answer["verdict"] == "ambiguous" and len(answer["rivals"]) > 1
    assert ["camera_scale"] in answer["rivals"]
    assert {region["design"] for region in answer["where"]} == {"d1", "d2", "d6"} and all(
        region["gap"] < 0 for region in answer["where"]
    )
    for name in ("viscoelasticity", "softening", "friction", "regulator_lag"):
        assert name in answer["not_judged"] and name not in set(names_in(answer))
    plan = read_protocol(answer["next_experiment"]["protocol"])
    assert (
        len({round(abs(float(rate)), 2) for rate in (plan.pressure_MPa[1:] - plan.pressure_MPa[:-1]) * plan.rate_Hz})
        > 2
    )
    assert "scale bar" in answer["next_experiment"]["setup"]


def test_without_bulging_windows_the_published_table_names_them(tmp_path: Path, benchlab: Any) -> None:
    done = benchlab("explain", PAPER, "--model", "beam", "--json")
    assert done.code == 0, done.err
    assert done.json["verdict"] == "named" and list(names_in(done.json)) == ["window_ballooning"]
    assert done.json["gap"]["rmse_after"] < 0.15 * done.json["gap"]["rmse_before"]


def test_one_sample_is_described(folder: Path, benchlab: Any) -> None:
    """Its friction is seen as a loop, and not named."""
    changed(folder / "loops.csv", lambda rows: [row for row in rows if row["sample"] == "s1"])
    given = ("--simulation", folder / "simulated.csv", "--out", folder / "out", "--json")
    done = benchlab("explain", folder / "loops.csv", *given)
    assert done.code == 0, done.err
    answer = done.json
    assert answer["verdict"] == "unexplained" and not list(names_in(answer)) and answer["model"] is None
    assert answer["p_gap"] is None and answer["false_naming_nominal"] is None
    assert {region["p"] for region in answer["where"]} == {None}
    assert any("with the direction" in line for line in answer["remainder"])
    page = (folder / "out" / "report.html").read_text(encoding="utf-8")
    assert "described only" in page and not re.search(r">[^<]*\bnan\b", page)
    assert "nan" not in done.err and "on the data of the fit" not in done.err


def test_soft_fingers_of_another_lab_are_described(real_folder: Path, benchlab: Any) -> None:
    """One sample of each configuration, measured once: that they differ may be their scatter."""
    columns = "design=Configuration,pressure_kPa=Pressure,angle_deg=Theta6"
    (measured,), (simulated,) = (
        list((real_folder / "actuators").glob(f"Hiroshan*{kind}*")) for kind in ("Experimental", "Simulation_Data")
    )
    given = ("--columns", columns, "--simulation", simulated, "--simulation-columns", columns)
    done = benchlab("explain", measured, *given, "--json")
    assert done.code == 0, done.err
    answer = done.json
    assert answer["verdict"] == "unexplained" and not list(names_in(answer)) and answer["samples"] == 14
    assert {region["p"] for region in answer["where"]} == {None}
    whole = [region for region in answer["where"] if region["design"] == "DS10DS30_2_1"]
    curves = [
        {
            float(row["Pressure"]): float(row["Theta6"])
            for row in read_bom(path)
            if row["Configuration"] == "DS10DS30_2_1"
        }
        for path in (measured, simulated)
    ]
    gap = [angle - curves[1][p] for p, angle in curves[0].items() if p in curves[1]]  # every 68 kPa
    assert len(whole) == 1 and whole[0]["gap"] == pytest.approx(sum(gap) / len(gap), abs=1.5)
    assert any("with the design: -2.5° on average for DS30E30_1_1" in line for line in answer["remainder"])
    assert any("neither a name nor a probability" in line for line in answer["warnings"])
    assert sum("measured but not simulated" in line for line in answer["warnings"]) == 1
    assert answer["next_experiment"]["setup"].startswith("two samples of each design")


def read_bom(path: Path) -> Rows:
    with path.open(encoding="utf-8-sig", newline="") as file:
        return list(csv.DictReader(file))


def test_the_loop_of_a_braided_muscle_is_described(real_folder: Path, benchlab: Any, tmp_path: Path) -> None:
    """Its own loading, medians in steps of 40 kPa, stands for the simulation: unloading, it pushes more at the same pressure."""
    (muscle,) = (real_folder / "actuators").glob("Agile*")
    force, pressure, time, _ = np.loadtxt(muscle, delimiter=",").T
    step = np.where(time < 14.5, pressure // 40, -1)
    rising = [
        {"design": "unnamed", "pressure_kPa": np.median(pressure[step == n]), "blocked_force_N": np.median(force[step == n])}
        for n in np.unique(step[step >= 0]) if (step == n).sum() > 20
    ]  # fmt: skip
    simulation = write(tmp_path / "rising.csv", rising)
    done = benchlab(
        "explain", muscle, "--columns", "force_N=1,pressure_kPa=2,time_s=3", "--simulation", simulation, "--json"
    )
    assert done.code == 0, done.err
    answer = done.json
    assert answer["verdict"] == "unexplained" and not list(names_in(answer))
    widest = max(
        (r for r in answer["where"] if r["direction"] == "unloading"),
        key=lambda r: r["pressure_MPa"][1] - r["pressure_MPa"][0],
    )
    assert widest["gap"] > 0 and widest["pressure_MPa"][1] > 0.5 and widest["p"] is None
    (line,) = (line for line in answer["remainder"] if "with the direction" in line)
    assert "on average for loading, +" in line and " N on" in line and line.endswith("for unloading")
    assert answer["not_judged"]["camera_scale"] == "it does not show in force_N"


def test_a_muscle_without_a_simulation_is_refused(real_folder: Path, benchlab: Any) -> None:
    (muscle,) = (real_folder / "actuators").glob("Agile*")
    done = benchlab("explain", muscle, "--columns", "force_N=1,pressure_kPa=2,time_s=3")
    assert done.code == 2 and "--simulation" in done.err


def test_the_loop_finds_what_is_hidden_in_the_twin(tmp_path: Path, benchlab: Any) -> None:
    curves = [row for row in simulated_rows() if row["design"] == "middle"]
    effects = "".join(f"  {name}: off\n" for name in ("viscoelasticity", "regulator_lag", "line_resistance"))
    (tmp_path / "twin.yaml").write_text(
        f"effects:\n  friction: {{half_width_deg_per_MPa: 12}}\n{effects}", encoding="utf-8"
    )
    options = ("--simulation", write(tmp_path / "simulated.csv", curves), "--samples", 3, "--rounds", 1)
    done = benchlab(
        "explain", "--loop", "--twin", tmp_path / "twin.yaml", *options, "--out", tmp_path / "loop", "--json"
    )
    assert done.code == 0, done.err
    answer = done.json
    assert answer["simulated"] and len(answer["loop"]["rounds"]) == 1
    assert "friction" in set(names_in(answer))
    assert (tmp_path / "loop" / "report.html").is_file() and (tmp_path / "loop" / "round1" / "measured.csv").is_file()
