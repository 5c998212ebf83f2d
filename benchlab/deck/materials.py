"""Laws as the material cards that Abaqus and CalculiX share."""

from __future__ import annotations

from benchlab.errors import UsageError
from benchlab.simulation.laws import LAWS, Law, Ogden, Polynomial, StVenantKirchhoff

OGDEN_TERMS = 3


def material_card(law: Law, bulk_over_shear: float) -> list[str]:
    """Lines after *MATERIAL. An incompressible law is made nearly so: D1 = 2/K with K = bulk_over_shear · μ, the other D 0.

    *ELASTIC with NLGEOM is St Venant's and Kirchhoff's law in CalculiX (exact in one element under tension); Abaqus'
    shells take it between logarithmic strain and Cauchy stress, which agrees to the first order in the strain.
    Raises UsageError for a law without a card.

    >>> material_card(Polynomial(C10=1.5, C20=3.0), 1000.0)
    ['*HYPERELASTIC, POLYNOMIAL, N=2', '1.5, 0, 3, 0, 0, 0.000666666667, 0']
    """
    if isinstance(law, StVenantKirchhoff):
        return ["*ELASTIC", f"{law.youngs_modulus_MPa:.9g}, {law.poisson_ratio:.9g}"]
    if not law.shear_modulus_MPa > 0:
        raise UsageError(
            f"shear modulus {law.shear_modulus_MPa:g} MPa", hint="give a material that is stiff when small"
        )
    d1 = 2 / (bulk_over_shear * law.shear_modulus_MPa)
    if isinstance(law, Polynomial):
        return _polynomial(law, d1)
    if isinstance(law, Ogden):
        return _ogden(law, d1)
    raise UsageError(f"the law {type(law).__name__} has no card in a deck", hint=f"use one of {', '.join(LAWS)}")


def _polynomial(law: Polynomial, d1: float) -> list[str]:
    if law.C30 and (law.C01 or law.C11 or law.C02):
        return [
            "*HYPERELASTIC, POLYNOMIAL, N=3",
            _row(law.C10, law.C01, law.C20, law.C11, law.C02, law.C30, 0, 0),
            _row(0, d1, 0, 0),
        ]
    if law.C30:
        return ["*HYPERELASTIC, YEOH", _row(law.C10, law.C20, law.C30, d1, 0, 0)]
    if law.C20 or law.C11 or law.C02:
        return ["*HYPERELASTIC, POLYNOMIAL, N=2", _row(law.C10, law.C01, law.C20, law.C11, law.C02, d1, 0)]
    if law.C01:
        return ["*HYPERELASTIC, MOONEY-RIVLIN", _row(law.C10, law.C01, d1)]
    return ["*HYPERELASTIC, NEO HOOKE", _row(law.C10, d1)]


def _ogden(law: Ogden, d1: float) -> list[str]:
    """The engines write 2 μ_i/α_i² in front of a term where the law here writes μ_i/α_i."""
    n = len(law.mu_MPa)
    if n > OGDEN_TERMS:
        raise UsageError(f"Ogden's law with {n} terms", hint=f"CalculiX takes {OGDEN_TERMS} at most")
    numbers = [x for mu, alpha in zip(law.mu_MPa, law.alpha) for x in (mu * alpha / 2, alpha)]
    numbers += [d1, *[0.0] * (n - 1)]
    return [f"*HYPERELASTIC, OGDEN, N={n}", *(_row(*numbers[i : i + 8]) for i in range(0, len(numbers), 8))]


def _row(*numbers: float) -> str:
    return ", ".join(f"{number:.9g}" for number in numbers)
