"""Small protocols, and runs of them."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from benchlab.runner.stop import Stop
from benchlab.workflows import run as run_workflow
from benchlab.workflows import run_prepare
from benchlab.workflows.run import Driven
from benchlab.workflows.run_prepare import RunSettings

SHORT = """\
title: Short
limit_MPa: 0.35
segments:
  - trigger: camera
  - ramp: {to_MPa: 0.3, duration_s: 1}
  - mark: top
  - hold: {duration_s: 3}
  - vent: {duration_s: 4}
"""


LOOP = """\
title: Loop
limit_MPa: 0.35
control: {kp_MPa_per_deg: 0.0005, ki_MPa_per_deg_s: 0.01}
segments:
  - vent: {duration_s: 0.5}
  - curvature: {hold: {angle_deg: 60, duration_s: 4}}
"""


def left(folder: Path) -> list[str]:
    return sorted(path.name for path in folder.iterdir()) if folder.exists() else []


def driven(folder: Path, protocol: str, **settings: Any) -> Driven:
    """A run up to its journal `a.journal`, without the files that are made of it."""
    prepared = run_prepare.prepare(protocol, RunSettings(out=folder, name="a", fast=True, **settings))
    return run_workflow.drive(prepared, Stop())
