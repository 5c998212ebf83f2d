"""The scene that an experiment would make: each design once, as many runs on it as the experiment has."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from benchlab.discrepancy.base import Base, DesignBase
from benchlab.discrepancy.experiment import Experiment
from benchlab.discrepancy.scene import Scene


def trial_scene(experiment: Experiment, base: Base, designs: Sequence[str]) -> Scene:
    """(T, R) of the experiment on these designs, R = designs × runs, those of one design next to each other.

    One sample stands for all of a design. The recorded pressure is the command's: what lies between is for the effects.
    The order of runs is known where there are several.
    """
    time_s, pressure_MPa = experiment.trace()
    mountings = np.array(experiment.mountings_deg)
    runs, count = len(mountings), len(designs) * len(mountings)

    def across(values: np.ndarray) -> np.ndarray:
        return np.repeat(values[:, None], count, axis=1)

    place = np.tile(np.arange(runs, dtype=float), len(designs))
    return Scene(
        base=of_length(base, designs, experiment.length_ratio),
        names=tuple(designs),
        design=np.repeat(np.arange(len(designs)), runs),
        sample=np.repeat(np.arange(len(designs)), runs),
        order=place if runs > 1 else np.full(count, np.nan),
        time_s=across(time_s),
        pressure_MPa=across(pressure_MPa),
        command_MPa=across(pressure_MPa),
        temperature_C=np.full((len(time_s), count), np.nan),
        real=np.ones((len(time_s), count), dtype=bool),
        start_s=place * (experiment.run_s + experiment.rest_s),
        orientation_deg=np.tile(mountings, len(designs)),
    )


def of_length(base: Base, designs: Sequence[str], ratio: float) -> Base:
    """The base of samples that are `ratio` times as long: the curvature is the same, so angle and volume go with the length.

    A design of unknown length keeps it unknown. Forces, which depend on the fixture, are left out.
    """
    if ratio == 1:
        return base
    return replace(base, designs={name: _longer(base.designs[name], ratio) for name in designs})


def _longer(design: DesignBase, ratio: float) -> DesignBase:
    shape = design.shape and replace(design.shape, length_mm=design.shape.length_mm * ratio)
    curves = {name: ratio * curve for name, curve in design.curves.items() if name != "force_N"}
    return replace(design, shape=shape, curves=curves)


def name_at(base: Base, design: str, ratio: float) -> str:
    """What samples of a design in another length are called: by their length, where it is known.

    >>> name_at(Base({"a": DesignBase("a", np.zeros(1), {})}, "foreign", ""), "a", 2.0)
    'a_x2'
    """
    shape = base.designs[design].shape
    if ratio == 1:
        return design
    return f"{design}_x{ratio:g}" if shape is None else f"{design}_{shape.length_mm * ratio:g}mm"


def with_length(base: Base, designs: Sequence[str], ratio: float) -> Base:
    """The base with designs of another length beside its own."""
    made = of_length(base, designs, ratio).designs
    new = {name_at(base, name, ratio): replace(made[name], name=name_at(base, name, ratio)) for name in designs}
    return replace(base, designs={**base.designs, **new})
