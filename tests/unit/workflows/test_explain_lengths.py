"""Designs of one cell share their curves, whatever their length and name."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from benchlab.actuator import ShellDesign
from benchlab.io.layup_file import read_layup
from benchlab.workflows.explain_base import base_pressures, beam_base

LONG = ShellDesign(strip_width_mm=10, window_width_mm=3)
SHORT = replace(LONG, length_mm=60.0)


def curves(designs: dict[str, ShellDesign], cache: Path | None) -> dict[str, dict[str, np.ndarray]]:
    base = beam_base(
        designs, read_layup("from-measured-angles"), base_pressures(0.35), forces=True, knobs=(), cache=cache
    )
    assert {name: one.shape for name, one in base.designs.items()} == designs
    return {name: dict(one.curves) for name, one in base.designs.items()}


def test_a_length_is_as_if_simulated_and_kept_once(tmp_path: Path) -> None:
    alone = curves({"short": SHORT}, None)["short"]
    both = curves({"long": LONG, "short": SHORT}, tmp_path)
    assert len(list(tmp_path.iterdir())) == 1
    again = curves({"other": SHORT}, tmp_path)["other"]
    for quantity in ("angle_deg", "volume_mL", "force_N"):
        assert both["short"][quantity] == pytest.approx(alone[quantity], rel=1e-9)
        assert again[quantity] == pytest.approx(alone[quantity], rel=1e-9)
    assert both["short"]["angle_deg"][-1] == pytest.approx(both["long"]["angle_deg"][-1] / 3)
    assert both["short"]["force_N"][-1] == pytest.approx(both["long"]["force_N"][-1])
