"""Twin files: what they switch, and what is refused with its line."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from benchlab.actuator import ShellDesign
from benchlab.errors import InputError, UsageError
from benchlab.io.layup_file import read_layup
from benchlab.io.truth_table import FIRST_LINE, write_truth_csv
from benchlab.io.twin_file import read_curve, read_twin, shipped_curve
from benchlab.simulation.actuator_response import actuator_response
from benchlab.twin.effects.catalogue import DEFAULT, EFFECTS
from benchlab.twin.truth import COLUMNS, Truth


def written(tmp_path: Path, text: str) -> Path:
    path = tmp_path / "twin.yaml"
    path.write_text(text)
    return path


def test_the_twin_that_comes_with_benchlab() -> None:
    twin = read_twin(None)
    assert tuple(twin.effects) == DEFAULT and twin.seed == 1 and twin.length_mm == 180
    assert all(effect == EFFECTS[name]() for name, effect in twin.effects.items())


def test_the_shipped_curve_is_what_the_simulation_gives() -> None:
    curve = shipped_curve()
    at = [0.05, 0.2, 0.35]
    found = actuator_response(ShellDesign(10, 3), read_layup("from-measured-angles"), at, blocked=False)
    assert np.interp(at, curve.pressure_MPa, curve.angle_deg) == pytest.approx(found.angle_deg, rel=1e-3)
    assert np.interp(at, curve.pressure_MPa, curve.volume_mL) == pytest.approx(found.volume_mL, rel=1e-4)


def test_effects_are_switched_and_set(tmp_path: Path) -> None:
    text = """
seed: 7
effects:
  friction: {half_width_deg_per_MPa: 6}
  softening: on
  viscoelasticity: off
faults:
  burst: {at_s: 3}
camera: {frames_per_s: 60}
"""
    twin = read_twin(written(tmp_path, text))
    assert set(twin.effects) == {*DEFAULT, "softening", "burst"} - {"viscoelasticity"}
    assert twin.effects["friction"] == EFFECTS["friction"](half_width_deg_per_MPa=6.0)
    assert twin.effects["burst"] == EFFECTS["burst"](at_s=3.0) and twin.effects["softening"] == EFFECTS["softening"]()
    assert list(twin.effects) == [name for name in EFFECTS if name in twin.effects]
    assert twin.seed == 7 and twin.camera.frames_per_s == 60


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("effects:\n  softning: on\n", r"line 2: unknown key effects.softning; did you mean softening"),
        ("effects:\n  friction: {half_width: 3}\n", "line 2: unknown key effects.friction.half_width"),
        ("effects:\n  friction: {half_width_deg: 300}\n", "line 2: effects.friction.half_width_deg is 300; give 20 or less"),
        ("effects:\n  friction:\n", "line 2: effects.friction is null"),
        ("effects:\n  friction: yes\n", "line 2: effects.friction is \"yes\""),
        ("effects:\n  burst: on\n", "line 2: unknown key effects.burst"),
        ("faults:\n  burst: {at_s: -1}\n", "line 2: faults.burst.at_s is -1"),
        ("seed: 1.5\n", "line 1: seed is 1.5"),
        ("seed: 1\nseed: 2\n", "line 2: duplicate key seed"),
        ("camera: {width_px: 641}\n", "even"),
        ("effects:\n  viscoelasticity: {share_1: 0.6, share_2: 0.6}\n", "viscoelasticity: share_1 and share_2 are 1.2 together"),
        ("seed: -1\neffects: {gravity: maybe}\n", "2 things are wrong"),
    ],
)  # fmt: skip
def test_refused(tmp_path: Path, text: str, words: str) -> None:
    with pytest.raises(InputError, match=words) as error:
        read_twin(written(tmp_path, text))
    assert "twin.yaml" in str(error.value)


def test_a_curve_beside_the_file(tmp_path: Path) -> None:
    header = "pressure_MPa,angle_deg,curvature_per_mm,axial_stretch,volume_mL,moment_Nmm,blocked_force_N\n"
    (tmp_path / "a.csv").write_text(header + "0,0,0,1,20,,\n0.1,30,0.003,1,21,,\n0.2,50,0.005,1,22,,\n0.3,,,,,,\n")
    (tmp_path / "late.csv").write_text(header + "0.1,30,0.003,1,21,,\n0.2,50,0.005,1,22,,\n")
    twin = read_twin(written(tmp_path, "curve: a.csv\n"))
    assert twin.curve.angle_deg.tolist() == [0, 30, 50] and twin.curve.last_MPa == 0.2 and twin.design == "a"
    assert read_curve(tmp_path / "a.csv").source == "a.csv"
    alone = read_twin(tmp_path / "a.csv")
    assert alone.curve.angle_deg.tolist() == [0, 30, 50] and tuple(alone.effects) == DEFAULT and alone.length_mm == 180
    with pytest.raises(InputError, match=r"late.csv: .*begin at 0 MPa"):
        read_twin(written(tmp_path, "curve: late.csv\n"))
    with pytest.raises(UsageError, match="no such file"):
        read_twin(written(tmp_path, "curve: none.csv\n"))
    with pytest.raises(InputError, match="length_mm is 150, and the curve was simulated for 180"):
        read_twin(written(tmp_path, "length_mm: 150\n"))


def test_the_truth_says_that_it_is_simulated(tmp_path: Path) -> None:
    truth = Truth(*(np.arange(3) + 0.1 * i for i in range(len(COLUMNS))))
    write_truth_csv(tmp_path / "a.truth.csv", truth)
    lines = (tmp_path / "a.truth.csv").read_text().splitlines()
    assert lines[0] == FIRST_LINE and "simulated, not measured" in lines[0]
    assert lines[1].split(",")[0] == "time_s" and len(lines) == 5
    assert [float(x) for x in lines[4].split(",")] == pytest.approx([2 + 0.1 * i for i in range(len(COLUMNS))])
