"""Files on disk: checked before they are opened, written whole or not at all."""

from __future__ import annotations

import errno
import hashlib
import os
import stat
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path

from benchlab.errors import InputError, UsageError


def reason_of(error: OSError) -> str:
    """What the system says of an error, in a few words.

    >>> reason_of(FileNotFoundError(2, "No such file or directory"))
    'no such file or directory'
    """
    return (error.strerror or str(error)).lower()


def check_regular_file(path: Path) -> os.stat_result:
    """The file's stat, if it is one that may be opened; nothing is opened here, so a FIFO or a device cannot hang us.

    Raises UsageError for a missing path or a folder, InputError for a device, a pipe, no permission or no bytes.
    """
    try:
        found = path.stat()
    except (FileNotFoundError, NotADirectoryError):
        raise UsageError("no such file", file=path, hint="check the path; addresses and streams are not read") from None
    except OSError as error:
        raise InputError(reason_of(error), file=path) from error
    if stat.S_ISDIR(found.st_mode):
        raise UsageError("is a folder", file=path, hint="give the file itself")
    if not stat.S_ISREG(found.st_mode):
        raise InputError("not a regular file", file=path, hint="copy the recording to disk first")
    if found.st_size == 0:
        raise InputError("empty file (0 bytes)", file=path, hint="was the copy finished?")
    if not os.access(path, os.R_OK):
        raise InputError("permission denied", file=path, hint="ask its owner for read permission")
    return found


def sha256(path: Path) -> str:
    """Hexadecimal SHA-256 of a file's bytes."""
    with path.open("rb") as file:
        return hashlib.file_digest(file, "sha256").hexdigest()


def cannot_write(error: OSError, path: Path) -> InputError:
    """What the disk said, as one line about `path`."""
    hint = "free some space; the old result is unchanged" if error.errno == errno.ENOSPC else None
    return InputError(f"could not be written: {reason_of(error)}", file=path, hint=hint)


def check_new_file(path: Path, overwrite: bool = False) -> None:
    """Raises UsageError where a file at `path` would replace another, or has no folder to lie in."""
    if path.is_dir():
        raise UsageError("is a folder", file=path, hint="give the name of a file in it")
    if path.exists() and not overwrite:
        raise UsageError("exists", file=path, hint="choose another --out, or replace it with --overwrite")
    if not path.absolute().parent.is_dir():
        raise UsageError("no such folder", file=path.parent, hint="make it, or choose another --out")


@contextmanager
def written_whole(path: Path) -> Iterator[Path]:
    """A temporary name beside `path` to write to; on success it is flushed to disk and takes the place of `path`.

    If the block raises, nothing at `path` has changed and the temporary file is gone.
    Raises InputError where the disk refuses (full, read-only), with the reason.
    """
    try:
        handle, name = tempfile.mkstemp(dir=path.parent, prefix=f".{path.stem[:40]}-", suffix=path.suffix)
        os.close(handle)
    except OSError as error:
        raise InputError(f"cannot write here: {reason_of(error)}", file=path) from error
    temporary = Path(name)
    try:
        yield temporary
        with temporary.open("rb+") as file:
            os.fsync(file.fileno())
        umask = os.umask(0)
        os.umask(umask)
        temporary.chmod(0o666 & ~umask)
        temporary.replace(path)
    except OSError as error:
        raise cannot_write(error, path) from error
    finally:
        with suppress(OSError):
            temporary.unlink()
