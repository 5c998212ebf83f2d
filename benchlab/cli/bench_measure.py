"""The readings of a calibration: the bench is held at its levels, and somebody is asked what the gauge shows."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import closing, contextmanager
from typing import Any

import click

from benchlab.bench import Bench, is_reference, new_bench
from benchlab.cli.bench_answers import Answers, ask_unit, ask_volts, pressure_of
from benchlab.cli.bench_options import device_of
from benchlab.devices.interface import Device
from benchlab.errors import InputError, UsageError, printable
from benchlab.io.bench_file import SIMULATED
from benchlab.io.gauge_readings import GaugeReading
from benchlab.twin.lines import SUPPLY_V
from benchlab.workflows.bench_hold import ThreadHold, VirtualHold
from benchlab.workflows.bench_readings import Level, levels_MPa, take_readings, twin_gauge
from benchlab.workflows.open_bench import open_bench

TWIN_GAUGE = "twin"

AGAIN = "r"
"""What is typed to go back to the level before: its reading was a mistake."""

UNLIKE = 2.0
"""A reading that differs from what the nominal regulator gives by more than this factor is asked for once more."""


def measure(text: str, gauge: str, options: dict[str, Any]) -> tuple[list[GaugeReading], float, str, float | None]:
    """Readings, supply, what the file says of the gauge, and counts of the Nano's reference, from an open bench."""
    kind = device_of(text).kind
    simulated = gauge == TWIN_GAUGE
    if simulated and kind != "twin":
        raise UsageError("--gauge twin is the simulated gauge of a twin", hint=f"say which gauge is at {text}")
    if simulated and options["supply_V"] is not None:
        raise UsageError("--supply-V is measured, and a twin's is known", hint="leave --supply-V out")
    if kind == "twin" and not simulated:
        raise UsageError(f"there is no gauge {gauge!r} on a twin, which is simulated", hint="give --gauge twin")
    # What is not calibrated yet is driven as a bench that nobody calibrated.
    name = options["name"] or kind
    nominal = new_bench(name, options["limit_MPa"], options["full_scale_MPa"], options["limit_reason"] or "")
    top = options["max_MPa"] or nominal.ceiling_MPa
    if not 0 < top <= nominal.ceiling_MPa:
        raise UsageError(
            f"--max-MPa is {top:g}", hint=f"give at most {nominal.ceiling_MPa:.4g}, the most that a new bench is given"
        )
    settle_s = options["settle_s"]
    with closing(open_bench(text, nominal)) as device:
        levels = levels_MPa(min(top, device.about().get("ceiling_MPa", top)), options["points"])
        if simulated:
            supply_V = SUPPLY_V
            with VirtualHold(device) as hold:
                readings = take_readings(hold, levels, nominal, supply_V, twin_gauge(device), settle_s, _say)
            return readings, supply_V, f"{SIMULATED} gauge of the twin", None
        with _interruption_told():
            return _asked(device, nominal, levels, kind, gauge, options)


def _asked(
    device: Device, nominal: Bench, levels: list[float], kind: str, gauge: str, options: dict[str, Any]
) -> tuple[list[GaugeReading], float, str, float | None]:
    """By somebody who reads a gauge."""
    settle_s = options["settle_s"]
    answers, about = Answers(), device.about()
    supply_V = options["supply_V"] or ask_volts(answers)
    counts = _counted(about, supply_V)
    for told in about.get("notes", []):
        _say(f"warning: {told}")
    unit = options["unit"] or ask_unit(answers)
    first = 1000 * levels[0]
    _say(
        f"the first level is {first:.0f} kPa by the nominal regulator; if the gauge shows far more, press Ctrl-C: it vents"
    )
    _say(f"type {AGAIN} in place of a reading to read the level before once more")
    with ThreadHold(device) as held:
        answers.check = held.check
        readings = take_readings(
            held, levels, nominal, supply_V, lambda level: _ask_gauge(answers, level, unit), settle_s, _say
        )
    click.echo("vented", err=True)
    for fault in device.faults():
        _say(f"{fault.cause} ({fault.count})")
    return readings, supply_V, gauge if kind == "serial" else f"{SIMULATED} bench ({kind}): {gauge}", counts


@contextmanager
def _interruption_told() -> Iterator[None]:
    """Ctrl-C and SIGTERM, which come here once the bench is vented: where that was not confirmed, that comes in their place."""
    try:
        yield
    except (KeyboardInterrupt, SystemExit):
        click.echo("vented, nothing written", err=True)
        raise KeyboardInterrupt from None


def _counted(about: dict[str, Any], supply_V: float) -> float | None:
    """What the Nano counted for its reference, kept beside the supply so that runs see it change. None from one that does not measure it.

    InputError where no Nano counts so much on this supply, before anything is armed.
    """
    counts: float | None = about.get("reference_counts")
    if counts is None:
        _say(f"warning: firmware {about.get('firmware')} does not measure its supply, and runs will not see it change")
        return None
    if not is_reference(counts, supply_V):
        low, high = about["supply_between_V"]
        raise InputError(
            f"the supply is given as {supply_V:g} V, and the Nano's own measurement says {low:.2f} to {high:.2f} V",
            hint="measure between 5V and GND of the Nano, plugged in as it will be used",
        )
    return round(counts, 3)


def _ask_gauge(answers: Answers, level: Level, unit: str) -> float | None:
    """The gauge's pressure in MPa, None for `r`; asked again where it cannot be read, and once more where it is unlike the level."""
    doubted = ""
    while True:
        way = "up" if level.rising else "down"
        text = answers.ask(f"{level.number}/{level.of} {way}, {level.volts:.3f} V: the gauge in {unit}?")
        if text.lower() == AGAIN and level.number > 1:
            return None
        try:
            pressure = pressure_of(text, unit)
        except InputError as error:
            click.echo(f"  {error}", err=True)
            continue
        if level.asked_MPa / UNLIKE < pressure < level.asked_MPa * UNLIKE or text == doubted:
            return pressure
        doubted = text
        click.echo(
            f"  that is {pressure:.4g} MPa, where the nominal regulator gives {level.asked_MPa:.4g}; type it again if it is so",
            err=True,
        )


def _say(text: str) -> None:
    click.echo(f"  {printable(text)}", err=True)
