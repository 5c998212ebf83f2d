"""The screen of a run: what it says, and that it fits."""

import math
import re

import pytest
from rich.cells import cell_len

from benchlab.cli.run_screen import Screen, drawn_lines, up_by
from benchlab.devices.interface import Reading, Status
from benchlab.io.protocol_file import read_protocol
from benchlab.runner.stop import QUIT, Stop
from benchlab.runner.tick import Tick


def tick(index: int = 175, angle_deg: float = 88.94, pressure_MPa: float = 0.2512, late_s: float = 0.0004) -> Tick:
    reading = Reading(pressure_MPa, 1.0, 2000, 1.0, Status.ARMED)
    return Tick(index, index / 100, late_s, 0.2661, reading, 1, angle_deg)


@pytest.fixture
def screen() -> Screen:
    return Screen(read_protocol("linear_ramp"), Stop(), keys=True)


def shown(screen: Screen, which: Tick, title: str = "Linear ramp on twin", width: int = 80) -> list[str]:
    return [re.sub(r"\x1b\[[0-9;]*m", "", line) for line in drawn_lines(screen, which, title, width)]


def test_it_says_where_in_the_plan_and_what_was_measured(screen: Screen) -> None:
    screen.on_tick(tick(late_s=0.0021))
    screen.on_tick(tick())
    bar, place, values, keys = shown(screen, tick())
    assert bar.startswith("Linear ramp on twin ━") and 0.3 < bar.count("━") / (bar.count("━") + bar.count("─")) < 0.4
    assert place.startswith("1.8 of ") and ", ramp 0 to 0.35 MPa in 2.5 s" in place
    assert values == "set 0.266 MPa, measured 0.251 MPa, 88.9°, at most 2.1 ms late"
    assert keys == "p pauses, q stops"


def test_what_the_bench_has_not_is_not_shown(screen: Screen) -> None:
    assert screen.values(tick(angle_deg=math.nan, pressure_MPa=math.nan)) == "set 0.266 MPa"
    one = tick()
    one.reference_deg = 90.0
    assert "88.9° of 90.0°" in screen.values(one)


def test_its_last_line_says_what_can_be_done(screen: Screen) -> None:
    screen.stop.toggle_pause()
    assert "PAUSED" in screen.hint() and "p goes on" in screen.hint()
    screen.stop.ask(QUIT)
    assert screen.hint() == "stopping"
    assert Screen(screen.plan, Stop(), keys=False).hint() == "Ctrl-C stops"
    assert Screen(screen.plan, Stop(pausable=False), keys=True).hint() == "q stops"


@pytest.mark.parametrize("width", [20, 40, 80, 300])
@pytest.mark.parametrize("title", ["short", "软体执行器的压力协议" * 6, "long " * 40])
def test_no_line_is_wider_than_the_terminal(screen: Screen, width: int, title: str) -> None:
    lines = shown(screen, tick(), title, width)
    assert len(lines) == 4 and all(cell_len(line) < width for line in lines)


def test_it_is_drawn_over_itself() -> None:
    assert up_by(0) == "\r\x1b[J" and up_by(4) == "\r\x1b[4A\x1b[J"


def test_in_virtual_time_it_says_how_long_it_still_computes_and_in_real_time_not(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    now = [100.0]
    monkeypatch.setattr("benchlab.cli.run_screen.time.monotonic", lambda: now[0])
    for pausable, words in ((False, "(about 6 s left)"), (True, "")):
        screen = Screen(read_protocol("linear_ramp"), Stop(pausable=pausable), keys=True)
        screen.on_tick(tick(0))
        now[0] += 0.5
        assert "left" not in screen.place(tick(83))  # too early to say
        now[0] += 0.7
        assert words in screen.place(tick(83)) and bool(words) == ("left" in screen.place(tick(83)))


def test_after_the_vent_it_says_that_it_watches(screen: Screen) -> None:
    screen.stop.close()
    assert screen.hint() == "vented; watched until it is empty, Ctrl-C ends that"
