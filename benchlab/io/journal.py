"""The journal of a run: an append-only file that survives whatever dies.

A line of JSON that says what is in it, then records, each under a CRC: samples of fixed size, and events of JSON.
"""

from __future__ import annotations

import numpy as np

SAMPLE = np.dtype(
    [
        ("tick", "<u4"),  # of the plan
        ("step", "<u4"),  # index of the plan's step
        ("time_s", "<f8"),  # of the command, since the start of the run
        ("late_s", "<f4"),  # after its deadline
        ("answer_s", "<f4"),  # from the command to its answer
        ("command_MPa", "<f8"),
        ("command_V", "<f4"),
        ("code", "<i4"),  # that the DAC holds; −1 unknown
        ("pressure_MPa", "<f8"),  # measured; NaN without a sensor
        ("flex_V", "<f8"),
        ("angle_deg", "<f8"),  # measured, by the flex sensor; NaN where it is not calibrated
        ("reference_deg", "<f8"),  # NaN in open loop
        ("device_time_s", "<f8"),
        ("status", "<u4"),
    ]
)
"""One tick of a run, little-endian, without padding."""

UNITS = {
    **{"tick": "", "step": "", "time_s": "s", "late_s": "s", "answer_s": "s", "command_MPa": "MPa", "command_V": "V"},
    **{"code": "", "pressure_MPa": "MPa", "flex_V": "V", "angle_deg": "deg", "reference_deg": "deg"},
    **{"device_time_s": "s", "status": ""},
}
"""Unit of each field of SAMPLE."""
