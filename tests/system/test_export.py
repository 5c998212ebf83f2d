from pathlib import Path

import pytest

from benchlab.io.calculix import find_calculix


def test_a_deck_of_each_engine_says_what_it_is(benchlab, tmp_path: Path) -> None:
    for engine, elements in (("calculix", "solid"), ("calculix", "shell"), ("calculix", "sheets"), ("abaqus", "shell")):
        out = tmp_path / f"{engine}_{elements}.inp"
        done = benchlab(
            "export", "tw3_slw10", "--engine", engine, "--elements", elements, "--cells", 1, "--out", out, "--json"
        )
        assert done.code == 0, done.err
        assert done.json["elements"] == elements and done.json["rib_z_mm"] == [0, 5]
        assert done.json["pressures_MPa"][-1] == pytest.approx(0.35)
        head = out.read_text(encoding="ascii").split("*NODE")[0]
        for fact in (
            "tw3_slw10",
            "mm, N, MPa",
            "Origin of the layup",
            "RIB_002: z = 5 mm",
            "not measured",
            "from-FEM-angles",
        ):
            assert fact in head, fact
        assert ("never been run in Abaqus" in head) == (engine == "abaqus")


def test_the_full_length_is_half_of_the_actuator(benchlab, tmp_path: Path) -> None:
    done = benchlab(
        "export",
        "tw9_slw10",
        "--engine",
        "abaqus",
        "--whole",
        "--along-mm",
        3,
        "--out",
        tmp_path / "a.inp",
        "--json",
    )
    assert done.code == 0, done.err
    assert done.json["length_mm"] == pytest.approx(90.0)
    assert done.json["rib_z_mm"][-1] == pytest.approx(8 * 11)


def test_an_existing_deck_is_kept(benchlab, tmp_path: Path) -> None:
    out = tmp_path / "a.inp"
    out.write_text("mine")
    done = benchlab("export", "tw3_slw10", "--engine", "abaqus", "--out", out)
    assert done.code == 2 and "--overwrite" in done.err and out.read_text() == "mine"
    assert benchlab("export", "tw3_slw10", "--engine", "abaqus", "--cells", 1, "--out", out, "--overwrite").code == 0


@pytest.mark.parametrize(
    ("options", "says"),
    [
        (["--cells", "0"], "--cells"),
        (["--cells", "2", "--whole"], "--whole"),
        (["--pressure-MPa", "-1"], "--pressure-MPa is -1"),
        (["--along-mm", "0"], "along_mm is 0"),
        (["--elements", "sheets"], "CalculiX alone"),
        (["--material", "nothing"], "no material is called"),
        (["--bulk-over-shear", "0"], "--bulk-over-shear is 0"),
        (["--out", "absent/of/a.inp"], "no such folder"),
    ],
)
def test_what_makes_no_deck_is_refused(options: list[str], says: str, benchlab, tmp_path: Path, monkeypatch) -> None:
    monkeypatch.chdir(tmp_path)
    done = benchlab("export", "tw3_slw10", "--engine", "abaqus", *options)
    assert done.code == 2 and says in done.err.replace("\n", " "), done.err
    assert not list(tmp_path.iterdir())


@pytest.mark.skipif(find_calculix() is None, reason="CalculiX (ccx) is not installed")
def test_a_deck_run_on_the_spot_gives_the_angle_of_simulate(benchlab, tmp_path: Path) -> None:
    coarse = ("--along-mm", 1, "--steps", 1, "--bulk-over-shear", 200)
    out = tmp_path / "deck.inp"
    deck = ("export", "tw3_slw10", "--engine", "calculix", "--cells", 2, "--pressure-MPa", 0.1, "--out", out)
    run = benchlab(*deck, *coarse, "--run", "--json")
    assert run.code == 0, run.err
    simulated = benchlab("simulate", "--design", "tw3_slw10", "--pressure-MPa", "0.1", "--out", tmp_path, "--json")
    assert run.json["run"]["angle_deg"][0][0] == pytest.approx(simulated.json["points"][0]["angle_deg"], rel=0.05)
    refused = benchlab("export", "tw3_slw10", "--engine", "abaqus", "--out", tmp_path / "a.inp", "--run")
    assert refused.code == 2 and "cannot be run here" in refused.err
