"""Tables in memory explained: the answer depends on what was measured, not on how the table says it."""

from __future__ import annotations

import json
from typing import Any

import numpy as np
import pandas as pd
import pytest

from benchlab.discrepancy.base import Base, DesignBase
from benchlab.errors import InputError
from benchlab.workflows.explain import explain_frame
from benchlab.workflows.sample_explain import PLAY_DEG_PER_MPa, curve_deg, measured_rows

DESIGNS = ("narrow", "middle")
SIZES = pd.DataFrame({"design": DESIGNS, "tw_mm": 3.0, "slw_mm": [5.0, 10.0]})
PRESSURE = np.linspace(0, 0.35, 15)
BASE = Base(
    {name: DesignBase(name, PRESSURE, {"angle_deg": curve_deg(name, PRESSURE)}) for name in DESIGNS},
    "foreign",
    "closed form",
)


@pytest.fixture(scope="module")
def frame() -> pd.DataFrame:
    """Two designs, three samples, the fast run: 390 readings."""
    every = pd.DataFrame(measured_rows(1)).astype({"time_s": float, "pressure_MPa": float, "angle_deg": float})
    return every[every["design"].isin(DESIGNS) & every["sample"].isin(["s1", "s2", "s3"]) & (every["run"] == "fast")]


@pytest.fixture(scope="module")
def answer(frame: pd.DataFrame) -> dict[str, Any]:
    return explain_frame(frame, SIZES, base=BASE)


def told(answer: dict[str, Any]) -> str:
    """The answer in seven digits, without what the user must know of the table."""
    kept = {name: value for name, value in answer.items() if name != "warnings"}
    return json.dumps(json.loads(json.dumps(kept), parse_float=lambda text: f"{float(text):.6g}"), sort_keys=True)


def test_the_play_that_was_drawn_is_found(answer: dict[str, Any]) -> None:
    assert answer["verdict"] == "named" and answer["simulated"] and answer["model"] is None
    (effect,) = answer["effects"]
    width = effect["parameters"]["half_width_deg"]
    assert effect["name"] == "friction"
    assert width["low"] < PLAY_DEG_PER_MPa * 0.35 < width["high"]
    assert width["high"] - width["low"] < 0.2 * width["value"]  # a fifth: what the form of a loop may be off
    gap = answer["gap"]
    assert gap["heldout_after"] < 1.15 * gap["noise_floor"] < 0.6 * gap["heldout_before"]


def test_without_the_play_they_agree(frame: pd.DataFrame) -> None:
    rng = np.random.default_rng(3)
    gains = {key: 1 + 0.02 * rng.standard_normal() for key in frame.groupby(["design", "sample"]).groups}
    curves = np.concatenate([curve_deg(d, np.array([p])) for d, p in zip(frame["design"], frame["pressure_MPa"])])
    gain = np.array([gains[key] for key in zip(frame["design"], frame["sample"])])
    null = frame.assign(angle_deg=gain * curves + 0.2 * rng.standard_normal(len(frame)))
    found = explain_frame(null, SIZES, base=BASE)
    assert found["verdict"] == "agree" and found["effects"] == [] and found["next_experiment"] is None


def test_the_order_of_rows_says_nothing(frame: pd.DataFrame, answer: dict[str, Any]) -> None:
    mixed = frame.iloc[np.random.default_rng(1).permutation(len(frame))]
    assert told(explain_frame(mixed, SIZES, base=BASE)) == told(answer)


def test_nor_do_units(frame: pd.DataFrame, answer: dict[str, Any]) -> None:
    other = frame.rename(columns={"pressure_MPa": "pressure_kPa", "angle_deg": "angle_rad", "time_s": "time_ms"})
    other = other.assign(
        pressure_kPa=1000 * other["pressure_kPa"],
        angle_rad=np.radians(other["angle_rad"]),
        time_ms=1000 * other["time_ms"],
    )
    found = explain_frame(other, SIZES, base=BASE)
    assert found["verdict"] == answer["verdict"]
    for name, number in answer["effects"][0]["parameters"].items():
        assert found["effects"][0]["parameters"][name]["value"] == pytest.approx(number["value"], rel=1e-5)
    assert found["gap"] == pytest.approx(answer["gap"], rel=1e-5)


def test_what_a_model_has_already_is_not_named_again(frame: pd.DataFrame, answer: dict[str, Any]) -> None:
    from dataclasses import replace

    from benchlab.discrepancy.effects.catalogue import built_in
    from benchlab.discrepancy.effects.effect import Active

    (effect,) = answer["effects"]
    values = {name: number["value"] for name, number in effect["parameters"].items()}
    given = replace(BASE, given=(Active(built_in()["friction"], values, effect["form"]),))
    found = explain_frame(frame, SIZES, base=given)
    assert found["gap"]["rmse_before"] == pytest.approx(answer["gap"]["rmse_after"], rel=1e-3)
    assert "friction" not in {name for one in found["tried"] for name in one["names"]}
    assert found["verdict"] == "agree"


def test_every_fit_for_rules_of_others(frame: pd.DataFrame) -> None:
    every = explain_frame(frame, SIZES, base=BASE, every_fit=True)["every_fit"]
    measured = np.array(every["measured"])
    assert measured.shape[0] == len(every["design"]) == 6
    off = {fit["effect"]: float(np.nanmean((np.array(fit["predicted"]) - measured) ** 2)) for fit in every["fits"]}
    assert min(off, key=lambda name: off[name]) == "friction" and off["friction"] < 0.2 * off[""]
    left = {fit["effect"]: float(np.nanmean((np.array(fit["left_out"]) - measured) ** 2)) for fit in every["fits"]}
    assert left["friction"] > off["friction"] and left[""] == off[""]


@pytest.mark.parametrize(
    ("change", "words"),
    [
        (lambda f: f.assign(design="other " + f["design"]), "none of the measured designs is simulated"),
        (
            lambda f: f.assign(pressure_MPa=f["pressure_MPa"] + 0.5),
            "no measured value lies where there is a simulated curve",
        ),
        (lambda f: f.assign(angle_deg=np.nan), "no number in column angle_deg"),
        (lambda f: f.head(3), "cannot carry a verdict"),
        (lambda f: f.assign(angle_rad=np.radians(f["angle_deg"])), "two columns|angle"),
    ],
    ids=["no design", "no pressure", "nothing measured", "three readings", "mixed units"],
)
def test_no_verdict_from_data_that_cannot_carry_one(frame: pd.DataFrame, change: Any, words: str) -> None:
    with pytest.raises(InputError, match=words):
        explain_frame(change(frame), SIZES, base=BASE)


def test_one_sample_is_described(frame: pd.DataFrame) -> None:
    found = explain_frame(frame[frame["sample"] == "s1"], SIZES, base=BASE, every_fit=True)
    assert found["verdict"] == "unexplained" and not found["effects"] and not found["rivals"]
    assert found["p_gap"] is None and {region["p"] for region in found["where"]} == {None}
    assert any("one sample of each design, and fewer than three runs" in words for words in found["warnings"])
    assert "triangle:" in found["next_experiment"]["protocol"] and found["every_fit"]["fits"] == []


def test_a_column_called_like_an_effect_is_told_and_says_nothing(frame: pd.DataFrame, answer: dict[str, Any]) -> None:
    found = explain_frame(frame.assign(friction=1.0), SIZES, base=BASE)
    assert told(found) == told(answer)
    assert any("friction is called like an effect" in words for words in found["warnings"])


def test_readings_that_are_missing_are_left_out_and_told(frame: pd.DataFrame) -> None:
    some = frame.copy()
    some.iloc[::9, some.columns.get_loc("angle_deg")] = np.nan
    found = explain_frame(some, SIZES, base=BASE)
    assert found["verdict"] == "named" and found["effects"][0]["name"] == "friction"


def test_a_design_without_a_simulation_is_left_out_and_told(frame: pd.DataFrame, answer: dict[str, Any]) -> None:
    more = pd.concat([frame, frame[frame["design"] == "narrow"].assign(design="new")])
    found = explain_frame(more, SIZES, base=BASE)
    assert told(found) == told(answer)
    assert any(words.startswith("new is measured but not simulated") for words in found["warnings"])
