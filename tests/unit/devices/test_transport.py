"""The serial port: what it is opened by, and what is said where it cannot be."""

import contextlib
import errno
import os
import pty
import subprocess
import sys
import threading
import time
from collections.abc import Iterator
from pathlib import Path

import pytest
import serial

from benchlab.devices import transport
from benchlab.devices.interface import LostError
from benchlab.devices.transport import SerialTransport
from benchlab.errors import BenchError


@pytest.fixture
def line() -> Iterator[tuple[int, str]]:
    master, slave = pty.openpty()
    yield master, os.ttyname(slave)
    for each in (master, slave):
        with contextlib.suppress(OSError):
            os.close(each)


def test_bytes_go_both_ways(line: tuple[int, str]) -> None:
    master, name = line
    port = SerialTransport(name)
    port.write(b"hello\x00\r\n\xff")
    assert os.read(master, 100) == b"hello\x00\r\n\xff"
    os.write(master, bytes(range(256)))
    assert port.read(1.0) == bytes(range(256))
    port.close()
    port.close()


def test_reading_waits_as_long_as_it_is_told(line: tuple[int, str]) -> None:
    master, name = line
    port = SerialTransport(name)
    began = time.monotonic()
    assert port.read(0.05) == b""
    assert 0.045 < time.monotonic() - began < 20
    threading.Timer(0.02, os.write, (master, b"x")).start()
    began = time.monotonic()
    assert port.read(60) == b"x"
    assert time.monotonic() - began < 30
    assert port.read(0) == b""
    port.close()


def test_a_missing_port_lists_those_that_there_are(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(transport, "ports", lambda: ["/dev/ttyUSB7 (CH340)"])
    with pytest.raises(BenchError, match=r"/dev/nothing: no such port; ports here: /dev/ttyUSB7 \(CH340\)") as told:
        SerialTransport("/dev/nothing")
    assert told.value.exit_code == 5


@pytest.mark.parametrize("name", ["/etc/passwd", "/tmp"])
def test_what_is_no_port_is_told(name: str) -> None:
    with pytest.raises(BenchError, match="is not a serial port; ports here"):
        SerialTransport(name)


def test_a_second_program_is_refused(line: tuple[int, str]) -> None:
    """Another process, as it would be."""
    _, name = line
    port = SerialTransport(name)
    code = f"from benchlab.devices.transport import SerialTransport; SerialTransport({name!r})"
    second = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=False)
    assert "BenchError" in second.stderr and "in use by another program" in second.stderr
    port.close()
    assert subprocess.run([sys.executable, "-c", code], check=False).returncode == 0


def opened_without_a_lock(name: str) -> subprocess.CompletedProcess[str]:
    """By a program that asks for no lock, as `cat` or an upload does; not as root, who is let in."""
    nobody = {"user": 65534} if os.getuid() == 0 else {}
    words = ["sh", "-c", f"exec 3<>{name}"]
    return subprocess.run(
        words, capture_output=True, text=True, check=False, env={**os.environ, "LC_ALL": "C"}, **nobody
    )


def test_a_program_that_does_not_lock_cannot_open_the_port_in_mid_run(line: tuple[int, str]) -> None:
    """Opened, a Nano's port resets it."""
    _, name = line
    Path(name).chmod(0o666)
    assert opened_without_a_lock(name).returncode == 0
    port = SerialTransport(name)
    refused = opened_without_a_lock(name)
    assert refused.returncode != 0 and "busy" in refused.stderr
    port.close()
    assert opened_without_a_lock(name).returncode == 0


@pytest.mark.parametrize(
    ("error", "words"),
    [
        (serial.SerialException(errno.EACCES, "Permission denied"), "no permission; .*dialout"),
        (serial.SerialException(errno.EBUSY, "Device or resource busy"), "in use by another program"),
        (serial.SerialException("could not open port 'COM3': PermissionError(13, 'Access is denied.')"), "in use"),
        (serial.SerialException("could not open port 'COM9': FileNotFoundError(2, 'no such file')"), "no such port"),
        (serial.SerialException(errno.EIO, "Input/output error"), "cannot be opened: .*; ports here"),
    ],
)
def test_why_a_port_cannot_be_opened(error: Exception, words: str, monkeypatch: pytest.MonkeyPatch) -> None:
    def refuse(*_: object, **__: object) -> None:
        raise error

    monkeypatch.setattr(serial, "Serial", refuse)
    with pytest.raises(BenchError, match=words):
        SerialTransport("COM3")


def test_a_port_that_vanishes_is_lost(line: tuple[int, str]) -> None:
    master, name = line
    port = SerialTransport(name)
    os.close(master)
    with pytest.raises(LostError, match=r"the port is gone.*was the cable pulled"):
        port.read(0.1)
    with pytest.raises(LostError, match="the port is gone"):
        port.write(b"x")
    port.close()


def test_a_port_that_takes_nothing_is_lost(line: tuple[int, str], monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(transport, "WRITE_S", 0.05)
    port = SerialTransport(line[1])
    with pytest.raises(LostError, match=r"takes no bytes for 0.05 s"):
        port.write(bytes(200_000))
    port.close()
