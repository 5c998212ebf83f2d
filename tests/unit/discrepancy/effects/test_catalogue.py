"""The catalogue with effects of installed packages, and the page about it."""

from __future__ import annotations

import re
import sys
from collections.abc import Callable, Iterator
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from benchlab.discrepancy.effects.catalogue import built_in, effects, faults
from benchlab.discrepancy.effects.effect import Active, Effect
from benchlab.discrepancy.predict import predict
from benchlab.errors import InputError
from tests.benchmarks.effects_table import PAGE, placed
from tests.unit.discrepancy.scenes import scene

TEXT = PAGE.read_text(encoding="utf-8")
EXAMPLE = re.findall(r"```python\n(.*?)```", TEXT, re.DOTALL)[0]

Install = Callable[..., None]


@pytest.fixture
def install(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Install]:
    """`install(code, points, package)` puts a package with these entry points where Python finds it."""

    def put(code: str, points: str, package: str = "our_lab_effects") -> None:
        folder = tmp_path / package
        info = folder / f"{package}-1.0.dist-info"
        info.mkdir(parents=True)
        (folder / f"{package}.py").write_text(code, encoding="utf-8")
        (info / "METADATA").write_text(f"Metadata-Version: 2.1\nName: {package}\nVersion: 1.0\n", encoding="utf-8")
        (info / "entry_points.txt").write_text(f"[benchlab.effects]\n{points}\n", encoding="utf-8")
        monkeypatch.syspath_prepend(str(folder))
        sys.modules.pop(package, None)
        effects.cache_clear()

    effects.cache_clear()
    yield put
    effects.cache_clear()


def test_without_packages_it_is_the_vocabulary() -> None:
    assert list(effects()) == list(built_in())
    assert effects() is effects(), "found once"


def test_the_example_of_the_page_is_found_and_acts(install: Install) -> None:
    declared = re.search(r'^locking = "(.*)"$', TEXT, re.MULTILINE)
    assert declared
    install(EXAMPLE, f"locking = {declared[1]}")
    found = effects()
    assert list(found) == [*built_in(), "locking"]
    on = scene(("slow",), 2)
    bare = predict(on, [])["angle_deg"]
    changed = predict(on, [Active(found["locking"], {"share": 0.05})])["angle_deg"]
    np.testing.assert_allclose(changed, bare * (1 - 0.05 * (bare / 100) ** 2))
    assert np.array_equal(predict(on, [Active(found["locking"], {"share": 0.0})])["angle_deg"], bare)


def test_packages_come_after_the_vocabulary_by_name(install: Install) -> None:
    install(EXAMPLE.replace('"locking"', '"zeal"'), "zeal = z_effects:Locking", "z_effects")
    install(
        EXAMPLE.replace('"locking"', '"ardour"') + "\n\nARDOUR = Locking()\n", "ardour = a_effects:ARDOUR", "a_effects"
    )
    assert list(effects())[22:] == ["ardour", "zeal"]


@pytest.mark.parametrize(
    ("code", "points", "message"),
    [
        ("1/0", "bad = our_lab_effects:Locking", r"cannot be loaded \(ZeroDivisionError: division by zero\)"),
        (EXAMPLE, "bad = our_lab_effects:Looking", r"cannot be loaded \(AttributeError"),
        (EXAMPLE, "bad = our_lab_effect:Locking", r"cannot be loaded \(ModuleNotFoundError"),
        ("Locking = dict", "bad = our_lab_effects:Locking", "our_lab_effects:Locking is no Effect"),
        (EXAMPLE.replace("looks_like =", "looked ="), "bad = our_lab_effects:Locking", "it has no looks_like"),
        (EXAMPLE.replace('"locking"', '"friction"'), "bad = our_lab_effects:Locking", "its name 'friction' is taken"),
        (
            EXAMPLE.replace("0.15)", "0.5)"),
            "bad = our_lab_effects:Locking",
            "share has 0.5 outside of its bounds 0 to 0.3",
        ),
    ],
)
def test_a_broken_package_is_refused_by_its_name(install: Install, code: str, points: str, message: str) -> None:
    install(code, points)
    with pytest.raises(InputError, match=message) as refused:
        effects()
    assert "effect 'bad' of our_lab_effects 1.0 is refused" in str(refused.value)
    assert "\n" not in str(refused.value)


ANGLE = 'return angle_deg * (1 - at.values["share"] * (angle_deg / 100) ** 2)'
"""What the example does to the angle."""


@pytest.mark.parametrize(
    ("does", "message"),
    [
        ("return angle_deg * at.values['part']", "angle, line 23: effect 'locking' of our_lab_effects 1.0: it fails with KeyError: 'part'"),
        ("import math; return math.sqrt(angle_deg)", "it fails with TypeError: only"),
        ("return None", "angle: effect 'locking' of our_lab_effects 1.0: it gives NoneType; give numbers"),
        ("return 'much'", "it gives str"),
        ("return angle_deg / 0", "it gives values that are not finite"),
        ("return angle_deg[0]", r"it gives values of shape \(\d+,\) where \(\d+, \d+\) are asked for"),
        ("raise RuntimeError", r"it fails with RuntimeError; repair it there, or uninstall the package to go on without it"),
    ],
)  # fmt: skip
def test_what_the_code_of_a_package_does_wrong_is_told_as_its_own(install: Install, does: str, message: str) -> None:
    install(EXAMPLE.replace(ANGLE, does), "locking = our_lab_effects:Locking")
    with pytest.raises(InputError, match=message) as refused:
        predict(scene(("slow",), 2), [Active(effects()["locking"], {"share": 0.05})])
    assert str(refused.value).startswith("our_lab_effects.py, angle") and "\n" not in str(refused.value)


@pytest.mark.parametrize(
    ("method", "message"),
    [
        ("def knobs(self, at): return {'film': 1.1}", "knobs: effect 'locking' of .* 1.0: no structural knob is called 'film'"),
        ("def knobs(self, at): return 1.1", "it gives float; give a dict of settings by knob"),
        ("def knobs(self, at): return {'film_modulus': [1, 2]}", r"it gives values of shape \(2,\)"),
        ("def cannot_show(self, scene): return 1 / 0", "cannot_show, line 25: .* it fails with ZeroDivisionError: division by zero"),
    ],
)  # fmt: skip
def test_so_are_knobs_and_what_cannot_be_shown(install: Install, method: str, message: str) -> None:
    install(f"{EXAMPLE}\n    {method}\n", "locking = our_lab_effects:Locking")
    on, effect = scene(("slow",), 2), effects()["locking"]
    with pytest.raises(InputError, match=message):
        predict(on, [Active(effect, {"share": 0.05})])
        effect.cannot_show(on)


def test_a_package_that_changes_what_it_is_given_changes_a_copy(install: Install) -> None:
    install(
        f"{EXAMPLE}\n    def gauge(self, pressure_MPa, at):\n        pressure_MPa *= 0.5\n        return pressure_MPa\n",
        "locking = our_lab_effects:Locking",
    )
    on = scene(("slow",), 2)
    before = on.pressure_MPa.copy()
    predict(on, [Active(effects()["locking"], {"share": 0.05})])
    assert np.array_equal(on.pressure_MPa, before)


def changed(**parts: object) -> Effect:
    friction = type(built_in()["friction"])
    return type("Changed", (friction,), parts)()  # type: ignore[no-any-return]


@pytest.mark.parametrize(
    ("part", "fault"),
    [
        ({"low": 3.0, "high": 3.0}, "bounds of half_width_deg are 3 and 3"),
        ({"typical": 25.0}, "half_width_deg has 25 outside of its bounds 0 to 20"),
        ({"neutral": -1.0}, "half_width_deg has -1 outside"),
        ({"starts": ()}, "half_width_deg has no starts"),
        ({"neutral": None}, "no parameter has a neutral value"),
    ],
)
def test_faults_of_parameters_are_told(part: dict[str, object], fault: str) -> None:
    first, second = built_in()["friction"].parameters
    assert faults(changed(parameters=(replace(first, **part), second))).startswith(fault)  # type: ignore[arg-type]


def test_the_page_has_the_catalogue_of_today() -> None:
    assert placed(TEXT) == TEXT, "run python tests/benchmarks/effects_table.py"
    for effect in built_in().values():
        assert f"### {effect.name}\n" in TEXT
