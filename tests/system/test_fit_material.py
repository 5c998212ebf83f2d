"""`benchlab fit-material` from end to end: drawn tests of known truth, real files, and what is refused."""

from pathlib import Path

import cv2
import numpy as np
import pytest

from benchlab.io.layup_file import read_layup
from benchlab.simulation.laws import Law, Ogden, Polynomial
from benchlab.simulation.laws.homogeneous import nominal_stress_MPa
from benchlab.simulation.layup import Layup

SAMPLE = Path(__file__).resolve().parents[2] / "sample_data" / "tensile_drawn.csv"


def write_test(path: Path, law: Law, seed: int = 0, largest: float = 2.5) -> Path:
    stretch = np.linspace(1, largest, 80)
    stress = nominal_stress_MPa(law, stretch) + np.random.default_rng(seed).normal(0, 0.004, 80)
    rows = "".join(f"{x:.6f},{y:.6f}\n" for x, y in zip(stretch, stress))
    path.write_text("stretch,stress_MPa\n" + rows)
    return path


def test_the_sample_test_gives_the_law_it_was_drawn_from(tmp_path: Path, benchlab) -> None:
    done = benchlab("fit-material", SAMPLE, "--out", tmp_path / "film.yaml", "--json")
    assert done.code == 0, done.err
    found = done.json
    assert found["law"] == "yeoh" and len(found["laws"]) == 7
    (yeoh,) = [law for law in found["laws"] if law["law"] == "yeoh"]
    for coefficient, truth in zip(yeoh["coefficients"], (1.5, 0.3, 0.0)):
        assert coefficient["low"] <= truth <= coefficient["high"], coefficient
    layup = read_layup(tmp_path / "film.yaml")
    assert layup.name == "film" and layup.film == Polynomial(**{c["name"]: c["value"] for c in yeoh["coefficients"]})
    assert layup == Layup(layup.name, layup.origin, layup.film, film_largest_stretch=1.6)
    for word in ("tensile_drawn.csv", found["tests"][0]["sha256"], "stretches 1 to 1.6", "not measured"):
        assert word in layup.origin
    assert "from the file: gauge 50 mm" in done.err and "break or slip" in done.err and "yeoh is written" in done.err
    picture = cv2.imread(str(tmp_path / "film.png"))
    assert picture.shape[1] > 1000 and picture.std() > 20
    assert sorted(p.name for p in tmp_path.iterdir()) == ["film.png", "film.yaml"]


def test_thickness_goes_into_the_layup_and_one_law_is_fitted(tmp_path: Path, benchlab) -> None:
    options = ["--thickness-mm", 0.2, "--width-mm", 10, "--gauge-mm", 50, "--law", "ogden-1", "--max-stretch", 1.3]
    done = benchlab("fit-material", SAMPLE, *options, "--out", tmp_path / "a.yaml", "--json")
    assert done.code == 0 and [law["law"] for law in done.json["laws"]] == ["ogden-1"]
    layup = read_layup(tmp_path / "a.yaml")
    assert layup.film_thickness_mm == 0.2 and isinstance(layup.film, Ogden)
    assert layup.film.shear_modulus_MPa == pytest.approx(3.0 * 1.5, rel=0.1)  # two thirds of the area that it has
    assert done.json["tests"][0]["stretch"][1] == pytest.approx(1.3, abs=0.005)


def test_specimens_are_fitted_together_with_their_scatter(tmp_path: Path, benchlab) -> None:
    files = [write_test(tmp_path / f"{i}.csv", Polynomial(c), i) for i, c in enumerate((0.38, 0.40, 0.42))]
    done = benchlab("fit-material", *files, "--law", "neo-hooke", "--json")
    assert done.code == 0, done.err
    (c,) = done.json["laws"][0]["coefficients"]
    half = 4.303 * 0.02 / 3**0.5  # Student's t with 2 degrees of freedom, sd 0.02, three specimens
    assert (c["value"], c["high"] - c["low"]) == (pytest.approx(0.40, rel=0.01), pytest.approx(2 * half, rel=0.1))
    assert (tmp_path / "0.yaml").exists() and (tmp_path / "0.png").exists()
    assert any("scatter of 3 specimens" in warning for warning in done.json["warnings"])


def test_an_unstable_law_is_written_only_when_asked_for_and_says_so(tmp_path: Path, benchlab) -> None:
    source = write_test(tmp_path / "soft.csv", Polynomial(0.5, C20=-0.03), largest=3.5)
    done = benchlab("fit-material", source, "--law", "yeoh", "--json")
    assert done.code == 0 and "not stable over the stretches" in done.json["warnings"][0]
    assert "not stable over" in (tmp_path / "soft.yaml").read_text()
    assert benchlab("fit-material", source, "--overwrite", "--json").json["law"] != "yeoh"


@pytest.mark.parametrize(
    ("options", "code", "words"),
    [
        (["none.csv"], 2, "no such file"),
        (["a.csv", "a.csv"], 2, "same content as a.csv"),
        (["a.csv", "--out", "x.txt"], 2, "not a .yaml file"),
        (["a.csv", "--out", "none/of/x.yaml"], 2, "no such folder"),
        (["a.csv", "--out", "taken.yaml"], 2, "exists; choose another --out, or replace it with --overwrite"),
        (["a.csv", "--out", "free.yaml"], 2, "free.png: exists"),
        (["a.csv", "--max-stretch", "0.9"], 2, "--max-stretch is 0.9"),
        (["a.csv", "--gauge-mm", "-3"], 2, "--gauge-mm is -3"),
        (["a.csv", "--columns", "force_N"], 2, "names 1 columns, the table has 2"),
        (["a.csv", "--law", "hooke"], 2, "'hooke' is not one of"),
        (["a.csv", "--max-stretch", "1.05"], 3, "a.csv: 3 points in the first loading"),
        (["bad.csv"], 3, "bad.csv, line 9: 'x' is not a number"),
        (["flat.csv"], 3, "flat.csv: stretches from"),
    ],
)
def test_refusals_leave_nothing_behind(
    tmp_path: Path, benchlab, monkeypatch: pytest.MonkeyPatch, options: list[str], code: int, words: str
) -> None:
    monkeypatch.chdir(tmp_path)
    good = write_test(tmp_path / "a.csv", Polynomial(0.4)).read_text().splitlines()
    (tmp_path / "bad.csv").write_text("\n".join([*good[:8], "1.5,x", *good[9:]]))
    (tmp_path / "flat.csv").write_text("stretch,stress_MPa\n" + "".join(f"1.{i:05d},0.{i}\n" for i in range(9)))
    (tmp_path / "taken.yaml").write_text("mine")
    (tmp_path / "free.png").write_text("mine")
    before = {p.name: p.read_bytes() for p in tmp_path.iterdir()}
    done = benchlab("fit-material", *options)
    assert done.code == code and words in done.err, done.err
    assert {p.name: p.read_bytes() for p in tmp_path.iterdir()} == before


@pytest.mark.parametrize(
    ("pattern", "options", "law"),
    [
        ("TRACER*", ["--columns", "stretch,stress_MPa"], "yeoh"),
        ("*Meunier*", ["--columns", "stress_MPa,stretch"], "ogden-2"),
        ("*Ecoflex*", [], "yeoh"),
        ("*RUN_2*", ["--columns", "extension_mm,force_N", "--thickness-mm", 3, "--width-mm", 13, "--gauge-mm", 100], "yeoh"),
        ("*RUN_3*", ["--columns", "force_N,extension_mm", "--thickness-mm", 3, "--width-mm", 13, "--gauge-mm", 100], "yeoh"),
    ],
)  # fmt: skip
def test_real_materials(
    tmp_path: Path, benchlab, real_folder: Path, pattern: str, options: list[object], law: str
) -> None:
    (source,) = (real_folder / "materials").glob(pattern)
    done = benchlab("fit-material", source, *options, "--out", tmp_path / "a.yaml", "--json")
    assert done.code == 0, done.err
    assert done.json["law"] == law
    (chosen,) = [one for one in done.json["laws"] if one["law"] == law]
    assert chosen["r_squared"] > 0.97 and chosen["stable_over_data"] and 0.5 <= chosen["biaxial_factor"] <= 2
    assert read_layup(tmp_path / "a.yaml").film.shear_modulus_MPa == pytest.approx(chosen["shear_modulus_MPa"])


def test_what_no_law_describes_is_not_written(tmp_path: Path, benchlab) -> None:
    rng = np.random.default_rng(1)
    rows = "\n".join(f"{1 + 0.01 * i:.2f},{rng.uniform(0.1, 20):.3f}" for i in range(1, 60))
    (tmp_path / "noise.csv").write_text(f"stretch,stress_MPa\n1,0\n{rows}\n")
    refused = benchlab(
        "fit-material", tmp_path / "noise.csv", "--law", "neo-hooke", "--keep-slack", "--out", tmp_path / "a.yaml"
    )
    assert refused.code == 3 and "that is no description" in refused.err
    assert not (tmp_path / "a.yaml").exists()


def test_the_film_may_be_thinner_than_the_specimen(tmp_path: Path, benchlab) -> None:
    done = benchlab(
        "fit-material",
        SAMPLE,
        "--law",
        "yeoh",
        "--thickness-mm",
        2,
        "--film-thickness-mm",
        0.25,
        "--out",
        tmp_path / "a.yaml",
    )
    assert done.code == 0, done.err
    layup = read_layup(tmp_path / "a.yaml")
    assert layup.film_thickness_mm == 0.25 and layup.film_largest_stretch > 1.5
