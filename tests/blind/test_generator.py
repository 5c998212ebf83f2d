"""The hidden truth is as it is said to be: of the right size and sign, the same from the same seed, and nothing where nothing is hidden."""

from __future__ import annotations

import ast
from itertools import pairwise
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import pytest

from benchlab.actuator import ShellDesign
from benchlab.io.layup_file import read_layup
from benchlab.simulation.actuator_response import actuator_response
from tests.blind.cards import Case, cases
from tests.blind.generator.bench import plain_curve
from tests.blind.generator.hidden.catalogue import HIDDEN, KNOWN, STRUCTURAL, UNKNOWN
from tests.blind.generator.hidden.gravity import Gravity
from tests.blind.generator.hidden.leakage import AIR_MPa, Leakage
from tests.blind.generator.hidden.picture import on_the_line, pinhole, seen_deg, straight_on
from tests.blind.generator.runs import cycles_of
from tests.blind.generator.setting import MOST_ROWS, Layout, Setting
from tests.blind.generator.size import clean, noise_floor, shift
from tests.blind.generator.solved import DESIGNS, FILM, GRIDS, base, family
from tests.blind.generator.study import Study, study

SMALL = Layout(samples=2)
BLIND = Path(__file__).parent


def layout_for(name: str) -> Layout:
    """One on which the effect shows."""
    return Layout(
        samples=2,
        runs=("slow", "fast", "hold", *(["blocked"] if name == "frame_compliance" else [])),
        orientations_deg=(0.0,) if name == "gravity" else (),
        session=name in {"temperature", "warm_up_drift"},
        warming=name == "temperature",
    )


def forced(name: str, strength: float = 4.0, seed: int = 5, **form: Any) -> Study:
    return study(seed, (name,), (strength,), layout_for(name), [(name, key, value) for key, value in form.items()])


def gaps(one: Study) -> dict[str, tuple[np.ndarray, np.ndarray]]:
    """(T,) command and (T, S) what the effect changes, without noise, for each run."""
    with_it, without = clean(one.setting, one.hidden), clean(one.setting, ())
    return {run.name: (run.command_MPa(run.times_s(1)), a - b) for (run, a), (_, b) in zip(with_it, without)}


def test_the_same_seed_gives_the_same_study_and_another_seed_another() -> None:
    first, again, other = (study(seed, ("friction",), (2.0,), SMALL) for seed in (3, 3, 4))
    pd.testing.assert_frame_equal(first.frame, again.frame)
    assert first.answer == again.answer
    assert not first.frame["angle_deg"].equals(other.frame["angle_deg"])


@pytest.mark.parametrize("name", HIDDEN)
def test_an_effect_has_the_size_that_was_asked_for(name: str) -> None:
    sizes = []
    for strength in (1.0, 4.0):
        found = forced(name, strength)
        quantity = HIDDEN[name].quantity
        floor = noise_floor(found.setting, found.scatter, quantity)
        assert shift(found.setting, found.hidden[0]) / floor == pytest.approx(strength, rel=0.02)
        assert found.answer["effects"][0]["strength"] == pytest.approx(strength, rel=0.02)
        sizes.append(found.hidden[0].size)
    assert 0 < sizes[0] < sizes[1]


def test_nothing_is_hidden_in_a_null_study() -> None:
    found = study(8, layout=Layout(samples=5))
    assert found.answer["effects"] == []
    angles = found.frame[found.frame["run"] == "slow"]
    misses = []
    for design, rows in angles.groupby("design"):
        made = found.designs.set_index("design").loc[design]
        curve = plain_curve(made["tw_mm"], made["slw_mm"], made["length_mm"])
        mean = rows.groupby("time_s")[["pressure_MPa", "angle_deg"]].mean()
        misses.append(mean["angle_deg"] - curve(mean["pressure_MPa"]))
    rms = float(np.sqrt(np.mean(np.concatenate(misses) ** 2)))
    assert rms < 2 * found.answer["noise_floor"]["angle_deg"]


def test_the_noise_floor_is_the_scatter_of_means_that_many_studies_show() -> None:
    """The floor is worked out from the amplitudes; here the same from readings of many samples."""
    found = study(21, layout=Layout(samples=40, runs=("slow",)))
    spread = found.frame.groupby(["design", "time_s"])["angle_deg"].var()
    drawn = float(np.sqrt(spread.mean() / 40))
    assert drawn == pytest.approx(found.answer["noise_floor"]["angle_deg"], rel=0.15)


def test_samples_scatter_as_the_published_ones() -> None:
    """The published SDs at 0.35 MPa are 1.7 to 4.0°, 2.8 on average."""
    tops = []
    for seed in range(6):
        frame = study(seed, layout=Layout(samples=8, runs=("slow",))).frame
        top = frame[frame["pressure_MPa"] > 0.33].groupby(["design", "sample"])["angle_deg"].max()
        tops.append(top.groupby("design").std().to_numpy())
    assert 1.5 < np.sqrt(np.mean(np.square(tops))) < 3.5


def test_the_solved_curves_are_those_of_the_cell() -> None:
    tw, slw = DESIGNS[1]
    cell = base(tw, slw)
    asked = cell.pressure_MPa[[2, 8]]
    found = actuator_response(ShellDesign(slw, tw), read_layup(FILM), asked, blocked=False)
    np.testing.assert_allclose(found.angle_rad / 180, cell.angle_rad_per_mm[0][[2, 8]], rtol=1e-4)


@pytest.mark.parametrize("change", GRIDS)
def test_a_changed_cell_between_two_solved_ones_is_well_interpolated(change: str) -> None:
    """Leaving one solved value out, the others give it to within half a degree (the steps are then twice as wide)."""
    for tw, slw in DESIGNS:
        cells = family(change, tw, slw)
        kept = np.arange(len(cells.values)) != len(cells.values) // 2
        fewer = type(cells)(
            cells.values[kept],
            cells.pressure_MPa,
            cells.angle_rad_per_mm[kept],
            cells.volume_mm2,
            cells.moment_Nmm,
            cells.logarithmic,
        )
        left_out = cells.angle_rad_per_mm[~kept][0]
        miss = np.degrees(fewer.at(float(cells.values[~kept][0])) - left_out) * 180
        assert np.abs(miss).max() < 0.6


def test_a_camera_clock_ahead_shows_the_past() -> None:
    """Stamped t, the angle is that of t − Δt: less than the pressure's while it rises."""
    found = forced("clock_offset", behind=False)
    ahead = found.answer["effects"][0]["parameters"]["offset_s"]
    (run, late), (_, true) = clean(found.setting, found.hidden)[0], clean(found.setting, ())[0]
    time = run.times_s(1)
    assert ahead > 0
    np.testing.assert_allclose(late[:, 0], np.interp(time - found.hidden[0].size, time, true[:, 0]), atol=1e-9)


@pytest.mark.parametrize("name", ["regulator_lag", "line_resistance", "friction"])
def test_what_comes_late_is_less_on_the_way_up_and_more_on_the_way_down(name: str) -> None:
    command, gap = gaps(forced(name))["fast"]
    rate = np.gradient(command)
    middle = (command > 0.1) & (command < 0.25)
    assert gap[middle & (rate > 0)].mean() < -0.2 < 0.2 < gap[middle & (rate < 0)].mean()


def test_a_lag_grows_with_the_rate_and_friction_does_not() -> None:
    def loop(name: str, run: str) -> float:
        command, gap = gaps(forced(name, seed=6))[run]
        rate, middle = np.gradient(command), (command > 0.1) & (command < 0.25)
        return float(gap[middle & (rate < 0)].mean() - gap[middle & (rate > 0)].mean())

    assert loop("regulator_lag", "fast") > 5 * loop("regulator_lag", "slow")
    assert loop("friction", "fast") == pytest.approx(loop("friction", "slow"), rel=0.2)


def test_creep_goes_on_in_a_hold() -> None:
    command, gap = gaps(forced("viscoelasticity", form="prony-pressure", slow=True))["hold"]
    held = np.flatnonzero(np.isclose(command, command.max()))
    assert gap[held[-1]].mean() > gap[held[5]].mean() + 0.5


def test_softening_makes_a_second_loading_bend_more_than_the_first() -> None:
    for form in ("path", "ogden-roxburgh"):
        found = forced("softening", form=form)
        run, read = next((run, read) for run, read in clean(found.setting, found.hidden) if run.name == "fast")
        command = run.command_MPa(run.times_s(1))
        cycle, rising = cycles_of(command), np.gradient(command) > 0
        at = [int(np.flatnonzero((cycle == c) & rising & (command > 0.2))[0]) for c in (1, 2)]
        first = found.setting.runs[0].name == "fast"
        assert read[at[1], 0] > read[at[0], 0] + (0.5 if first else -0.5)


def test_a_sensor_that_reads_high_has_less_inside() -> None:
    for name in ("pressure_gain", "pressure_offset"):
        command, gap = gaps(forced(name, high=True))["slow"]
        assert gap[command > 0.2].mean() < -1
    assert forced("pressure_gain", high=True).answer["effects"][0]["parameters"]["gain"] > 1


def test_a_laminar_leak_keeps_the_flow_in_equal_to_the_flow_out() -> None:
    leak = Leakage(0.1, "laminar", 100.0)
    p = np.array([0.05, 0.2, 0.3])
    supply = leak._supply(p)
    into = (supply + AIR_MPa) ** 2 - (p + AIR_MPa) ** 2
    out = 0.1 * ((p + AIR_MPa) ** 2 - AIR_MPa**2)
    np.testing.assert_allclose(into, out, rtol=1e-9)


def test_the_camera_sees_a_circle_as_it_is_and_scale_tilt_and_offset_as_geometry_has_them() -> None:
    angle = np.array([-20.0, 0.0, 30.0, 90.0, 150.0])
    np.testing.assert_allclose(seen_deg(angle, 180.0, straight_on), angle, atol=0.05)
    nearer = pinhole(1000.0, nearer_mm=1000 * (1 - 1 / 1.05))
    np.testing.assert_allclose(seen_deg(angle, 180.0, nearer), angle / 1.05, atol=0.05)
    kappa = np.radians(angle) / 180
    beside = seen_deg(angle, 180.0, straight_on, lambda a, mm: on_the_line(a, mm, aside_mm=6.0))
    np.testing.assert_allclose(beside, np.degrees(180 * kappa / (1 + 6 * kappa)), atol=0.1)
    tilted = seen_deg(np.array([10.0]), 180.0, pinhole(1e6, turned_rad=np.radians(30), about=1))
    np.testing.assert_allclose(tilted, 10 * np.cos(np.radians(30)), atol=0.1)


def test_weight_holds_back_what_hangs_and_helps_what_stands() -> None:
    """And where it is light, by the closed form of a stiff arc: the moment of the straight weight over the stiffness."""
    for orientation, sign in ((0.0, -1), (180.0, 1)):
        found = study(9, ("gravity",), (2.0,), Layout(samples=2, orientations_deg=(orientation,)))
        command, gap = gaps(found)["slow"]
        assert sign * gap[command > 0.2].mean() > 0.5
    cell, setting = base(*DESIGNS[1]), Setting.draw(Layout(designs=(1,), samples=1, orientations_deg=(90.0,)), _rng())
    at = setting.stations(1)[0][1]
    light, p = Gravity(1e-3), 0.006
    bent = light.bent(np.zeros(at.shape), np.full(at.shape, p), at)[0, 0]
    weight, stiffness = 1e-3 * 9.81e-3 / 180, cell.moment_Nmm[0][0] / cell.angle_rad_per_mm[0][0]
    assert bent == pytest.approx(-np.degrees(weight * 180**3 / 6 / stiffness), rel=0.02)


def test_rigid_ends_take_more_from_a_shorter_actuator_and_a_scale_does_not() -> None:
    def share(name: str, **form: Any) -> tuple[float, float]:
        layout = Layout(designs=(1,), samples=1, lengths_mm=(180.0, 120.0), runs=("slow",))
        found = study(2, (name,), (4.0,), layout, [(name, k, v) for k, v in form.items()])
        (_, with_it), (_, without) = clean(found.setting, found.hidden)[0], clean(found.setting, ())[0]
        top = without[:, 0].argmax()
        ratio = with_it[top] / without[top]
        return float(ratio[0]), float(ratio[1])

    long, short = share("end_caps")
    assert 1 - short == pytest.approx(1.5 * (1 - long), rel=1e-6)
    long, short = share("camera_scale", longer=True)
    assert long == pytest.approx(short, rel=2e-3)


def test_a_frame_that_gives_takes_the_same_part_of_any_force_only_where_force_and_free_angle_are_in_proportion() -> (
    None
):
    found = forced("frame_compliance")
    command, gap = gaps(found)["blocked"]
    assert gap[command > 0.1].max() < 0
    assert found.frame.loc[found.frame["run"] == "blocked", "angle_deg"].isna().all()
    assert found.frame.loc[found.frame["run"] == "slow", "force_N"].isna().all()


def test_a_warmer_actuator_bends_more() -> None:
    found = forced("temperature")
    warm = found.setting.room.rise_C > 0
    _, gap = gaps(found)["slow"]
    late = found.setting.starts_s[0].argmax()
    assert (gap[:, late].mean() > 0) == warm


def test_the_same_truth_goes_on_under_another_protocol() -> None:
    protocol = (
        "title: up\nlimit_MPa: 0.35\nsegments:\n  - ramp: {to_MPa: 0.3, duration_s: 3}\n  - hold: {duration_s: 2}\n"
    )
    found = study(4, ("end_caps",), (4.0,), Layout(samples=2))
    frame, designs = found.measure(protocol)
    assert list(frame.columns) == list(found.frame.columns)
    assert set(frame["design"]) == set(found.frame["design"]) == set(designs["design"])
    assert frame["time_s"].max() == pytest.approx(5, abs=0.1)
    assert frame["run_index"].unique().tolist() == [4]
    again, _ = study(4, ("end_caps",), (4.0,), Layout(samples=2)).measure(protocol)
    pd.testing.assert_frame_equal(frame, again)
    shorter, made = found.measure(protocol, length_mm=120, orientation_deg=180)
    assert set(made["length_mm"]) == {120} and shorter["orientation_deg"].eq(180).all()
    assert not set(shorter["design"]) & set(found.frame["design"])


def test_softening_is_remembered_by_the_same_samples_and_not_by_new_ones() -> None:
    protocol = "title: up\nlimit_MPa: 0.35\nsegments:\n  - ramp: {to_MPa: 0.3, duration_s: 30}\n"
    form = [("softening", "form", "ogden-roxburgh")]
    found = study(4, ("softening",), (4.0,), Layout(designs=(1,), samples=8), form)
    old, _ = found.measure(protocol)
    new, _ = found.measure(protocol, new_samples=True)
    middle = [frame.loc[frame["pressure_MPa"].between(0.15, 0.2), "angle_deg"].mean() for frame in (old, new)]
    assert middle[0] > middle[1] + 2


def test_tables_are_tidy_and_not_too_long() -> None:
    layout = Layout(session=True, temperature=True, command=True, orientations_deg=(0.0, 180.0))
    frame = study(1, layout=layout).frame
    assert 40_000 < len(frame) <= MOST_ROWS + 200
    assert {"command_MPa", "run_index", "start_s", "orientation_deg", "temperature_C"} <= set(frame.columns)
    for _, rows in frame.groupby(["design", "sample", "run"]):
        assert (np.diff(rows["time_s"]) > 0).all()
    fast = frame[frame["run"] == "fast"]
    assert sorted(fast["cycle"].unique()) == [1, 2, 3]


def test_cards_are_disjoint_and_as_large_as_they_must_be() -> None:
    every = {card: cases(card) for card in ("tune", "calibrate", "score")}
    seeds = [case.seed for of_card in every.values() for case in of_card]
    assert len(set(seeds)) == len(seeds)
    assert all(len({case.name for case in of_card}) == len(of_card) for of_card in every.values())
    assert len(every["tune"]) >= 150 and len(every["calibrate"]) >= 300 and len(every["score"]) >= 600

    def count(kind: str) -> int:
        return sum(case.kind == kind for case in every["score"])

    assert count("null") >= 150 and count("single") >= 220
    assert min(count("unknown"), count("two"), count("pair")) >= 60
    singles = {(case.names[0], case.strengths[0]) for case in every["score"] if case.kind == "single"}
    assert singles == {(name, strength) for name in KNOWN for strength in (1.0, 2.0, 4.0)}
    assert {case.names[0] for case in every["score"] if case.kind == "unknown"} == set(UNKNOWN)
    assert set(STRUCTURAL) <= set(KNOWN)


def test_cases_are_drawn_whatever_their_layout() -> None:
    few = [case for case in cases("tune") if case.kind in {"two", "pair"}][::12]
    for case in few:
        found = case.study()
        assert found.answer == case.answer()
        assert [e["name"] for e in found.answer["effects"]] == list(case.names)
        assert found.frame["pressure_MPa"].notna().all()


def test_nothing_here_sees_the_identifier_or_the_twins_effects() -> None:
    """Neither by name nor through a module of benchlab that imports them; but for the test that asks the identifier."""
    for path in set(BLIND.rglob("*.py")) - {BLIND / "test_subset.py"}:
        for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
            names = [a.name for a in node.names] if isinstance(node, ast.Import) else []
            names += [node.module or ""] if isinstance(node, ast.ImportFrom) else []
            hidden = [n for n in names if n.startswith(("benchlab.discrepancy", "benchlab.twin"))]
            assert not hidden, f"{path.name} imports {hidden}"


def test_cycles_begin_where_the_command_begins_to_rise_again() -> None:
    assert cycles_of(np.array([0, 0.3, 0, 0, 0.3, 0])).tolist() == [1, 1, 1, 2, 2, 2]
    assert cycles_of(np.zeros(3)).tolist() == [1, 1, 1]


def test_truth_of_a_case_is_what_has_a_name() -> None:
    assert Case("a", 1, "unknown", ("ratchet",), (2.0,)).truth == frozenset()
    assert Case("b", 1, "two", ("friction", "gravity"), (4.0, 4.0)).truth == {"friction", "gravity"}
    assert all(a != b for a, b in pairwise(sorted(HIDDEN)))


def _rng() -> np.random.Generator:
    return np.random.default_rng(0)
