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
    kept = "; the old result is unchanged" if path.is_file() else ""
    hint = f"free some space{kept}" if error.errno == errno.ENOSPC else None
    return InputError(f"could not be written: {reason_of(error)}", file=path, hint=hint)


def check_new_file(path: Path, overwrite: bool = False) -> None:
    """Raises UsageError where a file at `path` would replace another, or has no folder to lie in; `written_whole` makes the last one."""
    check_new_folder(path.parent)
    if path.is_dir():
        raise UsageError("is a folder", file=path, hint="give the name of a file in it")
    if path.exists() and not overwrite:
        raise UsageError("exists", file=path, hint="choose another --out, or replace it with --overwrite")


def check_new_folder(folder: Path) -> None:
    """Raises UsageError where files cannot lie in `folder`, or it cannot be made: only the last part of its path may be missing."""
    if folder.exists() and not folder.is_dir():
        raise UsageError("cannot be used as output folder: it is a file", file=folder, hint="choose another --out")
    there = folder if folder.is_dir() else folder.absolute().parent
    if not there.is_dir():
        raise UsageError("no such folder", file=folder.parent, hint="make it, or choose another --out")
    if not os.access(there, os.W_OK | os.X_OK):
        raise UsageError("the output folder is read-only", file=there, hint="choose another --out")


def make_folder(folder: Path) -> None:
    """Make a folder whose last part alone is missing; one that is there may be written to. Raises UsageError as `check_new_folder`."""
    check_new_folder(folder)
    try:
        folder.mkdir(exist_ok=True)
    except OSError as error:
        what = f"cannot be used as output folder: {reason_of(error)}"
        raise UsageError(what, file=folder, hint="choose another --out") from error


@contextmanager
def written_whole(path: Path) -> Iterator[Path]:
    """A temporary name beside `path` to write to; on success it is flushed to disk and takes the place of `path`.

    The last folder of `path` is made where it is missing.
    If the block raises, nothing at `path` has changed and the temporary file is gone.
    Raises InputError where the disk refuses (full, read-only), with the reason.
    """
    try:
        path.parent.mkdir(exist_ok=True)
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
