"""Material files: a layup as YAML, and the layups that come with benchlab by their names.

name, origin, film {law, coefficients_MPa, exponents, thickness_mm}, fabric {youngs_modulus_MPa, poisson_ratio, thickness_mm},
strip {thickness_mm}, and every other field of `Layup` under its own name.
"""

from __future__ import annotations

import dataclasses
from importlib.resources import as_file, files
from importlib.resources.abc import Traversable
from pathlib import Path
from typing import Any, get_type_hints

from pydantic import Field, create_model

from benchlab.errors import InputError, UsageError
from benchlab.io.yaml_file import Document, read_document, write_document
from benchlab.simulation.laws import StVenantKirchhoff, describe_law, make_law
from benchlab.simulation.layup import Layup

DEFAULT_LAYUP = "from-FEM-angles"
"""Name of the layup that is simulated where none is given."""

_NESTED = ("film", "fabric", "film_thickness_mm", "fabric_thickness_mm", "strip_thickness_mm")
_DEFAULTS: dict[str, Any] = {f.name: f.default for f in dataclasses.fields(Layup)}


class _Film(Document):
    law: str
    coefficients_MPa: dict[str, float]
    exponents: dict[str, float] = Field(default_factory=dict)
    thickness_mm: float = Field(default=_DEFAULTS["film_thickness_mm"], gt=0)


class _Fabric(Document):
    youngs_modulus_MPa: float = Field(default=StVenantKirchhoff().youngs_modulus_MPa, gt=0)
    poisson_ratio: float = Field(default=StVenantKirchhoff().poisson_ratio, gt=-1, lt=0.5)
    thickness_mm: float = Field(default=_DEFAULTS["fabric_thickness_mm"], gt=0)


class _Strip(Document):
    thickness_mm: float = Field(default=_DEFAULTS["strip_thickness_mm"], gt=0)


def _simple_fields() -> dict[str, Any]:
    """Fields of Layup that are written as they are: name -> (type, default)."""
    hints = get_type_hints(Layup)
    return {
        f.name: (hints[f.name], ... if f.default is dataclasses.MISSING else f.default)
        for f in dataclasses.fields(Layup)
        if f.name not in _NESTED
    }


_LayupDocument: Any = create_model(
    "_LayupDocument",
    __base__=Document,
    film=(_Film, ...),
    fabric=(_Fabric, _Fabric()),
    strip=(_Strip, _Strip()),
    **_simple_fields(),
)


def shipped_layups() -> tuple[str, ...]:
    """Names of the layups that come with benchlab.

    >>> "trial" in shipped_layups()
    True
    """
    return tuple(sorted(item.name.removesuffix(".yaml") for item in _folder().iterdir() if item.name.endswith(".yaml")))


def read_layup(text_or_path: str | Path) -> Layup:
    """A layup by its name (upper or lower case) or from a file.

    Raises UsageError for what is neither, InputError for a file that does not hold a possible layup.

    >>> read_layup("Trial").film
    Polynomial(C10=1.5, C01=0.0, C20=3.0, C11=0.0, C02=0.0, C30=0.0)
    """
    name = str(text_or_path).strip().lower()
    if name in shipped_layups():
        with as_file(_folder() / f"{name}.yaml") as path:
            return _layup(path)
    path = Path(text_or_path)
    if not path.exists() and len(path.parts) <= 1 and not path.suffix:
        hint = f"give a file, or one of {', '.join(shipped_layups())}"
        raise UsageError(f"no material is called {str(text_or_path)!r}", hint=hint)
    return _layup(path)


def write_layup(path: Path, layup: Layup, header_comment: str = "") -> None:
    """Write a layup so that `read_layup` gives the same again. InputError where the disk refuses."""
    write_document(path, layup_document(layup), header_comment)


def layup_document(layup: Layup) -> dict[str, Any]:
    """A layup as plain data, in the order of the file."""
    simple = {name: getattr(layup, name) for name in _simple_fields()}
    return {
        "name": simple.pop("name"),
        "origin": simple.pop("origin"),
        "film": {**describe_law(layup.film), "thickness_mm": float(layup.film_thickness_mm)},
        "fabric": {
            "youngs_modulus_MPa": float(layup.fabric.youngs_modulus_MPa),
            "poisson_ratio": float(layup.fabric.poisson_ratio),
            "thickness_mm": float(layup.fabric_thickness_mm),
        },
        "strip": {"thickness_mm": float(layup.strip_thickness_mm)},
        **simple,
    }


def _folder() -> Traversable:
    return files("benchlab") / "layups"


def _layup(path: Path) -> Layup:
    found = read_document(path, _LayupDocument)
    try:
        return Layup(
            film=make_law(found.film.law, found.film.coefficients_MPa, found.film.exponents),
            fabric=StVenantKirchhoff(found.fabric.youngs_modulus_MPa, found.fabric.poisson_ratio),
            film_thickness_mm=found.film.thickness_mm,
            fabric_thickness_mm=found.fabric.thickness_mm,
            strip_thickness_mm=found.strip.thickness_mm,
            **{name: getattr(found, name) for name in _simple_fields()},
        )
    except UsageError as error:
        raise InputError(error.what, file=path, where=error.where, hint=error.hint) from error
