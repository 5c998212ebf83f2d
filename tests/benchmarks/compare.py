"""What `benchlab stats` and `benchlab report` reach: `python tests/benchmarks/compare.py [digits] [study]` prints tables.

digits: how many of F are right in NIST's eleven certified one-way sets. study: angles and force of the sample study against what was drawn,
and what its report takes.

benchlab reads the values as decimal text, from a table as `benchlab stats` does; scipy and statsmodels get them as floats, as any program
that reads numbers would hand them over. Digits are NIST's log relative error against 15 certified ones.
"""

from __future__ import annotations

import argparse
import csv
import platform
import subprocess
import sys
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

SAMPLE_DATA = Path(__file__).parents[2] / "sample_data"


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


def study() -> None:
    """The sample study through `benchlab report`, twice."""
    with tempfile.TemporaryDirectory() as folder:
        out = Path(folder) / "report"
        command = [sys.executable, "-m", "benchlab", "report", str(SAMPLE_DATA), "--out", str(out), "--jobs", "2"]
        took = []
        for _ in range(2):
            start = time.perf_counter()
            subprocess.run(command, check=True, capture_output=True)
            took.append(time.perf_counter() - start)
        with (out / "tables" / "values.csv").open(encoding="utf-8") as file:
            found = {Path(row["recording"]).name: float(row["angle_deg"]) for row in csv.DictReader(file)}
        page = (out / "report.html").stat().st_size
    with (SAMPLE_DATA / "truth.csv").open(encoding="utf-8") as file:
        truth = {Path(row["file"]).name: float(row["angle_deg"]) for row in csv.DictReader(file)}
    error = np.array([found[name] - angle for name, angle in truth.items()])
    print(f"\n| sample study: {len(error)} clips | |\n|---|---|")
    print(f"| angle less truth, mean | {error.mean():+.3f}° |\n| largest | {np.abs(error).max():.3f}° |")
    print(
        f"| the report, `--jobs 2` | {took[0]:.0f} s |\n| again, nothing changed | {took[1]:.0f} s |\n| the page | {page / 1e6:.2f} MB |"
    )


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("what", nargs="*", choices=[[], "digits", "study"], help="what to measure [default: all]")
    what = parser.parse_args().what or ["digits", "study"]
    if "digits" in what:
        digits_of_F()
    if "study" in what:
        study()


def digits_of_F() -> None:
    """The table of NIST's sets."""
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
