"""The numbers against NIST's certified ones, read as the command reads them: from a table of decimal text."""

from pathlib import Path

import numpy as np
import pytest

from benchlab.io.group_table import read_group_table
from benchlab.stats.anova import one_way
from benchlab.stats.groups import groups_of
from benchlab.stats.measurements import measurements_of
from tests.benchmarks.nist import SETS, correct_digits, read_set

NEEDED = 13.0


@pytest.mark.parametrize("name", SETS)
def test_certified_digits(name: str, tmp_path: Path) -> None:
    nist = read_set(name)
    path = tmp_path / f"{name}.csv"
    path.write_text("treatment,response\n" + "".join(f"{g},{v}\n" for g, v in zip(nist.groups, nist.values)))
    table = read_group_table(path, "response", ["treatment"])
    found = one_way(groups_of(measurements_of(table.groups, table.values)))
    assert found.F is not None and found.eta_squared is not None
    for value, certified in (
        (found.F, nist.F),
        (found.ss_between, nist.ss_between),
        (found.ss_within, nist.ss_within),
        (found.eta_squared, nist.r_squared),
        (found.ms_within**0.5, nist.residual_sd),
    ):
        assert correct_digits(value, certified) >= NEEDED


def test_floats_lose_what_text_keeps() -> None:
    """The files with 13 constant digits, as floats: their differences are gone before anything is computed, and it is said so."""
    nist = read_set("SmLs07")
    floats = measurements_of(nist.groups, [float(v) for v in nist.values])
    assert "give the values as text" in floats.warnings[0]
    texts = measurements_of(nist.groups, nist.values)
    assert "only 3 digits" in texts.warnings[0] and "nothing is lost here" in texts.warnings[0]
    assert measurements_of(nist.groups, [v[-3:] for v in nist.values]).warnings == ()
    assert np.ptp(texts.deviations) == 0.4
