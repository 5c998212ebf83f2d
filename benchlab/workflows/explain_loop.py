"""`benchlab explain --loop`: measure, explain, run the proposed experiment, explain all of it again, until there is an answer."""

from __future__ import annotations

import json
import math
import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any

from benchlab.discrepancy.base import Base
from benchlab.discrepancy.experiment import BenchLimits, Experiment
from benchlab.discrepancy.experiments import default_experiment
from benchlab.discrepancy.explanation import Explanation, NextExperiment
from benchlab.discrepancy.trial import with_length
from benchlab.errors import InputError, UsageError
from benchlab.io.files import make_folder, written_whole
from benchlab.io.nexus import plain
from benchlab.io.twin_file import read_twin
from benchlab.workflows.explain_lab import Lab
from benchlab.workflows.explain_mount import MountedLab
from benchlab.workflows.explain_next import write_next
from benchlab.workflows.explain_round import Round, measure_round
from benchlab.workflows.explain_twin import TwinLab
from benchlab.workflows.open_bench import spec_of
from benchlab.workflows.run_prepare import RunSettings

Explainer = Callable[[Sequence[Path], Base, BenchLimits], Explanation]
"""Explains tables of runs, against the base, and proposes what this bench can do."""

RECORD = "loop.json"
"""What was done so far: settings, rounds, verdicts."""

SETTLED = {
    "agree": "simulation and measurement agree",
    "named": "one explanation is left",
    "unexplained": "no effect of the vocabulary explains the gap",
}


@dataclass(frozen=True)
class LoopSettings:
    """out: the folder; one that holds a loop already is taken up again. samples: of each design. rounds, minutes: the budget.

    protocol: a file for the first round in place of the default experiment.
    """

    out: Path
    samples: int = 5
    rounds: int = 4
    minutes: float = 60.0
    protocol: Path | None = None
    limits: BenchLimits = field(default_factory=BenchLimits)

    def check(self) -> None:
        for name, value, low, high in (
            ("samples", self.samples, 1, 100),
            ("rounds", self.rounds, 1, 20),
            ("minutes", self.minutes, 0.01, 1e5),
        ):
            if not low <= value <= high:
                raise UsageError(f"--{name} is {value:g}", hint=f"give {low:g} to {high:g}")


@dataclass(frozen=True)
class Told:
    """One round that is over: what was run, and what came out of all data so far."""

    round: Round
    explanation: Explanation


@dataclass(frozen=True)
class Loop:
    """All rounds, why it ended, and on what it was measured. settled: whether there is an answer."""

    rounds: tuple[Told, ...]
    ended: str
    settled: bool
    about: str
    origin: str

    @property
    def explanation(self) -> Explanation:
        """The last one, of all data."""
        return self.rounds[-1].explanation

    def as_json(self) -> dict[str, Any]:
        return {
            "verdict": self.explanation.verdict,
            "ended": self.ended,
            "settled": self.settled,
            "measured_on": self.about,
            "origin": self.origin,
            "rounds": [_told(one) for one in self.rounds],
        }


def lab_of(
    run: RunSettings,
    base: Base,
    ask: Callable[[str], object],
    *,
    seed: int = 1,
    film: bool = False,
    twin: Path | None = None,
) -> Lab:
    """The lab of `--bench`: a twin with the effects of its file (`twin:FILE`, or `twin`), or a bench at which somebody mounts samples.

    run: bench, calibration, guards. ask: shows a line and returns when it is done. Raises UsageError for an option that is for a twin only.
    """
    spec = spec_of(run.bench)
    if spec.kind == "twin":
        return TwinLab(base, read_twin(twin or (Path(spec.where) if spec.where else None)), seed, film)
    for option, given in (("--twin", twin is not None), ("--film", film)):
        if given:
            raise UsageError(f"{option} is for a twin, and the bench is {spec}", hint=f"leave {option} out")
    if spec.kind == "replay":
        raise UsageError("a replay makes no new run", hint="give --bench twin or serial:PORT")
    return MountedLab(run, ask)


def explain_loop(
    settings: LoopSettings,
    lab: Lab,
    base: Base,
    explainer: Explainer,
    tell: Callable[[str], None] = lambda _: None,
    clock: Callable[[], float] = time.monotonic,
) -> Loop:
    """Go round until the verdict is no longer `ambiguous`, nothing separates what is left, or the budget is spent.

    What was measured is kept whatever ends it, and the same call goes on from there: runs that are there are not made again. Raises
    UsageError and InputError for what cannot begin, BenchError from the bench, KeyboardInterrupt from whoever ends it.
    """
    settings.check()
    make_folder(settings.out)
    begun = _begin(settings, lab)
    began, designs, limits = clock(), tuple(base.designs), _within(settings.limits, base, lab)
    proposed = NextExperiment("", "", math.nan, experiment=default_experiment(limits))
    rounds: list[Told] = []
    known, runs_before = base, 0
    for number in range(1, settings.rounds + 1):
        one = _round(settings, number, proposed)
        ratio = one.experiment.length_ratio
        measure_round(one, lab, base, designs, settings.samples, tell, runs_before)
        known = known if ratio == 1 else with_length(known, designs, ratio)
        runs_before += len(one.experiment.mountings_deg) * (ratio == 1)
        tell(f"round {number}: explaining")
        explanation = explainer([*(told.round.table for told in rounds), one.table], known, limits)
        rounds.append(Told(one, explanation))
        done = tuple(told.round.experiment for told in rounds)
        ended, settled = _end(explanation, done, settings, clock() - began)
        loop = Loop(tuple(rounds), ended, settled, lab.about, lab.origin)
        _write(settings.out / RECORD, {"settings": begun, "ended": ended, "rounds": [_told(told) for told in rounds]})
        if ended:
            return loop
        assert explanation.next_experiment is not None
        proposed = explanation.next_experiment
    raise AssertionError("the last round ends the loop")


def _end(
    explanation: Explanation, done: tuple[Experiment, ...], settings: LoopSettings, spent_s: float
) -> tuple[str, bool]:
    """Why there is no further round, "" where there is one; and whether that is an answer."""
    following = explanation.next_experiment
    if explanation.verdict in SETTLED:
        return SETTLED[explanation.verdict], True
    if following is None or following.experiment is None:
        why = "no experiment was proposed" if following is None else following.cannot
        return why or "no experiment was proposed", True
    if len(done) >= settings.rounds:
        return f"the budget of {settings.rounds} rounds is spent; next would be: {following.experiment.what}", False
    if spent_s > 60 * settings.minutes:
        return f"the budget of {settings.minutes:g} min is spent; next would be: {following.experiment.what}", False
    if following.experiment in done:
        return f"{following.experiment.what} was run and did not separate them: more samples would", True
    return "", False


def _round(settings: LoopSettings, number: int, proposed: NextExperiment) -> Round:
    """The round, with its protocol on disk."""
    folder = settings.out / f"round{number}"
    make_folder(folder)
    assert proposed.experiment is not None
    if number == 1 and settings.protocol is not None:
        experiment = Experiment(settings.protocol.stem, f"the protocol {settings.protocol.name}", ())
        return Round(number, folder, settings.protocol, experiment)
    return Round(number, folder, Path(write_next(folder, proposed).protocol), proposed.experiment)


def _within(limits: BenchLimits, base: Base, lab: Lab) -> BenchLimits:
    """Not beyond where the simulation ends, and what the lab can show."""
    top = min([limits.pressure_MPa, *(base.largest_pressure_MPa(name) for name in base.designs)])
    return replace(limits, pressure_MPa=top, remembers=limits.remembers and lab.remembers)


def _begin(settings: LoopSettings, lab: Lab) -> dict[str, Any]:
    """The settings, as the record has them. A folder with a loop was begun in the same way: data of two labs are not pooled."""
    protocol = None if settings.protocol is None else str(settings.protocol)
    path, now = settings.out / RECORD, {"measured_on": lab.about, "samples": settings.samples, "protocol": protocol}
    if not path.exists():
        _write(path, {"settings": now, "rounds": []})
        return now
    try:
        before = json.loads(path.read_text(encoding="utf-8"))["settings"]
    except (ValueError, KeyError, TypeError, OSError) as error:
        raise InputError(f"is no record of a loop: {error}", file=path, hint="choose another --out") from None
    for name, value in now.items():
        if before.get(name) != value:
            what = f"was begun with another {name}: {before.get(name)!r}, and now it is {value!r}"
            raise UsageError(what, file=path, hint="choose another --out, or call it as before")
    return now


def _told(one: Told) -> dict[str, Any]:
    found, following = one.explanation, one.explanation.next_experiment
    return {
        "round": one.round.number,
        "experiment": one.round.experiment.what,
        "setup": one.round.experiment.setup,
        "protocol": str(one.round.protocol),
        "data": str(one.round.table),
        "verdict": found.verdict,
        "effects": [effect.name for effect in found.effects],
        "rivals": [list(names) for names in found.rivals],
        "next": None if following is None or following.experiment is None else following.experiment.name,
        "expected_sd": None if following is None or math.isnan(following.expected_sd) else following.expected_sd,
    }


def _write(path: Path, content: dict[str, Any]) -> None:
    with written_whole(path) as temporary:
        temporary.write_text(json.dumps(plain(content), indent=1, ensure_ascii=False) + "\n", encoding="utf-8")
