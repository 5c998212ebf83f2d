"""Material cards, against the laws themselves: one element under tension in CalculiX."""

from pathlib import Path

import numpy as np
import pytest

from benchlab.deck.materials import material_card
from benchlab.errors import UsageError
from benchlab.io.calculix import find_calculix, run_calculix
from benchlab.simulation.laws import Law, Ogden, Polynomial, StVenantKirchhoff
from benchlab.simulation.laws.law import uniaxial_stress_MPa

needs_calculix = pytest.mark.skipif(
    find_calculix() is None, reason="CalculiX (ccx) is not installed: apt package calculix-ccx"
)

ELEMENT = """*NODE, NSET=ALL
1, 0, 0, 0\n2, 1, 0, 0\n3, 1, 1, 0\n4, 0, 1, 0\n5, .5, 0, 0\n6, 1, .5, 0\n7, .5, 1, 0\n8, 0, .5, 0
*ELEMENT, TYPE=S8R, ELSET=E
1, 1, 2, 3, 4, 5, 6, 7, 8
*MATERIAL, NAME=M
{card}
*SHELL SECTION, ELSET=E, MATERIAL=M
.3
*NSET, NSET=LEFT\n1, 4, 8\n*NSET, NSET=RIGHT\n2, 3, 6\n*NSET, NSET=BOTTOM\n1, 2, 5
*BOUNDARY\nLEFT, 1, 1\nBOTTOM, 2, 2\nALL, 3, 3
*STEP, NLGEOM\n*STATIC\n.1, 1.\n*BOUNDARY\nRIGHT, 1, 1, {pull}\n*NODE PRINT, NSET=RIGHT, TOTALS=ONLY\nRF\n*END STEP
"""


def pulled_MPa(law: Law, stretch: float, folder: Path) -> float:
    """Nominal stress that CalculiX finds at a stretch."""
    deck = folder / "one.inp"
    deck.write_text(ELEMENT.format(card="\n".join(material_card(law, 5000.0)), pull=stretch - 1))
    words = run_calculix(deck, timeout_s=600).read_text().split("total force")[-1].split()
    return float(words[words.index("time") + 2]) / 0.3


@needs_calculix
@pytest.mark.parametrize("stretch", [1.05, 1.6])
@pytest.mark.parametrize(
    "law",
    [
        Polynomial(C10=1.5),
        Polynomial(C10=1.5, C01=0.4),
        Polynomial(C10=1.5, C20=3.0),
        Polynomial(C10=1.2, C01=0.3, C20=0.5, C11=0.2, C02=0.1),
        Polynomial(C10=1.2, C20=-0.1, C30=0.05),
        Polynomial(C10=1.2, C01=0.3, C30=0.05),
        Ogden(mu_MPa=(2.0,), alpha=(3.0,)),
        Ogden(mu_MPa=(0.63, 0.0012, -0.01), alpha=(1.3, 5.0, -2.0)),
    ],
    ids=["neo-hooke", "mooney", "N2", "N2-full", "yeoh", "N3", "ogden1", "ogden3"],
)
def test_a_card_is_the_law(law: Law, stretch: float, tmp_path: Path) -> None:
    found = pulled_MPa(law, stretch, tmp_path)
    assert found == pytest.approx(float(uniaxial_stress_MPa(law, np.array(stretch))), rel=2e-3)


@needs_calculix
@pytest.mark.parametrize("stretch", [1.05, 1.2])
def test_elastic_is_st_venant_and_kirchhoff(stretch: float, tmp_path: Path) -> None:
    found = pulled_MPa(StVenantKirchhoff(498.0, 0.35), stretch, tmp_path)
    assert found == pytest.approx(498.0 * stretch * (stretch**2 - 1) / 2, rel=1e-5)


def test_four_ogden_terms_are_refused() -> None:
    with pytest.raises(UsageError, match="4 terms"):
        material_card(Ogden(mu_MPa=(1.0,) * 4, alpha=(1.0, 2.0, 3.0, 4.0)), 1000.0)
