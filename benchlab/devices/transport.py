"""Bytes to and from a device: the interface, and the serial port."""

from __future__ import annotations

import errno
import select
import sys
import time
import typing
from contextlib import suppress

import serial
from serial.tools import list_ports

from benchlab.devices.interface import LostError
from benchlab.errors import BenchError

BAUD = 500_000
"""Exact at the Nano's 16 MHz and in its USB chips, FT232 and CH340."""

WRITE_S = 0.25

BY_ITSELF = "the firmware vents by itself once it hears nothing; if it has no supply either, look at the regulator"


class Transport(typing.Protocol):
    """A line to one device, with the clock that its waiting is measured by: real, or the virtual one of an emulation."""

    name: str

    def about(self) -> dict[str, typing.Any]:
        """What is worth keeping of the line itself."""
        ...

    def clock_s(self) -> float:
        """Time now; never goes back."""
        ...

    def advance(self, time_s: float) -> None:
        """Where time is virtual: let the device run until then. Where it is real: nothing."""
        ...

    def write(self, data: bytes) -> None:
        """LostError where the line is gone."""
        ...

    def read(self, timeout_s: float) -> bytes:
        """What has arrived, or arrives first within timeout_s; b"" if nothing did. LostError where the line is gone."""
        ...

    def close(self) -> None:
        """Idempotent."""
        ...


class SerialTransport:
    """A serial port, for nobody else while it is open. BenchError where it cannot be opened, with the ports that there are.

    It is locked for programs that lock too (flock, by pyserial) and closed to those that do not (TIOCEXCL, which does not hold for root):
    opening a Nano's port resets it, in mid run too.
    """

    def __init__(self, port: str, baud: int = BAUD) -> None:
        self.name = port
        exclusive = None if sys.platform == "win32" else True  # on Windows, a port is exclusive anyway
        try:
            self._port = serial.Serial(port, baud, timeout=0, write_timeout=WRITE_S, exclusive=exclusive)
        except (OSError, ValueError) as error:
            raise _cannot_open(port, error) from error
        _exclusive(self._port, True)
        self._low_latency = False
        with suppress(AttributeError, OSError, ValueError, NotImplementedError):
            self._port.set_low_latency_mode(True)
            self._low_latency = True

    def about(self) -> dict[str, typing.Any]:
        return {"port": self.name, "baud": self._port.baudrate, "low_latency": self._low_latency}

    def clock_s(self) -> float:
        return time.monotonic()

    def advance(self, time_s: float) -> None:
        pass

    def write(self, data: bytes) -> None:
        try:
            self._port.write(data)
        except serial.SerialTimeoutException:
            raise LostError(f"takes no bytes for {WRITE_S:g} s", file=self.name) from None
        except (OSError, TypeError) as error:  # pyserial has no file any more where another thread closed it
            raise self._gone(error) from error

    def read(self, timeout_s: float) -> bytes:
        try:
            if not self._port.in_waiting:
                self._wait(timeout_s)
            return bytes(self._port.read(self._port.in_waiting))
        except (OSError, TypeError) as error:
            raise self._gone(error) from error

    def close(self) -> None:
        _exclusive(self._port, False)
        with suppress(OSError):
            self._port.close()

    def _wait(self, timeout_s: float) -> None:
        """For the first byte."""
        if sys.platform != "win32":
            select.select([self._port.fileno()], [], [], timeout_s)
            return
        until = time.monotonic() + timeout_s
        while not self._port.in_waiting and time.monotonic() < until:
            time.sleep(0.0005)

    def _gone(self, error: Exception) -> LostError:
        return LostError(
            f"the port is gone: {error}", file=self.name, hint=f"was the cable pulled, or the supply lost? {BY_ITSELF}"
        )


def _exclusive(port: serial.Serial, whether: bool) -> None:
    """Close the port to other programs, or open it again: a pty would stay closed. Where the system has it: not on Windows."""
    if sys.platform == "win32":
        return
    import fcntl
    import termios

    with suppress(OSError, serial.SerialException, TypeError):
        fcntl.ioctl(port.fileno(), termios.TIOCEXCL if whether else termios.TIOCNXCL)


def ports() -> list[str]:
    """Serial ports of this computer, with what they say they are."""
    return [f"{each.device} ({each.description})" for each in list_ports.comports()]


def _cannot_open(port: str, error: Exception) -> BenchError:
    number, said = getattr(error, "errno", None), str(error)
    there = ", ".join(ports()) or "none"
    if number == errno.ENOENT or "FileNotFoundError" in said:
        return BenchError("no such port", file=port, hint=f"ports here: {there}")
    if number == errno.EACCES:
        return BenchError(
            "no permission", file=port, hint="add yourself to the group dialout (`sudo usermod -aG dialout $USER`)"
        )
    if number in {errno.EBUSY, errno.EAGAIN} or "exclusively lock" in said or "PermissionError" in said:
        return BenchError("in use by another program", file=port, hint="close it: a serial monitor, a second benchlab")
    if number in {errno.ENOTTY, errno.EISDIR, errno.EINVAL} or "Inappropriate ioctl" in said:
        return BenchError("is not a serial port", file=port, hint=f"ports here: {there}")
    return BenchError(f"cannot be opened: {said}", file=port, hint=f"ports here: {there}")
