"""Strain energy of a thin sheet in plane stress, one law a file.

Every law is a frozen dataclass of its coefficients (MPa) and gives `energy(a, b)`: the strain energy per reference
volume and its derivatives, where C is the in-plane right Cauchy-Green tensor, a = tr C and b = det C. The thickness is
eliminated: an incompressible sheet has the thickness stretch b^(-1/2), so I1 = a + 1/b and I2 = a/b + b.
"""

from benchlab.simulation.laws.catalogue import LAWS, POLYNOMIAL_TERMS, describe_law, make_law
from benchlab.simulation.laws.law import Energy, Law
from benchlab.simulation.laws.ogden import Ogden
from benchlab.simulation.laws.polynomial import Polynomial
from benchlab.simulation.laws.st_venant_kirchhoff import StVenantKirchhoff

__all__ = [
    "LAWS",
    "POLYNOMIAL_TERMS",
    "Energy",
    "Law",
    "Ogden",
    "Polynomial",
    "StVenantKirchhoff",
    "describe_law",
    "make_law",
]
