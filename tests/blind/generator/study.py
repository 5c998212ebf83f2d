"""A study from its seed: tables, the answer, and more measurements of the same truth."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd

from tests.blind.generator.bench import angles, forces, pressures
from tests.blind.generator.hidden.catalogue import HIDDEN
from tests.blind.generator.hidden.hidden import Hidden
from tests.blind.generator.runs import SUBSTEPS, Run, cycles_of, protocol_run
from tests.blind.generator.scatter import People, Scatter, coloured
from tests.blind.generator.setting import MOST_ROWS, Layout, Setting
from tests.blind.generator.size import noise_floor, sized
from tests.blind.generator.station import FloatArray, Sample, Station

PERIMETER_MM, RIB_MM = 40.0, 2.0


@dataclass
class Study:
    """frame: the readings, tidy. designs: what was made. answer: what is true."""

    seed: int
    setting: Setting
    scatter: Scatter
    people: People
    hidden: tuple[Hidden, ...]
    frame: pd.DataFrame
    designs: pd.DataFrame
    answer: dict[str, Any]
    memory: dict[str, FloatArray] = field(default_factory=dict)
    _measured: int = 0

    def measure(
        self,
        protocol: str | Path,
        *,
        orientation_deg: float | None = None,
        length_mm: float | None = None,
        new_samples: bool = False,
    ) -> tuple[pd.DataFrame, pd.DataFrame]:
        """The same truth under another protocol: readings and designs, to be put under the first ones.

        protocol: text, path or name of a protocol file. The same samples, an hour later, remember what they have been through; new ones
        (also those of another length) have not. Deterministic: the n-th measurement of a study is always the same.
        """
        self._measured += 1
        rng = np.random.default_rng([self.seed, 7, self._measured])
        count = self.setting.layout.samples
        fresh = new_samples or length_mm is not None
        samples = self.setting.made_again(length_mm, count) if fresh else self.setting.samples
        people = People.draw(self.scatter, len(samples), rng) if fresh else self.people
        memory = {} if fresh or not self.setting.layout.ordered else self.memory
        run = protocol_run(protocol, f"next{self._measured}", MOST_ROWS / len(samples))
        number = 1 if fresh else len(self.setting.runs) + self._measured
        starts = self.setting.starts_s.max() + 3600 + np.arange(len(samples)) * (run.duration_s + 60)
        if orientation_deg is not None:
            turned = np.full(len(samples), float(orientation_deg))
        else:
            turned = np.resize(self.setting.orientation_deg, len(samples))
        setting = Setting(self.setting.layout, samples, (run,), turned, starts[None], self.setting.room)
        station = setting.station(run, SUBSTEPS, number, starts)
        station.memory = memory
        told = self.setting.layout
        frame = _read(run, station, told, self.scatter, people, self.hidden, rng, orientation_deg is not None)
        return frame[[c for c in self.frame.columns if c in frame] + [c for c in frame if c not in self.frame]], _made(
            samples
        )


@dataclass(frozen=True)
class Truth:
    """What is hidden in a study, before anything is measured. answer: the same in JSON's own types."""

    setting: Setting
    scatter: Scatter
    hidden: tuple[Hidden, ...]
    answer: dict[str, Any]


def truth(
    seed: int,
    names: Sequence[str] = (),
    strengths: Sequence[float] = (),
    layout: Layout | None = None,
    forms: Sequence[tuple[str, str, Any]] = (),
) -> Truth:
    """The truth of the study of the same arguments."""
    layouts, drawn = (np.random.default_rng([seed, part]) for part in range(2))
    setting = Setting.draw(layout or Layout(), layouts)
    scatter = Scatter.draw(layouts)
    floors = {q: noise_floor(setting, scatter, q) for q in _quantities(setting)}
    hidden, effects = [], []
    for name, strength in zip(names, strengths, strict=True):
        given = {key: value for effect, key, value in forms if effect == name}
        typical = replace(HIDDEN[name].draw(drawn), **given)
        one, moved = sized(typical, setting, strength * floors[typical.quantity])
        hidden.append(one)
        effects.append(
            {
                "name": one.name,
                "known": one.known,
                "same_form": one.same_form,
                "parameters": one.parameters(),
                "strength": moved / floors[one.quantity],
            }
        )
    return Truth(setting, scatter, tuple(hidden), _plain({"effects": effects, "noise_floor": floors}))


def study(
    seed: int,
    names: Sequence[str] = (),
    strengths: Sequence[float] = (),
    layout: Layout | None = None,
    forms: Sequence[tuple[str, str, Any]] = (),
) -> Study:
    """names: what is hidden, nothing or one or several; strengths: the RMS shift of each in noise floors.

    forms: (effect, field, value) that are given instead of drawn. The same seed and the same wishes give the same study.
    """
    true = truth(seed, names, strengths, layout, forms)
    makers, noise = (np.random.default_rng([seed, part]) for part in (2, 3))
    setting, scatter, hidden = true.setting, true.scatter, true.hidden
    people = People.draw(scatter, len(setting.samples), makers)
    memory: dict[str, FloatArray] = {}
    parts = []
    for run, station in setting.stations(SUBSTEPS):
        station.memory = memory if setting.layout.ordered else {}
        parts.append(_read(run, station, setting.layout, scatter, people, hidden, noise))
    frame = pd.concat(parts, ignore_index=True)
    frame = frame.sort_values(["design", "sample"], kind="stable", ignore_index=True)
    return Study(seed, setting, scatter, people, hidden, frame, _made(setting.samples), true.answer, memory=memory)


def _quantities(setting: Setting) -> list[str]:
    return ["angle_deg"] + (["force_N"] if any(run.blocked for run in setting.runs) else [])


def _read(
    run: Run,
    at: Station,
    layout: Layout,
    scatter: Scatter,
    people: People,
    hidden: Sequence[Hidden],
    rng: np.random.Generator,
    orientation_told: bool = False,
) -> pd.DataFrame:
    """The rows of a run: every SUBSTEPS-th time of the station, all samples."""
    recorded, effective = pressures(run.command_MPa(at.time_s), hidden, at)
    read = (forces if run.blocked else angles)(effective, people, hidden, at)[::SUBSTEPS]
    time, count = at.time_s[::SUBSTEPS], read.shape[1]
    step = time[1] - time[0]
    if run.blocked:
        read = read + scatter.force_offset_N * rng.standard_normal(count)
        read = read + scatter.force_white_N * rng.standard_normal(read.shape)
    else:
        read = read + scatter.offset_deg * rng.standard_normal(count)
        read = read + scatter.colour_deg * coloured(read.shape, step, scatter.colour_s, rng)
        read = read + scatter.white_deg * rng.standard_normal(read.shape)
    command = run.command_MPa(time)
    pressure = recorded[::SUBSTEPS] + scatter.sensor_MPa * rng.standard_normal(read.shape)

    def across(values: Any) -> FloatArray:
        return np.broadcast_to(values, read.shape).T.ravel()

    blank = np.full(read.size, np.nan)
    rows = {
        "design": np.repeat([one.design for one in at.samples], len(time)),
        "sample": np.repeat([one.sample for one in at.samples], len(time)),
        "run": run.name,
        "cycle": across(cycles_of(command)[:, None]),
        "time_s": across(time[:, None].round(4)),
        "pressure_MPa": across(pressure.round(5)),
        "angle_deg": blank if run.blocked else across(read.round(3)),
    }
    if "blocked" in layout.runs:
        rows["force_N"] = across(read.round(3)) if run.blocked else blank
    if layout.command:
        rows["command_MPa"] = across(command[:, None].round(5))
    if layout.ordered:
        rows["run_index"] = across(at.ordinal)
    if layout.session:
        rows["start_s"] = across(at.start_s)
    if layout.orientations_deg or orientation_told:
        rows["orientation_deg"] = across(at.orientation_deg)
    if layout.temperature:
        noise = 0.05 * rng.standard_normal(read.shape)
        rows["temperature_C"] = across((at.temperature_C[::SUBSTEPS] + noise).round(2))
    return pd.DataFrame(rows)


def _made(samples: Sequence[Sample]) -> pd.DataFrame:
    rows = dict.fromkeys((one.design, one.tw_mm, one.slw_mm, RIB_MM, one.length_mm, PERIMETER_MM) for one in samples)
    names = ["design", "tw_mm", "slw_mm", "fw_mm", "length_mm", "perimeter_mm"]
    return pd.DataFrame(list(rows), columns=names)


def _plain(value: Any) -> Any:
    """As JSON has it, numbers to three digits, so that the answer's hash does not hang on the last bits."""
    if isinstance(value, dict):
        return {str(k): _plain(v) for k, v in value.items()}
    if isinstance(value, (list, tuple)):
        return [_plain(v) for v in value]
    if isinstance(value, (float, np.floating)):
        return float(f"{value:.3g}")
    return value.item() if isinstance(value, np.generic) else value
