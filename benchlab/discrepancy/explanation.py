"""What comes out of explaining: where, what, with which evidence, and how much of the gap is closed."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from benchlab.discrepancy.experiment import Experiment
from benchlab.units import FloatArray

VERDICTS = {
    "agree": "simulation and measurement agree within the scatter of the samples",
    "named": "one explanation is left",
    "ambiguous": "several explanations cannot be told apart by these data",
    "unexplained": "they disagree, and no effect of the vocabulary explains it",
}


@dataclass(frozen=True)
class Region:
    """Where they disagree. direction: loading, unloading, hold, or all. rate_MPa_s: None in a hold, and where it is not known; cycle: None
    where it is over all of them.

    gap: measured − simulated on average over the interval, in the unit of the quantity; p: simultaneous over all regions looked at, NaN
    where it is not known how samples scatter.
    """

    design: str
    quantity: str
    direction: str
    rate_MPa_s: float | None
    cycle: int | None
    pressure_MPa: tuple[float, float]
    gap: float
    p: float


@dataclass(frozen=True)
class Estimate:
    """A parameter with its 95 % interval; low or high NaN where the data do not bound it. at_bound: it lies on a bound of the effect."""

    value: float
    low: float
    high: float
    unit: str
    what: str = ""
    at_bound: bool = False


@dataclass(frozen=True)
class Found:
    """An effect that was named. form: of its equation that fits best; other_forms: those that the data do not exclude."""

    name: str
    form: str
    parameters: Mapping[str, Estimate]
    share_explained: float
    other_forms: tuple[str, ...] = ()


@dataclass(frozen=True)
class Gap:
    """Root mean square of measured − model, in the unit of the quantity, over the means of designs and features.

    heldout: of samples that the fit did not see (each design's samples left out in turn); of a table of means, of designs. noise_floor: of
    a sample about its own design's mean, as a model without fault would reach on a held-out sample; of a table of means, their standard
    error. ceiling: share of the gap before that any model could explain.
    """

    rmse_before: float
    rmse_after: float
    heldout_before: float
    heldout_after: float
    noise_floor: float
    ceiling: float


@dataclass(frozen=True)
class HeldOut:
    """Left out of the fit, and predicted. kind: sample, design or rate; what: which one. before, after: rmse of its features;
    noise_floor: of its samples."""

    kind: str
    what: str
    before: float
    after: float
    noise_floor: float


@dataclass(frozen=True)
class Tried:
    """One candidate in the table of rivals. names: of its effects. misfit: −2 log L against the base alone (negative is better).

    p_enough: of the test that nothing in the vocabulary is missing beside it; in_set: not told apart from the best.
    reason: why it is out, in words.
    """

    names: tuple[str, ...]
    form: str
    misfit: float
    share_explained: float
    p_enough: float
    in_set: bool
    reason: str


@dataclass(frozen=True)
class Curves:
    """The features that were compared, (F,) each, for pictures and tables: a bin of pressure (in a hold: of time) of a kind of run.

    kind: words for the kind of run ("to 0.35 MPa at 0.12 MPa/s"). rate_MPa_s: as it is told of the kind, NaN in a hold. measured: mean
    over samples; sd: between samples (of a table of means: the table's own), NaN where it is not known; n: samples; simulated: base
    alone; explained: with the effects (= simulated where none); p: simultaneous, of measured ≠ simulated, NaN where scatter is not
    known.
    """

    design: NDArray[np.str_]
    quantity: NDArray[np.str_]
    kind: NDArray[np.str_]
    direction: NDArray[np.str_]
    cycle: NDArray[np.int64]
    rate_MPa_s: FloatArray
    pressure_MPa: FloatArray
    time_s: FloatArray
    measured: FloatArray
    sd: FloatArray
    n: FloatArray
    simulated: FloatArray
    explained: FloatArray
    p: FloatArray


@dataclass(frozen=True)
class NextExperiment:
    """protocol: path of the file, or its text before it is written. separates: rivals told apart, as words. expected_sd: smallest
    expected distance of two rivals in standard deviations, NaN where it was not chosen for a pair. setup: what to do beside the protocol
    (mounting, second length), empty where
    nothing. cannot: why there is none. experiment: the same as data, None where there is none."""

    protocol: str
    separates: str
    expected_sd: float
    setup: str = ""
    cannot: str = ""
    experiment: Experiment | None = None


@dataclass(frozen=True)
class Explanation:
    """All that was found. p_gap: of no disagreement at all. false_naming: nominal rate of a name where nothing is missing, to which the
    rules are calibrated. samples: behind all means. Both probabilities are NaN where the data could only be described.

    judged_not: effects that these data cannot show, with the reason. remainder: what is left and what it depends on, in words.
    left_out: measured designs that were not compared, with the reason.
    """

    verdict: str
    where: tuple[Region, ...]
    effects: tuple[Found, ...]
    rivals: tuple[tuple[str, ...], ...]
    gap: Gap
    p_gap: float
    false_naming: float
    tried: tuple[Tried, ...]
    judged_not: Mapping[str, str]
    remainder: tuple[str, ...]
    held_out: tuple[HeldOut, ...]
    curves: Curves
    warnings: tuple[str, ...]
    base: str
    source: str
    simulated: bool
    samples: int
    next_experiment: NextExperiment | None = None
    left_out: Mapping[str, str] = field(default_factory=dict)

    @property
    def only_described(self) -> bool:
        """Whether nothing scatters in these data, so that nothing could be tested."""
        return self.verdict == "unexplained" and bool(np.isnan(self.p_gap))
