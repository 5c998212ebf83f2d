"""Laws by name and named coefficients, as material files write them: `yeoh` with C10, C20, C30."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from typing import Any

from benchlab.errors import UsageError
from benchlab.simulation.laws.law import Law
from benchlab.simulation.laws.ogden import Ogden
from benchlab.simulation.laws.polynomial import Polynomial

POLYNOMIAL_TERMS: dict[str, tuple[str, ...]] = {
    "neo-hooke": ("C10",),
    "mooney-rivlin": ("C10", "C01"),
    "yeoh": ("C10", "C20", "C30"),
    "polynomial-2": ("C10", "C01", "C20", "C11", "C02"),
}
"""The coefficients (MPa) of each law that is linear in them; smaller laws first."""

Named = Mapping[str, float]


def make_law(name: str, coefficients_MPa: Named, exponents: Named | None = None) -> Law:
    """The law called `name` with these coefficients; terms that are left out are zero.

    `ogden` takes mu1, mu2, ... in `coefficients_MPa` and alpha1, alpha2, ... in `exponents`.
    Raises UsageError for an unknown law or coefficient, a value that is not finite, an initial modulus that is not positive.

    >>> make_law("mooney-rivlin", {"C10": 0.2, "C01": 0.05}).shear_modulus_MPa
    0.5
    """
    if name not in LAWS:
        raise UsageError(f"no law is called {name!r}", hint=f"use one of {', '.join(LAWS)}")
    for key, value in [*coefficients_MPa.items(), *(exponents or {}).items()]:
        if not math.isfinite(value):
            raise UsageError(f"{key} of {name} is {value}", hint="give a finite number")
    law = LAWS[name](coefficients_MPa, exponents or {})
    if not law.shear_modulus_MPa > 0:
        raise UsageError(
            f"{name} with these coefficients has an initial shear modulus of {law.shear_modulus_MPa:g} MPa",
            hint="a material has a positive one: check the signs of the coefficients",
        )
    return law


def describe_law(law: Law) -> dict[str, Any]:
    """What `make_law` needs to make this law again: {"law", "coefficients_MPa"} and "exponents" for `ogden`.

    Raises ValueError for a law that is not in the catalogue.

    >>> describe_law(Polynomial(C10=1.5, C20=3.0))
    {'law': 'yeoh', 'coefficients_MPa': {'C10': 1.5, 'C20': 3.0, 'C30': 0.0}}
    """
    if isinstance(law, Ogden):
        return {
            "law": "ogden",
            "coefficients_MPa": {f"mu{i}": mu for i, mu in enumerate(law.mu_MPa, 1)},
            "exponents": {f"alpha{i}": alpha for i, alpha in enumerate(law.alpha, 1)},
        }
    if isinstance(law, Polynomial):
        used = {key for key, value in vars(law).items() if value}
        for name, terms in POLYNOMIAL_TERMS.items():
            if used <= set(terms):
                return {"law": name, "coefficients_MPa": {key: float(getattr(law, key)) for key in terms}}
    raise ValueError(f"no name in the catalogue for {law}")


def _polynomial(name: str) -> Callable[[Named, Named], Law]:
    def make(coefficients: Named, exponents: Named) -> Law:
        terms = POLYNOMIAL_TERMS[name]
        if exponents:
            raise UsageError(f"{name} has no exponents", hint="remove them, or is ogden meant?")
        if unknown := sorted(set(coefficients) - set(terms)):
            raise UsageError(f"{name} has no coefficient {', '.join(unknown)}", hint=f"it has {', '.join(terms)}")
        return Polynomial(**{key: float(coefficients.get(key, 0.0)) for key in terms})

    return make


def _ogden(coefficients: Named, exponents: Named) -> Law:
    count = max(len(coefficients), len(exponents))
    mus, alphas = ([f"{stem}{i}" for i in range(1, count + 1)] for stem in ("mu", "alpha"))
    if set(coefficients) != set(mus) or set(exponents) != set(alphas):
        raise UsageError(
            f"ogden has the coefficients {', '.join(coefficients) or 'none'} and the exponents {', '.join(exponents) or 'none'}",
            hint="give mu1, mu2, ... and as many exponents alpha1, alpha2, ...",
        )
    return Ogden(tuple(float(coefficients[k]) for k in mus), tuple(float(exponents[k]) for k in alphas))


LAWS: dict[str, Callable[[Named, Named], Law]] = {
    **{name: _polynomial(name) for name in POLYNOMIAL_TERMS},
    "ogden": _ogden,
}
"""How each law of the catalogue is made from its named coefficients and exponents."""
