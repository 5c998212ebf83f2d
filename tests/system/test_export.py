from pathlib import Path

import pytest


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
        for fact in ("tw3_slw10", "mm, N, MPa", "Origin of the layup", "RIB_002: z = 5 mm", "not measured", "from-FEM-angles"):
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
        (["--out", "absent/a.inp"], "no such folder"),
    ],
)
def test_what_makes_no_deck_is_refused(options: list[str], says: str, benchlab, tmp_path: Path, monkeypatch) -> None:
    monkeypatch.chdir(tmp_path)
    done = benchlab("export", "tw3_slw10", "--engine", "abaqus", *options)
    assert done.code == 2 and says in done.err.replace("\n", " "), done.err
    assert not list(tmp_path.iterdir())
