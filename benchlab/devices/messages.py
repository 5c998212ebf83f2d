"""What is said to the Nano and what it answers, as numbers; the layouts stand in docs/firmware.md."""

from __future__ import annotations

import struct
from dataclasses import dataclass, replace

from benchlab.bench import DAC_CODES

PROTOCOL = 1
"""Of the frames; a firmware of another is refused."""

HELLO, ARM, SET, VENT, STATUS = 1, 2, 3, 4, 5
UNKNOWN_CODE = 0xFFFF
"""Of a DAC that does not acknowledge."""

_HELLO = struct.Struct("<4B6H4B")
_SUPPLY = struct.Struct("<HB")
_ANSWER = struct.Struct("<4HI3H")
_SET = struct.Struct("<HB")
_ARM = struct.Struct("<H")
MEASURES_SUPPLY = 1, 1
"""First version, major and minor, whose hello ends with a measurement of the supply."""

READS_BACK = 1, 1, 1
"""First version whose vents are confirmed by what the DAC holds, and not by its acknowledgement alone."""

CAUSES = {1: "power", 2: "reset", 4: "brown-out", 8: "watchdog"}


@dataclass(frozen=True)
class Hello:
    """What the firmware tells of itself. boot: number of its boots. boot_cause: MCUSR at boot, 0 where a bootloader cleared it.

    dac_eeprom: the code that the DAC takes at power-on, 65535 unknown. adc_samples: conversions in each mean. reference: sum of so many
    conversions of the chip's own 1.1 V as reference_samples says; 0 until they are done, None from a firmware that does not measure it.
    """

    protocol: int
    major: int
    minor: int
    patch: int
    ceiling_code: int
    slew_codes_per_ms: int
    silence_ms: int
    watchdog_ms: int
    boot: int
    dac_eeprom: int
    boot_cause: int
    adc_samples: int
    dac_address: int
    flags: int
    reference: int | None = None
    reference_samples: int = 1

    @property
    def reference_counts(self) -> float | None:
        """The mean of a conversion of the reference; None where it was not measured."""
        return self.reference / self.reference_samples if self.reference else None

    @property
    def reads_back(self) -> bool:
        return (self.major, self.minor, self.patch) >= READS_BACK

    @property
    def version(self) -> str:
        return f"{self.major}.{self.minor}.{self.patch}"

    @property
    def cause(self) -> str:
        """Of the last boot, in words."""
        return ", ".join(word for bit, word in CAUSES.items() if self.boot_cause & bit) or "not told by the bootloader"


@dataclass(frozen=True, slots=True)
class Answer:
    """flex, monitor: sums of `adc_samples` conversions. flags: Status. micros: of the Nano's clock, from 0 again after 2³² µs."""

    code: int
    flex: int
    monitor: int
    flags: int
    micros: int
    boot: int
    crc_errors: int
    dropped: int


def hello_of(payload: bytes) -> Hello | None:
    """None where this is no hello. What its version does not have yet is not read, nor what a later one has after it."""
    if len(payload) < _HELLO.size:
        return None
    hello = Hello(*_HELLO.unpack_from(payload))
    if (hello.major, hello.minor) < MEASURES_SUPPLY or len(payload) < _HELLO.size + _SUPPLY.size:
        return hello
    reference, samples = _SUPPLY.unpack_from(payload, _HELLO.size)
    return replace(hello, reference=reference, reference_samples=max(1, samples))


def power_on_told(hello: Hello) -> str:
    """What must be told of the code that the DAC takes at power-on; nothing where it is 0."""
    if hello.dac_eeprom == 0:
        return ""
    if hello.dac_eeprom == UNKNOWN_CODE:
        return "the DAC's power-on code could not be read: it may give half of full scale until the firmware runs"
    share = 100 * hello.dac_eeprom / DAC_CODES
    return (
        f"the DAC's power-on code is {hello.dac_eeprom}, and the firmware could not program it to 0: each time it is switched on it gives "
        f"{share:.0f} % of the supply until the firmware runs; use another DAC"
    )


def answer_of(payload: bytes) -> Answer | None:
    """None where this is no answer."""
    return Answer(*_ANSWER.unpack(payload)) if len(payload) == _ANSWER.size else None


def set_payload(code: int, trigger: bool) -> bytes:
    """A code for the DAC, and whether to pulse the camera's output.

    >>> set_payload(2867, True).hex()
    '330b01'
    """
    return _SET.pack(code, trigger)


def arm_payload(boot: int) -> bytes:
    """Arming names the boot that it is for, so that noise and hosts of before a reboot do not arm."""
    return _ARM.pack(boot)
