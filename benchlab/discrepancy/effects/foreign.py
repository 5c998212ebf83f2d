"""An effect of another package: what its own code does wrong is told as its own, and not taken for a fault of benchlab."""

from __future__ import annotations

import sys
import traceback
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

import numpy as np

from benchlab.discrepancy.base import KNOBS
from benchlab.discrepancy.effects.effect import At, Effect
from benchlab.discrepancy.scene import Scene
from benchlab.errors import BenchlabError, InputError
from benchlab.units import FloatArray

TOLD = ("name", "acts_on", "physics", "looks_like", "shown_by", "parameters", "forms", "seen_in", "needs", "__module__")
"""What an effect says of itself."""

CHANGES = ("gauge", "inside", "load", "angle", "camera", "force", "flex")
"""Methods that take (T, R) values, and give as many."""


class Foreign(Effect):
    """The same effect, with InputError, which names effect, package, file and line, wherever its code fails.

    own: as the package has it. package: in words. Methods that it does not have stay those of Effect; values are given as copies.
    """

    def __init__(self, own: Effect, package: str) -> None:
        self.own, self.package = own, package
        for part in TOLD:
            setattr(self, part, getattr(own, part))
        for method in CHANGES:
            if getattr(type(own), method) is not getattr(Effect, method):
                setattr(self, method, self._change(method))

    def cannot_show(self, scene: Scene) -> str:
        return str(self._asked("cannot_show", scene) or "")

    def knobs(self, at: At) -> Mapping[str, FloatArray | float]:
        found = self._asked("knobs", at)
        if not isinstance(found, Mapping):
            raise self._failed(f"it gives {type(found).__name__}", "knobs", "give a dict of settings by knob")
        for name, setting in found.items():
            if name not in KNOBS:
                raise self._failed(f"no structural knob is called {name!r}", "knobs", f"use {', '.join(KNOBS)}")
            self._check("knobs", setting, ((), at.load_MPa.shape))
        return found

    def _change(self, method: str) -> Callable[[FloatArray, At], FloatArray]:
        def change(values: FloatArray, at: At) -> FloatArray:
            return self._check(method, self._asked(method, values.copy(), at), (values.shape,))

        return change

    def _asked(self, method: str, *given: Any) -> Any:
        """What its method gives."""
        try:
            return getattr(self.own, method)(*given)
        except BenchlabError:
            raise
        except Exception as error:  # whatever a package may do
            told = f"{type(error).__name__}: {error}".removesuffix(": ")
            lines = [f.lineno for f in traceback.extract_tb(error.__traceback__) if f.filename == self._file]
            where = f"{method}, line {lines[-1]}" if lines else method
            raise self._failed(f"it fails with {told}", where, "repair it there") from error

    def _check(self, method: str, values: Any, shapes: tuple[tuple[int, ...], ...]) -> FloatArray:
        """The values as an array, if they are numbers of one of the shapes."""
        try:
            found = np.asarray(values, dtype=float)
        except (TypeError, ValueError):
            found = None
        if values is None or found is None:
            raise self._failed(f"it gives {type(values).__name__}", method, "give numbers")
        if found.shape not in shapes:
            what = f"it gives values of shape {found.shape} where {shapes[-1]} are asked for"
            raise self._failed(what, method, "give as many as it takes")
        if not np.isfinite(found).all():
            raise self._failed("it gives values that are not finite", method, "try it at the bounds of its parameters")
        return found

    @property
    def _file(self) -> str:
        return getattr(sys.modules.get(self.own.__module__), "__file__", None) or self.own.__module__

    def _failed(self, what: str, where: str, hint: str) -> InputError:
        told = f"effect {self.name!r} of {self.package}: {what}"
        remedy = f"{hint}, or uninstall the package to go on without it"
        return InputError(told, file=Path(self._file).name, where=where, hint=remedy)
