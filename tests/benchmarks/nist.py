"""NIST's certified one-way sets (StRD), from the files that come with scipy: https://www.itl.nist.gov/div898/strd/anova/anova.html"""

from __future__ import annotations

import math
import re
from dataclasses import dataclass
from pathlib import Path

import scipy.stats

FOLDER = Path(scipy.stats.__file__).parent / "tests" / "data" / "nist_anova"
SETS = ("SiRstv", *(f"SmLs{i:02d}" for i in range(1, 10)), "AtmWtAg")
_NUMBER = r"([0-9.]+E[+-]\d+)"


@dataclass(frozen=True)
class CertifiedSet:
    """Rows as they are written, and what NIST certifies of them (15 digits)."""

    name: str
    groups: list[str]
    values: list[str]
    F: float
    ss_between: float
    ss_within: float
    r_squared: float
    residual_sd: float


def read_set(name: str) -> CertifiedSet:
    """One set, with the values as text."""
    text = (FOLDER / f"{name}.dat").read_text()
    head, _, data = text.rpartition("\nData:")
    between = re.search(rf"Between \w+\s+\d+\s+{_NUMBER}\s+{_NUMBER}\s+{_NUMBER}", head)
    within = re.search(rf"Within \w+\s+\d+\s+{_NUMBER}", head)
    share = re.search(rf"R-Squared\s+{_NUMBER}", head)
    spread = re.search(rf"Deviation\s+{_NUMBER}", head)
    assert between and within and share and spread, name
    rows = [line.split() for line in data.splitlines()[1:] if line.strip()]
    return CertifiedSet(
        name, [row[0] for row in rows], [row[1] for row in rows], float(between[3]), float(between[1]), float(within[1]),
        float(share[1]), float(spread[1]),
    )  # fmt: skip


def correct_digits(found: float, certified: float) -> float:
    """NIST's log relative error; 15 where nothing is left to see, 0 for worse than nothing."""
    error = abs(found - certified) / abs(certified) if math.isfinite(found) else 1.0
    return 15.0 if error == 0 else min(15.0, max(0.0, -math.log10(error)))
