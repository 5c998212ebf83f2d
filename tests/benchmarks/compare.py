"""How many digits of F are right: `python tests/benchmarks/compare.py` prints a table of NIST's eleven certified one-way sets.

benchlab reads the values as decimal text, from a table as `benchlab stats` does; scipy and statsmodels get them as floats, as any program
that reads numbers would hand them over. Digits are NIST's log relative error against 15 certified ones.
"""

from __future__ import annotations

import argparse
import platform
import tempfile
import time
import warnings
from datetime import date
from pathlib import Path

import numpy as np
import scipy
import statsmodels
from nist import SETS, CertifiedSet, correct_digits, read_set
from scipy import stats
from statsmodels.stats.oneway import anova_oneway

import benchlab
from benchlab.errors import BenchlabError
from benchlab.workflows.stats import StatsColumns
from benchlab.workflows.stats import stats as run


def of_benchlab(nist: CertifiedSet, folder: Path) -> float:
    path = folder / f"{nist.name}.csv"
    path.write_text("treatment,response\n" + "".join(f"{g},{v}\n" for g, v in zip(nist.groups, nist.values)))
    try:
        return run(path, StatsColumns(("treatment",), "response")).comparison.anova.F or float("nan")
    except BenchlabError:
        return float("nan")


def rows_of(nist: CertifiedSet) -> list[np.ndarray]:
    groups, values = np.array(nist.groups), np.array(nist.values, float)
    return [values[groups == name] for name in dict.fromkeys(nist.groups)]


def of_scipy(nist: CertifiedSet) -> float:
    return float(stats.f_oneway(*rows_of(nist)).statistic)


def of_statsmodels(nist: CertifiedSet) -> float:
    return float(anova_oneway(rows_of(nist), use_var="equal").statistic)


def main() -> None:
    argparse.ArgumentParser(description=__doc__).parse_args()
    versions = f"benchlab {benchlab.__version__}, scipy {scipy.__version__}, statsmodels {statsmodels.__version__}"
    print(f"{date.today().isoformat()}, {versions}, Python {platform.python_version()}\n")
    print(
        "| set | values | certified F | benchlab | scipy.f_oneway | statsmodels anova_oneway |\n|---|---|---|---|---|---|"
    )
    least = {"benchlab": 15.0, "scipy": 15.0, "statsmodels": 15.0}
    seconds = 0.0
    with tempfile.TemporaryDirectory() as folder, warnings.catch_warnings():
        warnings.simplefilter("ignore")
        for name in SETS:
            nist = read_set(name)
            start = time.perf_counter()
            ours = of_benchlab(nist, Path(folder))
            seconds += time.perf_counter() - start
            found = dict(zip(least, (ours, of_scipy(nist), of_statsmodels(nist))))
            digits = {who: correct_digits(F, nist.F) for who, F in found.items()}
            least = {who: min(least[who], digits[who]) for who in least}
            cells = " | ".join(f"{value:.1f}" for value in digits.values())
            print(f"| {name} | {len(nist.values)} | {nist.F:.14E} | {cells} |")
    print(f"| least | | | {' | '.join(f'{value:.1f}' for value in least.values())} |")
    print(f"\nbenchlab: {seconds:.1f} s for all, each with pairs, components and power too")


if __name__ == "__main__":
    main()
