"""The section on blocked force: words, tables and figures of drawn results, beside the paper's force."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
from scipy.stats import ttest_ind_from_stats

from benchlab.actuator import ShellDesign
from benchlab.force.curve import ActuatorCycles, BlockedForce, blocked_force
from benchlab.report.document import Pictures, Section, Table, Words
from benchlab.report.study.document import study_document
from benchlab.report.study.force import force_section
from tests.unit.report import studies

STEPS = np.round(0.035 * np.arange(1, 11), 3)
LEVELS = np.repeat(STEPS, 5)
SHELL = ShellDesign(window_width_mm=3, strip_width_mm=10)


def force(slopes: tuple[float, ...] = (104.0, 108.0, 112.0), bow_N: float = 0.0, **options: Any) -> BlockedForce:
    rng = np.random.default_rng(7)
    bow = bow_N * (1 - ((LEVELS - LEVELS.mean()) / np.ptp(LEVELS) * 2) ** 2)
    lower = options.pop("lower_bound", np.zeros(50, bool))
    records = [
        ActuatorCycles(f"a{i}", slope * LEVELS + bow + rng.normal(0, 0.2, 50), LEVELS, lower)
        for i, slope in enumerate(slopes, start=1)
    ]
    return blocked_force(records, **options)


def section(*forces: BlockedForce | None, shell: ShellDesign | None = SHELL) -> Section | None:
    designs = tuple(studies.design(f"d{i}", 100, 2, shell=shell, force=one) for i, one in enumerate(forces, start=1))
    return force_section(studies.report(studies.values(designs)))


def words_of(found: Section | None) -> str:
    assert found is not None
    return " ".join(f"{block.head} {block.text}" for block in found.blocks if isinstance(block, Words))


def tables_of(found: Section | None) -> dict[str, Table]:
    assert found is not None
    return {block.name: block for block in found.blocks if isinstance(block, Table)}


def test_the_section_stands_behind_the_curves_and_only_where_there_is_a_force() -> None:
    assert section(None) is None
    designs = (studies.design("d1", 100, 2, shell=SHELL, force=force()), studies.design("d2", 80, 2))
    titles = [one.title for one in study_document(studies.report(studies.values(designs))).sections]
    assert titles.index("Blocked force") == titles.index("Angle against pressure") + 1


def test_a_line_is_told_with_its_force_and_beside_the_paper() -> None:
    one = force()
    text = words_of(section(one))
    mean, sd = one.over_actuators_N[-1], one.sd_N[-1]
    assert f"d1: {mean:.2f} ± {sd:.2f} N at 0.35 MPa (3 actuators, 150 cycles at 10 pressures)" in text
    assert "Nothing speaks against a line: lack of fit F(8, 16)" in text
    p = ttest_ind_from_stats(mean, sd, 3, 37.72, 1.56, 3, equal_var=False).pvalue
    assert (
        f"The paper gives 37.72 ± 1.56 N for this design at 0.35 MPa (3 actuators): here − paper {mean - 37.72:.2f} N"
        in text.replace("−0", "-0")
    )
    assert f"p = {p:.2g})" in text


def test_a_bow_is_told() -> None:
    assert "It is not linear in pressure" in words_of(section(force(bow_N=1.5)))


def test_other_dimensions_and_other_pressures_are_not_set_beside_the_paper() -> None:
    assert "The paper gives" not in words_of(section(force(), shell=ShellDesign(window_width_mm=3, strip_width_mm=5)))
    assert "The paper gives" not in words_of(section(force(), shell=None))
    low = blocked_force([ActuatorCycles("a", 100 * LEVELS[:25], LEVELS[:25], np.zeros(25, bool))])
    assert "The paper gives" not in words_of(section(low))


def test_tables_hold_forces_and_lines() -> None:
    one = force()
    tables = tables_of(section(one, force((100.0, 101.0))))
    rows = tables["blocked_force"].rows
    assert len(rows) == 20
    assert [row[1].value for row in rows[:10]] == STEPS.tolist()
    assert [row[4].value for row in rows[:10]] == pytest.approx(one.over_actuators_N)
    assert one.line is not None and one.line.linearity is not None
    first = dict(
        zip((column.name for column in tables["blocked_force_lines"].columns), tables["blocked_force_lines"].rows[0])
    )
    assert first["slope_N_per_MPa"].value == pytest.approx(one.line.slope_N_per_MPa.value)
    assert first["slope_low_N_per_MPa"].value == pytest.approx(one.line.slope_N_per_MPa.low)
    assert first["lack_of_fit_p"].value == one.line.linearity.p


def test_the_lever_arm_is_said_to_be_missing_or_stated() -> None:
    one = force()
    moment = 0.35 * math.pi * (40 / math.pi / 2) ** 3
    text = words_of(section(one))
    assert "the study does not state it (lever_arm_mm)" in text
    assert f"p·π·R³ = {moment:.0f} N·mm at 0.35 MPa" in text and moment == pytest.approx(284, abs=1)
    assert f"a lever arm of {moment / one.over_actuators_N[-1]:.1f} mm" in text
    told = words_of(section(force(lever_arm_mm=7.5)))
    assert f"7.5 mm, so that the moment at 0.35 MPa is {7.5 * one.over_actuators_N[-1]:.0f} N·mm" in told


def test_lower_bounds_one_actuator_and_no_line() -> None:
    found = section(force(lower_bound=np.arange(50) >= 45))
    assert "≥ 37" in words_of(found) and "lower bounds" in words_of(found)
    assert tables_of(found)["blocked_force"].rows[-1][4].text.startswith("≥ ")
    alone = words_of(section(force((104.0,))))
    assert "Linearity was not tested" in alone and "±" not in alone.split("(")[0]
    single = blocked_force([ActuatorCycles("a", np.array([3.0]), np.array([0.2]), np.zeros(1, bool))])
    assert "No line: a line needs two pressures" in words_of(section(single))
    assert "blocked_force_lines" not in tables_of(section(single))


def test_each_design_has_a_panel_of_its_own_name() -> None:
    found = section(force(), force((100.0,)))
    assert found is not None
    (pictures,) = [block for block in found.blocks if isinstance(block, Pictures)]
    assert [panel.name for panel in pictures.panels] == ["force_d1", "force_d2"]
    assert all(panel.svg.startswith("<?xml") and panel.png.startswith(b"\x89PNG") for panel in pictures.panels)
