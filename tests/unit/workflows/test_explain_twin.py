"""Labs: what a twin measures for the loop, and how somebody at a bench is asked."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from benchlab.discrepancy.experiment import Experiment, Triangle
from benchlab.discrepancy.explanation import NextExperiment
from benchlab.errors import BenchError, InputError
from benchlab.io.drive_file import read_drive_file
from benchlab.io.twin_file import read_twin
from benchlab.runner.end import Cause
from benchlab.runner.stop import Stop
from benchlab.twin.effects.camera_scale import CameraScale
from benchlab.twin.effects.effect import Effect
from benchlab.twin.effects.end_caps import EndCaps
from benchlab.twin.effects.faults import Burst
from benchlab.twin.effects.gravity import Gravity
from benchlab.twin.settings import TwinSettings
from benchlab.workflows import explain_lab, explain_mount
from benchlab.workflows.explain_lab import Wanted
from benchlab.workflows.explain_mount import MountedLab
from benchlab.workflows.explain_next import write_next
from benchlab.workflows.explain_twin import Scatter, TwinLab, sample_curve
from benchlab.workflows.run_prepare import Prepared, RunSettings, prepare
from tests.unit.discrepancy.scenes import angle_deg, base

EXACT = Scatter(0, 0, 0, 0)
DESIGN = "tw3_slw10"


def twin(*effects: Effect) -> TwinSettings:
    return replace(read_twin(None), effects={effect.name: effect for effect in effects})


def wanted(folder: Path, **more: object) -> Wanted:
    one = Experiment("cycle", "one cycle", (Triangle(0, 0.3, 0.2),))
    protocol = Path(write_next(folder, NextExperiment("", "a from b", 1.0, experiment=one)).protocol)
    return Wanted(DESIGN, DESIGN, "s1", "r1", protocol, folder, **more)  # type: ignore[arg-type]


def test_a_twin_without_effects_and_scatter_gives_the_simulated_curve(tmp_path: Path) -> None:
    run = TwinLab(base(1), twin(), scatter=EXACT).measure(wanted(tmp_path))
    assert run.values["angle_deg"] == pytest.approx(angle_deg(run.pressure_MPa), abs=0.25)  # a tick at 0.2 MPa/s
    assert run.pressure_MPa.max() == pytest.approx(0.3, abs=0.01)
    assert run.run_index is None and run.orientation_deg == 0.0  # it hangs
    assert run.cycle is not None and set(run.cycle) == {1}


def test_hidden_effects_are_in_what_is_measured(tmp_path: Path) -> None:
    hidden = twin(EndCaps(18), CameraScale(1.25))
    run = TwinLab(base(1), hidden, scatter=EXACT).measure(wanted(tmp_path))
    assert run.values["angle_deg"] == pytest.approx(0.8 / 1.25 * angle_deg(run.pressure_MPa), abs=0.25)


def test_caps_take_more_of_a_shorter_sample_and_a_turned_one_hangs_otherwise(tmp_path: Path) -> None:
    """Half the length: half the angle, of which caps of 18 mm take 40 %. Turned by 180° the weight adds what it took."""
    short = TwinLab(base(1), twin(EndCaps(18)), scatter=EXACT).measure(wanted(tmp_path, length_ratio=0.5))
    assert short.values["angle_deg"] == pytest.approx(0.5 * 0.6 * angle_deg(short.pressure_MPa), abs=0.25)
    turned = TwinLab(base(1), twin(Gravity(2.0, 0.0)), scatter=EXACT)
    other = replace(wanted(tmp_path, mounting_deg=180.0), run="r2")
    run = turned.measure(other)
    true = angle_deg(run.pressure_MPa)
    assert run.values["angle_deg"] == pytest.approx(true + 2 * np.sin(np.radians(true / 2)), abs=0.25)
    assert run.orientation_deg == 180


def test_a_sample_is_the_same_in_each_run_and_its_noise_is_not(tmp_path: Path) -> None:
    lab = TwinLab(base(1), twin(), seed=3)
    first = wanted(tmp_path)
    again, other = replace(first, run="r2"), replace(first, sample="s2")
    curves = [lab.twin(one).curve.angle_deg for one in (first, again, other)]
    assert (curves[0] == curves[1]).all() and not (curves[0] == curves[2]).any()
    assert lab.twin(first).seed != lab.twin(again).seed
    assert (TwinLab(base(1), twin(), seed=3).twin(first).curve.angle_deg == curves[0]).all()
    assert not (TwinLab(base(1), twin(), seed=4).twin(first).curve.angle_deg == curves[0]).any()


def test_samples_scatter_as_told() -> None:
    rng, design = np.random.default_rng(5), base(1).designs[DESIGN]
    tops = [sample_curve(design, Scatter(0.03, 0, 0), rng).angle_deg[-1] for _ in range(400)]
    assert np.std(tops) / design.curves["angle_deg"][-1] == pytest.approx(0.03, rel=0.15)
    rests = [sample_curve(design, Scatter(0, 0.5, 0), rng).angle_deg[0] for _ in range(400)]
    assert np.std(rests) == pytest.approx(0.5, rel=0.15)


def test_drive_file_and_journal_lie_in_the_folder_and_no_truth(tmp_path: Path) -> None:
    TwinLab(base(1), twin()).measure(wanted(tmp_path))
    assert {path.name for path in tmp_path.iterdir()} == {
        "next_cycle.yaml",
        f"{DESIGN}_s1_r1.journal",
        f"{DESIGN}_s1_r1.h5",
    }
    assert read_drive_file(tmp_path / f"{DESIGN}_s1_r1.h5").complete


def test_a_run_that_stops_for_safety_is_an_error_that_names_it(tmp_path: Path) -> None:
    lab = TwinLab(base(1), replace(read_twin(None), effects={**read_twin(None).effects, "burst": Burst(at_s=1.0)}))
    with pytest.raises(BenchError, match=f"{DESIGN}_s1_r1"):
        lab.measure(wanted(tmp_path))
    assert (tmp_path / f"{DESIGN}_s1_r1.h5").exists()


def test_somebody_is_asked_to_mount_what_has_to_change(tmp_path: Path) -> None:
    asked: list[str] = []
    lab = MountedLab(RunSettings(bench="twin", fast=True), asked.append)
    first = wanted(tmp_path)
    turned = replace(first, run="r3", mounting_deg=90.0)
    runs = [lab.measure(one) for one in (first, replace(first, run="r2", rest_s=30.0, index=2), turned)]
    assert asked == [
        f"mount sample s1 of {DESIGN}, as before, then press Enter",
        f"leave {DESIGN} s1 vented for 30 s, then press Enter",
        f"mount sample s1 of {DESIGN}, at 90°, then press Enter",
    ]
    assert [run.run_index for run in runs] == [1.0, 2.0, 1.0]
    assert runs[1].start_s is not None and runs[0].start_s is not None and runs[1].start_s > runs[0].start_s


def test_a_bench_that_measures_no_angle_is_refused_before_anybody_is_asked(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def without_flex(protocol: str, settings: RunSettings) -> Prepared:
        prepared = prepare(protocol, settings)
        return replace(prepared, bench=replace(prepared.bench, flex=None))

    monkeypatch.setattr(explain_mount, "prepare", without_flex)
    asked: list[str] = []
    lab = MountedLab(RunSettings(bench="twin", fast=True), asked.append)
    with pytest.raises(InputError, match="flex sensor of this bench is not calibrated"):
        lab.measure(wanted(tmp_path))
    assert not asked and not list(tmp_path.glob("*.journal"))


def test_a_run_that_somebody_ends_leaves_its_files(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    class Asked(Stop):
        def __init__(self, pausable: bool = True) -> None:
            super().__init__(pausable)
            self.ask(Cause("interrupted", "interrupted from the keyboard"))

    monkeypatch.setattr(explain_lab, "Stop", Asked)
    with pytest.raises(KeyboardInterrupt):
        TwinLab(base(1), twin()).measure(wanted(tmp_path))
    assert (tmp_path / f"{DESIGN}_s1_r1.journal").exists()
