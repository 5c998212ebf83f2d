"""The circle of `benchlab explain`: effects hidden in the twin, drawn by seed → protocol → twin → camera → table → explained from the tables alone.

`python -m tests.benchmarks.explain_circle` prints one row a case and how many were named right; `--cases 0:5` takes some of them, `--film` draws each
run as a film and analyses it (a minute a run), `--rounds 2` also runs what is proposed. `--out FILE` writes the page of docs/benchmarks; rows that are
in it from an earlier call stay, so that the cases may be run in parts. Curves are in closed form (tests/unit/discrepancy/scenes), with `--cell` those
of the shell cell. The twin's effects share no code with those of the discrepancies: other forms, other numerics.
"""

from __future__ import annotations

import argparse
import platform
import tempfile
import time
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from datetime import date
from pathlib import Path

import numpy as np
import scipy

from benchlab.actuator import ShellDesign
from benchlab.discrepancy.base import Base
from benchlab.discrepancy.experiment import BenchLimits
from benchlab.discrepancy.explanation import Explanation
from benchlab.errors import BenchError
from benchlab.io.layup_file import read_layup
from benchlab.io.measured_table import read_measured
from benchlab.io.twin_file import read_twin
from benchlab.twin.effects.catalogue import EFFECTS
from benchlab.twin.settings import Camera, TwinSettings
from benchlab.workflows.explain_base import base_pressures, cell_base
from benchlab.workflows.explain_loop import LoopSettings, explain_loop
from benchlab.workflows.explain_measured import explain_measured
from benchlab.workflows.explain_twin import TwinLab
from tests.unit.discrepancy.scenes import base as closed_form

SHAPES = ((3, 10), (3, 5), (9, 10))
"""(tw, slw) in mm."""

DRAWN: dict[str, dict[str, tuple[float, float]]] = {
    "friction": {"half_width_deg_per_MPa": (8, 20)},
    "viscoelasticity": {"share_1": (0.08, 0.2), "time_1_s": (0.3, 3)},
    "softening": {"softer": (0.1, 0.25)},
    "end_caps": {"cap_mm": (8, 20)},
    "dead_pressure": {"dead_MPa": (0.015, 0.04)},
    "gravity": {"sag_deg": (4, 10)},
    "leakage": {"share": (0.06, 0.15)},
    "line_resistance": {"resistance_MPa_s_per_mL": (0.01, 0.04)},
    "pressure_gain": {"gain": (1.06, 1.15)},
    "pressure_offset": {"offset_MPa": (0.01, 0.03)},
    "camera_scale": {"factor": (1.06, 1.15)},
    "marker_offset": {"offset_mm": (5, 12)},
    "clock_offset": {"ahead_s": (0.15, 0.5)},
}
"""Effects that are hidden, one at a time, and between what their parameters are drawn; others keep their typical values."""

RECORDED: dict[str, dict[str, tuple[float, float]]] = {"regulator_lag": {"lag_s": (0.15, 0.5)}}
"""The same, of what is no gap: the twin's monitor reads behind the regulator, so that its lag is in the recorded pressure."""

NULLS = 2
ALWAYS = ("dac_steps", "sensor_noise")
"""Of the twin in every case: not what is looked for."""


@dataclass(frozen=True)
class Case:
    """name: of the hidden effect, "" where nothing is. missing: whether the simulation lacks it. twin: with it."""

    name: str
    missing: bool
    parameters: Mapping[str, float]
    twin: TwinSettings


def cases(seed: int) -> list[Case]:
    found = []
    for index, name in enumerate((*DRAWN, *[""] * NULLS, *RECORDED)):
        rng = np.random.default_rng([seed, index])
        drawn = {key: float(rng.uniform(*between)) for key, between in (DRAWN | RECORDED).get(name, {}).items()}
        found.append(Case(name, name in DRAWN, drawn, twin_with({name: drawn} if name else {})))
    return found


def twin_with(hidden: Mapping[str, Mapping[str, float]]) -> TwinSettings:
    shown = read_twin(None)
    on = {name: effect for name, effect in shown.effects.items() if name in ALWAYS}
    on |= {name: EFFECTS[name](**values) for name, values in hidden.items()}
    return replace(shown, effects=on, camera=Camera(frames_per_s=30, width_px=640, height_px=480))


def cell_of(cache: Path, shapes: Sequence[tuple[float, float]] = SHAPES) -> Base:
    designs = [ShellDesign(strip_width_mm=slw, window_width_mm=tw) for tw, slw in shapes]
    layup = read_layup("from-measured-angles")
    return cell_base({one.name: one for one in designs}, layup, base_pressures(0.35), forces=False, jobs=2, cache=cache)


def explained(tables: Sequence[Path], base: Base, limits: BenchLimits) -> Explanation:
    return explain_measured(read_measured(tables), base, seed=1, limits=limits).explanation


def judged(case: Case, found: Explanation) -> str:
    """right, in the set, wrong, missed, or false: a name where nothing is missing."""
    sets = [{effect.name for effect in found.effects}] if found.verdict == "named" else [set(s) for s in found.rivals]
    if not case.missing:
        return "right" if found.verdict == "agree" else "false" if sets else "missed"
    if not any(sets):
        return "missed"
    if not any(case.name in names for names in sets):
        return "wrong"
    return "right" if sets == [{case.name}] else "in the set"


def stopped(case: Case, error: BenchError, took_s: float) -> str:
    """The row of a case in which the run's own watch saw that something was wrong, and vented."""
    drawn = ", ".join(f"{name} {value:.3g}" for name, value in case.parameters.items())
    what = error.what.split(";")[0].split(", or")[0]
    return f"{case.name or 'nothing'} | {drawn} | no data | {what} | stopped | – | {took_s:.0f} |"


def told(case: Case, found: Explanation, took_s: float) -> str:
    names = " or ".join("+".join(names) for names in found.rivals) or "+".join(effect.name for effect in found.effects)
    drawn = ", ".join(f"{name} {value:.3g}" for name, value in case.parameters.items())
    gap = found.gap
    return (
        f"{case.name or 'nothing'} | {drawn} | {found.verdict} | {names} | {judged(case, found)} | {gap.rmse_before:.2f} → {gap.rmse_after:.2f} "
        f"({gap.noise_floor:.2f}) | {took_s:.0f} |"
    )


HEAD = "| case | hidden | drawn | verdict | names | | gap before → after (noise floor), ° | s |\n|---|---|---|---|---|---|---|---|"
JUDGED = 5
"""Column of the judgement, after the number of the case."""


def counted(rows: Mapping[int, str]) -> str:
    words = [row.split("|")[JUDGED - 1].strip() for row in rows.values()]
    return ", ".join(f"{words.count(word)} {word}" for word in sorted(set(words)))


def page(rows: Mapping[int, str], how: str) -> str:
    versions = f"Python {platform.python_version()}, NumPy {np.__version__}, SciPy {scipy.__version__}"
    return f"""# Effects hidden in the twin and found again, {date.today().isoformat()}

Written by `{how}`, {versions}. Everything in it is simulated. One effect is hidden in a twin whose samples scatter; a protocol is run on
it, and the tables that come out are all that the explanation sees. The protocol is the one with which every loop begins. The seconds are of the whole
way, on a machine that did other things too; they measure nothing.

`right`: that name alone, or `agree` where nothing is missing. `in the set`: among rivals that these data cannot tell apart. `missed`: no name. `wrong`:
another one. `false`: a name where nothing is missing. `stopped`: the run's own watch saw that the pressure does not follow, and vented. The lag of the regulator is in the recorded pressure, so that nothing is missing there.

{HEAD}
{chr(10).join(f"| {number} | {row}" for number, row in sorted(rows.items()))}

{len(rows)} of {len(DRAWN) + NULLS + len(RECORDED)} cases: {counted(rows)}.
"""


def written_before(path: Path) -> dict[int, str]:
    """Rows of an earlier call, by number of the case."""
    lines = path.read_text(encoding="utf-8").splitlines() if path.exists() else []
    cells = [line[2:].split(" | ", 1) for line in lines if line.startswith("| ")]
    return {int(number): row for number, row in cells if number.isdigit()}


def main() -> None:
    options = argparse.ArgumentParser(description=__doc__)
    options.add_argument("--cases", default=":")
    options.add_argument("--seed", type=int, default=7)
    options.add_argument("--samples", type=int, default=3)
    options.add_argument("--rounds", type=int, default=1)
    options.add_argument("--film", action="store_true")
    options.add_argument("--cell", action="store_true")
    options.add_argument("--out", type=Path)
    options.add_argument("--cache", type=Path, default=Path(tempfile.gettempdir()) / "benchlab-circle")
    given = options.parse_args()
    given.cache.mkdir(exist_ok=True)
    base = cell_of(given.cache) if given.cell else closed_form(len(SHAPES))
    chosen = slice(*(int(part) if part else None for part in given.cases.split(":")))
    rows = written_before(given.out) if given.out else {}
    how = f"python -m tests.benchmarks.explain_circle --seed {given.seed} --samples {given.samples} --rounds {given.rounds}"
    how += " --film" * given.film + " --cell" * given.cell
    print(HEAD, flush=True)
    for number, case in list(enumerate(cases(given.seed)))[chosen]:
        began = time.perf_counter()
        with tempfile.TemporaryDirectory() as folder:
            settings = LoopSettings(Path(folder, "loop"), samples=given.samples, rounds=given.rounds)
            try:
                loop = explain_loop(settings, TwinLab(base, case.twin, given.seed, given.film), base, explained)
            except BenchError as error:
                rows[number] = stopped(case, error, time.perf_counter() - began)
            else:
                rows[number] = told(case, loop.explanation, time.perf_counter() - began)
        print(f"| {number} | {rows[number]}", flush=True)
        if given.out:
            given.out.write_text(page(rows, how), encoding="utf-8")
    print(counted(rows))


if __name__ == "__main__":
    main()
