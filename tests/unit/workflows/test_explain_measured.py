"""Which rivals the next experiment is for, where some of them cannot be told apart at all."""

from __future__ import annotations

from collections.abc import Sequence

from benchlab.discrepancy.effects.catalogue import built_in
from benchlab.discrepancy.effects.effect import Active
from benchlab.discrepancy.experiment import Experiment, Triangle
from benchlab.discrepancy.explanation import NextExperiment
from benchlab.discrepancy.next_experiment import Proposal, Scored
from benchlab.discrepancy.separation import Rival
from benchlab.workflows.explain_measured import _separating

CYCLE = Experiment("cycle", "one cycle", (Triangle(0, 0.3, 0.1),))
ALIKE = {"pressure_gain", "leakage"}


def rivals(*names: str) -> list[Rival]:
    return [Rival((Active(built_in()[name], {}),)) for name in names]


def propose(some: Sequence[Rival]) -> Proposal:
    """Separates all but a pressure's gain and a leak."""
    names = [rival.name for rival in some]
    pair = tuple(place for place, name in enumerate(names) if name in ALIKE)
    if len(pair) == 2:
        return Proposal(NextExperiment("", "", 0.1, cannot="no: " + " and ".join(names)), (Scored(CYCLE, 0.1, pair),))
    return Proposal(NextExperiment("cycle", " from ".join(names), 7.0, experiment=CYCLE), (Scored(CYCLE, 7.0, (0, 1)),))


def test_what_can_be_separated_is_and_what_cannot_is_told() -> None:
    found = _separating(propose, rivals("pressure_gain", "leakage", "friction"))
    assert found.experiment is CYCLE and found.separates == "pressure_gain from friction"
    assert found.cannot == "no: pressure_gain and leakage and friction"


def test_two_that_cannot_be_separated_have_no_experiment() -> None:
    found = _separating(propose, rivals("pressure_gain", "leakage"))
    assert found.experiment is None and found.cannot == "no: pressure_gain and leakage"


def test_where_all_can_be_separated_nothing_is_told() -> None:
    found = _separating(propose, rivals("leakage", "friction"))
    assert found.experiment is CYCLE and found.cannot == ""
