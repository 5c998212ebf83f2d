"""A bench before it is armed: on the supply that it was calibrated with, as its firmware measures it against the chip's own 1.1 V.

The supply is the reference of the DAC: on another USB port it may be 5 % higher, and each code then gives 5 % more pressure. The chip's
1.1 V is only good to 10 %, but it stays: what is judged is the ratio of what it counted at the calibration to what it counts now.
"""

from __future__ import annotations

from typing import Any

from benchlab.bench import SUPPLY_V, Bench
from benchlab.errors import BenchError

HIGH_SHARE = 0.02
"""A supply may be so much above the calibrated one: 7 kPa of 0.35 MPa. Less could not be told from what is no supply: 0.2 % each for
the ADC's step at the calibration and now, and up to 1 % for the reference between a cold and a warm room."""


def check_supply(about: dict[str, Any], bench: Bench) -> None:
    """Judge what a device says of its supply. BenchError where it is above the calibrated one, or none that a bench can have.

    A device that does not measure its supply is not judged. What it says of its settings, which it refuses to be armed with, is told here.
    """
    if unsafe := about.get("unsafe"):
        hint = "write its firmware anew with `benchlab bench firmware`, with --calibration if it has one"
        raise BenchError(f"not armed: {'; '.join(unsafe)}", hint=hint)
    counts = about.get("reference_counts")
    if counts is None:
        return
    (low_V, high_V), (lowest_V, highest_V) = about["supply_between_V"], SUPPLY_V
    if low_V > highest_V or high_V < lowest_V:
        raise BenchError(
            f"the Nano's reference of 1.1 V reads as {counts:.1f} counts, as on a supply of {low_V:.2f} to {high_V:.2f} V, and a bench has "
            f"{lowest_V:g} to {highest_V:g} V",
            hint="measure between 5V and GND; if that is right, this is no ATmega328P: use another Nano",
        )
    supply_V = bench.supply_now_V(counts)
    if supply_V is None or supply_V <= (1 + HIGH_SHARE) * bench.supply_V:
        return
    share = supply_V / bench.supply_V - 1
    raise BenchError(
        f"the supply is {supply_V:.2f} V, calibrated at {bench.supply_V:.2f} V: each pressure would be {100 * share:.1f} % above what is "
        "asked for",
        hint="use the USB port and the Nano that it was calibrated with, or calibrate again with `benchlab bench calibrate`",
    )
