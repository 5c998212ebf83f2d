"""`benchlab cut` from the command line."""

import ezdxf
import pytest

from benchlab.actuator import ShellDesign
from benchlab.io.design_file import write_design


def test_a_name_becomes_a_drawing(benchlab, tmp_path) -> None:
    out = tmp_path / "shell.dxf"
    done = benchlab("cut", "tw3_slw10", "--out", out, "--kerf-mm", "0.2", "--json")
    assert done.code == 0, done.err
    assert f"wrote {out}" in done.err and "35 windows (Eq 7: 35.60), 1.50 mm" in done.err
    found = done.json
    assert found["windows"] == 35 and found["end_margin_mm"] == 1.5 and found["out"] == str(out)
    assert found["window_area_eq6_whole_mm2"] == 35 * 90 and found["window_area_eq6_mm2"] == pytest.approx(35.6 * 90)
    assert 0 <= found["window_area_eq6_whole_mm2"] - found["window_area_mm2"] < 1
    assert [(p["name"], p["length_mm"], p["width_mm"], p["windows"], p["holes"]) for p in found["parts"]] == [
        ("fabric", 192, 40, 35, 4),
        ("film", 192, 40, 0, 4),
        ("strip", 192, 12, 0, 4),
    ]
    assert found["settings"] == {"weld_mm": 5, "cap_mm": 0, "hole_mm": 2, "kerf_mm": 0.2, "corner_radius_mm": 0}
    assert found["cut_length_mm"]["FABRIC_CUT"] == pytest.approx(35 * 2 * (2.8 + 29.8) + 2 * (192.2 + 40.2))
    windows = ezdxf.readfile(out).modelspace().query("LWPOLYLINE[layer=='FABRIC_CUT']")
    assert len(windows) == 36


def test_a_file_becomes_a_drawing_of_one_material(benchlab, tmp_path) -> None:
    write_design(tmp_path / "d.yaml", ShellDesign(12, 4, 3, 50, 120))
    done = benchlab(
        "cut", tmp_path / "d.yaml", "--out", tmp_path / "f.svg", "--sheet", "fabric", "--hole-mm", 0, "--json"
    )
    assert done.code == 0, done.err
    assert [(p["name"], p["length_mm"], p["width_mm"]) for p in done.json["parts"]] == [
        ("fabric", 120, 50),
        ("strip", 120, 12),
    ]
    assert "FILM_CUT" not in (tmp_path / "f.svg").read_text()


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (["tw3_slw10", "--out", "a.pdf"], ["a.pdf", ".dxf or .svg"]),
        (["tw3_slw10", "--out", "none/of/a.dxf"], ["no such folder"]),
        (["tw3_slw10", "--out", "folder.dxf", "--overwrite"], ["is a folder"]),
        (["tw3_slw10", "--kerf-mm", "2"], ["kerf_mm is 2", "rib width fw is 2 mm"]),
        (["tw3_slw10", "--kerf-mm", "nan"], ["not a finite number"]),
        (["tw3_slw40"], ["strip_width_mm (slw) is 40", "perimeter_mm of 40"]),
        (["shell.yaml"], ["shell.yaml", "no such design file"]),
    ],
)
def test_what_is_refused_leaves_nothing(benchlab, tmp_path, monkeypatch, arguments, words) -> None:
    monkeypatch.chdir(tmp_path)
    (tmp_path / "folder.dxf").mkdir()
    done = benchlab("cut", *arguments, "--json")
    assert done.code == 2 and done.json["error"]["code"] == 2
    for word in words:
        assert word in done.err
    assert [p.name for p in tmp_path.iterdir()] == ["folder.dxf"]


def test_a_drawing_is_replaced_only_when_told(benchlab, tmp_path) -> None:
    out = tmp_path / "a.dxf"
    out.write_text("mine")
    done = benchlab("cut", "tw3_slw10", "--out", out)
    assert done.code == 2 and "--overwrite" in done.err and out.read_text() == "mine"
    assert benchlab("cut", "tw3_slw10", "--out", out, "--overwrite").code == 0
    assert out.read_text() != "mine"
