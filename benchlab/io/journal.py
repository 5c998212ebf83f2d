"""The journal of a run: an append-only file that survives whatever dies.

A line of JSON that says what is in it, then records, each under a CRC: samples of fixed size, and events of JSON. Layout: journal_format.
"""

from __future__ import annotations

import errno
import json
import os
import struct
import threading
import zlib
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from benchlab.errors import InputError, UsageError, counted
from benchlab.io.files import check_regular_file, reason_of
from benchlab.io.journal_format import (
    CRC,
    EVENT_MARK,
    HEAD,
    MAX_EVENT,
    SAMPLE_MARK,
    Loss,
    header_line,
    packed,
    read_header_line,
    records,
)
from benchlab.io.nexus import plain

SAMPLE = np.dtype(
    [
        ("tick", "<u4"),  # of the plan
        ("step", "<u4"),  # index of the plan's step
        ("time_s", "<f8"),  # of the command, since the start of the run
        ("late_s", "<f4"),  # after its deadline
        ("answer_s", "<f4"),  # from the command to its answer
        ("command_MPa", "<f8"),
        ("command_V", "<f4"),
        ("code", "<i4"),  # that the DAC holds; −1 unknown
        ("pressure_MPa", "<f8"),  # measured; NaN without a sensor
        ("flex_V", "<f8"),
        ("angle_deg", "<f8"),  # measured, by the flex sensor; NaN where it is not calibrated
        ("reference_deg", "<f8"),  # NaN in open loop
        ("device_time_s", "<f8"),
        ("status", "<u4"),
        ("monitor_V", "<f8"),  # at the regulator's monitor output; NaN where that is not wired
    ]
)
"""One tick of a run, little-endian, without padding."""

UNITS = {
    **{"tick": "", "step": "", "time_s": "s", "late_s": "s", "answer_s": "s", "command_MPa": "MPa", "command_V": "V"},
    **{"code": "", "pressure_MPa": "MPa", "flex_V": "V", "angle_deg": "deg", "reference_deg": "deg"},
    **{"device_time_s": "s", "status": "", "monitor_V": "V"},
}
"""Unit of each field of SAMPLE."""

KINDS = ("mark", "trigger", "fault", "warning", "pause", "resume", "vent", "stop")
"""Kinds of events; a stop, with its reason, is the last. Samples after a vent are of the disarmed bench, watched until it is empty."""

SYNC_S = 1.0
"""Seconds between two times that the disk is asked to have everything."""

MAX_BYTES = 1_000_000_000

_LETTERS = {"<u4": "I", "<i4": "i", "<f4": "f", "<f8": "d"}
_ROW = struct.Struct(HEAD.format + "".join(_LETTERS[SAMPLE[name].str] for name in SAMPLE.names or ()))
_DESCRIPTOR = [{"field": name, "units": UNITS[name], "dtype": SAMPLE[name].str} for name in SAMPLE.names or ()]


class JournalWriter:
    """Writes a new journal, one unbuffered write a record. A file that is there is never touched.

    header: whatever of the run is worth keeping, as JSON. The disk is asked to have everything about once a second, in a thread of
    its own. What the disk refuses, in that thread or in a write, is raised as InputError by the call in which it is found or the next.
    """

    def __init__(self, path: Path, header: dict[str, Any]) -> None:
        self.path = path
        line, self._seed = header_line({"start": plain(header), "descriptor": _DESCRIPTOR})
        flags = os.O_WRONLY | os.O_CREAT | os.O_EXCL | os.O_APPEND | getattr(os, "O_BINARY", 0)
        try:
            self._file = os.open(path, flags, 0o666)
        except FileExistsError:
            hint = "a journal is never written over: choose another name or --out"
            raise UsageError("exists", file=path, hint=hint) from None
        except OSError as error:
            hint = "choose another --out"
            raise InputError(f"a journal cannot be written here: {reason_of(error)}", file=path, hint=hint) from error
        self._number, self._size, self._closed = 0, SAMPLE.itemsize, False
        self._trouble: OSError | None = None
        self._stop = threading.Event()
        self._thread = threading.Thread(target=self._keep_synced, name="journal", daemon=True)
        try:
            _lock(self._file)
            self._write(line)
            os.fsync(self._file)
            _sync_folder(path.parent)
        except (OSError, InputError) as error:
            os.close(self._file)
            path.unlink()
            raise self._refused(error) if isinstance(error, OSError) else error from None
        self._thread.start()

    def sample(self, *values: Any) -> None:
        """Append one tick: a value for each field of SAMPLE, in its order."""
        row = _ROW.pack(SAMPLE_MARK, self._size, self._number, *values)
        self._write(row + CRC.pack(zlib.crc32(row, self._seed)))
        self._number += 1

    def event(self, kind: str, **content: Any) -> None:
        """Append an event of one of KINDS; a number in it that is not finite becomes null."""
        if kind not in KINDS:
            raise ValueError(f"{kind!r} is no kind of event: {', '.join(KINDS)}")
        body = json.dumps(plain({"kind": kind, **content}), separators=(",", ":"), allow_nan=False).encode()
        if len(body) > MAX_EVENT:
            raise ValueError(f"an event of {len(body)} bytes, more than {MAX_EVENT}")
        self._write(packed(EVENT_MARK, self._number, body, self._seed))
        self._number += 1

    def close(self) -> None:
        """Everything to the disk, and let go. May be called twice. Raises InputError for what the disk refused since the last call."""
        if self._closed:
            return
        self._closed = True
        self._stop.set()
        self._thread.join()
        try:
            os.fsync(self._file)
            self._check_there()
        except OSError as error:
            self._trouble = self._trouble or error
        finally:
            os.close(self._file)
        if self._trouble is not None:
            raise self._refused(self._trouble)

    def _write(self, record: bytes) -> None:
        if self._trouble is not None:
            trouble, self._trouble = self._trouble, None
            raise self._refused(trouble)
        try:
            written = os.write(self._file, record)
        except OSError as error:
            raise self._refused(error) from error
        if written < len(record):
            raise self._refused(OSError(errno.ENOSPC, os.strerror(errno.ENOSPC)))

    def _keep_synced(self) -> None:
        sync = getattr(os, "fdatasync", os.fsync)
        synced = 0
        while not self._stop.wait(SYNC_S):
            try:
                if synced != self._number:
                    synced = self._number
                    sync(self._file)
                self._check_there()
            except OSError as error:
                self._trouble = error

    def _check_there(self) -> None:
        """FileNotFoundError where our file is not at its place any more: removed, moved, or another in its stead."""
        here, there = os.fstat(self._file), self.path.stat()
        if here.st_nlink == 0 or (here.st_dev, here.st_ino) != (there.st_dev, there.st_ino):
            raise FileNotFoundError(errno.ENOENT, os.strerror(errno.ENOENT))

    def _refused(self, error: OSError) -> InputError:
        hint = "what was written before is kept: see `benchlab recover`"
        if error.errno == errno.ENOSPC:
            hint = f"free some space; {hint}"
        if error.errno == errno.ENOENT:
            what = "the journal is not at its place any more: it, or its folder, was removed or moved"
            return InputError(
                what, file=self.path, hint="look where it went; leave the folder alone while a run goes on"
            )
        return InputError(f"the journal could not be written: {reason_of(error)}", file=self.path, hint=hint)


@dataclass(frozen=True)
class Journal:
    """What is left of a run.

    header: as it was given to the writer. samples: (T,) of SAMPLE. events: in their order, each with its `kind` and `after_samples`, the
    number of samples before it. complete: whether a stop record is there. losses: what could not be read; nothing damaged is in the rest.
    """

    header: dict[str, Any]
    samples: NDArray[np.void]
    events: tuple[dict[str, Any], ...]
    complete: bool
    losses: tuple[Loss, ...] = ()

    @property
    def lost_bytes(self) -> int:
        return sum(loss.bytes for loss in self.losses)

    @property
    def stop(self) -> dict[str, Any] | None:
        """The stop record: reason, words, vented. None where the run ended without one."""
        return next((event for event in reversed(self.events) if event["kind"] == "stop"), None)

    @property
    def driven(self) -> NDArray[np.void]:
        """The samples of the plan: those up to its vent. The rest is of the vented bench, which was watched until it was seen empty."""
        vent = next((event for event in self.events if event["kind"] == "vent"), None)
        return self.samples if vent is None else self.samples[: int(vent["after_samples"])]

    @property
    def losses_told(self) -> list[str]:
        """What was lost, in words: how much, where, and why."""
        return [_told(loss) for loss in self.losses]


def vent_told(stop: dict[str, Any]) -> str:
    """How a run left its bench, by its stop record, in words.

    >>> vent_told({"vented": True, "empty": True}), vent_told({"vented": True, "empty": None}), vent_told({"vented": False})
    ('vented and seen empty', 'vented, as the device says', 'NOT CONFIRMED VENTED')
    """
    if not stop.get("vented"):
        return "NOT CONFIRMED VENTED"
    if stop.get("empty") is False:
        return "NOT EMPTY AFTER ITS VENT"
    return "vented and seen empty" if stop.get("empty") is True else "vented, as the device says"


def read_journal(path: Path) -> Journal:
    """All whole records of a journal, also of one that is cut, damaged, or still being written.

    A record whose checksum does not fit is left out, and reading goes on at the next whole one. Raises UsageError for a missing file and
    InputError for one that is no journal, has a damaged first line, is of a newer benchlab, or is larger than 1 GB.
    """
    if (size := check_regular_file(path).st_size) > MAX_BYTES:
        raise InputError(f"{size / 1e6:.0f} MB, more than the limit of {MAX_BYTES / 1e6:.0f} MB", file=path)
    try:
        data = path.read_bytes()
    except OSError as error:
        raise InputError(f"could not be read: {reason_of(error)}", file=path) from error
    header, seed, start = read_header_line(path, data)
    if header.get("descriptor") != _DESCRIPTOR or not isinstance(header.get("start"), dict):
        raise InputError("its samples have other fields than this benchlab knows", file=path, hint="update benchlab")
    rows, events, losses = bytearray(), [], []
    for item in records(data, start, seed):
        if isinstance(item, Loss):
            losses.append(item)
        elif item.mark == EVENT_MARK:
            events.append({**json.loads(item.content), "after_samples": len(rows) // SAMPLE.itemsize})
        elif len(item.content) == SAMPLE.itemsize:
            rows += item.content
        else:
            losses.append(Loss(item.end - len(item.content), len(item.content), 1, "a sample of another size"))
    complete = any(event["kind"] == "stop" for event in events)
    return Journal(header["start"], np.frombuffer(bytes(rows), SAMPLE), tuple(events), complete, tuple(losses))


def still_written(path: Path) -> bool:
    """Whether a JournalWriter, here or in another process, has this journal open."""
    try:
        import fcntl
    except ImportError:
        return False
    with path.open("rb") as file:
        try:
            fcntl.flock(file, fcntl.LOCK_SH | fcntl.LOCK_NB)
        except BlockingIOError:
            return True
    return False


def _told(loss: Loss) -> str:
    """`48 records at byte 101462, of which 88 bytes are left: damaged`."""
    records = counted(loss.records or 0, "record")
    if not loss.bytes:
        return f"{records} at byte {loss.at}: missing"
    left = f"{counted(loss.bytes, 'byte')} from byte {loss.at} on: {loss.why}"
    if loss.records:
        verb = "is" if loss.bytes == 1 else "are"
        return f"{records} at byte {loss.at}, of which {counted(loss.bytes, 'byte')} {verb} left: {loss.why}"
    return left


def _lock(file: int) -> None:
    """Kept until the file is closed, if only by the process's death, for `still_written`."""
    try:
        import fcntl
    except ImportError:
        return
    with suppress(OSError):
        fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)


def _sync_folder(folder: Path) -> None:
    """So that the name of a new file is on the disk too; not every system can."""
    with suppress(OSError):
        handle = os.open(folder, os.O_RDONLY)
        try:
            os.fsync(handle)
        finally:
            os.close(handle)
