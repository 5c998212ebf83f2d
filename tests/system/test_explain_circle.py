"""The whole circle on films: an effect hidden in the twin → protocol → run → drawn film → `benchlab analyze` → explained from the tables alone."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from benchlab.discrepancy.base import Base
from benchlab.discrepancy.experiment import BenchLimits
from benchlab.discrepancy.explanation import Explanation
from benchlab.discrepancy.measured import Measured
from benchlab.io.measured_table import read_measured
from benchlab.io.twin_file import read_twin
from benchlab.twin.effects.catalogue import EFFECTS
from benchlab.twin.settings import Camera
from benchlab.workflows.explain_loop import Loop, LoopSettings, explain_loop
from benchlab.workflows.explain_measured import explain_measured
from benchlab.workflows.explain_twin import TwinLab
from tests.unit.discrepancy.scenes import base

SEED, FRAMES_PER_S = 11, 6
PROTOCOL = """\
title: One cycle
limit_MPa: 0.35
segments:
  - trigger: camera
  - triangle: {low_MPa: 0, high_MPa: 0.35, rate_MPa_per_s: 0.14, cycles: 1}
  - vent: {duration_s: 1}
"""
HIDDEN = {
    "dead_pressure": ("dead_MPa", 0.03, 0.05),
    "end_caps": ("cap_mm", 15, 25),
    "regulator_lag": ("lag_s", 0.4, 0.6),
}


def circle(folder: Path, name: str, film: bool) -> Loop:
    """Two designs, three samples of each, an effect whose size is drawn."""
    protocol = folder / "cycle.yaml"
    protocol.write_text(PROTOCOL)
    parameter, low, high = HIDDEN[name]
    size = float(np.random.default_rng(SEED).uniform(low, high))
    hidden = replace(
        read_twin(None),
        effects={name: EFFECTS[name](**{parameter: size})},
        camera=Camera(frames_per_s=FRAMES_PER_S, width_px=480, height_px=360),
    )
    settings = LoopSettings(folder / "loop", samples=3, rounds=1, protocol=protocol)
    return explain_loop(settings, TwinLab(base(2), hidden, SEED, film), base(2), explained)


def explained(tables: Sequence[Path], known: Base, limits: BenchLimits) -> Explanation:
    return explain_measured(read_measured(tables), known, seed=1, limits=limits).explanation


@pytest.mark.parametrize(("name", "film"), [("dead_pressure", True), ("end_caps", False)])
def test_an_effect_hidden_in_the_twin_is_found(name: str, film: bool, tmp_path: Path) -> None:
    loop = circle(tmp_path, name, film)
    found = loop.explanation
    sets = [{effect.name for effect in found.effects}] if found.verdict == "named" else [set(s) for s in found.rivals]
    assert any(name in names for names in sets), (found.verdict, sets)
    assert found.gap.rmse_after < 0.5 * found.gap.rmse_before
    check_tables(loop.rounds[0].round.folder, film)


def test_a_lag_that_the_recorded_pressure_shows_is_no_gap(tmp_path: Path) -> None:
    """The monitor reads behind the regulator: recorded and asked for differ, the angle is that of the recorded pressure."""
    loop = circle(tmp_path, "regulator_lag", film=False)
    measured = read_measured([loop.rounds[0].round.folder / "measured.csv"])
    assert isinstance(measured, Measured)
    behind = [np.abs(np.subtract(run.command_MPa, run.pressure_MPa)) for run in measured.runs]
    assert all(np.median(off) > 0.03 for off in behind)
    assert loop.explanation.verdict == "agree" and not loop.explanation.where


def check_tables(folder: Path, film: bool) -> None:
    """They are of the camera's frames, not of the truth."""
    measured = read_measured([folder / "measured.csv"])
    assert isinstance(measured, Measured) and measured.simulated and len(measured.runs) == 6
    assert not list(folder.rglob("*.truth.csv"))
    assert len(list((folder / "seen").glob("*.h5"))) == 6 * film
    assert all(np.diff(run.time_s) == pytest.approx(1 / FRAMES_PER_S, abs=1e-3) for run in measured.runs)
