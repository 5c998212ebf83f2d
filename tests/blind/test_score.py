"""What answers are worth, and the card made of them: by answers whose worth is plain."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from tests.benchmarks.explain import main, read_records
from tests.blind import seal
from tests.blind.baselines import iid_bic, leave_one_out, lowest_rmse, sparse_regression
from tests.blind.cards import Case, cases
from tests.blind.generator.setting import Layout
from tests.blind.generator.study import study
from tests.blind.judge import coverages, outcome, set_returned, sets_named
from tests.blind.score_card import Scored, score_card, wilson


def answered(verdict: str, *named: str, rivals: tuple[tuple[str, ...], ...] = (), **parameters: Any) -> dict[str, Any]:
    effects = [{"name": name, "parameters": parameters, "share_explained": 0.9} for name in named]
    return {"verdict": verdict, "effects": effects, "rivals": [list(r) for r in rivals], "gap": {}}


SINGLE = Case("s", 1, "single", ("friction",), (4.0,))
TWO = Case("t", 1, "two", ("friction", "gravity"), (4.0, 4.0))
PAIR = Case("p", 1, "pair", ("friction",), (4.0,), rival="softening", separated_by="protocol")


@pytest.mark.parametrize(
    ("case", "result", "expected"),
    [
        (SINGLE, answered("named", "friction"), "unique"),
        (SINGLE, answered("ambiguous", "gravity", rivals=(("friction",),)), "in set"),
        (SINGLE, answered("ambiguous", "friction", rivals=(("friction",),)), "unique"),
        (SINGLE, answered("named", "gravity"), "wrong"),
        (SINGLE, answered("named", "friction", "gravity"), "with others"),
        (SINGLE, answered("unexplained", "gravity"), "unexplained"),
        (SINGLE, answered("agree"), "agree"),
        (TWO, answered("named", "gravity", "friction"), "unique"),
        (TWO, answered("named", "gravity"), "part"),
        (TWO, answered("named", "gravity", "friction", "leakage"), "with others"),
        (Case("n", 1, "null"), answered("named", "gravity"), "named"),
        (Case("u", 1, "unknown", ("ratchet",), (4.0,)), answered("unexplained"), "unexplained"),
    ],
)
def test_outcomes(case: Case, result: dict[str, Any], expected: str) -> None:
    assert outcome(case, result) == expected


def test_a_set_is_returned_where_both_of_a_pair_are_in_it() -> None:
    both = answered("ambiguous", "softening", rivals=(("friction",), ("leakage",)))
    assert set_returned(PAIR, both) and not set_returned(PAIR, answered("named", "friction"))
    assert sets_named(both) == [frozenset({"softening"}), frozenset({"friction"}), frozenset({"leakage"})]


def test_an_interval_covers_in_whatever_unit_it_is_written() -> None:
    case = Case("o", 1, "single", ("pressure_offset",), (4.0,))
    truth = {"effects": [{"name": "pressure_offset", "same_form": True, "parameters": {"offset_MPa": 0.012}}]}
    within = answered("named", "pressure_offset", b={"value": 11, "low": 10, "high": 13, "unit": "kPa"})
    beside = answered("named", "pressure_offset", b={"value": 0.01, "low": 0.009, "high": 0.0115, "unit": "MPa"})
    assert [c.covered for c in coverages(case, truth, within)] == [True]
    assert [c.covered for c in coverages(case, truth, beside)] == [False]
    assert coverages(case, truth, answered("named", "gravity")) == []


def test_the_interval_of_a_share_is_wilsons() -> None:
    """15 of 148, and 0 of 20: Newcombe (1998), table I: 0.0624 to 0.1605, and 0 to 0.1611 (without continuity correction)."""
    assert wilson(15, 148) == pytest.approx((0.0624, 0.1605), abs=5e-5)
    assert wilson(0, 20) == pytest.approx((0.0, 0.1611), abs=5e-5)


def test_the_card_counts_what_was_answered() -> None:
    truth: dict[str, Any] = {"effects": []}
    nulls = [Case(f"n{i}", i, "null") for i in range(4)]
    every = [Scored(case, truth, answered("agree"), 1.0) for case in nulls[:3]]
    every.append(Scored(nulls[3], truth, answered("named", "friction"), 3.0))
    every.append(Scored(SINGLE, truth, answered("named", "friction"), 1.0))
    both = answered("ambiguous", "friction", rivals=(("softening",),))
    every.append(Scored(PAIR, truth, both, 1.0, second=answered("named", "friction")))
    card = score_card(every)
    assert "| null studies falsely named | ≤ 5 %, upper bound ≤ 9 % | 25.0 % (1/4; 5–70) |" in card
    assert "| right, unique or in set, at 4× | ≥ 98 % | 100.0 % (1/1; 21–100) |" in card
    assert "| pairs separable by a protocol: right alone after it | ≥ 80 % | 100.0 % (1/1; 21–100) |" in card
    assert "| wrong name (truth outside the set) | ≤ 2 % | 0.0 % (0/2; 0–66) |" in card


def test_baselines_choose_as_their_rules_say() -> None:
    rng = np.random.default_rng(0)
    measured = rng.normal(size=(6, 20))
    half = measured / 2
    fits = [
        {"effect": "", "parameters": 0, "predicted": np.zeros((6, 20)).tolist()},
        {"effect": "friction", "parameters": 1, "predicted": (0.001 * measured).tolist()},
        {"effect": "gravity", "parameters": 1, "predicted": half.tolist(), "left_out": (-half).tolist()},
    ]
    table = {"measured": measured.tolist(), "design": ["a"] * 6, "fits": fits}
    assert lowest_rmse(table) == "gravity" and iid_bic(table) == "gravity"
    assert leave_one_out(table) == ""
    assert iid_bic({**table, "fits": fits[:2]}) == ""


def test_the_sparse_regression_names_a_large_scale() -> None:
    found = study(7, ("camera_scale",), (14.0,), Layout(samples=3), [("camera_scale", "longer", True)])
    assert sparse_regression(found.frame, found.designs) in {"camera_scale", "pressure_gain"}


def test_the_sealed_answers_are_those_of_the_card() -> None:
    """All names, and of some cases the answers; tools that change an answer are told."""
    every = cases("score")
    assert list(seal.sealed()) == [case.name for case in every]
    for case in every[:1] + every[200:600:130]:
        answer = case.answer()
        seal.check_seal(case, answer)
        with pytest.raises(ValueError, match="is not what was sealed"):
            seal.check_seal(case, {**answer, "effects": [{"name": "another"}]})


def test_a_changed_file_of_seals_is_refused(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    kept = json.loads(seal.FILE.read_text(encoding="utf-8"))
    kept["cases"]["null-000"] = "0" * 64
    (tmp_path / "sealed.json").write_text(json.dumps(kept), encoding="utf-8")
    monkeypatch.setattr(seal, "FILE", tmp_path / "sealed.json")
    with pytest.raises(ValueError, match="changed after it was sealed"):
        seal.sealed()


def test_a_card_is_run_kept_and_gone_on_with(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    asked = ["tune", "--jobs", "1", "--out", str(tmp_path), "--baselines"]
    asked += ["--identifier", "tests.blind.simple_identifier:explain_frame"]
    main([*asked, "--cases", "null-000", "pair-end_caps-camera_scale-*"])
    kept = list(read_records(tmp_path / "explain-tune.jsonl"))
    assert {record["case"] for record in kept} == {"null-000", "pair-end_caps-camera_scale-0"}
    pair = next(record for record in kept if record["case"].startswith("pair"))
    assert pair["second"]["verdict"] in {"ambiguous", "agree"} and not any(record["error"] for record in kept)
    assert "| pairs: set returned | ≥ 95 % | 100.0 % (1/1; 21–100) |" in capsys.readouterr().out
    main([*asked, "--cases", "null-000"])
    assert "1 cases, 1 of them answered before" in capsys.readouterr().err
    assert len(list(read_records(tmp_path / "explain-tune.jsonl"))) == 2
