"""Curves of models: closed forms, the cell solved anew, and the same as a slow run predicts."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import pytest

from benchlab.actuator import ShellDesign
from benchlab.discrepancy.base import Base, DesignBase, Knob
from benchlab.discrepancy.effects.catalogue import effects
from benchlab.discrepancy.explanation import Estimate
from benchlab.discrepancy.predict import predict
from benchlab.errors import InputError
from benchlab.io.layup_file import read_layup
from benchlab.io.model_file import ModelBase, ModelEffect, ModelFile, ModelProvenance, digest_of, write_model
from benchlab.simulation.actuator_response import Fixture, actuator_response
from benchlab.simulation.beam import beam_response
from benchlab.workflows.explain_base import base_pressures, beam_base
from benchlab.workflows.explain_structure import design_with
from benchlab.workflows.model_curves import Model, knobs_of, model_base, modelled, open_model, slow_ramp

LAYUP = "from-measured-angles"
DESIGN = ShellDesign(10, 3)
P = [0.07, 0.14, 0.21, 0.28, 0.35]


def an_effect(name: str, form: str = "plain", **values: float) -> ModelEffect:
    numbers = {
        p.name: Estimate(values.get(p.name, p.typical), math.nan, math.nan, p.unit) for p in effects()[name].parameters
    }
    assert set(values) <= set(numbers)
    return ModelEffect(name, form, numbers)


def a_model(folder: Path, *found: ModelEffect, kind: str = "beam", source: str = LAYUP) -> Model:
    digest = digest_of(kind, folder / source if kind == "foreign" else source)
    made = ModelProvenance("hand", "2024-05-01")
    write_model(folder / "model.yaml", ModelFile(ModelBase(kind, source, digest), found, made))
    return open_model(folder / "model.yaml")


def curves(model: Model, design: ShellDesign = DESIGN, forces: bool = False, pressures: list[float] = P):  # type: ignore[no-untyped-def]
    base = model_base(model, {design.name: design}, pressures[-1], forces=forces)
    return modelled(base, design.name, model.file.actives, pressures)


def test_without_effects_it_is_the_base(tmp_path: Path) -> None:
    found = curves(a_model(tmp_path), forces=True)
    beam = beam_response(DESIGN, read_layup(LAYUP), P)
    assert found.curves["angle_deg"] == pytest.approx(beam.angle_deg, abs=0.05)
    assert found.curves["volume_mL"] == pytest.approx(beam.volume_mL, abs=0.01)
    assert found.curves["force_N"] == pytest.approx(Fixture().force_N(beam.pressure_MPa, beam.moment_Nmm), rel=1e-3)
    assert all((found.curves[name] == found.bare[name]).all() for name in found.curves)


def test_effects_in_closed_form(tmp_path: Path) -> None:
    bare = curves(a_model(tmp_path))
    capped = curves(a_model(tmp_path, an_effect("end_caps", cap_mm=9.0)))
    assert capped.curves["angle_deg"] == pytest.approx(0.9 * bare.curves["angle_deg"], rel=1e-9)
    assert capped.bare["angle_deg"] == pytest.approx(bare.curves["angle_deg"], rel=1e-9)
    gauge = curves(a_model(tmp_path, an_effect("pressure_gain", gain=1.25)), pressures=[0.25, 0.35])
    assert gauge.curves["angle_deg"][0] == pytest.approx(
        curves(a_model(tmp_path), pressures=[0.2, 0.35]).curves["angle_deg"][0], abs=0.05
    )
    rubbed = curves(a_model(tmp_path, an_effect("friction", half_width_deg=2.0, grows=1.0)))
    assert bare.curves["angle_deg"] - rubbed.curves["angle_deg"] == pytest.approx(2.0 * np.array(P) / 0.35, abs=1e-6)


def test_bulging_of_the_beam_is_the_beam_that_bulges(tmp_path: Path) -> None:
    wide = ShellDesign(10, 9)
    found = curves(a_model(tmp_path, an_effect("window_ballooning", share=1.0)), wide)
    beam = beam_response(wide, read_layup(LAYUP), P, ballooning=1.0)
    assert found.curves["angle_deg"] == pytest.approx(beam.angle_deg, abs=0.5)
    assert (found.bare["angle_deg"] > 1.5 * found.curves["angle_deg"]).all()


def test_structure_of_the_cell_is_that_of_a_cell_solved_anew(tmp_path: Path) -> None:
    """To the error of looking it up between simulated structures: 0.1 % here, of an effect of 9 %."""
    found = curves(a_model(tmp_path, an_effect("seam_margin", margin_mm=0.2), kind="cell"), pressures=[0.1, 0.2])
    anew = actuator_response(
        *design_with(DESIGN, read_layup(LAYUP), {"seam_margin_mm": 0.2}), [0.1, 0.2], blocked=False
    )
    assert found.curves["angle_deg"] == pytest.approx(anew.angle_deg, rel=0.003)
    assert (found.bare["angle_deg"] > 1.07 * anew.angle_deg).all()


def test_it_is_what_explain_predicts_for_a_run_that_is_slow(tmp_path: Path) -> None:
    """The same base, the same effects, a ramp of an hour in 200 points, looked at where the curve is asked for."""
    given = [an_effect(name) for name in ("viscoelasticity", "friction", "dead_pressure", "regulator_lag", "gravity")]
    model = a_model(tmp_path, *given)
    base = beam_base({"d": DESIGN}, read_layup(LAYUP), base_pressures(0.35), forces=False, knobs=())
    pressure = np.linspace(0, 0.35, 201)
    scene = slow_ramp(base, "d", pressure)
    slow = scene.__class__(**{**vars(scene), "time_s": scene.pressure_MPa / 0.35 * 3600})
    there = predict(slow, model.file.actives)["angle_deg"][:, 0]
    assert curves(model).curves["angle_deg"] == pytest.approx(np.interp(P, pressure, there), abs=0.05)


def test_what_a_curve_cannot_show_is_said(tmp_path: Path) -> None:
    found = curves(a_model(tmp_path, an_effect("temperature"), an_effect("clock_offset"), an_effect("viscoelasticity")))
    assert found.curves["angle_deg"] == pytest.approx(found.bare["angle_deg"], rel=1e-6)
    assert [note.split(":")[0] for note in found.notes] == ["not shown"] * 3


def test_the_knobs_that_effects_turn() -> None:
    turned = [an_effect(name).active for name in ("friction", "softening", "seam_margin", "window_ballooning")]
    assert knobs_of(turned) == ("film_modulus", "seam_margin_mm", "ballooning")
    assert knobs_of([]) == ()


def test_foreign_curves_keep_their_own_and_are_refused_for_other_designs(tmp_path: Path) -> None:
    rows = "".join(f"tw3_slw10,{p:g},{300 * p:g},{20 + 10 * p:g}\n" for p in np.linspace(0, 0.35, 8))
    (tmp_path / "fem.csv").write_text("design,pressure_MPa,angle_deg,volume_mL\n" + rows)
    model = a_model(tmp_path, an_effect("camera_scale", factor=1.2), kind="foreign", source="fem.csv")
    found = curves(model)
    assert found.curves["angle_deg"] == pytest.approx(250 * np.array(P), rel=1e-6)
    with pytest.raises(InputError, match="no design tw9_slw10"):
        curves(model, ShellDesign(10, 9))


def test_beyond_the_base_is_refused(tmp_path: Path) -> None:
    pressure, ones = np.linspace(0, 0.2, 5), np.ones((2, 5))
    knobs = {"seam_margin_mm": Knob(np.array([0.0, 0.4]), {"angle_deg": ones})}
    base = Base({"d": DesignBase("d", pressure, {"angle_deg": 300 * pressure}, DESIGN, knobs)}, "cell", "drawn")
    margins = [an_effect("seam_margin", margin_mm=margin).active for margin in (0.3, 0.5)]
    assert modelled(base, "d", margins[:1], [0.1]).curves["angle_deg"] == pytest.approx([30])
    with pytest.raises(InputError, match=r"sets seam_margin_mm to 0\.5, and d is simulated from 0 to 0\.4"):
        modelled(base, "d", margins[1:], [0.1])
    with pytest.raises(InputError, match="not simulated with another fabric_modulus"):
        modelled(base, "d", [an_effect("fabric_compliance").active], [0.1])
    with pytest.raises(InputError, match=r"up to 0\.2 MPa"):
        modelled(base, "d", (), [0.1, 0.3])
    with pytest.raises(InputError, match="no design"):
        modelled(base, "other", (), [0.1])
