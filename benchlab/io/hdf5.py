"""HDF5 files, opened so that damage, foreign content and outsize claims end in one clear refusal.

Links are followed only where they are hard links within the file; sizes are checked before memory is taken; numbers
are guarded by HDF5's own checksums and texts by a SHA-256 beside them.
"""

from __future__ import annotations

import hashlib
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import h5py
import numpy as np
from numpy.typing import NDArray

from benchlab.errors import InputError
from benchlab.io.files import check_regular_file
from benchlab.io.global_heap import global_heaps_are_sound

MAX_BYTES = 2_000_000_000
"""Bytes that may be read out of one file."""

SIGNATURE = b"\x89HDF\r\n\x1a\n"
DAMAGE = (OSError, RuntimeError, KeyError, ValueError, TypeError, UnicodeError, OverflowError)
"""What h5py raises on damaged files, as found by flipping and cutting them."""

_MAX_RATIO = 1100  # deflate reaches 1032
_CHECKSUM_HINT = "the file was damaged on disk or in copying; copy it again, or make it again"
_TEXT = h5py.string_dtype("utf-8")


def is_hdf5(path: Path) -> bool:
    """Whether a file begins as HDF5 files do. Raises as check_regular_file does."""
    check_regular_file(path)
    with path.open("rb") as file:
        return file.read(len(SIGNATURE)) == SIGNATURE


@contextmanager
def open_hdf5(path: Path, kind: str = "HDF5 file") -> Iterator[Reader]:
    """A Reader of an HDF5 file. InputError "not a <kind>" or "truncated", also for damage found in the block."""
    if not is_hdf5(path):
        raise InputError(f"not a {kind}", file=path)
    try:
        with h5py.File(path, "r", locking="best-effort") as file:
            if not global_heaps_are_sound(path):
                raise InputError(f"checksum error in the texts of a {kind}", file=path, hint=_CHECKSUM_HINT)
            yield Reader(path, file, kind)
    except DAMAGE as error:
        if "truncated" in str(error).lower():
            hint = "the writing was interrupted; copy it again, or make it again"
            raise InputError("truncated", file=path, hint=hint) from error
        raise InputError(f"damaged {kind}", file=path, hint=_CHECKSUM_HINT) from error


class Reader:
    """Reads one open file, keeping account of the bytes asked for."""

    def __init__(self, path: Path, file: h5py.File, kind: str) -> None:
        self.path, self.file, self.kind = path, file, kind
        self._size = path.stat().st_size
        self._left = MAX_BYTES

    def find(self, name: str) -> h5py.Group | h5py.Dataset | None:
        """The object at an absolute name; None if there is none. Only hard links are followed."""
        at = self.file["/"]
        for part in name.strip("/").split("/"):
            link = at.get(part, getlink=True) if isinstance(at, h5py.Group) else None
            if link is None:
                return None
            if not isinstance(link, h5py.HardLink):
                hint = "links are not followed: they may lead out of the file"
                raise InputError("is a link", file=self.path, where=name, hint=hint)
            at = at[part]
        return at

    def attribute(self, name: str, default: object = None) -> Any:
        """An attribute of the root group."""
        return self.file.attrs.get(name, default)

    def numbers(self, name: str, shape: tuple[int, ...] | None = None) -> NDArray[Any]:
        """A numeric dataset; InputError if it is missing, of another shape than `shape`, too large or damaged."""
        dataset = self._dataset(name)
        if dataset.dtype.kind not in "fiub" or (shape is not None and dataset.shape != shape):
            wanted = "numbers" if shape is None else f"numbers of shape {shape}"
            raise self._refused(f"dataset {name} is {dataset.dtype} of shape {dataset.shape}, not {wanted}")
        self._take(name, dataset, dataset.nbytes)
        try:
            return np.asarray(dataset[()])
        except DAMAGE as error:
            raise self._damaged(name, error) from error

    def texts(self, name: str, count: int | None = None) -> tuple[str, ...]:
        """A dataset of UTF-8 texts, one-dimensional with `count` of them or, for None, a single one."""
        dataset = self._dataset(name)
        shape = () if count is None else (count,)
        if h5py.check_string_dtype(dataset.dtype) is None or dataset.shape != shape:
            raise self._refused(
                f"dataset {name} is {dataset.dtype} of shape {dataset.shape}, not texts of shape {shape}"
            )
        self._take(name, dataset, dataset.nbytes)
        texts: list[str] = []
        try:
            rows = max(1, MAX_BYTES // self._size)  # any row may be nearly as long as the file
            for part in [()] if count is None else [slice(i, i + rows) for i in range(0, count, rows)]:
                read = dataset.asstr("utf-8", "strict")[part]
                texts += [read] if isinstance(read, str) else list(read)
                self._left -= sum(map(len, texts[-rows:]))
                if self._left < 0:
                    raise self._too_large(name)
            stored = dataset.attrs["sha256"]
        except DAMAGE as error:
            raise self._damaged(name, error) from error
        if stored != _text_digest(texts):
            raise self._refused(f"checksum error in dataset {name}")
        return tuple(texts)

    def _dataset(self, name: str) -> h5py.Dataset:
        try:
            dataset = self.find(name)
        except DAMAGE as error:
            raise self._damaged(name, error) from error
        if not isinstance(dataset, h5py.Dataset):
            raise self._refused(f"no dataset {name}")
        if dataset.is_virtual or dataset.external or dataset.shape is None:
            raise self._refused(f"dataset {name} does not hold its own data")
        return dataset

    def _take(self, name: str, dataset: h5py.Dataset, n_bytes: int) -> None:
        """Account for a dataset before it is read: its claim against the limit and against what the file can hold."""
        self._left -= n_bytes
        stored = min(dataset.id.get_storage_size(), self._size)
        if self._left < 0:
            raise self._too_large(name)
        if n_bytes > _MAX_RATIO * stored:
            raise self._refused(f"dataset {name} claims {n_bytes} bytes and has {stored} stored")

    def _too_large(self, name: str) -> InputError:
        return InputError(
            f"more than {MAX_BYTES / 1e9:g} GB", file=self.path, where=name, hint="larger files are not read"
        )

    def _refused(self, what: str) -> InputError:
        return InputError(
            what, file=self.path, hint=f"not a {self.kind}, or a damaged one; copy it again, or make it again"
        )

    def _damaged(self, name: str, error: Exception) -> InputError:
        if any(word in str(error).lower() for word in ("checksum", "filter returned failure")):
            return InputError(f"checksum error in dataset {name}", file=self.path, hint=_CHECKSUM_HINT)
        return InputError(f"dataset {name} is damaged", file=self.path, hint=_CHECKSUM_HINT)


def add_numbers(group: h5py.Group, name: str, values: NDArray[Any], units: str, long_name: str) -> h5py.Dataset:
    """A numeric dataset with checksum and compression, its unit and the name that a plot shows."""
    filters: dict[str, Any] = {}
    if values.size:
        rows = max(1, min(len(values), (1 << 20) // max(1, values[0].nbytes)))
        filters = {"chunks": (rows, *values.shape[1:]), "fletcher32": True, "shuffle": True, "compression": 4}
    dataset = group.create_dataset(name, data=values, **filters)
    if units:
        dataset.attrs["units"] = units
    dataset.attrs["long_name"] = long_name
    return dataset


def add_texts(group: h5py.Group, name: str, values: Sequence[str] | str, long_name: str) -> h5py.Dataset:
    """A dataset of UTF-8 texts, or a single one, with the SHA-256 that a reader checks."""
    texts = [values] if isinstance(values, str) else list(values)
    data = values if isinstance(values, str) else np.array(texts, dtype=object)
    dataset = group.create_dataset(name, data=data, dtype=_TEXT)
    dataset.attrs["sha256"] = _text_digest(texts)
    dataset.attrs["long_name"] = long_name
    return dataset


def _text_digest(texts: Sequence[str]) -> str:
    digest = hashlib.sha256()
    for text in texts:
        encoded = text.encode("utf-8", "surrogatepass")
        digest.update(len(encoded).to_bytes(8, "little") + encoded)
    return digest.hexdigest()
