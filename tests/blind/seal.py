"""The answers of the scoring card, sealed: their hashes are on file before anything is scored.

`python -m tests.blind.seal` writes sealed.json beside this file: a hash of every case with its answer, and one of them all.
"""

from __future__ import annotations

import hashlib
import json
import os
from collections.abc import Mapping
from concurrent.futures import ProcessPoolExecutor
from dataclasses import asdict
from pathlib import Path
from typing import Any

from tests.blind.cards import Case, cases

FILE = Path(__file__).with_name("sealed.json")


def canonical(value: Any) -> str:
    """JSON with sorted keys and no spaces: the same for the same value."""
    return json.dumps(value, sort_keys=True, separators=(",", ":"), ensure_ascii=False)


def seal_of(case: Case, answer: Mapping[str, Any]) -> str:
    """SHA-256 of a case and its answer."""
    return hashlib.sha256(canonical([asdict(case), answer]).encode()).hexdigest()


def sealed() -> dict[str, str]:
    """Hash of every case by its name, as on file. Raises ValueError where the file does not agree with itself."""
    found: dict[str, Any] = json.loads(FILE.read_text(encoding="utf-8"))
    if whole(found["cases"]) != found["sha256"]:
        raise ValueError(f"{FILE.name} was changed after it was sealed: seal it again, and score everything again")
    return dict(found["cases"])


def check_seal(case: Case, answer: Mapping[str, Any]) -> None:
    """Raises ValueError where a case of the scoring card is not the one that was sealed."""
    if sealed().get(case.name) != seal_of(case, answer):
        raise ValueError(f"{case.name} is not what was sealed: the generator has changed since; seal and score again")


def whole(seals: Mapping[str, str]) -> str:
    return hashlib.sha256(canonical(dict(seals)).encode()).hexdigest()


def _seal(case: Case) -> str:
    return seal_of(case, case.answer())


if __name__ == "__main__":
    os.environ["OPENBLAS_NUM_THREADS"] = os.environ["OMP_NUM_THREADS"] = "1"
    every = cases("score")
    with ProcessPoolExecutor(2) as pool:
        seals = dict(zip([case.name for case in every], pool.map(_seal, every, chunksize=8)))
    FILE.write_text(json.dumps({"sha256": whole(seals), "cases": seals}, indent=1) + "\n", encoding="utf-8")
    print(f"{len(seals)} answers sealed: {whole(seals)}")
