"""CalculiX decks, run: a tube of one material against the closed form, cells against each other."""

import re
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from scipy.optimize import fsolve

from benchlab.actuator import ShellDesign
from benchlab.deck.calculix import calculix_deck
from benchlab.deck.sheets import sheets_of
from benchlab.deck.solid import solid_of
from benchlab.deck.tube import Extent, Section, Tube, tube_of
from benchlab.io.calculix import find_calculix, read_displacements, run_calculix
from benchlab.simulation.laws import Law, Polynomial
from benchlab.simulation.layup import Layer, Layup
from benchlab.workflows.calculix_run import read_angles_deg

needs_calculix = pytest.mark.skipif(
    find_calculix() is None, reason="CalculiX (ccx) is not installed: apt package calculix-ccx"
)
DESIGN = ShellDesign(strip_width_mm=10, window_width_mm=3)
LAYUP = Layup("test", "guess", film=Polynomial(C10=1.5, C20=3.0))


def one_material(extent: Extent, law: Law, thickness_mm: float) -> Tube:
    tube = tube_of(DESIGN, LAYUP, extent, around_mm=2.5, along_mm=1.25)
    layer = Layer("film", law, -thickness_mm / 2, thickness_mm / 2)
    return replace(tube, sections=(Section("LAMINATE_1", (layer,), tube.wall),))


@needs_calculix
def test_a_tube_of_one_material_inflates_as_the_closed_form_says(tmp_path: Path) -> None:
    """A long thin closed cylinder: h·∂W/∂λθ = p·R·λθ·λz and h·∂W/∂λz = p·R·λθ²/2."""
    law, thickness, pressure = Polynomial(C10=1.5, C20=0.2), 0.05, 0.011
    radius = DESIGN.diameter_mm / 2

    def unbalanced(stretches: np.ndarray) -> np.ndarray:
        hoop, axial = stretches
        at = law.energy(np.array(hoop**2 + axial**2), np.array(hoop**2 * axial**2))
        by_hoop = at.W_a * 2 * hoop + at.W_b * 2 * hoop * axial**2
        by_axial = at.W_a * 2 * axial + at.W_b * 2 * axial * hoop**2
        load = pressure * (radius - thickness / 2) / thickness
        return np.array([by_hoop - load * hoop * axial, by_axial - load * hoop**2 / 2])

    hoop, axial = fsolve(unbalanced, [1.1, 1.0])
    assert hoop > 1.15
    tube = one_material(Extent(2), law, thickness)
    deck = tmp_path / "tube.inp"
    deck.write_text(calculix_deck(tube, [pressure], bulk_over_shear=500.0))
    (sets,) = read_displacements(run_calculix(deck, timeout_s=600)).values()
    for name, stretch in (("RIB_001", None), ("RIB_002", axial)):
        nodes, moved = sets[name]
        at = tube.nodes_mm[nodes - 1]
        across = np.ptp(at[:, 0] + moved[:, 0]) / (2 * radius)
        assert across == pytest.approx(hoop, rel=0.01)
        if stretch:
            assert 1 + moved[:, 2].mean() / at[0, 2] == pytest.approx(stretch, rel=0.01)


@needs_calculix
@pytest.mark.parametrize(("make", "pressure_MPa"), [(sheets_of, 0.02), (solid_of, 0.03)])
def test_cells_bend_alike_from_mid_rib_and_from_mid_window(make, pressure_MPa: float, tmp_path: Path) -> None:
    """Two cells from a rib, one and a half from a window: all alike but for the cap, which the last cell feels."""
    angles = []
    for extent in (Extent(2), Extent(2, from_window=True)):
        model = make(tube_of(DESIGN, LAYUP, extent, around_mm=5.0, along_mm=1.5))
        deck = tmp_path / "cells.inp"
        deck.write_text(calculix_deck(model, [pressure_MPa], bulk_over_shear=100.0))
        angles.append(read_angles_deg(run_calculix(deck, timeout_s=600), model)[-1])
    assert angles[0].shape == angles[1].shape == (2,)
    assert angles[0][0] > 5
    assert angles[0][0] == pytest.approx(angles[1][0], rel=0.02)
    assert angles[0] == pytest.approx(angles[0][0], rel=0.06)


def test_a_deck_uses_only_what_it_defines() -> None:
    for model in (tube_of(DESIGN, LAYUP, Extent(1)), solid_of(tube_of(DESIGN, LAYUP, Extent(1)))):
        deck = calculix_deck(model, [0.1, 0.2], ["a heading"])
        sets = set(re.findall(r"^\*(?:NSET|ELSET), \w+=(\w+)", deck, re.MULTILINE))
        materials = set(re.findall(r"^\*MATERIAL, NAME=(\w+)", deck, re.MULTILINE))
        assert deck.startswith("** a heading\n*NODE\n")
        assert set(re.findall(r"ELSET=(\w+), (?:MATERIAL|COMPOSITE)", deck)) <= sets
        assert set(re.findall(r"^\*NODE PRINT, NSET=(\w+)", deck, re.MULTILINE)) <= sets
        assert set(re.findall(r"MATERIAL=(\w+)", deck)) | set(re.findall(r"^0\.3, , (\w+)", deck, re.M)) == materials
        assert re.findall(r"PRESSURES\n([\d.]+)\n([\d.]+)\n\*STEP", deck) == [("0.5", "1")]
        assert all(len(line) <= 132 for line in deck.splitlines())
