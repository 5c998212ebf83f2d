"""What all result files of benchlab have in common: NXroot and NXentry, a schema with its version, texts of JSON, NXdata groups."""

from __future__ import annotations

import json
import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction
from pathlib import Path
from typing import Any

import h5py
import numpy as np

from benchlab.errors import BenchlabError, InputError
from benchlab.io.files import written_whole
from benchlab.io.hdf5 import Reader, add_texts, open_hdf5


@dataclass(frozen=True)
class Schema:
    """A kind of file: the root's attributes schema and schema_version, and its name in words."""

    name: str
    version: int
    kind: str

    def check(self, reader: Reader) -> None:
        """Raises InputError for a file of another kind, or from a newer benchlab."""
        if reader.attribute("schema") != self.name:
            raise InputError(
                f"not a {self.kind}", file=reader.path, hint=f"its root has no attribute schema = {self.name}"
            )
        version = int(reader.attribute("schema_version", 0))
        if version > self.version:
            what = f"made by a newer benchlab (schema {version}, this one reads {self.version})"
            raise InputError(what, file=reader.path, hint="update benchlab")
        if version < 1:
            raise InputError(f"schema version {version} was never in use", file=reader.path, hint="make the file again")


def write_nexus(
    path: Path,
    schema: Schema,
    default: str,
    documents: Mapping[str, Any],
    fill: Callable[[h5py.Group], None],
    partial: bool = False,
) -> None:
    """Write a result file whole or not at all: /entry with `documents` as JSON texts and what `fill` puts into it.

    default: name of the NXdata group that viewers draw. Raises InputError where the disk refuses.
    """
    # Made in memory, so that a full disk cannot leave HDF5 with work undone.
    with h5py.File(path, "w", driver="core", backing_store=False, libver=("v110", "v110")) as file:
        file.attrs.update({"NX_class": "NXroot", "default": "entry", "creator": "benchlab"})
        file.attrs.update({"schema": schema.name, "schema_version": schema.version, "partial": partial})
        entry = file.create_group("entry")
        entry.attrs.update({"NX_class": "NXentry", "default": default})
        for name, content in documents.items():
            add_texts(entry, name, json.dumps(plain(content), allow_nan=False), f"{name} (JSON)")
        fill(entry)
        file.flush()
        image = bytes(file.id.get_file_image())
    with written_whole(path) as temporary:
        temporary.write_bytes(image)


def plain(value: object) -> object:
    """The same in JSON's own types; a number that is not finite is null, as JSON has none.

    >>> plain({"a": np.array([1.0, np.nan]), "b": (np.int64(2),)})
    {'a': [1.0, None], 'b': [2]}
    """
    if isinstance(value, Mapping):
        return {str(key): plain(item) for key, item in value.items()}
    if isinstance(value, list | tuple):
        return [plain(item) for item in value]
    if isinstance(value, np.generic | np.ndarray):
        return plain(value.tolist())
    if isinstance(value, Path | Fraction):
        return str(value)
    return None if isinstance(value, float) and not math.isfinite(value) else value


def nxdata(entry: h5py.Group, name: str, signal: str, axes: Sequence[str], title: str) -> h5py.Group:
    """A new NXdata group."""
    group = entry.create_group(name)
    group.attrs.update({"NX_class": "NXdata", "signal": signal, "axes": list(axes)})
    add_texts(group, "title", title, "title")
    return group


def read_document(reader: Reader, name: str, schema: Schema, form: type = dict) -> Any:
    """A JSON text of /entry. InputError where it is not a `form`."""
    (text,) = reader.texts(f"/entry/{name}")
    content = json.loads(text)
    if not isinstance(content, form):
        raise InputError(f"dataset /entry/{name} is not what a {schema.kind} holds", file=reader.path)
    return content


def schema_of(path: Path) -> str:
    """What the root of an HDF5 file says that it is, "" where it says nothing. Raises as `open_hdf5`."""
    with open_hdf5(path) as reader:
        return str(reader.attribute("schema", ""))


def read_provenance_of(path: Path, schema: Schema) -> dict[str, Any] | None:
    """The provenance of a file of this schema, read alone and quickly; its key `partial` tells one that was not finished.

    None where there is no such file, or none of this schema, or an unreadable one.
    """
    try:
        with open_hdf5(path, schema.kind) as reader:
            schema.check(reader)
            return {**read_document(reader, "provenance", schema), "partial": bool(reader.file.attrs["partial"])}
    except BenchlabError:
        return None
