"""`benchlab design` from the command line: what it names does bend to the angle, and its files are that."""

import csv
import re

import numpy as np
import pytest

from benchlab.actuator import ShellDesign
from benchlab.io.design_file import read_design
from benchlab.io.layup_file import DEFAULT_LAYUP, read_layup
from benchlab.simulation.actuator_response import PUBLISHED_LEVER_ARM_MM, actuator_response

FAST = ("--pressure-MPa", "0.1", "--jobs", "1")


@pytest.fixture(scope="module")
def found(tmp_path_factory):
    """One inverse design on a line, for all tests that only look at it."""
    import json
    import subprocess
    import sys

    out = tmp_path_factory.mktemp("design")
    command = ["design", "--angle-deg", "38", *FAST, "--tw-mm", "3,4", "--slw-mm", "1:25", "--out", str(out), "--json"]
    done = subprocess.run([sys.executable, "-m", "benchlab", *command], capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    return out, json.loads(done.stdout)


def test_every_design_named_bends_to_the_angle_when_simulated_anew(found):
    out, document = found
    assert {row["tw_mm"] for row in document["candidates"]} == {3, 4}
    narrow, wide = (row for row in document["candidates"] if row["tw_mm"] == 3)
    assert 1 < narrow["slw_mm"] < 8 < wide["slw_mm"] < 25
    for row in (narrow, wide):
        design = ShellDesign(row["slw_mm"], row["tw_mm"])
        response = actuator_response(design, read_layup(DEFAULT_LAYUP), [0.05, 0.1])
        assert response.angle_deg[-1] == pytest.approx(38, abs=0.2)
        assert row["angle_deg"] == pytest.approx(response.angle_deg[-1], abs=1e-4)
        assert row["volume_mL"] == pytest.approx(response.volume_mL[-1])
        assert row["blocked_force_N"] == pytest.approx(response.blocked_force_N[-1])
        assert row["whole_windows"] == design.whole_windows
    with (out / "design_38deg.csv").open() as file:
        table = list(csv.DictReader(file))
    assert len(table) == len(document["candidates"])
    assert float(table[0]["slw_mm"]) == pytest.approx(document["candidates"][0]["slw_mm"])


def test_the_change_by_a_cutting_error_is_that_of_a_design_cut_wrong(found):
    _, document = found
    row = max(document["candidates"], key=lambda row: row["slw_mm"])
    angles = [
        actuator_response(ShellDesign(row["slw_mm"] + error, row["tw_mm"]), read_layup(DEFAULT_LAYUP), [0.1], blocked=False).angle_deg[-1]
        for error in (0.0, 0.1)
    ]  # fmt: skip
    assert row["dangle_dslw_deg_per_0_1mm"] == pytest.approx(np.diff(angles)[0], rel=0.1)
    assert row["cut_error_deg"] == pytest.approx(
        np.hypot(row["dangle_dslw_deg_per_0_1mm"], row["dangle_dtw_deg_per_0_1mm"])
    )


def test_the_best_are_written_as_designs_that_other_commands_read(found):
    out, document = found
    rows, best = document["candidates"], document["best"]
    assert set(best) == {"balanced", "least_cut_error", "least_volume", "most_force", "least_film_strain"}
    for name, index in best.items():
        design = read_design(out / f"design_38deg_{name}.yaml")
        assert (design.window_width_mm, design.strip_width_mm) == (rows[index]["tw_mm"], rows[index]["slw_mm"])
    assert rows[best["least_volume"]]["volume_mL"] == min(row["volume_mL"] for row in rows)
    assert rows[best["most_force"]]["blocked_force_N"] == max(row["blocked_force_N"] for row in rows)
    assert (out / "design_38deg.png").stat().st_size > 20_000
    assert not list(out.glob(".*"))


def test_existing_files_are_not_replaced(found, benchlab):
    out, _ = found
    before = (out / "design_38deg.csv").read_bytes()
    done = benchlab("design", "--angle-deg", "38", *FAST, "--out", out)
    assert done.code == 2 and "exists" in done.err and (out / "design_38deg.csv").read_bytes() == before


def test_along_tw_where_slw_is_fixed_and_the_force_chooses(benchlab, tmp_path):
    line = ("--angle-deg", "38", *FAST, "--tw-mm", "1:6", "--slw-mm", "10", "--out", tmp_path, "--json")
    done = benchlab("design", *line, "--force-N", 1000)
    assert done.code == 2 and f"lever arm {PUBLISHED_LEVER_ARM_MM:g} mm" in done.err
    (most,) = re.findall(r"push with up to (\d+\.\d) N", done.err)
    enough = benchlab("design", *line, "--force-N", 0.98 * float(most))
    assert enough.code == 0, enough.err
    rows, best = enough.json["candidates"], enough.json["best"]
    forces = [row["blocked_force_N"] for row in rows]
    assert {row["slw_mm"] for row in rows} == {10} and most == f"{max(forces):.1f}"
    assert all(rows[index]["blocked_force_N"] >= 0.98 * float(most) for index in best.values())


def test_an_angle_out_of_reach_is_said_with_the_largest_and_the_length_that_would_do(benchlab, tmp_path):
    line = (*FAST, "--tw-mm", "3", "--slw-mm", "5:15", "--out", tmp_path)
    done = benchlab("design", "--angle-deg", "90", *line)
    assert done.code == 2 and "no design bends 90 deg at 0.1 MPa; the largest is" in done.err
    assert not list(tmp_path.iterdir())
    longer = done.err.split("--length-mm ")[1].split(")")[0]
    reached = benchlab("design", "--angle-deg", "90", *line, "--length-mm", longer)
    assert reached.code == 0, reached.err
    little = benchlab("design", "--angle-deg", "5", *line)
    assert little.code == 2 and "every design bends more than 5 deg" in little.err


@pytest.mark.parametrize(
    ("arguments", "what"),
    [
        (("--angle-deg", "-3"), "--angle-deg is -3"),
        (("--angle-deg", "30", "--force-N", "0"), "--force-N is 0"),
        (("--angle-deg", "30", "--tw-mm", "3", "--slw-mm", "10"), "both fixed"),
        (("--angle-deg", "30", "--slw-mm", "1:45"), "leaves no window"),
        (("--angle-deg", "30", "--tw-mm", "3:3.05"), "no whole number of windows"),
        (("--angle-deg", "30", "--tw-mm", "5:3"), "does not grow"),
        (("--angle-deg", "30", "--pressure-MPa", "0"), "--pressure-MPa is 0"),
        (("--angle-deg", "30", "--lever-arm-mm", "5", "--contact-area-mm2", "9"), "give one of them"),
        (("--angle-deg", "30", "--slw-mm", "0:9"), "positive length"),
    ],
)
def test_what_cannot_be_is_refused_and_leaves_nothing(benchlab, tmp_path, arguments, what):
    done = benchlab("design", *arguments, "--jobs", 1, "--out", tmp_path / "new")
    assert done.code == 2 and what in done.err, done.err
    assert not list(tmp_path.rglob("*.*"))
