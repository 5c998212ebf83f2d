"""The loop with labs and explainers that are made up: rounds, ends, budgets, and what is kept."""

from __future__ import annotations

import json
from collections.abc import Sequence
from pathlib import Path

import numpy as np
import pytest

from benchlab.discrepancy.base import Base
from benchlab.discrepancy.experiment import BenchLimits, Experiment, Triangle
from benchlab.discrepancy.experiments import family
from benchlab.discrepancy.explanation import Explanation
from benchlab.discrepancy.measured import Measured, Run
from benchlab.errors import UsageError
from benchlab.io.measured_table import read_measured
from benchlab.io.runs_table import write_runs_csv
from benchlab.twin.effects.end_caps import EndCaps
from benchlab.workflows.explain_lab import Wanted
from benchlab.workflows.explain_loop import Loop, LoopSettings, explain_loop, lab_of
from benchlab.workflows.explain_mount import MountedLab
from benchlab.workflows.explain_twin import TwinLab
from benchlab.workflows.run_prepare import RunSettings
from tests.unit.discrepancy.scenes import base
from tests.unit.workflows.explanations import explanation

CYCLE = Experiment("cycle", "one cycle", (Triangle(0, 0.3, 0.1),))
SLOW = Experiment("slow", "one slow cycle", (Triangle(0, 0.3, 0.05),))
SHORT = Experiment("cycle_short", "one cycle, on shorter samples", (Triangle(0, 0.3, 0.1),), length_ratio=0.5)
TURNED = Experiment("turned", "one cycle, turned", (Triangle(0, 0.3, 0.1),), mountings_deg=(0.0, 90.0), rest_s=30)


class FakeLab:
    """Gives a straight line for each run. broken_at: the run, from 1, that somebody ends."""

    origin, about, remembers = "simulated (twin)", "made up", False

    def __init__(self, broken_at: int = 0) -> None:
        self.asked: list[Wanted] = []
        self.broken_at = broken_at

    def measure(self, wanted: Wanted) -> Run:
        self.asked.append(wanted)
        if len(self.asked) == self.broken_at:
            raise KeyboardInterrupt
        time_s = np.linspace(0, 4, 9)
        values = {"angle_deg": 100 * time_s / 4}
        return Run(wanted.called, wanted.sample, wanted.run, time_s, 0.3 * time_s / 4, values, run_index=wanted.index)


class Told:
    """Says the verdicts one after another, and remembers what it was given."""

    def __init__(self, *says: Explanation) -> None:
        self.says = list(says)
        self.given: list[tuple[list[Path], Base]] = []
        self.limits: BenchLimits | None = None

    def __call__(self, tables: Sequence[Path], known: Base, limits: BenchLimits) -> Explanation:
        self.given.append((list(tables), known))
        self.limits = limits
        return self.says[len(self.given) - 1]


def loop(folder: Path, explainer: Told, lab: FakeLab | None = None, **settings: object) -> Loop:
    chosen = LoopSettings(folder / "loop", samples=2, **settings)  # type: ignore[arg-type]
    return explain_loop(chosen, lab or FakeLab(), base(2), explainer)


@pytest.mark.parametrize("verdict", ["agree", "named", "unexplained"])
def test_an_answer_ends_the_loop_after_one_round(verdict: str, tmp_path: Path) -> None:
    found = loop(tmp_path, Told(explanation(verdict, CYCLE)))
    assert len(found.rounds) == 1 and found.settled
    assert found.as_json()["verdict"] == verdict


def test_what_is_proposed_is_run_and_all_data_are_explained_together(tmp_path: Path) -> None:
    explainer = Told(explanation("ambiguous", CYCLE), explanation("named"))
    found = loop(tmp_path, explainer)
    assert [one.round.experiment.name for one in found.rounds] == ["two_rates_hold_cycles", "cycle"]
    assert [len(tables) for tables, _ in explainer.given] == [1, 2]
    pooled = read_measured(explainer.given[1][0])
    assert isinstance(pooled, Measured) and pooled.simulated
    assert len(pooled.runs) == 2 * 2 * 2
    assert found.rounds[1].round.protocol.name == "next_cycle.yaml" and found.rounds[1].round.protocol.exists()


def test_ambiguous_without_an_experiment_ends_with_the_reason(tmp_path: Path) -> None:
    found = loop(tmp_path, Told(explanation("ambiguous", cannot="cannot be separated on this bench: a and b")))
    assert found.ended == "cannot be separated on this bench: a and b"
    assert found.settled


def test_the_budget_of_rounds_ends_it_without_an_answer(tmp_path: Path) -> None:
    told = [explanation("ambiguous", one) for one in (SLOW, TURNED, CYCLE)]
    found = loop(tmp_path, Told(*told), rounds=3)
    assert len(found.rounds) == 3 and not found.settled
    assert found.ended == "the budget of 3 rounds is spent; next would be: one cycle"


def test_what_was_run_in_vain_is_not_run_again(tmp_path: Path) -> None:
    found = loop(tmp_path, Told(*[explanation("ambiguous", CYCLE)] * 3), rounds=5)
    assert len(found.rounds) == 2 and found.settled
    assert found.ended == "one cycle was run and did not separate them: more samples would"


def test_the_budget_of_time_ends_it_after_the_round_that_spent_it(tmp_path: Path) -> None:
    times = iter([0.0, 30.0, 90.0, 1e9])
    settings = LoopSettings(tmp_path / "loop", samples=1, minutes=1.0)
    explainer = Told(*[explanation("ambiguous", CYCLE)] * 4)
    found = explain_loop(settings, FakeLab(), base(1), explainer, clock=lambda: next(times))
    assert len(found.rounds) == 2
    assert found.ended.startswith("the budget of 1 min is spent")


def test_what_was_measured_is_kept_and_the_same_call_goes_on(tmp_path: Path) -> None:
    with pytest.raises(KeyboardInterrupt):
        loop(tmp_path, Told(explanation("agree")), FakeLab(broken_at=3))
    kept = read_measured([tmp_path / "loop" / "round1" / "measured.csv"])
    assert isinstance(kept, Measured) and len(kept.runs) == 2
    lab = FakeLab()
    found = loop(tmp_path, Told(explanation("agree")), lab)
    assert [one.stem for one in lab.asked] == ["tw3_slw5_s1_r1", "tw3_slw5_s2_r1"]
    whole = read_measured([found.rounds[0].round.table])
    assert isinstance(whole, Measured) and len(whole.runs) == 4


def test_a_run_that_was_broken_off_is_made_again_under_another_name(tmp_path: Path) -> None:
    (tmp_path / "loop" / "round1").mkdir(parents=True)
    (tmp_path / "loop" / "round1" / "tw3_slw10_s1_r1.journal").write_text("broken off")
    lab = FakeLab()
    loop(tmp_path, Told(explanation("agree")), lab)
    assert lab.asked[0].stem == "tw3_slw10_s1_r1-again2"


def test_samples_of_another_length_are_designs_of_their_own(tmp_path: Path) -> None:
    explainer = Told(explanation("ambiguous", SHORT), explanation("named"))
    found = loop(tmp_path, explainer)
    _, known = explainer.given[1]
    assert set(known.designs) == {"tw3_slw10", "tw3_slw5", "tw3_slw10_90mm", "tw3_slw5_90mm"}
    shape = known.designs["tw3_slw10_90mm"].shape
    assert shape is not None and shape.length_mm == 90
    measured = read_measured([found.rounds[1].round.table])
    assert isinstance(measured, Measured) and measured.designs == ("tw3_slw10_90mm", "tw3_slw5_90mm")


def test_each_sample_is_mounted_in_all_its_ways_one_after_the_other(tmp_path: Path) -> None:
    lab = FakeLab()
    loop(tmp_path, Told(explanation("ambiguous", TURNED), explanation("named")), lab)
    second = [(one.called, one.sample, one.mounting_deg, one.rest_s, one.index) for one in lab.asked[4:]]
    assert second[:2] == [("tw3_slw10", "s1", 0.0, 0.0, 2), ("tw3_slw10", "s1", 90.0, 30, 3)]
    assert len(second) == 8


def test_a_folder_begun_otherwise_is_refused(tmp_path: Path) -> None:
    loop(tmp_path, Told(explanation("agree")))
    other = FakeLab()
    other.about = "another bench"
    with pytest.raises(UsageError, match="was begun with another measured_on"):
        loop(tmp_path, Told(explanation("agree")), other)


def test_the_record_tells_the_rounds(tmp_path: Path) -> None:
    loop(tmp_path, Told(explanation("ambiguous", CYCLE), explanation("named")))
    record = json.loads((tmp_path / "loop" / "loop.json").read_text())
    assert [one["verdict"] for one in record["rounds"]] == ["ambiguous", "named"]
    assert record["rounds"][0]["next"] == "cycle" and record["rounds"][0]["expected_sd"] == 4.0
    assert record["settings"]["measured_on"] == "made up"


def test_the_first_protocol_and_what_is_proposed_keep_to_the_bench(tmp_path: Path) -> None:
    explainer = Told(explanation("agree"))
    found = loop(tmp_path, explainer, limits=BenchLimits(pressure_MPa=0.2, can_turn=False))
    assert max(found.rounds[0].round.experiment.trace()[1]) == 0.2
    assert explainer.limits == BenchLimits(pressure_MPa=0.2, can_turn=False, remembers=False)
    assert not any(len(each.mountings_deg) > 1 for each in family(explainer.limits))


@pytest.mark.parametrize("wrong", [{"samples": 0}, {"rounds": 21}, {"minutes": 0.0}])
def test_settings_out_of_range_are_refused(wrong: dict[str, float], tmp_path: Path) -> None:
    with pytest.raises(UsageError, match=f"--{next(iter(wrong))}"):
        LoopSettings(tmp_path, **wrong).check()  # type: ignore[arg-type]


def test_the_bench_decides_on_the_lab(tmp_path: Path) -> None:
    (tmp_path / "twin.yaml").write_text("effects:\n  end_caps: {cap_mm: 7}\n")
    lab = lab_of(RunSettings(bench=f"twin:{tmp_path / 'twin.yaml'}"), base(1), print, seed=3)
    assert isinstance(lab, TwinLab) and lab.seed == 3 and lab.hidden.effects["end_caps"] == EndCaps(7)
    assert "simulated, not measured" in lab.about and "chosen" in lab.about
    assert isinstance(lab_of(RunSettings(bench="serial:/dev/null"), base(1), print), MountedLab)


@pytest.mark.parametrize(
    ("bench", "options", "words"),
    [("emulated", {"film": True}, "--film is for a twin"), ("replay:a.h5", {}, "a replay makes no new run")],
)
def test_what_a_bench_cannot_give_is_refused(bench: str, options: dict[str, bool], words: str) -> None:
    with pytest.raises(UsageError, match=words):
        lab_of(RunSettings(bench=bench), base(1), print, **options)


def test_runs_come_back_from_their_table(tmp_path: Path) -> None:
    time_s = np.array([0.0, 0.5, 1.0])
    values = {"angle_deg": np.array([0.0, np.nan, 20.0]), "force_N": np.array([0.0, 1.5, 3.25])}
    run = Run(
        "a", "s1", "r1", time_s, 0.1 * time_s, values, 0.11 * time_s, np.ones(3), run_index=2.0, orientation_deg=90.0
    )
    write_runs_csv(tmp_path / "runs.csv", [run], "bench")
    back = read_measured([tmp_path / "runs.csv"])
    assert isinstance(back, Measured) and not back.simulated
    (same,) = back.runs
    assert (same.design, same.sample, same.run, same.run_index, same.orientation_deg) == ("a", "s1", "r1", 2.0, 90.0)
    assert same.command_MPa is not None
    for got, put in [(same.time_s, time_s), (same.pressure_MPa, run.pressure_MPa), (same.command_MPa, 0.11 * time_s)]:
        assert got == pytest.approx(put, abs=1e-6)
    for name, put in values.items():
        assert same.values[name] == pytest.approx(put, abs=1e-4, nan_ok=True)
