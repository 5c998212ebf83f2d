"""Whole-actuator quantities: geometry in closed form, published force, CalculiX."""

import csv
from pathlib import Path

import numpy as np
import pytest
from scipy.integrate import cumulative_trapezoid

from benchlab.actuator import ShellDesign, tip_position_mm
from benchlab.errors import UsageError
from benchlab.io.layup_file import read_layup
from benchlab.simulation.actuator_response import Fixture, actuator_response, tip_force_N
from benchlab.simulation.laws import Polynomial
from benchlab.simulation.layup import Layup

REFERENCE = Path(__file__).parent / "calculix_reference.csv"
TRIAL = Layup("reference", "of the CalculiX runs", film=Polynomial(C10=1.5, C20=3.0))


def calculix(name):
    with REFERENCE.open(encoding="utf-8") as file:
        rows = [
            row
            for row in csv.DictReader(line for line in file if not line.startswith("#"))
            if (row["run"], row["elements"], row["design"]) == ("reference", "sheets", name)
        ]
    return np.array([(float(row["pressure_MPa"]), float(row["angle_deg"])) for row in rows]).T


@pytest.mark.parametrize("window, strip", [(3, 10), (3, 20), (9, 10), (3, 5)])
def test_angles_are_those_of_calculix(window, strip):
    pressures, angles = calculix(f"tw{window}_slw{strip}")
    assert len(pressures) == 10
    ours = actuator_response(ShellDesign(strip, window), TRIAL, list(pressures), blocked=False).angle_deg
    off = np.abs(ours - angles)
    assert ((off <= 1.0) | (off <= 0.02 * angles)).all(), off


def test_published_design():
    # FEM angle 130.2 deg, blocked force 37.72 N, linear in pressure (the paper's Table I and section III-B).
    found = actuator_response(ShellDesign(10, 3), read_layup("from-FEM-angles"), list(np.linspace(0.035, 0.35, 10)))
    assert found.limit_pressure_MPa is None
    assert found.angle_deg[-1] == pytest.approx(130.2, abs=5)
    assert found.blocked_force_N[-1] == pytest.approx(37.72, abs=0.5)
    assert np.corrcoef(found.pressure_MPa, found.blocked_force_N)[0, 1] ** 2 > 0.99
    assert np.degrees(found.curvature_per_mm * found.axial_stretch * 180) == pytest.approx(found.angle_deg)
    assert (np.diff(found.volume_mL) > 0).all()
    columns = found.columns()
    assert list(columns) == [
        "pressure_MPa",
        "angle_deg",
        "curvature_per_mm",
        "axial_stretch",
        "volume_mL",
        "moment_Nmm",
        "blocked_force_N",
    ]


def test_caps_bend_less_and_hold_a_round_section():
    free, capped = (
        actuator_response(ShellDesign(10, 3), TRIAL, [0.2], cap_mm=cap, blocked=False) for cap in (0.0, 9.0)
    )
    assert capped.angle_rad == pytest.approx(0.9 * free.angle_rad)
    radius = 40 / (2 * np.pi)
    assert capped.volume_mm3 == pytest.approx(0.9 * free.volume_mm3 + np.pi * radius**2 * 18)
    with pytest.raises(UsageError, match="caps of 90"):
        actuator_response(ShellDesign(10, 3), TRIAL, [0.2], cap_mm=90.0)


def test_beyond_bursting_points_are_missing():
    soft = Layup("soft", "Neo-Hooke has no hardening", film=Polynomial(C10=1.5))
    found = actuator_response(ShellDesign(10, 15), soft, [0.05, 0.1, 0.3], blocked=False)
    assert 0.1 < found.limit_pressure_MPa < 0.3
    assert found.pressure_MPa.tolist() == [0.05, 0.1]


def test_tip_of_an_arc():
    # The tip of an arc, by integrating its direction along it.
    angle, length = 1.7, 180.0
    along = np.linspace(0, length, 20001)
    turned = along / length * angle
    x = cumulative_trapezoid(np.sin(turned), along)[-1]
    z = cumulative_trapezoid(np.cos(turned), along)[-1]
    assert tip_position_mm(np.array(angle), length) == pytest.approx([x, z], rel=1e-6)


@pytest.mark.parametrize("angle", [1e-9, 0.5, 2.0])
def test_tip_force_does_the_work_of_the_moment(angle):
    step = 1e-5
    ahead, behind = (tip_position_mm(np.array(angle + sign * step), 180.0) for sign in (1, -1))
    moved = np.hypot(*(ahead - behind))
    assert float(tip_force_N(np.array(50.0), np.array(angle), 180.0)) * moved == pytest.approx(
        50.0 * 2 * step, rel=1e-5
    )


def test_fixtures():
    pressure, moment = np.array([0.1, 0.2]), np.array([30.0, 70.0])
    assert Fixture(lever_arm_mm=10.0).force_N(pressure, moment) == pytest.approx([3.0, 7.0])
    assert Fixture(None, contact_area_mm2=100.0).force_N(pressure, moment) == pytest.approx([10.0, 20.0])
    assert str(Fixture(lever_arm_mm=10.0)) == "lever arm 10 mm"
    for wrong in ({"lever_arm_mm": None}, {"contact_area_mm2": 5.0}, {"lever_arm_mm": -1.0}):
        with pytest.raises(UsageError, match="fixture"):
            Fixture(**wrong)
