"""report.json: every number of the page, and JSON that any reader accepts."""

import json

import numpy as np

from benchlab.report.study.numbers import report_numbers
from tests.unit.report import studies


def test_the_numbers_are_plain_json_and_those_of_the_values() -> None:
    report = studies.report(studies.paper_study())
    found = json.loads(json.dumps(report_numbers(report), allow_nan=False))
    assert [one["name"] for one in found["designs"]] == [design.name for design in report.values.designs]
    for one, design in zip(found["designs"], report.values.designs):
        assert one["mean_deg"] == design.angles_deg.mean() and one["n"] == 5 and one["cycles"] == 15
        assert [sample["angle_deg"] for sample in one["samples"]] == design.angles_deg.tolist()
        assert len(one["curve"]["mean_deg"]) == len(found["curve_pressure_MPa"]) == 36
    assert found["scatter"]["df"] == 20 and round(found["scatter"]["limit_deg"], 1) == 8.3
    sets = {one["name"]: one for one in found["sets"]}
    assert sets["all"]["anova"]["df"] == [4, 20] and round(sets["all"]["anova"]["F"], 2) == 529.46
    assert set(sets["slw"]) >= {"anova", "welch", "tukey", "games_howell", "groups", "components", "warnings"}
    assert found["published"][2]["anova"]["df"] == [4, 20]
    assert found["verdict"][0].startswith("Strip width, tw 3 mm. The designs differ")


def test_what_is_missing_is_null_with_a_reason() -> None:
    lost = studies.values((studies.design("a", 50, 1, samples=1, cycles=1),), curve_MPa=np.linspace(0, 0.35, 36))
    found = json.loads(json.dumps(report_numbers(studies.report(lost)), allow_nan=False))
    (design,) = found["designs"]
    assert design["sd_deg"] is None and design["simulated_deg"] is None and set(design["curve"]["sd_deg"]) == {None}
    assert "two designs" in found["sets"][0]["reason"]


def test_failures_name_their_place() -> None:
    found = report_numbers(studies.report(studies.doubtful_study()))
    (failure,) = found["failures"]
    assert failure["what"] == "tw3_slw5 s6, videos/cut.mp4" and failure["why"] == "truncated: index missing"
    assert (failure["design"], failure["sample"], failure["recording"]) == ("tw3_slw5", "s6", "videos/cut.mp4")
    warning = {"what": "tw3_slw10 s2, videos/b.mp4", "why": "3 of 126 frames not measured"}
    assert warning in found["warnings"] and failure["cycle"] is None
