"""Material files: what is written is read again, shipped names, and refusals."""

import dataclasses
from pathlib import Path

import pytest

from benchlab.errors import InputError, UsageError
from benchlab.io.layup_file import layup_document, read_layup, shipped_layups, write_layup
from benchlab.simulation.laws import Ogden, Polynomial, StVenantKirchhoff
from benchlab.simulation.layup import Layup


def different(layup: Layup) -> Layup:
    """The layup with every simple field changed from its default, each by another amount."""
    changes = {}
    for index, field in enumerate(dataclasses.fields(Layup)):
        value = getattr(layup, field.name)
        if isinstance(value, bool):
            changes[field.name] = not value
        elif isinstance(value, (int, float)):
            changes[field.name] = value + 0.125 * (index + 1)
        elif value is None:
            changes[field.name] = 1.25
    return dataclasses.replace(layup, **changes)


@pytest.mark.parametrize(
    "film",
    [Polynomial(1.5, 0.1, 3.0, -0.2, 0.3), Polynomial(0.2, C30=1e-5), Ogden((0.63, 0.0012, -0.01), (1.3, 5.0, -2.0))],
)
def test_what_is_written_is_read_again(tmp_path: Path, film: Polynomial | Ogden) -> None:
    plain = Layup("a: b", "words\nof two lines", film, StVenantKirchhoff(300.0, 0.2))
    for layup in (plain, different(plain)):
        write_layup(tmp_path / "a.yaml", layup, "Made in a test.")
        assert read_layup(tmp_path / "a.yaml") == layup
        assert read_layup(str(tmp_path / "a.yaml")) == layup


def test_trial_says_that_it_is_guessed() -> None:
    trial = read_layup("TRIAL")
    assert trial.film == Polynomial(C10=1.5, C20=3.0) and "not a measured material" in trial.origin
    assert dataclasses.replace(trial, name="x", origin="y") == Layup("x", "y", trial.film)


@pytest.mark.parametrize("name", shipped_layups())
def test_every_shipped_layup_is_named_as_its_file_and_says_where_it_is_from(name: str) -> None:
    layup = read_layup(name)
    assert layup.name.lower() == name and len(layup.origin) > 20 and name == name.lower()


def test_unknown_names_and_missing_files(tmp_path: Path) -> None:
    with pytest.raises(UsageError, match=r"no material is called 'triel'.*trial"):
        read_layup("triel")
    with pytest.raises(UsageError, match="no such file"):
        read_layup(tmp_path / "none.yaml")
    with pytest.raises(UsageError, match="no such file"):
        read_layup("none.yaml")


GOOD = "name: a\norigin: b\nfilm:\n  law: yeoh\n  coefficients_MPa: {C10: 1}\n"


@pytest.mark.parametrize(
    ("text", "words"),
    [
        (GOOD.replace("yeoh", "hooke"), "no law is called 'hooke'.*use one of neo-hooke"),
        (GOOD.replace("C10: 1", "C01: 1"), "yeoh has no coefficient C01; it has C10, C20, C30"),
        (GOOD.replace("C10: 1", "C10: -1"), "initial shear modulus"),
        (GOOD.replace("C10: 1", "C10: .nan"), "line 5: film.coefficients_MPa.C10 is nan"),
        (GOOD + "  thickness: 1\n", r"line 6: unknown key film.thickness.*did you mean thickness_mm\?"),
        (GOOD + "strip: {thickness_mm: 0}\n", "line 6: strip.thickness_mm is 0.*more than 0"),
        (GOOD + "fabric: {poisson_ratio: 0.5}\n", "line 6: fabric.poisson_ratio is 0.5"),
        (GOOD + "moulded: yes\n", 'line 6: moulded is "yes"'),
        ("name: a\norigin: b\n", "film is missing"),
    ],
)
def test_impossible_files_are_refused(tmp_path: Path, text: str, words: str) -> None:
    path = tmp_path / "a.yaml"
    path.write_text(text)
    with pytest.raises(InputError, match=words):
        read_layup(path)


def test_document_starts_with_name_and_origin() -> None:
    assert list(layup_document(Layup("a", "b", Polynomial(1.0))))[:5] == ["name", "origin", "film", "fabric", "strip"]
