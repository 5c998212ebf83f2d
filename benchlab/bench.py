"""The bench as calibrated: what volts at the DAC mean in pressure, what its sensors' volts mean, and its limits.

The chain: pressure (MPa) → volts at the regulator's input → code of the 12-bit DAC, whose reference is the supply of the
microcontroller. The limit is a pressure; volts and codes are derived, and rounded down so that they never cross it.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

from benchlab.errors import BenchError, InputError

DAC_CODES = 4096
"""Steps of the MCP4725: its output is supply · code / 4096 (datasheet, section 3.1)."""

NOMINAL_GAIN_MPA_PER_V = 0.48 / 5
"""The paper's regulator: 0 to 5 V is 0 to 0.48 MPa (section III-D)."""

PAPER_LIMIT_MPA = 0.35
"""The paper's highest pressure; a bench with a higher limit says why."""

UNCALIBRATED_CEILING_V, UNCALIBRATED_SHARE = 3.50, 0.96
"""Most volts on a bench without a calibration, and the share of what its label allows, whatever the USB supply: the paper's regulator
has 0.48 MPa at 5 V on its label, and its kind up to 0.5 MPa, which is 0.35 MPa at 3.50 V."""

LABEL_SHARE, LABEL_CEILING_SHARE = 0.10, 0.03
"""The pressure at 5 V may differ from the regulator's label by the first: a wrong unit, a wrong gain or supply differ by more. Whatever
the line says, the volts stay below those that the label has for the limit by the second: 0.361 MPa of 0.35 where the label is right."""

ADC_STEPS = 1024
"""Of the ATmega328P's ADC over its supply."""

SUPPLY_V = 4.5, 5.5
"""Lowest and highest supply that a bench may have."""

REFERENCE_V = 1.0, 1.2
"""The ATmega328P's own reference, 1.1 V: lowest and highest of any chip (datasheet, ADC characteristics). One chip's is steady."""

HIGHEST_USB_V = 5.25
"""What a supply that nobody measured may be (USB 2.0, section 7.2.1): a code then gives more volts than it is taken for."""


class LimitError(BenchError):
    """A pressure that the bench must not be asked for."""


@dataclass(frozen=True)
class Line:
    """value = gain · volts + offset. sd: standard deviation of one value about the line, NaN where unknown."""

    gain: float
    offset: float
    sd: float = math.nan

    def of(self, volts: float) -> float:
        """The value at these volts.

        >>> Line(0.12, -0.12).of(5.0)
        0.48
        """
        return self.gain * volts + self.offset

    def inverse(self, value: float) -> float:
        """The volts at which the line has this value."""
        return (value - self.offset) / self.gain


@dataclass(frozen=True)
class Bench:
    """A bench's calibration. Volts, MPa, degrees.

    regulator: pressure over volts at its input. monitor: pressure over volts at its monitor output, None where that is not wired.
    flex: bending angle in degrees over volts of the flex sensor's divider, None where it is not calibrated.
    supply_V: of the microcontroller, which is the DAC's and the ADC's reference. gauge, date: how and when it was
    calibrated. reference_counts: of 1.1 V at the ADC with that supply, as the firmware measures it; None where it was not.
    full_scale_MPa: at 5 V, as the regulator's label says. limit_reason: why the limit is above 0.35 MPa, empty where it is not.
    source: where a line is from that was never measured on this bench, as a data sheet; such a bench is not calibrated.
    calibrated: whether it was at all; without, the limit holds for a supply of 5.25 V and a regulator of 4 % more than its label too.
    InputError for numbers that no bench has, among them a regulator that would not vent at 0 V or is not as its label says.

    >>> bench = Bench(name="a", calibrated=True)
    >>> bench.code(0.35), round(bench.volts(2986), 3), round(bench.pressure_MPa(2986), 4)
    (2986, 3.645, 0.3499)
    """

    name: str
    regulator: Line = Line(NOMINAL_GAIN_MPA_PER_V, 0.0)
    monitor: Line | None = None
    flex: Line | None = None
    limit_MPa: float = PAPER_LIMIT_MPA
    limit_reason: str = ""
    full_scale_MPa: float = 5 * NOMINAL_GAIN_MPA_PER_V
    supply_V: float = 5.0
    reference_counts: float | None = None
    gauge: str = ""
    date: str = ""
    source: str = ""
    calibrated: bool = False

    def __post_init__(self) -> None:
        demands = {
            "a limit_MPa above 0 and at most 1": 0 < self.limit_MPa <= 1,
            f"a limit_reason for a limit_MPa of {self.limit_MPa:g}, above the {PAPER_LIMIT_MPA:g} MPa of the paper": (
                not self.limit_MPa > PAPER_LIMIT_MPA or bool(self.limit_reason.strip())
            ),
            f"a limit_MPa of at most its regulator's full_scale_MPa, {self.full_scale_MPa:g}": (
                self.limit_MPa <= self.full_scale_MPa
            ),
            "a supply_V from 4.5 to 5.5": SUPPLY_V[0] <= self.supply_V <= SUPPLY_V[1],
            "reference_counts of a reference from 1.0 to 1.2 V at its supply_V": self.reference_counts is None
            or is_reference(self.reference_counts, self.supply_V),
            "a regulator whose gain is from 0.001 to 1 MPa/V": 0.001 <= self.regulator.gain <= 1,
            "a regulator that vents at 0 V: an offset_MPa of at most a tenth of the limit, and at least -1": (
                -1 <= self.regulator.offset <= 0.1 * self.limit_MPa
            ),
            "a monitor whose gain is above 0": self.monitor is None or 0 < self.monitor.gain < math.inf,
            "a monitor whose offset_MPa is a number": self.monitor is None or math.isfinite(self.monitor.offset),
            "a flex sensor whose gain is a number and not 0": self.flex is None or 0 < abs(self.flex.gain) < math.inf,
            "a flex sensor whose offset_deg is a number": self.flex is None or math.isfinite(self.flex.offset),
        }
        for demand, met in demands.items():
            if not met:
                raise InputError(f"a bench needs {demand}", where=self.name)
        if not abs(self.regulator.of(5.0) / self.full_scale_MPa - 1) <= LABEL_SHARE:
            raise InputError(
                f"its line makes {self.regulator.of(5.0):.3g} MPa at 5 V, and its regulator's label says {self.full_scale_MPa:.3g} MPa",
                where=self.name,
                hint="is it the unit of the readings? else say what the label says: --full-scale-MPa, `full_scale_MPa` in the file",
            )

    @property
    def ceiling_code(self) -> int:
        """The largest code that this bench is ever given."""
        return self._floor_code(self._ceiling_V)

    @property
    def ceiling_MPa(self) -> float:
        """The largest pressure that this bench can be asked for: its limit, or less where volts are capped."""
        return max(0.0, min(self.limit_MPa, self.regulator.of(self._ceiling_V)))

    @property
    def _ceiling_V(self) -> float:
        volts = self.regulator.inverse(self.limit_MPa)
        volts = min(volts, (1 + LABEL_CEILING_SHARE) * 5 * self.limit_MPa / self.full_scale_MPa)
        if not self.calibrated:
            volts = min(UNCALIBRATED_SHARE * volts, UNCALIBRATED_CEILING_V)
            volts *= self.supply_V / max(self.supply_V, HIGHEST_USB_V)
        return min(volts, self.volts(DAC_CODES - 1))

    def code(self, pressure_MPa: float) -> int:
        """The DAC's code for a pressure, rounded down; 0, which vents, for 0 MPa whatever the regulator's offset.

        LimitError for a pressure that is negative, not a number or above the ceiling.
        """
        if not 0 <= pressure_MPa <= self.ceiling_MPa + 1e-12:
            raise LimitError(
                f"{pressure_MPa:g} MPa is outside 0 to {self.ceiling_MPa:.4g} MPa, the limit of bench {self.name}",
                hint="ask for less" if self.calibrated else "calibrate the bench with `benchlab bench calibrate`",
            )
        if pressure_MPa == 0:
            return 0
        return min(self._floor_code(self.regulator.inverse(pressure_MPa)), self.ceiling_code)

    def supply_now_V(self, reference_counts: float) -> float | None:
        """The supply on which this chip counts so much for its reference: counts go down as the supply goes up. None where they were
        not counted at the calibration, as another chip's reference may differ by 10 %.

        >>> round(Bench("a", supply_V=4.9, reference_counts=230.0).supply_now_V(220.8), 3)
        5.104
        """
        return None if self.reference_counts is None else self.supply_V * self.reference_counts / reference_counts

    def volts(self, code: int) -> float:
        """Volts at the regulator's input at a code."""
        return self.supply_V * code / DAC_CODES

    def pressure_MPa(self, code: int) -> float:
        """The pressure that a code asks of the regulator."""
        return max(0.0, self.regulator.of(self.volts(code)))

    def _floor_code(self, volts: float) -> int:
        return max(0, math.floor(volts / self.supply_V * DAC_CODES + 1e-9))


def new_bench(
    name: str,
    limit_MPa: float = PAPER_LIMIT_MPA,
    full_scale_MPa: float = 5 * NOMINAL_GAIN_MPA_PER_V,
    limit_reason: str = "",
) -> Bench:
    """A bench that nobody calibrated yet, by its regulator's label.

    >>> new_bench("new").ceiling_code, new_bench("strong", full_scale_MPa=0.9).ceiling_code
    (2730, 1456)
    """
    return Bench(
        name,
        Line(full_scale_MPa / 5, 0.0),
        limit_MPa=limit_MPa,
        full_scale_MPa=full_scale_MPa,
        limit_reason=limit_reason,
    )


def supply_between_V(reference_counts: float) -> tuple[float, float]:
    """Lowest and highest supply on which any chip counts so much for its reference.

    >>> [round(volts, 2) for volts in supply_between_V(225.3)]
    [4.55, 5.45]
    """
    return REFERENCE_V[0] * ADC_STEPS / reference_counts, REFERENCE_V[1] * ADC_STEPS / reference_counts


def is_reference(reference_counts: float, supply_V: float) -> bool:
    """Whether some chip counts so much for its reference on this supply.

    >>> is_reference(225.3, 5.0), is_reference(225.3, 4.5)
    (True, False)
    """
    low, high = REFERENCE_V
    return low <= reference_counts * supply_V / ADC_STEPS <= high
