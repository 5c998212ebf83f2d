"""The sketch as it is written for the Arduino IDE: whole, into a folder of its name, or not at all."""

from pathlib import Path

import pytest

from benchlab.bench import Bench
from benchlab.devices import firmware
from benchlab.errors import InputError, UsageError
from benchlab.workflows.bench_firmware import write_firmware

BENCH = Bench("a", calibrated=True, limit_MPa=0.2)


def test_the_sketch_has_the_benchs_ceiling_and_says_it(tmp_path: Path) -> None:
    path = write_firmware(tmp_path / "nano", BENCH)
    assert path == tmp_path / "nano" / "benchlab_nano" / "benchlab_nano.ino"
    (line,) = (line for line in path.read_text().splitlines() if line.startswith("#define CEILING_CODE"))
    assert (
        line
        == f"#define CEILING_CODE {BENCH.ceiling_code} /* codes above are refused: 0.2 MPa, 2.083 V at a supply of 5 V */"
    )


def test_a_sketch_is_replaced_only_when_asked(tmp_path: Path) -> None:
    path = write_firmware(tmp_path, BENCH)
    path.write_text("mine")
    with pytest.raises(UsageError, match=r"benchlab_nano.ino: exists"):
        write_firmware(tmp_path, BENCH)
    assert path.read_text() == "mine"
    assert "CEILING_CODE" in write_firmware(tmp_path, BENCH, overwrite=True).read_text()


@pytest.mark.parametrize("place", ["none/here", "taken", "taken/below"])
def test_where_it_cannot_lie(tmp_path: Path, place: str) -> None:
    (tmp_path / "taken").write_text("")
    with pytest.raises((UsageError, InputError), match=r"no such folder|is a file"):
        write_firmware(tmp_path / place, BENCH)


def test_a_sketch_without_a_ceiling_is_never_written(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    (tmp_path / "firmware" / "benchlab_nano").mkdir(parents=True)
    (tmp_path / "firmware" / "benchlab_nano" / "benchlab_nano.ino").write_text("#define CEILING 4095")
    monkeypatch.setattr(firmware, "files", lambda package: tmp_path)
    with pytest.raises(ValueError, match="0 ceilings"):
        write_firmware(tmp_path / "nano", BENCH)
    assert not list(tmp_path.glob("nano/benchlab_nano/*"))


@pytest.mark.parametrize("gauge", ["simulated gauge of the twin", "simulated bench (emulated): a", "none: simulated"])
def test_no_sketch_rests_on_a_calibration_of_a_twin(tmp_path: Path, gauge: str) -> None:
    with pytest.raises(InputError, match="bench of metal"):
        write_firmware(tmp_path / "nano", Bench("a", gauge=gauge, calibrated=True))
    assert not list(tmp_path.iterdir())
