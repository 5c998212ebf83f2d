"""`benchlab simulate` from the command line."""

from __future__ import annotations

import shutil
from dataclasses import replace

import cv2
import numpy as np
import pandas
import pytest

from benchlab.actuator import ShellDesign
from benchlab.io.design_file import write_design
from benchlab.io.layup_file import read_layup, write_layup
from benchlab.io.response_file import read_response_file
from benchlab.simulation.actuator_response import PUBLISHED_LEVER_ARM_MM
from benchlab.simulation.beam import beam_response
from benchlab.simulation.laws import Polynomial
from benchlab.simulation.layup import Layup
from benchlab.workflows import simulate
from tests.system.models import LAYUP, beam_model

FILES = ["tw9_slw10.cell.png", "tw9_slw10.csv", "tw9_slw10.h5", "tw9_slw10.png"]
SHORT = ("simulate", "--tw-mm", 9, "--slw-mm", 10, "--pressure-MPa", "0.05,0.1")


@pytest.fixture(scope="module")
def first(tmp_path_factory):
    """The folder of one simulation, for tests that only read it."""
    from benchlab.cli.app import run

    folder = tmp_path_factory.mktemp("simulated")
    with pytest.raises(SystemExit) as ended:
        run([*map(str, SHORT), "--out", str(folder)])
    assert ended.value.code == 0
    return folder


@pytest.fixture
def copied(first, tmp_path):
    """A copy of that folder, to write into."""
    return shutil.copytree(first, tmp_path / "copy")


def test_all_outputs_say_the_same(benchlab, tmp_path) -> None:
    done = benchlab(*SHORT, "--material", "trial", "--out", tmp_path / "new", "--tip-force-at-deg", 5, "--json")
    assert done.code == 0, done.err
    found = done.json
    assert sorted(p.name for p in (tmp_path / "new").iterdir()) == FILES
    assert sorted(found["outputs"]) == sorted(str(tmp_path / "new" / name) for name in FILES)
    assert found["design"]["window_width_mm"] == 9 and found["design"]["name"] == "tw9_slw10"
    assert found["limit_pressure_MPa"] is None and found["seconds"] > 0 and found["warnings"] == []
    assert "simulated" in found["statement"] and found["fixture"]["lever_arm_mm"] == PUBLISHED_LEVER_ARM_MM
    table = pandas.read_csv(tmp_path / "new" / "tw9_slw10.csv")
    assert list(table) == [
        "pressure_MPa",
        "angle_deg",
        "curvature_per_mm",
        "axial_stretch",
        "volume_mL",
        "moment_Nmm",
        "blocked_force_N",
    ]
    file = read_response_file(tmp_path / "new" / "tw9_slw10.h5")
    for index, point in enumerate(found["points"]):
        for name in table:
            assert table[name][index] == pytest.approx(point[name], rel=1e-7)
            assert getattr(file.curves, name)[index] == point[name]
        assert point["angle_deg"] == pytest.approx(np.degrees(point["curvature_per_mm"] * point["axial_stretch"] * 180))
        assert point["blocked_force_N"] == pytest.approx(point["moment_Nmm"] / PUBLISHED_LEVER_ARM_MM)
        radius = 1 / point["curvature_per_mm"]
        theta = np.radians(point["angle_deg"])
        assert point["tip_towards_strip_mm"] == pytest.approx(radius * (1 - np.cos(theta)))
        assert point["tip_along_mm"] == pytest.approx(radius * np.sin(theta))
        # held nearer to where it bends to of itself, it presses less; straight it would press at half its length
        assert 0 < point["tip_force_N"] < point["moment_Nmm"] / 90
        assert file.extras["tip_force_N"][index] == point["tip_force_N"]
    assert file.curves.about["simulation"]["statement"] == found["statement"]
    assert file.curves.about["material"]["film"]["coefficients_MPa"]["C10"] == 1.5
    assert file.curves.about["provenance"]["versions"]["benchlab"]
    assert (
        f"{found['points'][-1]['angle_deg']:.2f} deg" in done.err
        and f"lever arm {PUBLISHED_LEVER_ARM_MM:g} mm" in done.err
    )
    for name in FILES[::3]:
        assert cv2.imread(str(tmp_path / "new" / name)).std() > 10


def test_a_design_file_caps_and_a_contact_area(benchlab, tmp_path) -> None:
    write_design(tmp_path / "d.yaml", ShellDesign(10, 9))
    write_layup(tmp_path / "m.yaml", read_layup("trial"))
    files = ("--design", tmp_path / "d.yaml", "--material", tmp_path / "m.yaml", "--out", tmp_path, "--name", "mine")
    done = benchlab(
        "simulate", *files, "--cap-mm", 15, "--contact-area-mm2", 100, "--pressure-MPa", "0.05:0.1:0.05", "--json"
    )
    assert done.code == 0, done.err
    assert (tmp_path / "mine.h5").exists() and "contact area 100 mm²" in done.err
    last = done.json["points"][-1]
    assert last["blocked_force_N"] == pytest.approx(10)
    theta = np.radians(last["angle_deg"])
    assert theta == pytest.approx(last["curvature_per_mm"] * last["axial_stretch"] * 150)
    towards = (1 - np.cos(theta)) / last["curvature_per_mm"] + 15 * np.sin(theta)
    assert last["tip_towards_strip_mm"] == pytest.approx(towards)


def test_a_soft_film_bursts_and_the_limit_is_named(benchlab, tmp_path) -> None:
    write_layup(tmp_path / "soft.yaml", Layup("soft", "made up", film=Polynomial(C10=0.002)))
    soft = ("simulate", "--design", "tw15_slw10", "--material", tmp_path / "soft.yaml", "--out", tmp_path)
    done = benchlab(*soft, "--pressure-MPa", "0.0001,0.002", "--json", "--strict")
    assert done.code == 3 and "--strict" in done.err
    found = done.json
    assert len(found["points"]) == 1 and 0.0001 <= found["limit_pressure_MPa"] < 0.002
    assert f"{found['limit_pressure_MPa']:.4g} MPa" in done.err and "1 of 2 pressures" in done.err
    assert len(pandas.read_csv(tmp_path / "tw15_slw10.csv")) == 1
    for path in tmp_path.glob("tw15*"):
        path.unlink()
    done = benchlab(*soft, "--pressure-MPa", "0.002", "--json")
    assert done.code == 3 and "limit pressure" in done.json["error"]["what"]
    assert [p.name for p in tmp_path.iterdir()] == ["soft.yaml"]


def test_an_unstable_film_law_is_told(benchlab, copied, monkeypatch) -> None:
    monkeypatch.setattr(simulate, "unstable_share", lambda layers: 0.25)
    done = benchlab(*SHORT, "--out", copied)
    assert (
        done.code == 0
        and "not stable (Drucker) at 25 % of the film" in done.err
        and "the first at 0.05 MPa" in done.err
    )


def test_own_results_are_replaced_and_others_not(benchlab, copied) -> None:
    before = (copied / "tw9_slw10.h5").read_bytes()
    done = benchlab(*SHORT, "--out", copied, "--cap-mm", 5)
    assert done.code == 0, done.err
    assert (copied / "tw9_slw10.h5").read_bytes() != before
    (copied / "tw9_slw10.png").write_text("mine")
    done = benchlab(*SHORT, "--out", copied)
    assert done.code == 2 and "tw9_slw10.png" in done.err and "--overwrite" in done.err
    assert (copied / "tw9_slw10.png").read_text() == "mine"
    assert sorted(p.name for p in copied.iterdir()) == FILES
    assert benchlab(*SHORT, "--out", copied, "--overwrite").code == 0


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (["--tw-mm", "3"], ["--slw-mm is missing"]),
        (["--design", "tw3_slw40"], ["strip_width_mm (slw) is 40", "perimeter_mm of 40"]),
        (["--design", "tw0_slw10"], ["tw"]),
        (["--design", "tw200_slw10"], ["window_width_mm (tw) is 200", "176"]),
        (["--design", "tw3_slw10", "--length-mm", "nan"], ["not a finite number"]),
        (["--pressure-MPa", "0:0.35:0.03"], ["no whole number of steps", "0.33"]),
        (["--pressure-MPa", "0.3,0.1"], ["0.1 MPa follows 0.3 MPa", "grow"]),
        (["--pressure-MPa", "0.1,0.1"], ["grow"]),
        (["--pressure-MPa=-0.1,0.1"], ["0 MPa or more"]),
        (["--pressure-MPa", "0:1:0.0005"], ["2001 pressures, more than 2000"]),
        (["--pressure-MPa", "0:0.3"], ["START:END:STEP"]),
        (["--pressure-MPa", "0,nan"], ["not a number"]),
        (["--cap-mm", "90"], ["caps of 90", "180 mm"]),
        (["--cap-mm=-1"], ["caps of -1"]),
        (["--lever-arm-mm", "5", "--contact-area-mm2", "3"], ["both given", "give one of them"]),
        (["--lever-arm-mm", "0"], ["lever_arm_mm is 0", "positive"]),
        (["--tip-force-at-deg", "400"], ["400", "350"]),
        (["--material", "nothing"], ["no material is called 'nothing'"]),
        (["--material", "absent.yaml"], ["absent.yaml", "no such file"]),
        (["--name", "a/b"], ["a/b", "--out"]),
        (["--out", "none/of/this"], ["no such folder"]),
    ],
)
def test_what_is_refused_leaves_nothing(benchlab, tmp_path, monkeypatch, arguments, words) -> None:
    monkeypatch.chdir(tmp_path)
    design = [] if {"--tw-mm", "--design"} & set(arguments) else ["--design", "tw3_slw10"]
    done = benchlab("simulate", *design, *arguments, "--json")
    assert done.code == 2 and done.json["error"]["code"] == 2, done.err
    for word in words:
        assert word in done.err
    assert list(tmp_path.iterdir()) == []


def test_an_unstable_material_file_is_refused_with_its_place(benchlab, tmp_path) -> None:
    (tmp_path / "bad.yaml").write_text("name: bad\norigin: x\nfilm: {law: neo-hooke, coefficients_MPa: {C10: -1.0}}\n")
    done = benchlab("simulate", "--design", "tw3_slw10", "--material", tmp_path / "bad.yaml", "--out", tmp_path)
    assert done.code == 3 and "bad.yaml" in done.err and "shear modulus of -2" in done.err
    assert [p.name for p in tmp_path.iterdir()] == ["bad.yaml"]


def test_results_that_nobody_tested_are_warned_of(benchlab, tmp_path) -> None:
    layup = read_layup("from-FEM-angles")
    write_layup(tmp_path / "tested.yaml", replace(layup, film_largest_stretch=1.1))
    found = benchlab("simulate", "--tw-mm", 3, "--slw-mm", 10, "--length-mm", 600, "--pressure-MPa", "0.1,0.35",
                     "--material", tmp_path / "tested.yaml", "--out", tmp_path, "--json", "--strict")  # fmt: skip
    assert found.code == 3
    lying, stretched = found.json["warnings"]
    assert "lie on itself" in lying and "beyond 1.1" in stretched and "from 0.35 MPa on" in stretched


def test_the_tip_of_a_straight_actuator_presses_far_less(benchlab, tmp_path) -> None:
    (point,) = benchlab(
        "simulate", "--tw-mm", 3, "--slw-mm", 10, "--pressure-MPa", "0.2", "--out", tmp_path, "--json"
    ).json["points"]
    assert point["straight_tip_force_N"] == pytest.approx(point["moment_Nmm"] / 90)


def test_names_and_folders_in_the_way(benchlab, tmp_path) -> None:
    design = ("simulate", "--tw-mm", 3, "--slw-mm", 10, "--pressure-MPa", "0.1", "--out", tmp_path)
    assert "no name for files" in benchlab(*design, "--name", "x" * 300).err
    (tmp_path / "tw3_slw10.png").mkdir()
    refused = benchlab(*design, "--overwrite")
    assert refused.code == 2 and "is a folder" in refused.err


def test_a_model_is_its_base_with_its_effects(benchlab, tmp_path, monkeypatch) -> None:
    monkeypatch.setenv("BENCHLAB_CACHE", str(tmp_path / "kept"))
    model = beam_model(tmp_path / "found.yaml", end_caps={"cap_mm": 9.0}, viscoelasticity={})
    done = benchlab("simulate", "--tw-mm", 3, "--slw-mm", 10, "--pressure-MPa", "0.1,0.2", "--model", model, "--out",
                    tmp_path / "new", "--json")  # fmt: skip
    assert done.code == 0, done.err
    beam = beam_response(ShellDesign(10, 3), read_layup(LAYUP), [0.1, 0.2])
    found = [point["angle_deg"] for point in done.json["points"]]
    assert found == pytest.approx((0.9 * beam.angle_deg).tolist(), abs=0.1)
    assert [point["base_angle_deg"] for point in done.json["points"]] == pytest.approx(beam.angle_deg.tolist(), abs=0.1)
    assert done.json["points"][-1]["blocked_force_N"] == pytest.approx(beam.blocked_force_N[-1], rel=1e-2)
    assert sorted(p.name for p in (tmp_path / "new").iterdir()) == [
        f"tw3_slw10_found.{s}" for s in ("csv", "h5", "png")
    ]
    assert "found.yaml" in done.err and "not shown: creep" in done.err and "simulated" in done.json["statement"]
    table = pandas.read_csv(tmp_path / "new" / "tw3_slw10_found.csv")
    assert table["angle_deg"].tolist() == pytest.approx(found, rel=1e-6) and table["axial_stretch"].isna().all()
    file = read_response_file(tmp_path / "new" / "tw3_slw10_found.h5")
    assert file.states == () and file.extras["base_angle_deg"] == pytest.approx(beam.angle_deg, abs=0.1)
    assert file.curves.about["provenance"]["model"]["file"] == "found.yaml"
    assert [each["name"] for each in file.curves.about["simulation"]["model"]["effects"]] == [
        "end_caps",
        "viscoelasticity",
    ]
    assert cv2.imread(str(tmp_path / "new" / "tw3_slw10_found.png")) is not None


def test_what_a_model_does_not_go_with_is_refused(benchlab, tmp_path) -> None:
    model = beam_model(tmp_path / "found.yaml", end_caps={})
    short = (
        "simulate",
        "--tw-mm",
        3,
        "--slw-mm",
        10,
        "--pressure-MPa",
        "0.1",
        "--model",
        model,
        "--out",
        tmp_path / "new",
    )
    for option, value, what in (
        ("--material", "trial", "--model and --material"),
        ("--cap-mm", 5, "--cap-mm and --model"),
        ("--tip-force-at-deg", 10, "tip"),
    ):
        done = benchlab(*short, option, value)
        assert done.code == 2 and what in done.err and not (tmp_path / "new").exists()
    model.write_text(model.read_text(encoding="utf-8").replace("end_caps", "magic"), encoding="utf-8")
    done = benchlab(*short)
    assert done.code == 3 and "found.yaml" in done.err and "no effect is called 'magic'" in done.err
