"""Model files: read as written, refused with the line of what is wrong."""

import math
import shutil
from dataclasses import replace

import pytest

from benchlab.discrepancy.effects.catalogue import effects
from benchlab.discrepancy.explanation import Estimate, Found
from benchlab.errors import InputError, UsageError
from benchlab.io.layup_file import read_layup, write_layup
from benchlab.io.model_file import (
    Measurement,
    ModelBase,
    ModelEffect,
    ModelFile,
    ModelProvenance,
    check_source,
    digest_of,
    model_effects,
    read_model,
    write_model,
)

LAYUP = "from-measured-angles"


def typical(name, form="plain"):
    """An effect of the vocabulary with its typical values, half of them without bounds."""
    about = effects()[name].parameters
    numbers = {
        p.name: Estimate(
            p.typical, p.low if i % 2 else math.nan, math.nan, p.unit, p.what, p.typical in (p.low, p.high)
        )
        for i, p in enumerate(about)
    }
    return ModelEffect(name, form, numbers)


def a_model(*names, kind="cell"):
    base = ModelBase(kind, LAYUP, digest_of(kind, LAYUP))
    made = ModelProvenance("benchlab 0", "2024-05-01", (Measurement("a.csv", "0" * 64),), True, "θ: it falls short")
    return ModelFile(base, tuple(map(typical, names)), made)


def same(one, other):
    """Equal but for NaN, which is not equal to itself."""
    return repr(one) == repr(other)


@pytest.mark.parametrize("name", list(effects()))
def test_every_effect_goes_there_and_back(tmp_path, name):
    model = a_model(name, kind="beam" if name == "window_ballooning" else "cell")
    for form in effects()[name].forms:
        model = replace(model, effects=(replace(model.effects[0], form=form),))
        write_model(tmp_path / "model.yaml", model)
        again = read_model(tmp_path / "model.yaml")
        assert same(again, model)
        assert again.actives[0].effect is effects()[name] and again.actives[0].form == form


def test_numbers_go_there_and_back_to_the_last_bit_and_in_the_order_of_effects(tmp_path):
    model = a_model("regulator_lag", "friction")
    odd = replace(model.effects[1].parameters["half_width_deg"], value=0.1 + 0.2, low=1e-17, high=math.pi)
    changed = replace(model.effects[1], parameters={**model.effects[1].parameters, "half_width_deg": odd})
    model = replace(model, effects=(model.effects[0], changed))
    write_model(tmp_path / "model.yaml", model)
    assert same(read_model(tmp_path / "model.yaml"), model)
    assert [active.name for active in read_model(tmp_path / "model.yaml").actives] == ["regulator_lag", "friction"]


def test_what_was_found_is_what_is_written():
    one = typical("friction", "spread")
    assert model_effects([Found("friction", "spread", one.parameters, 0.8)]) == (one,)


def text(tmp_path, *changes):
    write_model(tmp_path / "model.yaml", a_model("friction"))
    whole = (tmp_path / "model.yaml").read_text(encoding="utf-8")
    for old, new in changes:
        assert old in whole
        whole = whole.replace(old, new, 1)
    (tmp_path / "model.yaml").write_text(whole, encoding="utf-8")
    return tmp_path / "model.yaml"


@pytest.mark.parametrize(
    "old, new, said",
    [
        ("name: friction", "name: magic", "no effect is called 'magic'"),
        ("form: plain", "form: fancy", "no form 'fancy'"),
        ("unit: deg", "unit: rad", "half_width_deg is told in 'rad'"),
        ("value: 1.5", "value: 21", "half_width_deg is 21"),
        ("value: 1.5", "value: -1", "half_width_deg is -1"),
        ("value: 0.8", "value: .nan", "grows"),
        ("grows:", "shrinks:", "no parameter 'shrinks'"),
        ("kind: cell", "kind: oracle", "kind"),
        ("sha256: ", "sha256: x", "sha256"),
        ("low:", "lowest:", "lowest"),
    ],
)
def test_refusals_name_line_and_remedy(tmp_path, old, new, said):
    path = text(tmp_path, (old, new))
    with pytest.raises(InputError, match=r"line \d+") as raised:
        read_model(path)
    assert said in str(raised.value)


def test_the_line_is_that_of_the_value(tmp_path):
    path = text(tmp_path, ("value: 1.5", "value: 21"))
    lines = path.read_text(encoding="utf-8").splitlines()
    with pytest.raises(InputError) as raised:
        read_model(path)
    where = int(str(raised.value).split("line ")[1].split(":")[0].split(" ")[0])
    assert "21" in lines[where - 1]


def test_an_unknown_effect_is_refused_with_the_known_ones(tmp_path):
    with pytest.raises(InputError, match="softening") as raised:
        read_model(text(tmp_path, ("name: friction", "name: magic")))
    assert all(name in str(raised.value) for name in effects())


def test_twice_the_same_effect_an_interval_beside_its_value_and_bulging_of_a_cell_are_refused(tmp_path):
    with pytest.raises(ValueError, match="twice"):
        write_model(tmp_path / "m.yaml", a_model("friction", "friction"))
    with pytest.raises(ValueError, match="beam lacks"):
        write_model(tmp_path / "m.yaml", a_model("window_ballooning"))
    model = a_model("camera_scale")
    number = replace(model.effects[0].parameters["factor"], low=1.1, high=1.2)
    with pytest.raises(ValueError, match="outside of its interval"):
        write_model(
            tmp_path / "m.yaml", replace(model, effects=(ModelEffect("camera_scale", "plain", {"factor": number}),))
        )
    assert not list(tmp_path.iterdir())


def test_a_parameter_that_is_missing_is_asked_for(tmp_path):
    model = a_model("friction")
    half = {"half_width_deg": model.effects[0].parameters["half_width_deg"]}
    with pytest.raises(ValueError, match="without grows"):
        write_model(tmp_path / "m.yaml", replace(model, effects=(ModelEffect("friction", "plain", half),)))


def test_the_base_must_be_what_it_was(tmp_path):
    write_layup(tmp_path / "film.yaml", read_layup("trial"))
    model = a_model("friction")
    model = replace(model, base=ModelBase("cell", "film.yaml", digest_of("cell", tmp_path / "film.yaml")))
    write_model(tmp_path / "model.yaml", model)
    assert check_source(tmp_path / "model.yaml", model) == str(tmp_path / "film.yaml")
    shutil.copy(tmp_path / "film.yaml", tmp_path / "kept.yaml")
    write_layup(tmp_path / "film.yaml", read_layup("from-FEM-angles"))
    with pytest.raises(InputError, match="not the one that the model was made with"):
        check_source(tmp_path / "model.yaml", model)
    (tmp_path / "film.yaml").unlink()
    with pytest.raises((InputError, UsageError), match="no such file"):
        check_source(tmp_path / "model.yaml", model)
    assert check_source(tmp_path / "model.yaml", a_model("friction")) == LAYUP
