from pathlib import Path

import numpy as np
import pytest

from benchlab.errors import InputError, UsageError
from benchlab.io import calculix

DAT = """
 displacements (vx,vy,vz) for set RIB_001 and time  0.5000000E+00

         1  0.000000E+00  1.000000E-01  0.000000E+00
        12 -2.000000E-01  0.000000E+00  3.000000E+00

 displacements (vx,vy,vz) for set RIB_002 and time  0.5000000E+00

         3  0.000000E+00  1.000000E-01  {last}
"""


def test_displacements_are_read(tmp_path: Path) -> None:
    path = tmp_path / "a.dat"
    path.write_text(DAT.format(last="4.0"))
    found = calculix.read_displacements(path)
    assert found.keys() == {0.5} and found[0.5].keys() == {"RIB_001", "RIB_002"}
    nodes, moved = found[0.5]["RIB_001"]
    np.testing.assert_array_equal(nodes, [1, 12])
    np.testing.assert_array_equal(moved, [[0, 0.1, 0], [-0.2, 0, 3]])


@pytest.mark.parametrize("text", [DAT.format(last="******"), DAT.format(last="4.0 7.0"), DAT.format(last="NaN")])
def test_what_is_no_number_is_refused(text: str, tmp_path: Path) -> None:
    path = tmp_path / "a.dat"
    path.write_text(text)
    with pytest.raises(InputError, match="RIB_002"):
        calculix.read_displacements(path)


def test_a_file_without_displacements_is_refused(tmp_path: Path) -> None:
    (tmp_path / "a.dat").write_text("nothing\n")
    with pytest.raises(InputError, match="no displacements"):
        calculix.read_displacements(tmp_path / "a.dat")


def test_without_calculix_the_package_is_named(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("PATH", str(tmp_path))
    with pytest.raises(UsageError, match="calculix-ccx"):
        calculix.run_calculix(tmp_path / "a.inp")


@pytest.mark.skipif(
    calculix.find_calculix() is None, reason="CalculiX (ccx) is not installed: apt package calculix-ccx"
)
def test_what_calculix_refuses_is_said(tmp_path: Path) -> None:
    deck = tmp_path / "bad.inp"
    deck.write_text(
        "*NODE\n1, 0, 0, 0\n*ELEMENT, TYPE=S8R, ELSET=E\n1, 1, 2, 3, 4, 5, 6, 7, 8\n*STEP\n*STATIC\n*END STEP\n"
    )
    with pytest.raises(InputError, match="CalculiX stopped"):
        calculix.run_calculix(deck, timeout_s=600)
