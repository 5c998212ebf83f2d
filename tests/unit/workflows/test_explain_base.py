"""The base that explain compares with: against cells simulated anew, from its cache, at its ends."""

import functools
from dataclasses import replace

import numpy as np
import pytest

from benchlab.actuator import ShellDesign
from benchlab.discrepancy.base import DesignBase
from benchlab.errors import BatchError, InputError, UsageError
from benchlab.io.layup_file import read_layup
from benchlab.simulation.actuator_response import actuator_response
from benchlab.simulation.laws import Polynomial
from benchlab.simulation.layup import Layup
from benchlab.workflows import explain_base
from benchlab.workflows.batch import Outcome
from benchlab.workflows.explain_base import cell_base, check_surrogate, foreign_base, surrogate
from benchlab.workflows.explain_cache import default_cache, key_of, read_cached
from benchlab.workflows.explain_curves import Wanted
from benchlab.workflows.explain_structure import design_with, knob_values

TRIAL = read_layup("trial")
DESIGN = ShellDesign(10, 3)
PRESSURES = [0.0, 0.01, 0.03, 0.06, 0.1, 0.15, 0.2]
FILM = ("film_modulus",)


@functools.cache
def film_base():
    return cell_base({"a": DESIGN}, TRIAL, PRESSURES, forces=True, knobs=FILM)


def solved(design, layup, pressures=PRESSURES):
    return actuator_response(design, layup, pressures)


def test_curves_are_those_of_the_cell_at_its_pressures_and_between():
    table, between = film_base().designs["a"], [0.02, 0.08, 0.18]
    cell = solved(DESIGN, TRIAL, between)
    for quantity, truth in (
        ("angle_deg", cell.angle_deg),
        ("volume_mL", cell.volume_mL),
        ("force_N", cell.blocked_force_N),
    ):
        assert surrogate(table, quantity, np.array(between), {}) == pytest.approx(truth, rel=3e-3)
    assert set(PRESSURES) <= set(table.pressure_MPa.tolist())


def test_a_factor_is_that_of_a_cell_simulated_at_a_value_between():
    # 0.85 is none of the values at which the base was simulated.
    _, softer = design_with(DESIGN, TRIAL, {"film_modulus": 0.85})
    cell = solved(DESIGN, softer, [0.05, 0.2])
    at = np.array([0.05, 0.2])
    found = surrogate(film_base().designs["a"], "angle_deg", at, {"film_modulus": 0.85})
    assert np.abs(found - cell.angle_deg).max() < 0.25
    assert (found > 1.05 * surrogate(film_base().designs["a"], "angle_deg", at, {})).all()
    force = surrogate(film_base().designs["a"], "force_N", at, {"film_modulus": 0.85})
    assert force == pytest.approx(cell.blocked_force_N, rel=5e-3)


def test_knobs_change_the_layup():
    _, all_of_them = design_with(
        DESIGN, TRIAL, {"film_modulus": 2.0, "fabric_modulus": 0.5, "seam_margin_mm": 0.2, "bladder_N_per_mm": 0.3}
    )
    assert all_of_them.film == Polynomial(C10=3.0, C20=6.0)
    assert all_of_them.fabric.youngs_modulus_MPa == 249.0
    assert (all_of_them.seam_margin_mm, all_of_them.bladder_N_per_mm) == (0.2, 0.3)
    assert design_with(DESIGN, TRIAL, {"film_modulus": 1.0, "ballooning": 0.5}) == (DESIGN, TRIAL)
    with pytest.raises(UsageError, match="no structural knob is called 'film'"):
        design_with(DESIGN, TRIAL, {"film": 1.0})
    with pytest.raises(UsageError, match="closes the windows"):
        design_with(DESIGN, TRIAL, {"seam_margin_mm": 1.5})


def test_film_and_fabric_stiffer_alike_are_a_lower_pressure():
    # All stresses times 2 at twice the pressure: the same shape.
    _, twice = design_with(DESIGN, TRIAL, {"film_modulus": 2.0, "fabric_modulus": 2.0})
    assert solved(DESIGN, twice, [0.2]).angle_deg == pytest.approx(solved(DESIGN, TRIAL, [0.1]).angle_deg, rel=1e-5)


def test_a_narrow_window_has_a_narrow_margin():
    assert knob_values("seam_margin_mm", ShellDesign(10, 1), TRIAL) == pytest.approx((0, 0.4 / 3, 0.8 / 3, 0.4))
    assert knob_values("seam_margin_mm", DESIGN, TRIAL)[-1] == 1.2


def test_what_is_kept_is_read_and_what_is_damaged_is_simulated_anew(tmp_path):
    first = cell_base({"a": DESIGN}, TRIAL, PRESSURES, forces=False, knobs=(), cache=tmp_path)
    (kept,) = tmp_path.glob("*.npz")
    written = kept.stat().st_mtime_ns
    again = cell_base({"b": DESIGN}, TRIAL, PRESSURES, forces=False, knobs=(), cache=tmp_path)
    assert kept.stat().st_mtime_ns == written and again.designs["b"].name == "b"
    assert (again.designs["b"].curves["angle_deg"] == first.designs["a"].curves["angle_deg"]).all()
    for damage in (b"", kept.read_bytes()[:200], b"PK not a zip"):
        kept.write_bytes(damage)
        mended = cell_base({"a": DESIGN}, TRIAL, PRESSURES, forces=False, knobs=(), cache=tmp_path)
        assert "simulated anew" in mended.warnings[0]
        assert (mended.designs["a"].curves["angle_deg"] == first.designs["a"].curves["angle_deg"]).all()
    wanted = Wanted("cell", TRIAL, tuple(PRESSURES), film_fixture(), False, ())
    assert read_cached(tmp_path, "a", DESIGN, wanted)[0] is not None
    assert [path.name for path in tmp_path.iterdir()] == [kept.name]


def film_fixture():
    from benchlab.simulation.actuator_response import Fixture

    return Fixture()


def test_a_file_under_another_key_is_not_taken(tmp_path):
    wanted = Wanted("cell", TRIAL, tuple(PRESSURES), film_fixture(), False, ())
    cell_base({"a": DESIGN}, TRIAL, PRESSURES, forces=False, knobs=(), cache=tmp_path)
    (kept,) = tmp_path.glob("*.npz")
    other = ShellDesign(12, 3)
    kept.rename(tmp_path / f"{key_of(other, wanted)}.npz")
    found, note = read_cached(tmp_path, "a", other, wanted)
    assert found is None and "damaged" in note


def test_the_key_is_of_all_inputs():
    wanted = Wanted("cell", TRIAL, tuple(PRESSURES), film_fixture(), False, FILM)
    others = [
        key_of(ShellDesign(10, 4), wanted),
        *(
            key_of(DESIGN, Wanted(*fields))
            for fields in (
                ("beam", TRIAL, tuple(PRESSURES), film_fixture(), False, FILM),
                ("cell", read_layup("from-FEM-angles"), tuple(PRESSURES), film_fixture(), False, FILM),
                ("cell", TRIAL, tuple(PRESSURES[:-1]), film_fixture(), False, FILM),
                ("cell", TRIAL, tuple(PRESSURES), film_fixture(), True, FILM),
                ("cell", TRIAL, tuple(PRESSURES), film_fixture(), False, ()),
            )
        ),
    ]
    assert len({key_of(DESIGN, wanted), *others}) == 7


def test_a_folder_that_cannot_be_written_is_told(tmp_path):
    (tmp_path / "file").write_text("no folder")
    base = cell_base({"a": DESIGN}, TRIAL, PRESSURES[:5], forces=False, knobs=(), cache=tmp_path / "file")
    assert "not kept" in base.warnings[0] and set(base.designs) == {"a"}


def test_where_curves_are_kept():
    assert default_cache({"XDG_CACHE_HOME": "/c"}, "linux").as_posix() == "/c/benchlab/explain"
    assert default_cache({}, "darwin").as_posix().endswith("Library/Caches/benchlab/explain")
    assert default_cache({"BENCHLAB_CACHE": "/own", "XDG_CACHE_HOME": "/c"}, "linux").as_posix() == "/own"


def test_a_curve_ends_where_the_actuator_bursts():
    soft = Layup("soft", "Neo-Hooke has no hardening", film=Polynomial(C10=1.5))
    wide = ShellDesign(10, 15)
    pressures = [0.0, 0.02, 0.04, 0.06, 0.08, 0.1, 0.3]
    base = cell_base({"wide": wide}, soft, pressures, forces=False, knobs=FILM)
    assert base.largest_pressure_MPa("wide") == 0.1
    assert "wide: simulated up to 0.1 MPa" in base.warnings[0]
    assert base.designs["wide"].knobs["film_modulus"].values[0] > 0.5  # a film half as stiff bursts earlier
    assert "film_modulus is known from" in base.warnings[1]
    with pytest.raises(InputError, match=r"has no stable state from 0\.3 MPa on"):
        cell_base({"wide": wide}, soft, [0.0, 0.1, 0.3], forces=False, knobs=())


def test_dead_workers_are_no_design_that_cannot_be_simulated(monkeypatch):
    died = BatchError("its worker process died twice")
    monkeypatch.setattr(
        explain_base, "run_batch", lambda items, *_, **__: (Outcome(item, None, died) for item in items)
    )
    with pytest.raises(BatchError, match=r"^a not simulated: the worker process died") as told:
        cell_base({"a": ShellDesign(10, 3)}, read_layup("from-measured-angles"), PRESSURES, forces=False)
    assert told.value.exit_code == 4


def test_impossible_pressures():
    with pytest.raises(UsageError, match=r"begin at 0\.1 MPa"):
        cell_base({"a": DESIGN}, TRIAL, [0.1, 0.2], forces=False)


def test_two_processes_give_the_same_numbers_as_one():
    designs = {"a": DESIGN, "b": ShellDesign(10, 5)}
    one, two = (cell_base(designs, TRIAL, PRESSURES[:5], forces=False, knobs=(), jobs=jobs) for jobs in (1, 2))
    assert list(one.designs) == list(two.designs) == ["a", "b"]
    for name in designs:
        assert (one.designs[name].curves["angle_deg"] == two.designs[name].curves["angle_deg"]).all()


def test_foreign_curves_take_volume_and_knobs_of_the_cell():
    cell = film_base()
    table = DesignBase("a", np.array([0.2]), {"angle_deg": np.array([80.0])})
    unknown = DesignBase("c", np.array([0.0, 0.2]), {"angle_deg": np.array([0.0, 50.0])})
    found = foreign_base({"a": table, "c": unknown}, {"a": DESIGN}, cell, "their.csv")
    assert found.kind == "foreign" and "sensitivities of the shell cell" in found.source
    drawn = found.designs["a"]
    assert np.interp(0.2, drawn.pressure_MPa, drawn.curves["angle_deg"]) == pytest.approx(80.0)
    assert drawn.curves["volume_mL"] == pytest.approx(cell.designs["a"].curves["volume_mL"])
    lent, own = found.designs["a"].knobs["film_modulus"], cell.designs["a"].knobs["film_modulus"]
    assert lent.factor["angle_deg"] == pytest.approx(own.factor["angle_deg"])
    assert not found.designs["c"].knobs and found.designs["c"].shape is None
    assert not found.warnings
    bursts = replace(cell, designs={}, missing={"a": "it bursts", "z": "too"})
    (told,) = foreign_base({"a": table, "c": unknown}, {"a": DESIGN}, bursts).warnings
    assert told == "a: no shell cell, so no structural effect (it bursts)"


def test_the_error_of_the_surrogate_is_told():
    largest, rms = check_surrogate(film_base(), {"a": DESIGN}, TRIAL, {"film_modulus": 0.85}, [0.0, 0.05, 0.2, 0.4])
    assert 0 < rms <= largest < 0.25
    with pytest.raises(UsageError, match="no design is simulated"):
        check_surrogate(film_base(), {"z": DESIGN}, TRIAL, {}, [0.0, 0.1])
