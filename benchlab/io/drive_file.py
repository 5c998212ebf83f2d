"""The drive file: one run on a pressure bench, as HDF5 that NeXus viewers draw and xarray opens.

    /entry          NXentry   the head of the run and what happened, as JSON texts
    /entry/drive    NXdata    over time_s: all fields of the journal's samples, and the cycle of each

It holds what the journal holds, which `read_drive_file` gives back as such. The signal is the angle where one was measured, else the
pressure, else what was asked for.
"""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

import h5py
import numpy as np

from benchlab.errors import InputError
from benchlab.io.hdf5 import add_numbers, is_hdf5, open_hdf5
from benchlab.io.journal import SAMPLE, UNITS, Journal, read_journal
from benchlab.io.journal_format import Loss
from benchlab.io.nexus import Schema, nxdata, read_document, write_nexus
from benchlab.protocol.cycles import number_cycles
from benchlab.units import FloatArray

SCHEMA = Schema("benchlab-drive", 1, "benchlab drive file")
GROUP = "/entry/drive"
DOCUMENTS = ("protocol", "plan", "bench", "device", "provenance")
"""Parts of the head that are texts of their own, where a head has them; `head` has the others."""

LONG_NAMES = {
    "tick": "tick of the plan",
    "step": "step of the plan, from 0",
    "time_s": "time (s)",
    "late_s": "command after its deadline (s)",
    "answer_s": "from command to answer (s)",
    "command_MPa": "pressure asked for (MPa)",
    "command_V": "volts asked for (V)",
    "code": "code of the DAC, -1 unknown",
    "pressure_MPa": "pressure measured at the regulator (MPa)",
    "flex_V": "volts of the flex sensor (V)",
    "angle_deg": "bending angle by the flex sensor (°)",
    "reference_deg": "bending angle asked for (°)",
    "device_time_s": "the device's own clock (s)",
    "status": "bits of the device's status",
    "monitor_V": "volts of the regulator's monitor (V)",
}
_SENSORS = {"pressure_MPa": "monitor", "angle_deg": "flex"}


def write_drive_file(path: Path, journal: Journal, source: Mapping[str, Any] | None = None) -> None:
    """Write a drive file whole or not at all. source: of which journal it is made. InputError where the disk refuses."""
    header, samples = journal.header, journal.samples
    parts = {name: header[name] for name in DOCUMENTS if isinstance(header.get(name), dict)}
    documents = {
        **parts,
        "head": {name: value for name, value in header.items() if name not in parts},
        "events": list(journal.events),
        "journal": {**(source or {}), "complete": journal.complete, "losses": [vars(loss) for loss in journal.losses]},
    }
    stop = journal.stop or {}

    def fill(entry: h5py.Group) -> None:
        title = str(header.get("title", "run"))
        group = nxdata(entry, "drive", signal_of(journal), ["time_s"], f"{title}{origin_words(header, ', ')}")
        group.attrs["auxiliary_signals"] = ["command_MPa"]
        for name in SAMPLE.names or ():
            add_numbers(group, name, samples[name], UNITS[name], LONG_NAMES[name])
        add_numbers(group, "cycle", cycles_of(journal), "", "cycle of the run, from 1; 0 in none")
        for name, sensor in _SENSORS.items():
            sd = sensor_sd(header, sensor)
            if np.isfinite(samples[name]).any() and np.isfinite(sd):
                error = np.where(np.isfinite(samples[name]), sd, np.nan)
                add_numbers(group, f"{name}_errors", error, UNITS[name], f"standard deviation of the {sensor}'s line")
        group["time_s"].make_scale("time_s")
        for name, dataset in group.items():
            if name not in ("time_s", "title"):
                dataset.dims[0].attach_scale(group["time_s"])

    write_nexus(path, SCHEMA, "drive", documents, fill, partial=stop.get("reason") != "completed")


def read_drive_file(path: Path) -> Journal:
    """What the journal of a drive file held. InputError for anything damaged, foreign, cut short, outsize or from a newer benchlab."""
    with open_hdf5(path, SCHEMA.kind) as reader:
        SCHEMA.check(reader)
        time_s = reader.numbers(f"{GROUP}/time_s")
        if time_s.ndim != 1:
            raise InputError("time_s is not a list of numbers", file=path, where=GROUP)
        samples = np.zeros(len(time_s), SAMPLE)
        for name in SAMPLE.names or ():
            samples[name] = reader.numbers(f"{GROUP}/{name}", time_s.shape)
        header = read_document(reader, "head", SCHEMA)
        for name in DOCUMENTS:
            if reader.find(f"/entry/{name}") is not None:
                header[name] = read_document(reader, name, SCHEMA)
        events = read_document(reader, "events", SCHEMA, list)
        told = read_document(reader, "journal", SCHEMA)
        losses = tuple(Loss(**loss) for loss in told["losses"])
    return Journal(header, samples, tuple(events), bool(told["complete"]), losses)


def read_run_record(path: Path) -> Journal:
    """What is recorded of a run, from its journal or from its drive file. Raises as `read_journal` and `read_drive_file`."""
    return read_drive_file(path) if is_hdf5(path) else read_journal(path)


def signal_of(journal: Journal) -> str:
    """The field that tells most of what was measured."""
    measured = (name for name in ("angle_deg", "pressure_MPa") if np.isfinite(journal.samples[name]).any())
    return next(measured, "command_MPa")


def steps_of(header: Mapping[str, Any]) -> list[dict[str, Any]]:
    """The steps of the plan, as the head tells them."""
    plan = header.get("plan")
    steps = plan.get("steps", []) if isinstance(plan, dict) else []
    return [step for step in steps if isinstance(step, dict)]


def cycles_of(journal: Journal) -> np.ndarray:
    """(T,) the cycle of each sample."""
    return number_cycles([step.get("counts", ()) for step in steps_of(journal.header)], journal.samples["step"])


def sensor_sd(header: Mapping[str, Any], sensor: str) -> float:
    """The standard deviation of a line of the bench, NaN where it is not known."""
    bench = header.get("bench")
    line = bench.get(sensor) if isinstance(bench, dict) else None
    sd = line.get("sd") if isinstance(line, dict) else None
    return float("nan") if sd is None else float(sd)


def trigger_ticks(journal: Journal) -> list[int]:
    """Ticks at which the camera was triggered."""
    return [int(event["tick"]) for event in journal.events if event["kind"] == "trigger" and "tick" in event]


def trigger_times_s(journal: Journal) -> FloatArray:
    """Times of the commands that went with a trigger of the camera."""
    samples = journal.samples
    first = [np.flatnonzero(samples["tick"] == tick)[:1] for tick in trigger_ticks(journal)]
    return np.asarray(samples["time_s"][np.concatenate([*first, np.empty(0, int)]).astype(int)], dtype=float)


def unfit_words(journal: Journal) -> str:
    """Why a run is no whole measurement, "" where it is one: it was not completed, or the actuator kept its air."""
    stop = journal.stop
    if stop is None:
        return "the run was not completed: no record of its end"
    if stop.get("reason") != "completed":
        return f"the run was not completed: {stop.get('reason')}"
    return "the actuator was not empty after its vent" if stop.get("empty") is False else ""


def made_on(header: Mapping[str, Any]) -> str:
    """The kind of bench that a run, or the run that it replays, was made on.

    >>> made_on({"bench_kind": "replay", "device": {"replayed": "twin"}})
    'twin'
    """
    return str(_replayed(header) or header.get("bench_kind", ""))


def is_replay(header: Mapping[str, Any]) -> bool:
    """Whether a run was played back and nothing was made again."""
    return bool(_replayed(header)) or header.get("bench_kind") == "replay"


def _replayed(header: Mapping[str, Any]) -> Any:
    device = header.get("device")
    return device.get("replayed") if isinstance(device, dict) else None


def origin(header: Mapping[str, Any]) -> str:
    """Where the numbers of a run are from, where that is not a bench of metal.

    >>> origin({"bench_kind": "twin"}), origin({"bench_kind": "serial"})
    ('simulated (twin)', '')
    """
    kind = made_on(header)
    words = {"twin": "simulated (twin)", "emulated": "emulated bench, nothing was measured"}.get(kind, "")
    return ", ".join(["replay of a run", *([words] if words else [])]) if is_replay(header) else words


def origin_words(header: Mapping[str, Any], before: str = "") -> str:
    """The same after a separator, or nothing."""
    words = origin(header)
    return f"{before}{words}" if words else ""
