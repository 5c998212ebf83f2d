"""`benchlab run` on a terminal: what is drawn, which keys there are, and that the terminal is left as it was."""

from __future__ import annotations

import json
import os
import select
import subprocess
import sys
import termios
import time
from collections.abc import Callable
from pathlib import Path

from benchlab.io.journal import Journal, read_journal
from tests.system.patience import LATE, LONG_S, PATIENT, wait_until

PROTOCOL = """\
title: A long hold
limit_MPa: 0.35
segments:
  - ramp: {to_MPa: 0.2, duration_s: 0.5}
  - hold: {duration_s: 120}
"""


class Terminal:
    """A run with its input and its progress on a pty."""

    def __init__(self, folder: Path, *options: str) -> None:
        (folder / "long.yaml").write_text(PROTOCOL)
        self.ours, self.theirs = os.openpty()
        termios.tcsetwinsize(self.theirs, (24, 90))
        self.before = termios.tcgetattr(self.theirs)
        run = [*PATIENT, "run", folder / "long.yaml", "--out", folder, "--name", "a", "--json", *LATE]
        self.journal = folder / "a.journal"
        env = {**os.environ, "TERM": "xterm"}
        script = (
            "import os, sys, fcntl, termios; fcntl.ioctl(0, termios.TIOCSCTTY, 0); os.execv(sys.argv[1], sys.argv[1:])"
        )
        self.process = subprocess.Popen(
            [sys.executable, "-c", script, *map(str, run), *options],
            stdin=self.theirs,
            stdout=subprocess.PIPE,
            stderr=self.theirs,
            text=True,
            env=env,
            start_new_session=True,
        )
        self.seen = ""

    def until(self, words: str) -> None:
        end = time.monotonic() + LONG_S
        while words not in self.seen:
            assert time.monotonic() < end, self.seen[-2000:]
            if select.select([self.ours], [], [], 0.1)[0]:
                self.seen += os.read(self.ours, 65536).decode()

    def until_journal(self, so: Callable[[Journal], bool]) -> None:
        wait_until(lambda: so(read_journal(self.journal)), lambda: self.process.poll() is None)

    def press(self, key: str) -> None:
        os.write(self.ours, key.encode())

    def ended(self) -> dict:
        out, _ = self.process.communicate(timeout=LONG_S)
        return json.loads(out)


def test_keys_pause_resume_and_stop_and_the_terminal_is_left_as_it_was(tmp_path: Path) -> None:
    terminal = Terminal(tmp_path)
    terminal.until("p pauses, q stops")
    terminal.until("hold 0.2 MPa for 120 s")
    terminal.until("A long hold on twin ━")
    for words in ("of 120.5 s", "set 0.2", "measured 0.", "at most "):
        assert words in terminal.seen
    terminal.press("p")
    terminal.until("PAUSED, holding: p goes on, q stops")
    terminal.press("p")
    terminal.until_journal(lambda journal: journal.events[-1]["kind"] == "resume")
    terminal.press("q")
    found = terminal.ended()
    assert (found["reason"], found["vented"], terminal.process.returncode) == ("quit", True, 130)
    assert [e["kind"] for e in read_journal(tmp_path / "a.journal").events] == ["pause", "resume", "vent", "stop"]
    assert termios.tcgetattr(terminal.theirs) == terminal.before
    terminal.until("wrote")


def test_ctrl_c_on_the_terminal_stops(tmp_path: Path) -> None:
    terminal = Terminal(tmp_path)
    terminal.until("hold 0.2 MPa for 120 s")
    terminal.press("\x03")
    assert terminal.ended()["reason"] == "interrupted" and terminal.process.returncode == 130
    assert termios.tcgetattr(terminal.theirs) == terminal.before


def test_a_terminal_that_nobody_reads_holds_up_nothing(tmp_path: Path) -> None:
    terminal = Terminal(tmp_path)
    terminal.until("hold 0.2 MPa for 120 s")
    ticks = len(read_journal(tmp_path / "a.journal").samples)
    termios.tcflow(terminal.theirs, termios.TCOOFF)  # as Ctrl-S does
    terminal.until_journal(lambda journal: len(journal.samples) >= ticks + 80)
    termios.tcflow(terminal.theirs, termios.TCOON)
    terminal.press("q")
    assert terminal.ended()["reason"] == "quit"


def test_quiet_draws_nothing_and_takes_no_keys(tmp_path: Path) -> None:
    terminal = Terminal(tmp_path, "--quiet", "--fast")
    found = terminal.ended()
    terminal.until("wrote")
    assert found["reason"] == "completed" and "━" not in terminal.seen
