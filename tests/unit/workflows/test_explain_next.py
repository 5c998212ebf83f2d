"""Proposed experiments as protocol files: what `benchlab run` reads is what was proposed."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import pytest

from benchlab.discrepancy.experiment import BenchLimits, Experiment
from benchlab.discrepancy.experiments import default_experiment, family
from benchlab.discrepancy.explanation import NextExperiment
from benchlab.io.experiment_protocol import REST_S
from benchlab.io.protocol_file import read_protocol
from benchlab.workflows.explain_next import write_next
from benchlab.workflows.protocol_show import show_protocol

EVERY = [
    *family(BenchLimits()),
    default_experiment(BenchLimits()),
    *family(BenchLimits(pressure_MPa=0.173, rate_MPa_s=0.31)),
    *family(BenchLimits(pressure_MPa=0.5)),
]


@pytest.mark.parametrize("experiment", EVERY, ids=lambda each: each.name)
def test_the_plan_of_the_file_goes_where_the_experiment_went(experiment: Experiment, tmp_path: Path) -> None:
    told = write_next(tmp_path, NextExperiment("", "a from b", 3.0, experiment=experiment))
    plan = read_protocol(told.protocol)
    time_s, pressure_MPa = experiment.trace()
    assert plan.duration_s == pytest.approx(experiment.run_s + 2 * REST_S, abs=0.05)
    followed = np.interp(time_s + REST_S, plan.time_s, plan.pressure_MPa)
    assert followed == pytest.approx(pressure_MPa, abs=0.7 * 0.02)  # a tick of the fastest rate, and its rounding
    assert next(event.kind for event in plan.events) == "trigger"
    assert plan.ends_vented and not plan.closed_loop


def test_the_file_says_what_it_separates_and_how_to_use_it(tmp_path: Path) -> None:
    (turned,) = (each for each in EVERY[:40] if each.name == "cycle_turned90" and each.trace()[1].max() == 0.35)
    told = write_next(tmp_path, NextExperiment("", "gravity from end_caps", 4.21, experiment=turned))
    text = Path(told.protocol).read_text()
    assert told.protocol == str(tmp_path / "next_cycle_turned90.yaml")
    comments = " ".join(line[2:] for line in text.splitlines() if line.startswith("# "))
    assert "Separates gravity from end_caps, by an expected 4.21 standard deviations." in comments
    assert "mounted at 0° then at 90°" in comments
    assert "`benchlab run" in comments and "together with the old ones" in comments
    assert all(len(line) <= 122 for line in text.splitlines())
    assert show_protocol(told.protocol)["peak_MPa"] == 0.35


def test_the_default_says_that_it_was_chosen_for_no_pair(tmp_path: Path) -> None:
    told = write_next(tmp_path, NextExperiment("", "", math.nan, experiment=default_experiment(BenchLimits())))
    assert "standard deviations" not in Path(told.protocol).read_text()


def test_without_an_experiment_nothing_is_written(tmp_path: Path) -> None:
    told = NextExperiment("", "", 0.2, cannot="cannot be separated on this bench: …")
    assert write_next(tmp_path, told) is told
    assert not list(tmp_path.iterdir())
