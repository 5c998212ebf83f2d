"""A Nano with benchlab's firmware, over any line: a serial port, a pty, or an emulation in lockstep."""

from __future__ import annotations

import math
import typing
from contextlib import suppress

from benchlab.bench import ADC_STEPS, Bench, LimitError
from benchlab.devices.conversation import Conversation
from benchlab.devices.interface import Fault, LostError, Reading, Status
from benchlab.devices.messages import (
    ARM,
    SET,
    UNKNOWN_CODE,
    VENT,
    Answer,
    answer_of,
    arm_payload,
    power_on_told,
    set_payload,
)
from benchlab.devices.supply import supply_notes, supply_told
from benchlab.devices.transport import BY_ITSELF, SerialTransport, Transport
from benchlab.devices.unsafe import check_output, unsafe_settings
from benchlab.errors import BenchError

PATIENCE = 0.9
"""Of the time between exchanges: how long an exchange waits for its answer."""

LOST_S = 0.5
WHOLE_CLOCK = 1 << 32


class SerialBench:
    """The device of `interface`, disarmed. Made by saying hello; BenchError where nothing that fits answers.

    An exchange waits for its answer for 0.9 of the time between exchanges and gives NO_ANSWER after that; LostError once nothing was
    answered for 0.5 s. Nothing is sent twice but hello, arm and vent. A reboot is not mended: open the bench again.
    """

    def __init__(self, transport: Transport, bench: Bench, kind: str = "serial") -> None:
        self.kind = kind
        self._line, self._bench, self._talk = transport, bench, Conversation(transport)
        self._armed = self._vented = self._closed = self._rebooted = False
        self._offset_s: float | None = None
        self._mute_s: float | None = None
        self._before = self._talk.came()
        self._last_s, self._period_s = -math.inf, 0.01
        self._turns = self._micros = 0
        try:
            self._hello = self._talk.greet()
            self._boot = self._hello.boot
            self.vent()
        except BaseException:
            transport.close()
            raise

    def about(self) -> dict[str, typing.Any]:
        hello, bench = self._hello, self._bench
        notes = []
        if hello.ceiling_code < bench.ceiling_code:
            notes.append(
                f"the firmware gives at most {self.ceiling_MPa:.4g} MPa, the bench {bench.ceiling_MPa:.4g} MPa"
            )
        if hello.ceiling_code > bench.ceiling_code:
            notes.append(
                f"the firmware's own ceiling, code {hello.ceiling_code}, lies above the bench's, {bench.ceiling_code}: write it anew with "
                "`benchlab bench firmware`"
            )
        if power_on := power_on_told(hello):
            notes.append(power_on)
        notes += supply_notes(hello, bench)
        return {
            "kind": self.kind,
            **self._line.about(),
            "firmware": hello.version,
            "protocol": hello.protocol,
            "ceiling_code": hello.ceiling_code,
            "ceiling_MPa": self.ceiling_MPa,
            "slew_MPa_per_s": 1000 * hello.slew_codes_per_ms * bench.volts(1) * bench.regulator.gain,
            "silence_s": hello.silence_ms / 1000,
            "watchdog_s": hello.watchdog_ms / 1000,
            "adc_samples": hello.adc_samples,
            "boot": hello.boot,
            "boot_cause": hello.cause,
            "dac_address": hello.dac_address,
            "dac_power_on_code": None if hello.dac_eeprom == UNKNOWN_CODE else hello.dac_eeprom,
            **supply_told(hello.reference_counts, bench),
            "reads_back": hello.reads_back,
            "notes": notes,
            "unsafe": unsafe_settings(hello, bench),
        }

    @property
    def ceiling_MPa(self) -> float:
        """The lower one of the bench's ceiling and the firmware's."""
        if self._hello.ceiling_code >= self._bench.ceiling_code:
            return self._bench.ceiling_MPa
        return self._bench.pressure_MPa(self._hello.ceiling_code)

    def arm(self) -> None:
        self._check_open()
        if self._rebooted:
            raise BenchError("the bench has booted since it was opened", file=self._line.name, hint="open it again")
        if unsafe := unsafe_settings(self._hello, self._bench):
            raise BenchError(
                f"the bench is not armed: {'; '.join(unsafe)}",
                file=self._line.name,
                hint="write its firmware anew with `benchlab bench firmware`, with --calibration if it has one",
            )
        answer = self._talk.insist(ARM, arm_payload(self._boot), "arm")
        self._reading(answer)
        if self._rebooted or not answer.flags & Status.ARMED:
            cause = (
                "its DAC does not acknowledge" if answer.flags & Status.DAC_LOST else "it has booted, or is not vented"
            )
            raise BenchError(f"the bench does not arm: {cause}", file=self._line.name, hint="look at its wires")
        self._armed, self._vented, self._offset_s, self._mute_s = True, False, None, None

    def exchange(self, time_s: float, pressure_MPa: float, trigger: bool = False) -> Reading:
        code = self._bench.code(pressure_MPa)
        self._check_open()
        if code > self._hello.ceiling_code:
            raise LimitError(
                f"{pressure_MPa:g} MPa is above {self.ceiling_MPa:.4g} MPa, the firmware's ceiling",
                file=self._line.name,
                hint="ask for less, or write the firmware anew with `benchlab bench firmware`",
            )
        if pressure_MPa > 0 and not self._armed:
            raise BenchError("the bench is not armed and gives no pressure", file=self._line.name, hint="arm it first")
        self._follow(time_s)
        self._vented = self._vented and code == 0
        if self._mute_s is None:
            self._before = self._talk.came()
        asked_s, patience_s = self._line.clock_s(), PATIENCE * self._period_s
        heard = self._talk.ask(SET, set_payload(code, trigger), patience_s)
        if heard is not None and (answer := answer_of(heard)):
            self._mute_s = None
            reading = self._reading(answer)
            check_output(reading, code, self._bench, self._line.name)
            return reading
        self._talk.tally.count(f"no answer to a command within {1000 * patience_s:.0f} ms; went on without")
        self._mute_s = asked_s if self._mute_s is None else self._mute_s
        if self._line.clock_s() - self._mute_s > LOST_S:
            self._armed = False
            instead = self._talk.instead(self._before)
            raise LostError(
                f"no answer for {LOST_S:g} s" + (f", but {instead}" if instead else ""),
                file=self._line.name,
                hint=("look at cable and noise" if instead else "was the cable pulled, or the supply lost?")
                + f"; {BY_ITSELF}",
            )
        return Reading(math.nan, math.nan, -1, math.nan, Status.NO_ANSWER)

    def vent(self) -> None:
        if self._closed:
            if self._vented:
                return
            raise LostError("closed, and nobody confirmed that it was vented", file=self._line.name)
        self._armed = False
        answer = self._talk.insist(VENT, b"", "vent")
        self._reading(answer)
        if answer.code != 0:
            what = "the DAC does not acknowledge, or does not hold 0, so nobody knows its output"
            if answer.code != UNKNOWN_CODE:
                what = f"asked to vent, the device says that the DAC's output is code {answer.code}"
            raise LostError(what, file=self._line.name, hint="take the pressure away by hand")
        self._vented = True

    def faults(self) -> list[Fault]:
        return self._talk.tally.take(self._talk.wire)

    def close(self) -> None:
        if self._closed:
            return
        with suppress(BenchError):
            self.vent()
        self._closed = True
        self._line.close()

    def _follow(self, time_s: float) -> None:
        """Keep the period of the exchanges; where time is virtual, let the device run until now."""
        if self._offset_s is None:
            self._offset_s = self._line.clock_s() - time_s
        elif time_s > self._last_s:
            self._period_s += 0.1 * (min(max(time_s - self._last_s, 0.001), 0.02) - self._period_s)
        self._last_s = time_s
        self._line.advance(self._offset_s + time_s)

    def _reading(self, answer: Answer) -> Reading:
        bench, steps = self._bench, (self._hello.adc_samples or math.nan) * ADC_STEPS / self._bench.supply_V
        status = Status(answer.flags)
        if answer.boot != self._boot:
            status |= Status.REBOOTED
            self._rebooted = True
        if not status & Status.ARMED:
            self._armed = False
        if answer.micros < self._micros:
            self._turns += 1
        self._micros = answer.micros
        self._talk.tally.device(answer.crc_errors, answer.dropped)
        return Reading(
            math.nan if bench.monitor is None else bench.monitor.of(answer.monitor / steps),
            answer.flex / steps,
            -1 if answer.code == UNKNOWN_CODE else answer.code,
            (answer.micros + self._turns * WHOLE_CLOCK) / 1e6,
            status,
            answer.monitor / steps,
        )

    def _check_open(self) -> None:
        if self._closed:
            raise BenchError("the bench is closed", file=self._line.name)


def open_serial(port: str, bench: Bench) -> SerialBench:
    """The bench on a serial port, as `/dev/ttyUSB0` or `COM3`. BenchError where there is none, it is in use, or nothing answers."""
    return SerialBench(SerialTransport(port), bench)
