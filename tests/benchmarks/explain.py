"""The score card of `benchlab explain`: studies in which an effect is hidden, explained and held against what is true.

`python tests/benchmarks/explain.py tune|calibrate|score [--jobs 2] [--cases N|NAMES…] [--baselines] [--out DIR] [--identifier MODULE:FUNCTION]`

Every answer is kept in DIR/explain-CARD.jsonl (results/ unless said otherwise) as it comes, and is not asked for again: an interrupted run goes on where it
was. The table is printed and written to DIR/explain-CARD.md. Pairs that the identifier proposes an experiment for are measured and explained a second
time. The card `score` asks for its sealed answers (tests/blind/seal.py) and stops where a case is not the one that was sealed.
One thread a process.
"""

from __future__ import annotations

import os

os.environ["OPENBLAS_NUM_THREADS"] = os.environ["OMP_NUM_THREADS"] = "1"

import argparse
import fnmatch
import functools
import importlib
import inspect
import json
import sys
import time
import traceback
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import ProcessPoolExecutor, as_completed
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT))

from tests.blind.baselines import RULES, sparse_regression  # noqa: E402
from tests.blind.cards import FIRST_SEED, Case, cases  # noqa: E402
from tests.blind.generator.solved import LENGTH_MM  # noqa: E402
from tests.blind.generator.study import Study  # noqa: E402
from tests.blind.score_card import Scored, score_card  # noqa: E402
from tests.blind.seal import check_seal  # noqa: E402

IDENTIFIER = "benchlab.workflows.explain:explain_frame"
CELLS = ROOT / "results" / "explain-cells"
Explain = Callable[..., dict[str, Any]]


def main(arguments: Sequence[str] | None = None) -> None:
    asked = _parser().parse_args(arguments)
    wanted = _wanted(cases(asked.card), asked.cases)
    asked.out.mkdir(parents=True, exist_ok=True)
    kept = asked.out / f"explain-{asked.card}.jsonl"
    done = {record["case"]: record for record in read_records(kept)}
    todo = [
        case for case in wanted if case.name not in done or (asked.baselines and "baselines" not in done[case.name])
    ]
    print(f"{len(wanted)} cases, {len(wanted) - len(todo)} of them answered before", file=sys.stderr)
    with kept.open("a", encoding="utf-8") as file:
        for number, record in enumerate(_answers(todo, asked), 1):
            file.write(json.dumps(record) + "\n")
            file.flush()
            done[record["case"]] = record
            said = record["error"] or f"{record['result']['verdict']}: {_named(record['result'])}"
            print(f"{number}/{len(todo)} {record['case']}: {said} ({record['seconds']:.1f} s)", file=sys.stderr)
    report = _report(asked.card, [(case, done[case.name]) for case in wanted if case.name in done])
    (asked.out / f"explain-{asked.card}.md").write_text(report, encoding="utf-8")
    print(report)


def read_records(path: Path) -> Iterator[dict[str, Any]]:
    """What was answered before; a line that an interruption has cut is left out."""
    if path.exists():
        for line in path.read_text(encoding="utf-8").splitlines():
            try:
                yield json.loads(line)
            except json.JSONDecodeError:
                continue


def answer_case(case: Case, card: str, identifier: str, baselines: bool) -> dict[str, Any]:
    """The study drawn, explained, and explained again after the proposed experiment where it is a pair."""
    explain = _explainer(identifier)
    study = case.study()
    if card == "score":
        check_seal(case, study.answer)
    record: dict[str, Any] = {"case": case.name, "answer": study.answer, "result": None, "error": None, "seconds": 0.0}
    begun = time.perf_counter()
    try:
        more = {"every_fit": True} if baselines else {}
        result = explain(study.frame, study.designs, seed=case.seed, **more, **_proposed(case, identifier))
        record["seconds"] = round(time.perf_counter() - begun, 3)
        every_fit = result.pop("every_fit", None)
        record["result"] = result
        if case.kind == "pair" and (result.get("next_experiment") or {}).get("protocol"):
            record |= _second(study, result["next_experiment"], explain, case.seed)
        if baselines:
            record["baselines"] = {name: rule(every_fit) for name, rule in RULES.items()} if every_fit else {}
            record["baselines"]["sparse regression"] = sparse_regression(study.frame, study.designs)
    except Exception:
        record["seconds"] = round(time.perf_counter() - begun, 3)
        record["error"] = traceback.format_exc(limit=-4)
    return json.loads(json.dumps(record, default=_plain))


def _second(study: Study, proposed: dict[str, Any], explain: Explain, seed: int) -> dict[str, Any]:
    """The proposed experiment run on the same truth, its tables put under the first, and all of it explained.

    proposed: `protocol`, and where it asks for them `mountings_deg` (one run each, null: as before) and `length_ratio` (of the actuators made
    for it to those there are).
    """
    ratio = proposed.get("length_ratio") or 1.0
    length_mm = None if ratio == 1 else ratio * LENGTH_MM
    try:
        runs = [
            study.measure(proposed["protocol"], orientation_deg=mounting, length_mm=length_mm)
            for mounting in proposed.get("mountings_deg") or [None]
        ]
    except Exception as error:
        return {"second": None, "second_error": f"{type(error).__name__}: {error}"}
    both = pd.concat([study.frame, *(frame for frame, _ in runs)], ignore_index=True)
    made = pd.concat([study.designs, *(designs for _, designs in runs)], ignore_index=True).drop_duplicates("design")
    begun = time.perf_counter()
    second = explain(both, made, seed=seed)
    return {"second": second, "second_seconds": round(time.perf_counter() - begun, 3)}


def _answers(todo: Sequence[Case], asked: argparse.Namespace) -> Iterator[dict[str, Any]]:
    given = (asked.card, asked.identifier, asked.baselines)
    if asked.jobs == 1:
        yield from (answer_case(case, *given) for case in todo)
        return
    with ProcessPoolExecutor(asked.jobs) as pool:
        for future in as_completed([pool.submit(answer_case, case, *given) for case in todo]):
            yield future.result()


def _report(card: str, answered: Sequence[tuple[Case, dict[str, Any]]]) -> str:
    good = [(case, record) for case, record in answered if record["result"] is not None]
    failed = [(case, record) for case, record in answered if record["result"] is None]
    every = [
        Scored(case, r["answer"], r["result"], r["seconds"], r.get("second"), r.get("baselines")) for case, r in good
    ]
    lines = [f"## Card `{card}`: {len(good)} cases answered, {len(failed)} with an error\n"]
    lines += [f"- `{case.name}`: {record['error'].strip().splitlines()[-1]}" for case, record in failed]
    return "\n".join([*lines, "", score_card(every) if every else "nothing to score"])


def _wanted(every: Sequence[Case], asked: Sequence[str]) -> list[Case]:
    """In an order that mixes the kinds, so that any beginning is a fair sample. asked: how many, or patterns of names."""
    mixed = [every[i] for i in np.random.default_rng(len(every)).permutation(len(every))]
    if not asked:
        return mixed
    if len(asked) == 1 and asked[0].isdigit():
        return mixed[: int(asked[0])]
    return [case for case in mixed if any(fnmatch.fnmatch(case.name, pattern) for pattern in asked)]


def _proposed(case: Case, identifier: str) -> dict[str, bool]:
    """An experiment is proposed for pairs alone, where it is run: for the others it would only take time."""
    return {"propose": case.kind == "pair"} if identifier == IDENTIFIER else {}


def _explainer(identifier: str) -> Explain:
    """The function by its name; one that keeps solved cells in a folder keeps them in results/ from case to case."""
    module, _, function = identifier.partition(":")
    explain = getattr(importlib.import_module(module), function)
    return functools.partial(explain, cache=CELLS) if "cache" in inspect.signature(explain).parameters else explain


def _named(result: dict[str, Any]) -> str:
    sets = [[effect["name"] for effect in result["effects"]], *(result.get("rivals") or [])]
    return " | ".join(" + ".join(one) if isinstance(one, list) else str(one) for one in sets if one) or "–"


def _plain(value: Any) -> Any:
    """Numbers and arrays of numpy, and paths, as JSON has them."""
    if isinstance(value, np.ndarray):
        return value.tolist()
    if isinstance(value, np.generic):
        return value.item()
    return str(value)


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("card", choices=list(FIRST_SEED))
    parser.add_argument("--jobs", type=int, default=2)
    parser.add_argument("--cases", nargs="*", default=[], help="how many, or names (* is anything)")
    parser.add_argument("--baselines", action="store_true")
    parser.add_argument("--out", type=Path, default=ROOT / "results")
    parser.add_argument("--identifier", default=IDENTIFIER)
    return parser


if __name__ == "__main__":
    main()
