"""What a design should do: stated, from a response table, from a sweep; refused where it is of another design."""

import math
from dataclasses import replace
from pathlib import Path

import pytest

from benchlab.actuator import ShellDesign
from benchlab.errors import BenchlabError, InputError
from benchlab.io.response_file import CURVES
from benchlab.io.study_file import StudyDesign, StudySimulated
from benchlab.workflows.study_simulated import simulated_of
from benchlab.workflows.study_values import simulated_or_missing

SWEEP = Path(__file__).resolve().parents[3] / "sample_data" / "simulated.h5"
DESIGN = StudyDesign("d", ShellDesign(strip_width_mm=10, window_width_mm=3), None, (), ())


def of_file(path: Path, design: StudyDesign = DESIGN) -> StudyDesign:
    return replace(design, simulated=StudySimulated(path, path.name, None, ""))


def test_nothing_or_a_stated_angle() -> None:
    assert simulated_of(DESIGN, 0.35) is None
    found = simulated_of(replace(DESIGN, simulated=StudySimulated(None, "", 130.2, "Table I")), 0.35)
    assert found is not None and (found.angle_deg, found.source, len(found.curve_deg)) == (130.2, "Table I", 0)


def test_a_sweep_gives_the_curve_of_the_design_with_its_material() -> None:
    found = simulated_of(of_file(SWEEP), 0.35)
    assert found is not None and found.angle_deg == pytest.approx(125.76, abs=0.01)
    assert found.source == "simulated with material from-FEM-angles (simulated.h5)"
    assert (found.pressure_MPa[0], found.pressure_MPa[-1]) == (0, 0.35)
    between = simulated_of(of_file(SWEEP), 0.3325)
    assert between is not None
    assert between.angle_deg == pytest.approx((found.curve_deg[-1] + found.curve_deg[-2]) / 2, abs=1e-9)


@pytest.mark.parametrize(
    ("shell", "words"),
    [
        (ShellDesign(7, 3), "no design of this sweep has tw_mm 3, slw_mm 7"),
        (None, "the dimensions of this one are not told"),
    ],
)
def test_a_sweep_without_the_design_is_refused(shell: ShellDesign | None, words: str) -> None:
    with pytest.raises(InputError, match=words):
        simulated_of(of_file(SWEEP, replace(DESIGN, shell=shell)), 0.35)


def test_a_table_of_curves_is_interpolated_and_not_stretched(tmp_path: Path) -> None:
    rows = [[p, 100 * p, *[0] * (len(CURVES) - 2)] for p in (0.0, 0.1, 0.2)]
    path = tmp_path / "r.csv"
    path.write_text("\n".join([",".join(CURVES), *(",".join(map(str, row)) for row in rows)]) + "\n")
    found = simulated_of(of_file(path), 0.15)
    assert found is not None and found.angle_deg == pytest.approx(15)
    beyond, (missing,) = simulated_or_missing(of_file(path), 0.35)
    assert beyond is not None and math.isnan(beyond.angle_deg)
    assert missing.why == "no simulated angle at 0.35 MPa: simulated is 0 to 0.2 MPa"


def test_a_file_that_is_none_is_missing_with_its_reason(tmp_path: Path) -> None:
    (tmp_path / "r.h5").write_text("no")
    for name in ("r.h5", "none.h5"):
        with pytest.raises(BenchlabError):
            simulated_of(of_file(tmp_path / name), 0.35)
        found, (missing,) = simulated_or_missing(of_file(tmp_path / name), 0.35)
        assert found is None and name in missing.why and missing.design == "d"
