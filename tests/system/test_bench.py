"""`benchlab bench` on a Nano at a pty: vent, monitor, ports, firmware, and calibration by somebody who types."""

from __future__ import annotations

import csv
import json
import os
import pty
import re
import select
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest

from benchlab.devices.messages import VENT
from benchlab.errors import printable
from benchlab.io.bench_file import read_bench, read_bench_file
from tests.system.patience import LONG_S, PATIENT, wait_until
from tests.system.small_nano import MONITOR, REGULATOR, SILENCE_S, SmallNano

BENCH = """name: left
date: '2026-05-31'
gauge: test
supply_V: 4.9
regulator: {gain_MPa_per_V: 0.0965, offset_MPa: -0.001}
monitor: {gain_MPa_per_V: 0.12, offset_MPa: -0.12}
flex: {gain_deg_per_V: 40.0, offset_deg: 5.0, from: a test}
readings:
- {volts: 0.5, pressure_MPa: 0.04725, monitor_V: 1.39375}
- {volts: 1.0, pressure_MPa: 0.0955, monitor_V: 1.7958333}
- {volts: 2.0, pressure_MPa: 0.192, monitor_V: 2.6}
- {volts: 3.0, pressure_MPa: 0.2885, monitor_V: 3.4041667}
"""


@pytest.fixture
def calibration(tmp_path: Path) -> Path:
    path = tmp_path / "left.yaml"
    path.write_text(BENCH)
    return path


def test_vent_says_what_was_confirmed(benchlab, calibration: Path) -> None:
    with SmallNano() as nano:
        done = benchlab("bench", "vent", "--bench", f"serial:{nano.port}")
        assert done.code == 0 and "code 0" in done.err and "nobody measured the pressure" in done.err
        done = benchlab("bench", "vent", "--bench", f"serial:{nano.port}", "--calibration", calibration, "--json")
    assert done.code == 0 and "monitor shows 0." in done.err
    assert done.json["confirmed"] and done.json["code"] == 0 and abs(done.json["pressure_MPa"]) < 0.001


def test_vent_tells_what_the_dac_gives_at_power_on(benchlab) -> None:
    with SmallNano() as nano:
        assert "at power-on the DAC gives code 0" in benchlab("bench", "vent", "--bench", f"serial:{nano.port}").err
        nano.power_on_code, nano.silence_ms = 2048, 60_000
        done = benchlab("bench", "vent", "--bench", f"serial:{nano.port}", "--json")
    assert done.code == 0 and done.json["dac_power_on_code"] == 2048
    assert "WARNING: the DAC's power-on code is 2048" in done.err and "50 % of the supply" in done.err
    assert "WARNING: the firmware's silence limit is 60000 ms" in done.err


def test_vent_says_whether_the_dac_was_read_back(benchlab) -> None:
    with SmallNano(counts=COUNTS) as nano:
        done = benchlab("bench", "vent", "--bench", f"serial:{nano.port}")
        assert "the DAC acknowledged, without being read back by this old firmware, code 0" in done.err
        nano.patch = 1
        assert "vented: the DAC holds code 0" in benchlab("bench", "vent", "--bench", f"serial:{nano.port}").err


def test_vent_does_not_wait_for_a_calibration_that_can_be_read(benchlab, calibration: Path) -> None:
    calibration.write_text("name: [")
    with SmallNano() as nano:
        nano.code, nano.armed = 500, True
        done = benchlab("bench", "vent", "--bench", f"serial:{nano.port}", "--calibration", calibration)
        assert nano.code == 0 and not nano.armed and "vent" in nano.vents
    assert done.code == 3 and "vented: the DAC acknowledged" in done.err and "left.yaml" in done.err


def test_a_bench_must_be_said(benchlab) -> None:
    for command in ("vent", "monitor"):
        done = benchlab("bench", command)
        assert done.code == 2 and "Missing option '--bench'" in done.err


def test_a_replay_is_no_bench(benchlab) -> None:
    for command in ("vent", "monitor"):
        done = benchlab("bench", command, "--bench", "replay:x.journal")
        assert done.code == 2 and "no bench" in done.err


def test_vent_of_a_bench_that_keeps_its_pressure_is_not_confirmed(benchlab, calibration: Path, monkeypatch) -> None:
    from benchlab.workflows import bench_vent

    monkeypatch.setattr(bench_vent, "WAIT_S", 0.3)
    with SmallNano(sticks_MPa=0.2) as nano:
        done = benchlab("bench", "vent", "--bench", f"serial:{nano.port}", "--calibration", calibration)
    assert done.code == 5
    assert "monitor shows 200" in done.err and "relief valve" in done.err


def test_vent_that_nobody_answers_is_not_confirmed(benchlab) -> None:
    with SmallNano(deaf_to=(VENT,)) as nano:
        done = benchlab("bench", "vent", "--bench", f"serial:{nano.port}", "--json")
    assert done.code == 5 and "by hand" in done.err
    assert done.json["error"]["code"] == 5


def test_monitor_in_lines_table_json_and_csv(benchlab, calibration: Path, tmp_path: Path) -> None:
    with SmallNano() as nano:
        where = ("--bench", f"serial:{nano.port}", "--calibration", calibration, "--seconds", "0.4", "--rate-Hz", 50)
        done = benchlab("bench", "monitor", *where, "--out", tmp_path / "seen.csv", "--json")
        assert (
            done.code == 0 and "angle 45.0 °" in done.err and "pressure 0." in done.err and "flex 1.000 V" in done.err
        )
        rows = list(csv.DictReader((tmp_path / "seen.csv").open()))
        assert len(rows) == done.json["readings"] >= 15
        assert done.json["flex_V"]["mean"] == pytest.approx(1.0, abs=1e-3)
        assert {row["angle_deg"][:4] for row in rows if row["angle_deg"]} <= {"44.9", "45.0"}  # a late answer is a hole
        lines = benchlab("bench", "monitor", *where, "--json-lines").out.splitlines()
        assert len(lines) >= 15 and json.loads(lines[0])["code"] == 0
        assert not nano.armed and nano.highest_code == 0
        assert benchlab("bench", "monitor", *where, "--out", tmp_path / "seen.csv").code == 2


def test_monitor_without_a_calibration_shows_volts(benchlab) -> None:
    with SmallNano() as nano:
        done = benchlab("bench", "monitor", "--bench", f"serial:{nano.port}", "--seconds", "0.1", "--json")
    assert done.code == 0 and "angle not calibrated" in done.err and "pressure not known" in done.err
    assert done.json["pressure_MPa"] is None and done.json["monitor_V"]["mean"] == pytest.approx(
        1.0 * 5 / 4.9, abs=0.01
    )


def test_firmware_has_the_ceiling_of_the_calibration(benchlab, calibration: Path, tmp_path: Path) -> None:
    done = benchlab("bench", "firmware", "--out", tmp_path / "nano", "--calibration", calibration, "--json")
    assert done.code == 0
    text = Path(done.json["outputs"][0]).read_text()
    code = read_bench(calibration).ceiling_code
    assert f"#define CEILING_CODE {code} " in text and done.json["ceiling_code"] == code
    assert benchlab("bench", "firmware", "--out", tmp_path / "nano").code == 2
    done = benchlab("bench", "firmware", "--out", tmp_path / "nano", "--overwrite")
    assert done.code == 0 and "not calibrated" in done.err and "code 2730" in done.err


def test_the_firmware_of_a_new_bench_with_another_regulator(benchlab, tmp_path: Path) -> None:
    done = benchlab("bench", "firmware", "--out", tmp_path / "nano", "--full-scale-MPa", "0.9")
    assert done.code == 0 and "code 1456" in done.err and "0.9 MPa at 5 V by its label and no other" in done.err
    done = benchlab("bench", "firmware", "--out", tmp_path / "b", "--limit-MPa", "0.5", "--full-scale-MPa", "0.9")
    assert done.code == 3 and "limit_reason" in done.err


def test_a_limit_above_the_papers_is_told_with_the_firmware(benchlab, calibration: Path, tmp_path: Path) -> None:
    calibration.write_text(BENCH.replace("supply_V", "limit_MPa: 0.4\nlimit_reason: three layers\nsupply_V"))
    done = benchlab("bench", "firmware", "--out", tmp_path / "nano", "--calibration", calibration)
    assert done.code == 0 and "LIMIT 0.4 MPa, above the paper's 0.35 MPa: 'three layers'" in done.err


def test_ports_are_listed(benchlab, monkeypatch) -> None:
    from serial.tools import list_ports
    from serial.tools.list_ports_common import ListPortInfo

    nano, other = ListPortInfo("/dev/ttyUSB7"), ListPortInfo("/dev/ttyS0")
    nano.vid, nano.pid, nano.description = 0x1A86, 0x7523, "USB Serial"
    monkeypatch.setattr(list_ports, "comports", lambda: [nano, other])
    done = benchlab("bench", "ports")
    assert done.code == 0 and "/dev/ttyUSB7  USB Serial, USB 1a86:7523, CH340, as on most Nanos" in done.out
    assert benchlab("bench", "ports", "--json").json["ports"][1]["usb"] == "1a86:7523"
    monkeypatch.setattr(list_ports, "comports", list)
    done = benchlab("bench", "ports")
    assert done.code == 0 and "no serial port" in done.err


@pytest.mark.skipif(not Path("/dev/full").exists(), reason="no /dev/full, which is a full disk")
def test_a_full_disk_behind_standard_output_is_no_bug() -> None:
    with Path("/dev/full").open("w") as full:
        done = subprocess.run([sys.executable, "-m", "benchlab", "bench", "ports", "--json"], stdout=full, stderr=subprocess.PIPE,
                              text=True, check=False)  # fmt: skip
    assert done.returncode == 3 and done.stderr.startswith("benchlab: disk full") and "Traceback" not in done.stderr


def test_bad_inputs_130_a_port_that_is_missing_or_no_port(benchlab, tmp_path: Path) -> None:
    for command in ("vent", "monitor"):
        done = benchlab("bench", command, "--bench", "serial:/dev/ttyNONE")
        assert done.code == 5 and "no such port" in done.err and "ports here" in done.err
    (tmp_path / "file").write_text("x")
    done = benchlab("bench", "vent", "--bench", f"serial:{tmp_path / 'file'}")
    assert done.code == 5 and "not a serial port" in done.err


@pytest.mark.skipif(os.geteuid() == 0, reason="root may open every port")
def test_bad_inputs_130_no_permission(benchlab) -> None:
    with SmallNano() as nano:
        Path(nano.port).chmod(0)
        done = benchlab("bench", "vent", "--bench", f"serial:{nano.port}")
    assert done.code == 5 and "dialout" in done.err


def test_bad_inputs_130_no_permission_as_the_system_says_it(benchlab, monkeypatch) -> None:
    import serial

    def refused(*_: object, **__: object) -> None:
        raise serial.SerialException(13, "could not open port /dev/ttyUSB0: [Errno 13] Permission denied")

    monkeypatch.setattr(serial, "Serial", refused)
    done = benchlab("bench", "vent", "--bench", "serial:/dev/ttyUSB0")
    assert done.code == 5 and "no permission" in done.err and "dialout" in done.err


def test_bad_inputs_139_a_second_benchlab_on_the_port(benchlab) -> None:
    with SmallNano() as nano:
        arguments = ["bench", "monitor", "--bench", f"serial:{nano.port}", "--json-lines"]
        first = subprocess.Popen([*PATIENT, *arguments], stdout=subprocess.PIPE, text=True)
        assert first.stdout is not None
        assert json.loads(first.stdout.readline())["code"] == 0
        done = benchlab("bench", "vent", "--bench", f"serial:{nano.port}")
        assert done.code == 5 and "in use by another program" in done.err
        first.send_signal(signal.SIGINT)
        assert first.wait(LONG_S) == 0
        assert benchlab("bench", "vent", "--bench", f"serial:{nano.port}").code == 0


class Typist:
    """`benchlab bench calibrate` in a terminal of its own."""

    def __init__(self, folder: Path, *arguments: str, words: tuple[str, ...] = PATIENT) -> None:
        self.pid, self.terminal = pty.fork()
        if self.pid == 0:
            os.chdir(folder)
            os.execv(sys.executable, [*words, "bench", "calibrate", *arguments])
        self.seen = ""

    def wait_for(self, text: str) -> None:
        """Until the terminal shows it, after what was shown before."""
        until = time.monotonic() + LONG_S
        while text not in self.seen:
            assert time.monotonic() < until, f"no {text!r} in {printable(self.seen)}"
            if select.select([self.terminal], [], [], 0.1)[0]:
                try:
                    self.seen += os.read(self.terminal, 4096).decode()
                except OSError:  # it has ended
                    raise AssertionError(f"no {text!r} in {printable(self.seen)}") from None
        self.seen = self.seen.partition(text)[2]

    def type(self, text: str) -> None:
        os.write(self.terminal, text.encode())

    def end(self) -> tuple[int, str]:
        """Exit code, and what was shown last."""
        until = time.monotonic() + LONG_S
        while time.monotonic() < until:
            try:
                if select.select([self.terminal], [], [], 0.1)[0]:
                    self.seen += os.read(self.terminal, 4096).decode()
            except OSError:
                break
        os.close(self.terminal)
        return os.waitstatus_to_exitcode(os.waitpid(self.pid, 0)[1]), self.seen


COUNTS = 1.1 * 1024 / 4.9


def typist(nano: SmallNano, folder: Path, *more: str, words: tuple[str, ...] = PATIENT) -> Typist:
    arguments = ("--bench", f"serial:{nano.port}", "--gauge", "Keller LEO 2", "--points", "4", "--max-MPa", "0.29",
                 "--settle-s", "0.1")  # fmt: skip
    return Typist(folder, *arguments, *more, words=words)


def test_a_calibration_is_typed(tmp_path: Path) -> None:
    with SmallNano(counts=COUNTS) as nano:
        lab = typist(nano, tmp_path)
        lab.wait_for("multimeter?")
        lab.type("49\n")
        lab.wait_for("4.5 to 5.5")
        lab.type("4.9 V\n")
        lab.wait_for("Which unit")
        lab.type("mPa\n")
        lab.wait_for("not a unit")
        lab.type("kPa\n")
        for number in range(1, 8):
            lab.wait_for(f"{number}/7 {'up' if number <= 4 else 'down'}")
            time.sleep(1.5 * SILENCE_S if number < 3 else 0)  # longer than the silence that the firmware allows
            assert nano.armed and nano.code > 0
            shown = 1000 * nano.pressure_MPa
            if number == 2:
                lab.type("about ten\n")
                lab.wait_for("is not a pressure")
                lab.type(f"{shown / 1000:.3f}\n")  # in MPa, without saying so
                lab.wait_for("type it again if it is so")
            if number == 5:
                lab.type("r\n")
                lab.wait_for("4/7")
                lab.type(f"{1000 * nano.pressure_MPa:.3f}\n")
                lab.wait_for("5/7")
            lab.type(f"{shown / 100:.5f} bar\n" if number == 3 else f"{shown:.3f}\n")
        code, shown_last = lab.end()
        assert code == 0, shown_last
        assert not nano.armed and nano.code == 0 and "silence" not in nano.vents
    assert (
        "vented" in shown_last and "wrote bench.yaml" in shown_last and (tmp_path / "bench.png").stat().st_size > 10_000
    )
    file = read_bench_file(tmp_path / "bench.yaml")
    assert file.bench.regulator.gain == pytest.approx(REGULATOR.gain, rel=1e-4)
    assert file.bench.regulator.offset == pytest.approx(REGULATOR.offset, abs=1e-5)
    assert file.bench.monitor is not None and len(file.readings) == 7
    assert file.bench.monitor.gain == pytest.approx(MONITOR.gain, rel=0.003)
    assert file.bench.gauge == "Keller LEO 2" and file.bench.supply_V == 4.9
    assert file.bench.reference_counts == pytest.approx(COUNTS, abs=0.01)


def test_a_supply_that_the_nano_cannot_have_is_refused_before_anything_is_armed(tmp_path: Path) -> None:
    """Typed as 5.5 V, it would put each pressure of a bench at 4.9 V 12 % off; the reference would be 1.23 V."""
    with SmallNano(counts=COUNTS) as nano:
        code, shown = typist(nano, tmp_path, "--supply-V", "5.5", "--unit", "kPa").end()
        assert code == 3 and "given as 5.5 V, and the Nano's own measurement says 4.45 to 5.35 V" in shown, shown
        assert nano.highest_code == 0


@pytest.mark.parametrize(
    ("end", "code", "told"),
    [
        (lambda lab: lab.type("\x03"), 130, "vented, nothing written"),
        (lambda lab: os.kill(lab.pid, signal.SIGTERM), 130, "vented, nothing written"),
        (lambda lab: lab.type("\x04"), 2, "standard input ended"),
        (lambda lab: lab.type("900\n900\n"), 5, "above the limit"),
    ],
    ids=["Ctrl-C", "SIGTERM", "Ctrl-D", "over the limit"],
)
def test_every_end_vents_and_writes_nothing(tmp_path: Path, end, code: int, told: str) -> None:
    with SmallNano() as nano:
        lab = typist(nano, tmp_path, "--supply-V", "4.9", "--unit", "kPa")
        lab.wait_for("1/7 up")
        assert nano.armed and nano.code > 0
        end(lab)
        left, shown = lab.end()
        assert left == code and told in shown, shown
        assert not nano.armed and nano.code == 0 and "silence" not in nano.vents
    assert not list(tmp_path.iterdir())


def test_a_killed_calibration_is_vented_by_the_firmware(tmp_path: Path) -> None:
    with SmallNano() as nano:
        lab = typist(nano, tmp_path, "--supply-V", "4.9", "--unit", "kPa")
        lab.wait_for("1/7 up")
        os.kill(lab.pid, signal.SIGKILL)
        wait_until(lambda: not nano.armed)
        assert nano.code == 0 and nano.vents[-1] == "silence"
        lab.end()


def test_a_firmware_with_a_lower_ceiling_is_calibrated_below_it(tmp_path: Path) -> None:
    with SmallNano(ceiling_code=1300) as nano:
        lab = Typist(tmp_path, "--bench", f"serial:{nano.port}", "--gauge", "a", "--points", "4", "--settle-s", "0.1",
                     "--supply-V", "4.9", "--unit", "kPa", "--limit-MPa", "0.18")  # fmt: skip
        lab.wait_for("firmware 1.0.0 does not measure its supply")
        for number in range(1, 8):
            lab.wait_for(f"{number}/7")
            lab.type(f"{1000 * nano.pressure_MPa:.3f}\n")
        code, shown = lab.end()
    assert code == 0 and "extrapolated" in shown
    assert read_bench_file(tmp_path / "bench.yaml").bench.reference_counts is None
    assert 1290 < nano.highest_code <= 1300


def test_a_bench_that_is_lost_ends_the_asking_at_once(tmp_path: Path) -> None:
    with SmallNano() as nano:
        hasty = (sys.executable, "-m", "benchlab")
        lab = typist(nano, tmp_path, "--supply-V", "4.9", "--unit", "kPa", words=hasty)
        lab.wait_for("1/7 up")
        nano.deaf_to = (1, 2, 3, 4, 5)
        code, shown = lab.end()
    assert code == 5 and "NOT CONFIRMED VENTED" in shown and "by hand" in shown


def test_readings_from_a_table_need_no_bench(benchlab, tmp_path: Path) -> None:
    table = tmp_path / "gauge.csv"
    volts = (0.5, 1.0, 1.5, 2.0, 2.5, 3.0, 2.5, 2.0, 1.5, 1.0)
    table.write_text("volts,pressure_kPa\n" + "".join(f"{v},{1000 * REGULATOR.of(v):.3f}\n" for v in volts))
    out = tmp_path / "left.yaml"
    arguments = (
        "bench",
        "calibrate",
        "--readings",
        table,
        "--gauge",
        "Keller LEO 2",
        "--supply-V",
        "4.93",
        "--out",
        out,
    )
    done = benchlab(*arguments, "--date", "2026-05-31", "--json")
    assert done.code == 0, done.err
    bench = read_bench(out)
    assert bench.regulator.gain == pytest.approx(REGULATOR.gain, rel=1e-5) and bench.date == "2026-05-31"
    assert bench.name == "left" and bench.monitor is None and "monitor: not wired" in done.err
    assert done.json["ceiling_code"] == bench.ceiling_code
    assert benchlab(*arguments).code == 2  # exists
    psi = tmp_path / "psi.csv"
    psi.write_text("volts,pressure_kPa\n" + "".join(f"{v},{145.04 * REGULATOR.of(v):.3f}\n" for v in volts))
    done = benchlab(*arguments[:3], psi, *arguments[4:], "--overwrite")
    assert done.code == 3 and "0.0698 MPa at 5 V" in done.err and "is it the unit" in done.err
    table.write_text(table.read_text().replace("192.000", "19.200", 1))
    done = benchlab(*arguments, "--overwrite")
    assert done.code == 3 and "reading 4" in done.err and "pressure_MPa" in done.err
    assert read_bench(out) == bench


def test_a_twin_s_gauge_is_simulated_and_its_calibration_is_for_no_bench_of_metal(benchlab, tmp_path: Path) -> None:
    out = tmp_path / "twin.yaml"
    done = benchlab("bench", "calibrate", "--bench", "twin", "--gauge", "twin", "--out", out, "--json")
    assert done.code == 0 and done.json["gauge"] == "simulated gauge of the twin"
    gain, monitor = (done.json[line]["gain_MPa_per_V"] for line in ("regulator", "monitor"))
    assert gain["low"] < 0.096 < gain["high"] and monitor["value"] == pytest.approx(0.12, rel=2e-3)
    assert done.json["readings"] == 15 and len(read_bench_file(out).readings) == 15
    with SmallNano() as nano:
        done = benchlab("bench", "vent", "--bench", f"serial:{nano.port}", "--calibration", out)
    assert done.code == 3 and "no pressure of a bench of metal" in done.err and nano.vents and "vented: " in done.err
    done = benchlab("bench", "monitor", "--bench", "twin", "--calibration", out, "--seconds", "0.2", "--json")
    assert done.code == 0 and abs(done.json["pressure_MPa"]["mean"]) < 0.005


def test_the_bench_file_of_the_guide_reads(tmp_path: Path) -> None:
    guide = (Path(__file__).parents[2] / "docs" / "bench.md").read_text(encoding="utf-8")
    (text,) = re.findall(r"```yaml\n(.*?)```", guide, re.DOTALL)
    (tmp_path / "bench.yaml").write_text(text, encoding="utf-8")
    file = read_bench_file(tmp_path / "bench.yaml")
    assert file.flex_from == "run 12 with video" and len(file.readings) == 6


@pytest.mark.parametrize(
    ("arguments", "named"),
    [
        (("--gauge", "a"), "either --bench or --readings"),
        (("--gauge", " ", "--bench", "twin"), "--gauge is empty"),
        (("--gauge", "twin", "--bench", "twin", "--limit-MPa", "0.4"), "say why with --limit-reason"),
        (("--gauge", "twin", "--bench", "twin", "--limit-MPa", "0.9", "--limit-reason", "a"), "label ends at 0.48"),
        (("--gauge", "a", "--readings", "x.csv", "--supply-V", "5", "--date", "2090-05-31"), "in the future"),
        (("--gauge", "a", "--readings", "x.csv"), "--supply-V"),
        (("--gauge", "a", "--readings", "x.csv", "--supply-V", "5", "--unit", "kPa"), "--unit"),
        (("--gauge", "a", "--bench", "twin", "--supply-V", "3.3"), "--supply-V"),
        (("--gauge", "a", "--bench", "twin", "--unit", "mPa"), "--unit"),
        (("--gauge", "a", "--bench", "twin"), "no gauge 'a' on a twin"),
        (("--gauge", "twin", "--bench", "twin", "--max-MPa", "0.4"), "--max-MPa"),
        (("--gauge", "a", "--bench", "twin", "--limit-MPa", "35"), "--limit-MPa"),
        (("--gauge", "a", "--bench", "twin", "--date", "2026-05-31"), "--date"),
        (("--gauge", "twin", "--bench", "emulated"), "simulated gauge"),
        (("--gauge", "twin", "--bench", "twin", "--supply-V", "4.9"), "--supply-V"),
        (("--gauge", "a", "--bench", "twin", "--full-scale-MPa", "70"), "--full-scale-MPa"),
        (("--gauge", "a", "--bench", "replay:x"), "replay"),
        (("--gauge", "a", "--bench", "twin", "--out", "bench.txt"), ".yaml"),
    ],
)
def test_usage(benchlab, arguments: tuple[str, ...], named: str, tmp_path: Path, monkeypatch) -> None:
    monkeypatch.chdir(tmp_path)
    done = benchlab("bench", "calibrate", *arguments)
    assert done.code == 2 and named in done.err
