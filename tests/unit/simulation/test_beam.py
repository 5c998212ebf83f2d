"""The beam against closed forms, against the published angles, and beside the shell cell."""

from dataclasses import replace

import numpy as np
import pytest

from benchlab.actuator import ShellDesign
from benchlab.errors import UsageError
from benchlab.io.layup_file import read_layup
from benchlab.io.published import published_angles
from benchlab.simulation.actuator_response import actuator_response
from benchlab.simulation.beam import beam_response
from benchlab.simulation.beam_window import Film, Wall, bow_rad, bow_slope, force_and_volume, window_at
from benchlab.simulation.laws import Ogden, Polynomial, StVenantKirchhoff
from benchlab.simulation.layup import Layer, Layup

SOFT = Polynomial(C10=1.5, C20=3.0)
LAYUP = Layup("trial", "guessed", film=SOFT)
STIFF = StVenantKirchhoff(1e7, 0.0)
PRESSURES = np.linspace(0.0, 0.35, 8)


def film(width_mm, law=SOFT, radius_mm=40 / (2 * np.pi), thickness_mm=0.3):
    return Film(Wall((Layer("film", law, 0.0, thickness_mm),)), width_mm, radius_mm)


def linear_angles(design, layup, pressure):
    """θ (rad) and λ0 − 1 of a film and a strip that are linear, by the two balances with integrals in closed form."""
    R, edge = design.perimeter_mm / (2 * np.pi), np.pi * design.strip_width_mm / design.perimeter_mm

    def moments(start, end):  # of x = R(1 − cos φ) over both halves of the section
        def upto(a):
            return np.array([a, a - np.sin(a), 1.5 * a - 2 * np.sin(a) + np.sin(2 * a) / 4])

        return 2 * np.array([R, R**2, R**3]) * (upto(end) - upto(start))

    film_stiff = layup.film_thickness_mm * 4 * layup.film.shear_modulus_MPa
    E, nu = layup.fabric.youngs_modulus_MPa, layup.fabric.poisson_ratio
    strip_stiff = layup.strip_thickness_mm * E / (1 - nu**2) + film_stiff
    tw = design.window_width_mm
    K = film_stiff * (tw + design.rib_width_mm) / tw * moments(edge, np.pi) + strip_stiff * moments(0, edge)
    stretch, k = np.linalg.solve([[K[0], K[1]], [K[1], K[2]]], pressure * np.pi * R**2 * np.array([1, R]))
    return k * design.length_mm, stretch


@pytest.mark.parametrize("window, strip, perimeter", [(3, 10, 40), (9, 5, 40), (15, 20, 60)])
def test_small_strains_are_those_of_the_linear_beam(window, strip, perimeter):
    design = ShellDesign(strip, window, perimeter_mm=perimeter)
    found = beam_response(design, LAYUP, [1e-5])
    angle, stretch = linear_angles(design, LAYUP, 1e-5)
    assert found.angle_rad[0] == pytest.approx(angle, rel=1e-3)
    assert found.axial_stretch[0] - 1 == pytest.approx(stretch, rel=2e-3, abs=1e-9)


@pytest.mark.parametrize("perimeter", [40, 80])
def test_stiff_narrow_strip_has_its_curvature_in_closed_form_whatever_the_radius(perimeter):
    design = ShellDesign(0.2, 5, perimeter_mm=perimeter)
    found = beam_response(design, replace(LAYUP, fabric=STIFF), [1e-5])
    kappa = 1e-5 * 5 / (3 * 0.3 * 4 * SOFT.shear_modulus_MPa * 7)
    assert found.curvature_per_mm[0] == pytest.approx(kappa, rel=0.01)


@pytest.mark.parametrize("law", [SOFT, Polynomial(C10=1.5), Ogden((1.0, 0.1), (2.0, 4.0))])
@pytest.mark.parametrize("ballooning", [0.0, 1.0])
def test_section_is_in_balance(law, ballooning):
    """Both balances, integrated anew on other points from the windows' forces at the state that was found."""
    design, pressure = ShellDesign(10, 3), 0.15
    found = beam_response(design, replace(LAYUP, film=law), [0.05, 0.1, pressure], ballooning=ballooning)
    R, k = 40 / (2 * np.pi), found.angle_rad[-1] / 180
    phi = (np.arange(3000) + 0.5) / 3000 * np.pi
    x, on_strip = R * (1 - np.cos(phi)), phi * R < 5
    stretch = found.axial_stretch[-1] + k * x
    window = film(3.0, law)
    opening = 3 + (stretch - 1) * 5
    bow = bow_rad(window, opening, ballooning * pressure) if ballooning else np.zeros_like(opening)
    force, _ = force_and_volume(window, opening, bow, ballooning * pressure)
    strip = Wall((Layer("strip", LAYUP.fabric, 0, 0.3), Layer("film", law, 0, 0.3)))
    pulled = np.where(on_strip, strip.tensions_N_per_mm(stretch, np.ones_like(stretch))[0], force)
    load = pressure * np.pi * R**2
    ds = 2 * R * np.pi / len(phi)
    assert pulled.sum() * ds == pytest.approx(load, rel=1e-3)
    assert (pulled * x).sum() * ds == pytest.approx(load * R, rel=1e-3)
    assert found.limit_pressure_MPa is None


def test_bow_is_where_the_energy_is_least():
    """Energy and volume of the arc by plain sums, against the slope in α and the force in c."""
    window, pressure = film(9.0), 0.2

    def potential(c, alpha):
        xi = (np.arange(4000) + 0.5) / 4000 * 2 - 1
        rho = c / (2 * np.sin(alpha))
        y, z = rho * (np.cos(xi * alpha) - np.cos(alpha)), rho * np.sin(np.linspace(-1, 1, 4001) * alpha)
        stretch = np.full_like(xi, 2 * rho * alpha / 9)
        energy = window.wall.energy_N_per_mm(stretch, 1 + y / window.radius_mm).mean() * 9
        return energy - pressure * ((y + y**2 / (2 * window.radius_mm)) * np.diff(z)).sum()

    for c, alpha in [(10.0, 0.3), (12.0, 0.9)]:
        slope = (potential(c, alpha + 1e-4) - potential(c, alpha - 1e-4)) / 2e-4
        assert bow_slope(window, np.array([c]), np.array([alpha]), pressure)[0] == pytest.approx(slope, rel=1e-4)
        force = (potential(c + 1e-3, alpha) - potential(c - 1e-3, alpha)) / 2e-3
        assert force_and_volume(window, np.array([c]), np.array([alpha]), pressure)[0][0] == pytest.approx(
            force, rel=1e-4
        )
    c = np.array([9.5, 11.0])
    found = bow_rad(window, c, pressure)
    for each, alpha in zip(c, found):
        near = [potential(each, alpha + off) for off in (-0.02, 0.0, 0.02)]
        assert near[1] < min(near[0], near[2])


def test_narrow_window_bows_as_a_strip_under_pressure():
    """Laplace: q = T/ρ, and the ribs feel T·cos α; its hoop stretch does not count where the radius is large."""
    window, pressure = film(3.0, radius_mm=3000.0), 0.3
    alpha = bow_rad(window, np.array([3.6]), pressure)[0]
    arc = 3.6 / 3 * alpha / np.sin(alpha)
    tension = window.wall.tensions_N_per_mm(np.array(arc), np.array(1.0))[0]
    assert np.sin(alpha) == pytest.approx(pressure * 3.6 / (2 * tension), rel=2e-3)
    force, volume = force_and_volume(window, np.array([3.6]), np.array([alpha]), pressure)
    assert force[0] == pytest.approx(tension * np.cos(alpha), rel=2e-3)
    assert volume[0] == pytest.approx(
        (3.6 / 2 / np.sin(alpha)) ** 2 * (alpha - np.sin(alpha) * np.cos(alpha)), rel=2e-3
    )


def test_flat_window_pulls_with_the_films_tension():
    window = film(3.0)
    flat = window_at(window, 0.0)
    stretch = flat.opening_mm / 3
    nominal = 0.3 * (2 * SOFT.C10 + 4 * SOFT.C20 * (stretch**2 + stretch**-2 - 2)) * (stretch - stretch**-3)
    assert flat.force_N_per_mm == pytest.approx(nominal, rel=1e-7, abs=1e-12)
    assert (flat.bow_rad == 0).all() and (flat.volume_mm2 < 1e-12).all()


def test_units_and_columns():
    """θ = κ·λ0·al; lengths twice as large at the same pressure give the same angle per cell, 8 times the volume."""
    one = beam_response(ShellDesign(10, 3), LAYUP, [0.1, 0.3], ballooning=1)
    double = replace(LAYUP, film_thickness_mm=0.6, strip_thickness_mm=0.6)
    two = beam_response(ShellDesign(20, 6, 4, 80, 360), double, [0.1, 0.3], ballooning=1)
    assert two.angle_deg == pytest.approx(one.angle_deg, rel=1e-6)
    assert two.volume_mL == pytest.approx(8 * one.volume_mL, rel=1e-6)
    assert two.moment_Nmm == pytest.approx(8 * one.moment_Nmm, rel=1e-6)
    assert one.angle_rad == pytest.approx(one.curvature_per_mm * one.axial_stretch * 180, rel=1e-12)
    assert list(one.columns()) == list(actuator_response(ShellDesign(10, 3), LAYUP, [0.1], blocked=False).columns())


def test_volume_is_that_of_pappus_and_moment_that_of_virtual_work():
    """Bare: V = πR²·(λ0 + k·R)·al. Held straight, M is what pressure does at the end less what the walls bear there."""
    found = beam_response(ShellDesign(10, 3), LAYUP, [0.2])
    R, k = 40 / (2 * np.pi), found.angle_rad[0] / 180
    assert found.volume_mm3[0] == pytest.approx(np.pi * R**2 * (found.axial_stretch[0] + k * R) * 180, rel=1e-9)
    assert 0.5 * 0.2 * np.pi * R**3 < found.moment_Nmm[0] < 0.2 * np.pi * R**3
    bows = beam_response(ShellDesign(10, 3), LAYUP, [0.2], ballooning=1)
    assert bows.volume_mm3[0] > np.pi * R**2 * (bows.axial_stretch[0] + bows.angle_rad[0] / 180 * R) * 180


@pytest.mark.parametrize("window", [3, 15])
def test_bending_stiffness_is_what_holds_it_straight_over_how_far_it_would_bend(window):
    """In the small, where both are linear in pressure."""
    found = beam_response(ShellDesign(strip_width_mm=10, window_width_mm=window), LAYUP, [1e-6])
    held, free = found.moment_Nmm[0], found.angle_rad[0] / found.design.length_mm
    assert found.bending_stiffness_Nmm2()[0] == pytest.approx(held / free, rel=1e-3)


def test_caps_shorten_the_part_that_bends():
    free = beam_response(ShellDesign(10, 3), LAYUP, [0.2], blocked=False)
    capped = beam_response(ShellDesign(10, 3), LAYUP, [0.2], cap_mm=18, blocked=False)
    assert capped.angle_deg[0] == pytest.approx(0.8 * free.angle_deg[0], rel=1e-12)
    assert np.isnan(free.moment_Nmm[0])


@pytest.mark.parametrize("ballooning", [0.0, 0.5, 1.0])
def test_angle_grows_with_pressure_from_nothing(ballooning):
    found = beam_response(ShellDesign(10, 9), LAYUP, PRESSURES, ballooning=ballooning)
    assert found.angle_deg[0] == pytest.approx(0, abs=1e-6) and found.volume_mL[0] == pytest.approx(22.918, abs=1e-3)
    assert (np.diff(found.angle_deg) > 0).all() and (np.diff(found.volume_mL) > 0).all()
    assert (np.diff(found.moment_Nmm) > 0).all()


def test_pressures_do_not_depend_on_those_before():
    alone = beam_response(ShellDesign(10, 9), LAYUP, [0.35], ballooning=1)
    after = beam_response(ShellDesign(10, 9), LAYUP, PRESSURES, ballooning=1)
    assert alone.angle_deg[0] == pytest.approx(after.angle_deg[-1], abs=1e-6)


def test_seam_margin_and_bladder_of_the_layup_count():
    bare = beam_response(ShellDesign(10, 3), LAYUP, [0.3], blocked=False).angle_deg[0]
    welded = beam_response(ShellDesign(10, 3), replace(LAYUP, seam_margin_mm=0.5), [0.3], blocked=False).angle_deg[0]
    narrow = beam_response(ShellDesign(11, 2, 3), replace(LAYUP, weld_width_mm=0), [0.3], blocked=False).angle_deg[0]
    lined = beam_response(ShellDesign(10, 3), replace(LAYUP, bladder_N_per_mm=0.5), [0.3], blocked=False).angle_deg[0]
    assert welded < bare and lined < bare
    assert welded == pytest.approx(narrow, rel=0.02)


def test_soft_film_ends_at_a_limit():
    soft = replace(LAYUP, film=Polynomial(C10=0.2))
    found = beam_response(ShellDesign(10, 15), soft, PRESSURES, ballooning=1)
    assert found.limit_pressure_MPa is not None and found.limit_pressure_MPa == found.pressure_MPa[-1] < 0.35
    assert len(found.angle_deg) == len(found.pressure_MPa) == len(found.moment_Nmm)


@pytest.mark.parametrize("name", ["from-FEM-angles", "from-measured-angles", "trial"])
def test_bare_gap_to_the_published_angles_grows_with_the_window_and_bulging_closes_most_of_it(name):
    layup = read_layup(name)
    gaps = {}
    for each in published_angles():
        if each.measured_angle_deg is not None:
            bare, bowed = (
                beam_response(each.design, layup, [each.pressure_MPa], blocked=False, ballooning=b).angle_deg[0]
                for b in (0.0, 1.0)
            )
            key = (each.design.window_width_mm, each.design.strip_width_mm)
            gaps[key] = (bare - each.measured_angle_deg, bowed - each.measured_angle_deg)
    bare = [gaps[tw, 10][0] for tw in (3, 9, 15)]
    assert bare[0] < 0.25 * bare[1] < 0.25 * bare[2], bare
    before, after = (np.sqrt(np.mean([pair[i] ** 2 for pair in gaps.values()])) for i in (0, 1))
    assert before > 85 and after < 0.25 * before, (before, after)


def test_narrow_windows_are_near_the_shell_cell_and_wide_ones_only_when_they_bulge():
    layup = read_layup("from-measured-angles")
    for window, bare_off, bowed_off in [(1, 0.10, 0.10), (9, None, 0.15)]:
        design = ShellDesign(10, window)
        cell = actuator_response(design, layup, [0.1, 0.2], blocked=False).angle_deg[-1]
        bare, bowed = (beam_response(design, layup, [0.2], blocked=False, ballooning=b).angle_deg[0] for b in (0, 1))
        assert bowed == pytest.approx(cell, rel=bowed_off)
        if bare_off:
            assert bare == pytest.approx(cell, rel=bare_off)
        else:
            assert bare > 1.5 * cell


def test_what_is_refused():
    for bad in ({"ballooning": 1.1}, {"ballooning": float("nan")}, {"cap_mm": 90}, {"pressures_MPa": [0.2, 0.1]}):
        with pytest.raises(UsageError):
            beam_response(**{"design": ShellDesign(10, 3), "layup": LAYUP, "pressures_MPa": [0.1], **bad})
