"""Studies drawn on the closed-form scene: effects are put in, samples scatter as told, so that the answer is known."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cache

import numpy as np

from benchlab.discrepancy.base import Base
from benchlab.discrepancy.effects.catalogue import built_in
from benchlab.discrepancy.effects.effect import Active, Effect
from benchlab.discrepancy.measured import Measured, Run
from benchlab.discrepancy.predict import predict
from benchlab.discrepancy.prepare import prepared
from benchlab.discrepancy.problem import Problem
from tests.unit.discrepancy.scenes import KINDS, base, scene

EFFECTS = built_in()
FEW = ("friction", "viscoelasticity", "end_caps", "camera_scale", "pressure_offset", "softening", "marker_offset")
"""A small vocabulary of effects that differ."""


@dataclass(frozen=True)
class Scattered:
    """Standard deviations: of a sample's gain and shift of pressure, of a run's offset, of a reading."""

    gain: float = 0.02
    pressure_MPa: float = 0.002
    run_deg: float = 0.3
    white_deg: float = 0.2


NO_SCATTER = Scattered(0.0, 0.0, 0.0, 0.0)


def active(name: str, form: str = "plain", **values: float) -> Active:
    """The effect with its typical numbers, but for those given."""
    effect = EFFECTS[name]
    return Active(effect, {p.name: values.get(p.name, p.typical) for p in effect.parameters}, form)


def few(*names: str) -> list[Effect]:
    return [EFFECTS[name] for name in names or FEW]


def drawn(
    seed: int,
    actives: Sequence[Active] = (),
    *,
    designs: int = 3,
    samples: int = 4,
    protocol: Sequence[str] = ("slow", "fast", "hold"),
    scatter: Scattered = Scattered(),
    on: Base | None = None,
    also_deg: float = 0.0,
) -> Measured:
    """Runs of the scene's protocol. also_deg: amplitude of a wiggle over pressure that no effect of the vocabulary has."""
    random = np.random.default_rng(seed)
    made = scene(protocol, designs, samples, on=on)
    shift = scatter.pressure_MPa * random.standard_normal(designs * samples)[made.sample]
    truth = predict(_moved(made, shift), actives)["angle_deg"]
    truth = truth * (1 + scatter.gain * random.standard_normal(designs * samples)[made.sample])
    truth += scatter.run_deg * random.standard_normal(truth.shape[1])
    truth += scatter.white_deg * random.standard_normal(truth.shape)
    truth += also_deg * np.sin(6 * np.pi * made.pressure_MPa / 0.35) * (made.pressure_MPa > 0)
    runs = []
    for r in range(truth.shape[1]):
        real = made.real[:, r]
        kind = protocol[r % len(protocol)]
        runs.append(
            Run(
                design=made.names[made.design[r]],
                sample=f"s{made.sample[r] % samples}",
                run=f"{r % len(protocol)} {kind}",
                time_s=made.time_s[real, r],
                pressure_MPa=made.pressure_MPa[real, r],
                values={"angle_deg": truth[real, r]},
                run_index=float(made.order[r]),
            )
        )
    return Measured(tuple(sorted(runs, key=lambda run: (run.design, run.sample, run.run))), "drawn, for tests", True)


def problem(seed: int, actives: Sequence[Active] = (), **how: object) -> Problem:
    """The prepared problem of such a study, against the scene's base."""
    on = how.pop("against", None)
    return prepared(drawn(seed, actives, **how), on or base(how.get("designs", 3)))[0]  # type: ignore[arg-type]


TRUE = active("camera_scale", factor=1.08)


@cache
def studies(number: int = 60) -> list[Problem]:
    """Cheap studies of two designs in which TRUE is hidden."""
    return [problem(100 + seed, [TRUE], designs=2, protocol=("slow",)) for seed in range(number)]


def _moved(made, shift):  # type: ignore[no-untyped-def]
    from dataclasses import replace

    return replace(made, pressure_MPa=np.maximum(made.pressure_MPa + shift, 0.0))


__all__ = ["EFFECTS", "FEW", "KINDS", "NO_SCATTER", "TRUE", "Scattered", "active", "drawn", "few", "problem", "studies"]
