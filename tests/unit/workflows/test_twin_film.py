"""The film of a twin: its times, its clock, its scale, and the angle that the tracker finds in it."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import av
import numpy as np
import pytest

from benchlab.errors import InputError
from benchlab.io.twin_file import read_twin
from benchlab.twin.effects.catalogue import EFFECTS
from benchlab.twin.settings import Camera
from benchlab.twin.truth import COLUMNS, Truth
from benchlab.workflows import twin_film
from benchlab.workflows.twin_film import frame_times_s, write_twin_film

SMALL = replace(read_twin(None), camera=Camera(frames_per_s=10, width_px=640, height_px=360, markers=7))
TIMES = np.arange(0, 2.001, 0.01)


def truth(*triggers_s: float) -> Truth:
    columns = {name: np.zeros(len(TIMES)) for name in COLUMNS}
    return Truth(**{**columns, "time_s": TIMES + 5, "camera_deg": 50 * TIMES}, triggers_s=triggers_s)


def test_it_begins_at_the_trigger_or_with_the_run() -> None:
    assert frame_times_s(truth(), SMALL) == pytest.approx(5 + np.arange(21) / 10)
    assert frame_times_s(truth(5.37, 6.0), SMALL) == pytest.approx(5.37 + np.arange(17) / 10)
    assert frame_times_s(truth(5.37), SMALL, start_s=6.5) == pytest.approx(6.5 + np.arange(6) / 10)
    with pytest.raises(InputError, match="cannot start at 9 s"):
        frame_times_s(truth(), SMALL, start_s=9.0)


@pytest.mark.parametrize(("ahead_s", "factor"), [(0.0, 1.0), (0.3, 1.1)])
def test_what_is_drawn(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, ahead_s: float, factor: float) -> None:
    drawn = []
    draw = twin_film.write_drawn_film
    monkeypatch.setattr(twin_film, "write_drawn_film", lambda *args: (drawn.append(args), draw(*args))[1])
    effects = {
        "clock_offset": EFFECTS["clock_offset"](ahead_s=ahead_s),
        "camera_scale": EFFECTS["camera_scale"](factor=factor),
    }
    settings = replace(SMALL, effects=effects)
    film = write_twin_film(tmp_path / "a.mp4", truth(5.5), settings)
    times = 5.5 + np.arange(16) / 10
    assert np.degrees(drawn[0][2]) == pytest.approx(50 * (times - ahead_s - 5))
    assert film.start_s == 5.5 and film.frames == 16
    assert film.scale_mm_per_px == pytest.approx(factor * 180 / twin_film.twin_scene(settings).length_px)
    with av.open(str(tmp_path / "a.mp4")) as container:
        assert container.metadata["title"] == "drawn by benchlab, not filmed: camera of a simulated bench (twin)"
        assert "simulated bench" in container.metadata["comment"] and "starts at 5.5" in container.metadata["comment"]
        assert len(list(container.decode(video=0))) == 16


def test_the_same_seed_draws_the_same_film(tmp_path: Path) -> None:
    for name, seed in (("a", 1), ("b", 1), ("c", 2)):
        write_twin_film(tmp_path / f"{name}.mp4", truth(6.8), replace(SMALL, seed=seed))

    def decoded(name: str) -> np.ndarray:
        with av.open(str(tmp_path / f"{name}.mp4")) as film:
            return np.array([frame.to_ndarray(format="gray") for frame in film.decode(video=0)])

    assert np.array_equal(decoded("a"), decoded("b")) and not np.array_equal(decoded("a"), decoded("c"))


def test_a_run_without_a_tick_is_no_film(tmp_path: Path) -> None:
    nothing = Truth(*(np.empty(0) for _ in COLUMNS))
    with pytest.raises(InputError, match="no tick"):
        write_twin_film(tmp_path / "a.mp4", nothing, SMALL)
    assert not list(tmp_path.iterdir())
