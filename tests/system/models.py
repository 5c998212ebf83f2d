"""Model files for tests of commands: of the beam, which is quick."""

from __future__ import annotations

import math
from pathlib import Path

from benchlab.discrepancy.effects.catalogue import effects
from benchlab.discrepancy.explanation import Estimate
from benchlab.io.model_file import ModelBase, ModelEffect, ModelFile, ModelProvenance, digest_of, write_model

LAYUP = "from-measured-angles"


def beam_model(path: Path, **found: dict[str, float]) -> Path:
    """Write a model of the beam with these effects: values by parameter, typical ones where they are not given."""
    numbers = {
        name: {
            p.name: Estimate(values.get(p.name, p.typical), math.nan, math.nan, p.unit)
            for p in effects()[name].parameters
        }
        for name, values in found.items()
    }
    base = ModelBase("beam", LAYUP, digest_of("beam", LAYUP))
    given = tuple(ModelEffect(name, "plain", each) for name, each in numbers.items())
    write_model(path, ModelFile(base, given, ModelProvenance("a test", "2024-05-01")))
    return path
