"""What a firmware tells of itself that no pressure should be given with: its settings, and a code that nobody asked for."""

from __future__ import annotations

from benchlab.bench import DAC_CODES, Bench
from benchlab.devices.interface import OutputError, Reading, Status
from benchlab.devices.messages import Hello

SILENCE_MS, SLEW_CODES_PER_MS, HUNG_MS = (50, 500), (1, 255), (20, 250)
"""Lowest and highest. A silence limit that is shorter vents at a computer's hiccup, a longer one holds pressure for a dead computer."""

CEILING_SHARE = 0.10
"""The firmware's ceiling may lie so far above the bench's, told: that of an earlier calibration, which a new one is made with. The bench's
own ceiling holds here all the same; the firmware's is for when it does not."""


def unsafe_settings(hello: Hello, bench: Bench) -> list[str]:
    """Why this firmware is not armed, in words; empty where it may be. It can be vented and watched all the same."""
    told = []
    for name, value, (low, high) in (
        ("silence limit", hello.silence_ms, SILENCE_MS),
        ("slew", hello.slew_codes_per_ms, SLEW_CODES_PER_MS),
        ("limit of a hung main loop", hello.watchdog_ms, HUNG_MS),
    ):
        if not low <= value <= high:
            unit = "codes/ms" if name == "slew" else "ms"
            told.append(f"the firmware's {name} is {value} {unit}, not {low} to {high}")
    if hello.ceiling_code >= DAC_CODES:
        told.append(f"the firmware's ceiling is code {hello.ceiling_code}, and the DAC ends at {DAC_CODES - 1}")
    elif hello.ceiling_code > (1 + CEILING_SHARE) * bench.ceiling_code:
        told.append(
            f"the firmware's ceiling is code {hello.ceiling_code}, more than {100 * CEILING_SHARE:g} % above this bench's "
            f"{bench.ceiling_code}"
        )
    if hello.adc_samples not in (1, 2, 4, 8, 16, 32):
        told.append(f"the firmware's readings are means of {hello.adc_samples} conversions, not 1, 2, 4, 8, 16 or 32")
    return told


def check_output(reading: Reading, asked_code: int, bench: Bench, where: str) -> None:
    """OutputError where the device says that its DAC holds more than was asked for, or than the bench's ceiling.

    A fall is never slowed, so an answer to a code that was taken has no higher one.
    """
    if reading.code < 0:
        return
    taken = not reading.status & Status.REFUSED
    if reading.code > bench.ceiling_code or (taken and reading.code > asked_code):
        raise OutputError(
            f"the DAC's output is code {reading.code}, and {asked_code} was asked for, with a ceiling of {bench.ceiling_code}",
            file=where,
            hint="vent by hand if it stays; flash the firmware anew with `benchlab bench firmware`, and look at the DAC's wires",
        )
