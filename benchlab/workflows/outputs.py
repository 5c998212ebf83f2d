"""Where the results of one recording go, whether they are already there, and who may replace them."""

from __future__ import annotations

import contextlib
import json
import os
import platform
import tempfile
from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass, replace
from hashlib import sha256 as new_sha256
from pathlib import Path
from typing import Any, Self

import benchlab
from benchlab.errors import BenchlabError, UsageError
from benchlab.io.drive_file import SCHEMA as DRIVE
from benchlab.io.files import cannot_write, check_regular_file, make_folder, sha256
from benchlab.io.nexus import schema_of
from benchlab.io.run_file import read_provenance
from benchlab.workflows.provenance import made_by


@dataclass(frozen=True)
class Outputs:
    """`<stem>.h5`, `.csv`, `.png` and, if asked for, `.overlay.mp4` in one folder.

    of_png: the recording is itself a PNG picture, so that the figure is `<stem>.figure.png`.
    """

    folder: Path
    stem: str
    overwrite: bool = False
    of_png: bool = False

    @classmethod
    def of(cls, source: Path, out: Path | None, overwrite: bool = False) -> Outputs:
        """Beside the recording, or in `out`."""
        path = source.resolve()
        stem = path.name if path.is_dir() else path.stem
        return cls(out or path.parent, stem, overwrite, of_png=path.suffix.lower() == ".png")

    @property
    def run_file(self) -> Path:
        return self.folder / f"{self.stem}.h5"

    @property
    def table(self) -> Path:
        return self.folder / f"{self.stem}.csv"

    @property
    def figure(self) -> Path:
        return self.folder / f"{self.stem}{'.figure' * self.of_png}.png"

    @property
    def overlay(self) -> Path:
        return self.folder / f"{self.stem}.overlay.mp4"

    def paths(self, overlay: bool) -> list[Path]:
        return [self.run_file, self.table, self.figure] + ([self.overlay] if overlay else [])

    def check(self, overlay: bool, inputs: Iterable[Path]) -> None:
        """The folder exists (made if only its last part is missing) and may be written; nothing of others is in the way.

        Results of an earlier benchlab run may be replaced; anything else only with `overwrite`; inputs and drive files never.
        Raises UsageError.
        """
        make_folder(self.folder)
        ours = {} if self.overwrite else self._written_before()
        read = {path.resolve() for path in inputs}
        for path in self.paths(overlay):
            if path.resolve() in read:
                raise UsageError(
                    "is read by this analysis and would be replaced", file=path, hint="choose another --out"
                )
            if path.is_dir():
                raise UsageError("is a folder, and a result goes there", file=path, hint="choose another --out")
            if _is_drive_file(path):
                raise UsageError(
                    "is the record of a run on a bench, which no analysis replaces",
                    file=path,
                    hint="choose another --out",
                )
            if (
                path.exists()
                and not self.overwrite
                and (told := ours.get(path.relative_to(self.folder).as_posix())) != "any"
                and told != sha256(path)
            ):
                raise UsageError(
                    "exists, and no run file beside it says that benchlab wrote it so",
                    file=path,
                    hint="choose another --out, or replace it with --overwrite",
                )

    def _written_before(self) -> dict[str, str]:
        """Names of the files of an earlier run, as from its folder, with their SHA-256; the run file itself needs none."""
        provenance = read_provenance(self.run_file)
        return {} if provenance is None else {self.run_file.name: "any", **provenance.get("outputs_sha256", {})}

    def current(self, source: Path, settings: dict[str, Any]) -> dict[str, Any] | None:
        """The summary of an earlier, complete run with the same content, settings and version, if it is all there."""
        provenance = None if self.overwrite else read_provenance(self.run_file)
        if (
            provenance is None
            or provenance.get("partial")
            or provenance.get("key") != _key(content_hash(source), settings)
        ):
            return None
        for name, digest in provenance["outputs_sha256"].items():
            path = self.folder / name
            if not path.is_file() or sha256(path) != digest:
                return None
        return {**provenance["summary"], "status": "current"}

    @contextmanager
    def staged(self) -> Iterator[Self]:
        """The same files in a hidden folder beside their place; they are moved there together when the block ends well.

        Raises InputError where the disk refuses; then nothing in the folder has changed.
        """
        try:
            with tempfile.TemporaryDirectory(dir=self.folder, prefix=f".{self.stem[:40]}-") as hidden:
                stage = replace(self, folder=Path(hidden))
                before = self._written_before()
                yield stage
                made = {p.relative_to(hidden).as_posix(): p for p in Path(hidden).rglob("*") if p.is_file()}
                for name, path in sorted(made.items(), key=lambda item: item[1] == stage.run_file):
                    (self.folder / name).parent.mkdir(exist_ok=True)
                    path.replace(self.folder / name)
                # A result of the run before that this one did not make would tell another story.
                for name in before.keys() - made.keys():
                    stale = self.folder / name
                    if stale.is_file() and sha256(stale) == before[name]:
                        stale.unlink()
        except OSError as error:
            raise cannot_write(error, self.folder) from error

    @contextmanager
    def locked(self) -> Iterator[None]:
        """Only one benchlab at a time writes these results. Raises UsageError naming the process that does."""
        lock = self.folder / f".{self.stem}.lock"
        for attempt in (1, 2):
            try:
                handle = os.open(lock, os.O_CREAT | os.O_EXCL | os.O_WRONLY)
                break
            except FileExistsError:
                holder = _holder(lock)
                if holder and attempt == 1 and not _alive(holder):
                    with contextlib.suppress(FileNotFoundError):
                        lock.unlink()
                    continue
                raise UsageError(
                    f"is being written by another benchlab ({holder or 'just started'})",
                    file=self.run_file,
                    hint=f"wait for it, or remove {lock.name} if that process is gone",
                ) from None
        os.write(handle, f"process {os.getpid()} on {platform.node()}".encode())
        os.close(handle)
        try:
            yield
        finally:
            with contextlib.suppress(FileNotFoundError):
                lock.unlink()


def _is_drive_file(path: Path) -> bool:
    try:
        return path.is_file() and schema_of(path) == DRIVE.name
    except BenchlabError:
        return False


def _holder(lock: Path) -> str:
    try:
        return lock.read_text()
    except OSError:
        return ""


def _alive(holder: str) -> bool:
    """Whether the process named in a lock still runs; one on another computer is taken to."""
    words = holder.split()
    if len(words) != 4 or words[3] != platform.node():
        return True
    try:
        os.kill(int(words[1]), 0)
    except (ProcessLookupError, ValueError):
        return False
    except OSError:
        return True
    return True


def content_hash(source: Path) -> str:
    """SHA-256 of a recording: of the file, or of the names and bytes in a folder."""
    if not source.is_dir():
        check_regular_file(source)
        return sha256(source)
    digest = new_sha256()
    for path in sorted(p for p in source.iterdir() if p.is_file() and not p.name.startswith(".")):
        digest.update(f"{path.name}\0{sha256(path)}\0".encode())
    return digest.hexdigest()


def _key(content: str, settings: dict[str, Any]) -> str:
    """One number for content, settings and version; files named in the settings enter by their content, not their place."""
    inputs = {name: sha256(Path(settings[name])) for name in ("lens", "pressure") if settings.get(name)}
    whole = json.dumps([content, {**settings, **inputs}, benchlab.__version__], sort_keys=True)
    return new_sha256(whole.encode()).hexdigest()


def provenance(source: Path, settings: dict[str, Any]) -> dict[str, Any]:
    """Who made a result, from what and how: enough to make it again."""
    content = content_hash(source)
    return {
        **made_by("numpy", "av", "cv2", "h5py"),
        "source": str(source),
        "sha256": content,
        "key": _key(content, settings),
    }


def refuse_same_names(outputs: list[Outputs]) -> None:
    """Raises UsageError where two recordings would write the same files."""
    seen: dict[Path, Outputs] = {}
    for item in outputs:
        if item.run_file in seen:
            raise UsageError(
                f"two inputs would both be written as {item.run_file.name}",
                file=item.folder,
                hint="analyse them into different --out folders",
            )
        seen[item.run_file] = item
