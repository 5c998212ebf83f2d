from collections.abc import Mapping
from dataclasses import replace

import numpy as np
import pytest

from benchlab.discrepancy.base import Base
from benchlab.discrepancy.measured import Measured, Run, Summary
from benchlab.discrepancy.prepare import TOGETHER, prepared
from benchlab.errors import InputError
from tests.unit.discrepancy.drawn import drawn
from tests.unit.discrepancy.scenes import TOP_MPa, base

BASE = base(3)
FIRST, SECOND, THIRD = sorted(BASE.designs)
STUDY = drawn(1, designs=3, samples=2, protocol=("slow",))


def changed(measured: Measured = STUDY, **columns: object) -> Measured:
    return replace(measured, runs=tuple(replace(run, **columns) for run in measured.runs))  # type: ignore[arg-type]


def without(*names: str, missing: Mapping[str, str] | None = None) -> Base:
    """The base without those designs."""
    return replace(BASE, designs={n: d for n, d in BASE.designs.items() if n not in names}, missing=missing or {})


def with_values(**values: float) -> Measured:
    """The study with constants measured beside the angle."""
    runs = [
        replace(run, values={**run.values, **{n: np.full_like(run.time_s, v) for n, v in values.items()}})
        for run in STUDY.runs
    ]
    return replace(STUDY, runs=tuple(runs))


def resting(run: Run) -> Run:
    """Twenty seconds without pressure before the run, and readings of the angle only there."""
    time = np.r_[np.arange(0, 20, 0.5), run.time_s + 20]
    angle = np.where(time < 19, 1.0, np.nan)
    return replace(run, time_s=time, pressure_MPa=np.r_[np.zeros(40), run.pressure_MPa], values={"angle_deg": angle})


REFUSED = {
    "none of the measured designs is simulated: measured .*; simulated other": (STUDY, Base({"other": BASE.designs[FIRST]}, "cell", "")),
    "no measured value lies where there is a simulated curve": (changed(pressure_MPa=np.full(121, 0.9)), BASE),
    "no run has a loading, an unloading or a hold with readings": (replace(STUDY, runs=tuple(map(resting, STUDY.runs))), BASE),
}  # fmt: skip


@pytest.mark.parametrize("words", REFUSED)
def test_what_cannot_be_compared_is_refused_with_its_source(words: str) -> None:
    with pytest.raises(InputError, match=words) as refused:
        prepared(*REFUSED[words])
    assert "drawn, for tests" in str(refused.value)


def test_a_good_study_is_taken_whole_and_without_a_warning() -> None:
    problem, warnings = prepared(STUDY, BASE)
    assert warnings == () and problem.samples == 6 and problem.freedom == 3
    assert problem.scene.names == (FIRST, SECOND, THIRD)
    assert prepared(replace(STUDY, warnings=("of reading",)), BASE)[1] == ("of reading",)


def test_designs_without_a_simulation_are_left_out_each_with_its_reason() -> None:
    problem, warnings = prepared(STUDY, without(SECOND, missing={SECOND: "no equilibrium"}))
    assert problem.scene.names == (FIRST, THIRD)
    assert warnings == (f"{SECOND} is measured but not simulated (no equilibrium): left out",)
    several = prepared(STUDY, without(FIRST, SECOND))[1]
    assert several == (f"{FIRST}, {SECOND} are measured but not simulated: left out",)


def test_pressures_above_the_simulated_ones_are_left_out_and_counted() -> None:
    run = STUDY.runs[0]
    higher = replace(run, pressure_MPa=1.2 * run.pressure_MPa)
    beyond = int((higher.pressure_MPa > 1.02 * TOP_MPa).sum())
    problem, (told,) = prepared(replace(STUDY, runs=(higher, *STUDY.runs[1:])), BASE)
    assert told == f"{beyond} of {121 * 6} readings lie above the simulated pressures: left out" and beyond > 10
    assert problem.scene.pressure_MPa.max() <= 1.02 * TOP_MPa


def test_what_was_measured_but_not_simulated_is_told_and_a_flex_sensor_is_compared_after_a_line() -> None:
    alone = {n: replace(d, curves={"angle_deg": d.curves["angle_deg"]}) for n, d in BASE.designs.items()}
    problem, warnings = prepared(with_values(force_N=3.0), replace(BASE, designs=alone))
    assert warnings == ("force_N is measured but not simulated: not compared",)
    assert problem.features.quantities == ("angle_deg",)
    problem, (told,) = prepared(with_values(flex_V=1.0), BASE)
    assert told.startswith("flex_V is compared after a straight line") and "flex_V" in problem.features.quantities


def test_a_lone_sample_takes_the_scatter_of_the_others_and_runs_stand_for_samples_where_there_is_one_of_each() -> None:
    lone = replace(STUDY, runs=STUDY.runs[:-1])
    problem, warnings = prepared(lone, BASE)
    assert warnings == (f"one sample alone of {THIRD}: its scatter is taken from the other designs",)
    assert problem.freedom == 2 and np.isfinite(problem.scatter.covariance[2]).all()
    one_each = drawn(1, designs=2, samples=1, protocol=("slow", "slow", "slow"))
    problem, (told,) = prepared(one_each, base(2))
    assert told.startswith("one sample of each design: its runs are taken for samples")
    assert problem.samples == 6 and problem.freedom == 4


def table(**columns: object) -> Summary:
    """Of two designs at two pressures, not in order."""
    given = Summary(
        (SECOND, FIRST, FIRST, SECOND), np.array([0.2, 0.3, 0.2, 0.3]), np.array([60.0, 90, 70, 80]),
        np.array([2.0, 3, 4, 5]), np.array([5.0, 5, 3, 9]), "angle_deg", "a table",
    )  # fmt: skip
    return replace(given, **columns)  # type: ignore[arg-type]


def test_means_are_sorted_and_scatter_by_the_pooled_sd_of_their_pressure() -> None:
    problem, warnings = prepared(table(), BASE)
    assert problem.features.value.tolist() == [70, 90, 60, 80] and problem.features.count.tolist() == [3, 5, 5, 9]
    pooled = np.sqrt([(4 * 2**2 + 2 * 4**2) / 6, (4 * 3**2 + 8 * 5**2) / 12])  # at 0.2 and 0.3 MPa
    for covariance, n in zip(problem.scatter.covariance, ((3, 5), (5, 9))):
        error = pooled / np.sqrt(n)
        assert np.sqrt(np.diag(covariance)) == pytest.approx(error)
        assert covariance[0, 1] == pytest.approx(TOGETHER * error[0] * error[1])
    assert problem.freedom == 12  # at the pressure that has most
    assert warnings[0].startswith("a table of means: no direction, rate or cycle") and len(warnings) == 2
    assert warnings[1] == f"means of one design are taken to scatter together (correlation {TOGETHER:g})"


@pytest.mark.parametrize(
    ("given", "against", "words"),
    [
        (table(design=("x",) * 4), BASE, "none of the designs is simulated: x"),
        (table(quantity="flex_V"), BASE, "none of the designs is simulated"),
        (table(pressure_MPa=np.full(4, 0.9)), BASE, "no measured pressure lies where there is a simulated curve"),
        (table(n=np.ones(4)), BASE, "means of one sample each: what scatters is not known"),
    ],
)
def test_means_that_cannot_be_compared_are_refused(given: Summary, against: Base, words: str) -> None:
    with pytest.raises(InputError, match=words) as refused:
        prepared(given, against)
    assert "a table" in str(refused.value)


def test_means_without_a_simulation_are_left_out_and_told() -> None:
    problem, warnings = prepared(table(), without(SECOND))
    assert problem.scene.names == (FIRST,) and f"{SECOND} is not simulated: left out" in warnings
