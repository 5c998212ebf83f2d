"""Small drawn actuators, and the command line run in this process."""

from __future__ import annotations

import json
from collections.abc import Callable
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from benchlab.cli.app import run
from benchlab.io.video_writer import VideoWriter
from benchlab.vision.synthetic import Scene, draw_frames
from tests.system.runs import SHORT

SMALL = Scene(width=640, height=360, markers=7, marker_radius_px=6.0, length_px=300.0, base_px=(140.0, 70.0), body_width_px=20.0,
              focal_px=900.0, noise_sd=1.0)  # fmt: skip
ANGLES_DEG = np.concatenate([np.zeros(5), np.linspace(0, 100, 35)])
FPS = 30.0


def draw_clip(
    path: Path, angles_deg: np.ndarray = ANGLES_DEG, scene: Scene = SMALL, fps: float = FPS, **changes: Any
) -> Path:
    """A small film of a known actuator; its length_px is 300 px."""
    scene = replace(scene, **changes)
    with VideoWriter(path, scene.width, scene.height, fps=fps, crf=16, preset="veryfast", full_range=scene.full_range,
                     matrix=scene.matrix) as writer:  # fmt: skip
        for planes in draw_frames(scene, np.radians(angles_deg), np.random.default_rng(5)):
            writer.write(planes)
    return path


@dataclass(frozen=True)
class Done:
    code: int
    out: str
    err: str

    @property
    def json(self) -> Any:
        return json.loads(self.out)


@pytest.fixture
def benchlab(capfd: pytest.CaptureFixture[str]) -> Callable[..., Done]:
    """`benchlab("analyze", path, ...)` runs the command line and returns exit code, standard output and standard error."""

    def call(*arguments: object) -> Done:
        capfd.readouterr()
        with pytest.raises(SystemExit) as ended:
            run([str(a) for a in arguments])
        captured = capfd.readouterr()
        code = ended.value.code
        return Done(code if isinstance(code, int) else -1, captured.out, captured.err)

    return call


@pytest.fixture(scope="session")
def drawn_clip(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """One film for all tests that only read it."""
    return draw_clip(tmp_path_factory.mktemp("films") / "trial.mp4")


@pytest.fixture
def bench(tmp_path: Path) -> Path:
    """A folder with two designs, two samples each, as tables, which are the quickest of recordings."""
    folder = tmp_path / "bench"
    folder.mkdir()
    for index, name in enumerate(("tw3_slw5_s1", "tw3_slw5_s2", "tw3_slw10_s1", "tw3_slw10_s2")):
        (folder / f"{name}.csv").write_text(f"cycle,angle_deg\n1,{50 + index}\n2,{51 + index}\n")
    return folder


@pytest.fixture
def short(tmp_path: Path) -> Path:
    """A protocol of eight seconds: up to 0.3 MPa, a hold, a vent."""
    path = tmp_path / "short.yaml"
    path.write_text(SHORT)
    return path
