"""The commands of README and of the guides in docs, run as they stand there, in a folder that looks like a clone."""

import re
import shlex
import subprocess
import sys
from pathlib import Path

import cv2
import numpy as np
import pytest

from benchlab.vision.synthetic import Scene
from benchlab.workflows import sample_data, sample_study
from tests.system.models import beam_model

ROOT = Path(__file__).resolve().parents[2]
README = (ROOT / "README.md").read_text(encoding="utf-8")
GUIDES = "\n".join(
    (ROOT / "docs" / f"{name}.md").read_text(encoding="utf-8")
    for name in (
        "see",
        "measure",
        "predict",
        "compare",
        "studies",
        "report",
        "firmware",
        "bench",
        "twin",
        "protocols",
        "drive",
        "runs",
        "explain",
    )
)
SHELL = "\n".join(re.findall(r"```sh\n(.*?)```", README + GUIDES, re.DOTALL))
COMMANDS = sorted(set(re.findall(r"benchlab [a-z][^&\n]*", SHELL)))
REFUSE_TO_REPLACE = (
    "bench calibrate",
    "bench firmware",
    "bench monitor",
    "calibrate",
    "cut",
    "design",
    "explain",
    "export",
    "fit-material",
    "force",
    "protocol show",
    "stats",
    "study new",
)


@pytest.fixture(scope="module")
def clone(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder with sample_data in it, with a model file, and with pictures of a chessboard held at several angles."""
    folder = tmp_path_factory.mktemp("clone")
    (folder / "benchlab").symlink_to(ROOT / "benchlab")
    _some_of_the_sample_data(folder / "sample_data")
    (folder / "lab").mkdir()
    beam_model(folder / "lab" / "model.yaml", end_caps={}, friction={})
    (folder / "board").mkdir()
    flat = np.full((760, 1060), 255, np.uint8)
    for row in range(7):
        for column in range(10):
            if (row + column) % 2:
                flat[30 + 100 * row : 130 + 100 * row, 30 + 100 * column : 130 + 100 * column] = 20
    camera = np.array([[1500.0, 0, 959.5], [0, 1500, 539.5], [0, 0, 1]])
    corners = np.array([[0, 0], [1060, 0], [1060, 760], [0, 760]], np.float32)
    plane = np.column_stack([(corners - (530, 380)) / 5, np.zeros(4)])  # mm, 20 mm squares
    for i, (x, y) in enumerate(
        [
            (0.0, 0.0),
            (0.5, 0.1),
            (-0.5, 0.2),
            (0.1, 0.5),
            (0.2, -0.5),
            (-0.4, -0.4),
            (0.4, 0.4),
            (-0.3, 0.5),
            (0.6, -0.3),
        ]
    ):
        turn, _ = cv2.Rodrigues(np.array([x, y, 0.1 * x]))
        seen = plane @ turn.T + (60 * y, 40 * x, 420)
        picture = (seen @ camera.T)[:, :2] / seen[:, 2:]
        onto = cv2.getPerspectiveTransform(corners, picture.astype(np.float32))
        seen = cv2.warpPerspective(flat, onto, (1920, 1080), borderValue=200, flags=cv2.INTER_AREA)
        cv2.imwrite(str(folder / "board" / f"{i}.png"), cv2.cvtColor(seen, cv2.COLOR_GRAY2BGR))
    return folder


def _some_of_the_sample_data(folder: Path) -> None:
    """All but the films of third to fifth samples, which take a minute."""
    (folder / "videos").mkdir(parents=True)
    for path in (ROOT / "sample_data").iterdir():
        if path.name not in ("videos", "study.yaml"):
            (folder / path.name).symlink_to(path)
    for path in (ROOT / "sample_data" / "videos").glob("*_s[12].mp4"):
        (folder / "videos" / path.name).symlink_to(path)
    study = (ROOT / "sample_data" / "study.yaml").read_text(encoding="utf-8")
    (folder / "study.yaml").write_text(re.sub(r"\n *s[345]: videos/.*", "", study), encoding="utf-8")


def test_readme_has_commands() -> None:
    assert len(re.findall(r"^benchlab [a-z]", README, re.MULTILINE)) >= 6


@pytest.mark.parametrize("command", COMMANDS)
def test_command_of_readme(command: str, clone: Path, benchlab, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(clone)
    monkeypatch.setenv("BENCHLAB_CACHE", str(clone / "kept"))
    if "sample-data" in command:  # drawn small, and elsewhere: the true ones take minutes and are in the repository
        monkeypatch.setattr(sample_data, "FRAMES", 2)
        monkeypatch.setattr(
            sample_data, "_scene", lambda *_: Scene(width=320, height=180, length_px=200.0, base_px=(40.0, 40.0))
        )
        monkeypatch.setattr(sample_study, "PRESSURES_MPA", (0.0, 0.1))
        command = command.replace("--out sample_data", "--out drawn")
    (clone / "results").mkdir(exist_ok=True)
    if "--lens" in command and not (clone / "results" / "lens.json").exists():
        (first,) = [c for c in COMMANDS if c.startswith("benchlab calibrate")]
        assert benchlab(*shlex.split(first)[1:]).code == 0
    words = shlex.split(command)[1:]
    if "--name" in words:  # a run is never replaced
        for old in (clone / "results").glob(f"{words[words.index('--name') + 1]}.*"):
            old.unlink()
    for name in re.findall(r"results/(\w+)\.(?:h5|journal)\b", command):
        _run_before(name, clone, benchlab)
    refuses = words[0] in REFUSE_TO_REPLACE or " ".join(words[:2]) in REFUSE_TO_REPLACE
    done = benchlab(*words, *(["--overwrite"] if refuses else []))
    assert done.code == 0, done.err
    assert any(word in done.err + done.out for word in ("wrote", "current", "complete", "lasts", "F("))


def test_the_python_of_the_guide_runs(clone: Path, benchlab, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(clone)
    (clone / "results").mkdir(exist_ok=True)
    (first,) = [c for c in COMMANDS if c == "benchlab analyze sample_data/videos/tw9_slw10_s1.mp4 --out results"]
    benchlab(*shlex.split(first)[1:])
    (code,) = _python_of("see")
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    assert 1.0 < float(done.stdout.split()[0]) < 2.0


def test_the_python_about_runs_runs(clone: Path, benchlab, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(clone)
    (clone / "results").mkdir(exist_ok=True)
    _run_before("ramp", clone, benchlab)
    (code,) = _python_of("runs")
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    angle, *words = done.stdout.split()
    assert 90 < float(angle) < 130 and words == ["deg", "angle_deg"]


def test_no_other_guide_has_python_that_is_not_run() -> None:
    assert len(re.findall(r"```python\n", README + GUIDES)) == 2


def _python_of(guide: str) -> list[str]:
    return re.findall(r"```python\n(.*?)```", (ROOT / "docs" / f"{guide}.md").read_text(encoding="utf-8"), re.DOTALL)


def _run_before(name: str, clone: Path, benchlab) -> None:
    """The run of this name that README or a guide makes first, unless it is there."""
    makers = [c for c in COMMANDS if c.startswith("benchlab run ") and f"--name {name} " in f"{c} "]
    if makers and not (clone / "results" / f"{name}.h5").exists():
        assert benchlab(*shlex.split(makers[0])[1:]).code == 0


def test_the_test_command_is_what_ci_runs() -> None:
    (command,) = re.findall(r"<!-- test command -->\n```sh\n(.*)\n```", README)
    assert command.endswith("-m pytest")
    script = (ROOT / ".ci" / "run").read_text()
    assert "<!-- test command -->" in script and "pytest" not in script
