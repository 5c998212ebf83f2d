"""Control files: the same again, and strict."""

import math
from pathlib import Path

import pytest

from benchlab.control.tuning import Lag, tune
from benchlab.errors import InputError
from benchlab.io.control_file import ControlFile, control_of_tuning, read_control, write_control

POINT = (
    "pressure_MPa: 0.1, gain_deg_per_MPa: -3, lag_s: 0.1, dead_time_s: 0, max_sensitivity: 1.5, crossover_rad_per_s: 2"
)
PLANTS = [Lag(500.0, 0.2, 0.05), Lag(300.0, 0.3, 0.06)]


def test_it_reads_back_the_same(tmp_path: Path) -> None:
    control = control_of_tuning(
        tune(PLANTS, 100), [0.1, 0.3], PLANTS, feed_forward=True, rate_Hz=100, source="run.h5, sha256 0"
    )
    write_control(tmp_path / "a.yaml", control, "by a test")
    found = read_control(tmp_path / "a.yaml")
    assert found.kp_MPa_per_deg == pytest.approx(control.kp_MPa_per_deg, rel=1e-5)
    assert found.points[1][2].phase_margin_deg == pytest.approx(control.points[1][2].phase_margin_deg, rel=1e-5)
    assert (found.feed_forward, found.source, found.rate_Hz) == (True, "run.h5, sha256 0", 100)
    write_control(tmp_path / "b.yaml", found)
    assert read_control(tmp_path / "b.yaml") == found


def test_gains_by_hand_are_short(tmp_path: Path) -> None:
    path = tmp_path / "hand.yaml"
    path.write_text("from: by hand\nrate_Hz: 100\ngains: {kp_MPa_per_deg: 1e-3, ki_MPa_per_deg_s: 5e-3}\n")
    found = read_control(path)
    assert found == ControlFile(1e-3, 5e-3, False, 0.0, 100, "by hand", found.closed_loop_s)
    assert math.isnan(found.closed_loop_s)


@pytest.mark.parametrize(
    ("line", "named"),
    [
        ("kp: 1", "line 4: unknown key kp"),
        ("lead_s: -1", "line 4: lead_s is -1"),
        ("lead_s: .nan", "line 4: lead_s is nan"),
        ("feed_forward: 1", "line 4: feed_forward is 1"),
        ("rate_Hz: 100", "line 4: duplicate key rate_Hz"),
        (f"plant: [{{{POINT}}}]", "gain_deg_per_MPa is -3"),
    ],
)
def test_what_is_wrong_is_told_with_its_line(tmp_path: Path, line: str, named: str) -> None:
    path = tmp_path / "a.yaml"
    path.write_text(f"from: hand\nrate_Hz: 100\ngains: {{kp_MPa_per_deg: 1e-3, ki_MPa_per_deg_s: 5e-3}}\n{line}\n")
    with pytest.raises(InputError) as refused:
        read_control(path)
    assert named in str(refused.value)
