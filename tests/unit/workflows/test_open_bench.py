"""From `--bench` and `--calibration` to a bench."""

import math
from pathlib import Path

import pytest

from benchlab.bench import Bench
from benchlab.errors import InputError, UsageError
from benchlab.io.journal import JournalWriter
from benchlab.workflows.open_bench import Spec, bench_doubts, bench_of, open_bench, spec_of, twin_of
from tests.benches import write_bench


def test_a_bench_is_named_by_kind_and_place() -> None:
    assert spec_of("twin") == Spec("twin") and str(spec_of("twin:a.yaml")) == "twin:a.yaml"
    assert spec_of("serial:COM3").where == "COM3" and spec_of("replay:a:b").where == "a:b"
    for wrong in ("", "Twin", "serial", "replay:", "emulated:1", "usb:1"):
        with pytest.raises(UsageError, match="--bench"):
            spec_of(wrong)


def test_what_a_bench_may_be_asked_for_without_a_file() -> None:
    twin, metal = bench_of(spec_of("twin")), bench_of(spec_of("serial:x"))
    assert twin.ceiling_MPa == 0.35 and twin.monitor is not None and twin.flex is not None
    assert not metal.calibrated and metal.ceiling_MPa < 0.336
    assert bench_doubts(spec_of("serial:x"), metal) and not bench_doubts(spec_of("twin"), twin)


def test_a_calibration_file_goes_before_all(tmp_path: Path) -> None:
    path = tmp_path / "bench.yaml"
    write_bench(path, Bench("lab", limit_MPa=0.2, gauge="Keller", date="2026-01-02", calibrated=True))
    for text in ("twin", "emulated", "serial:x"):
        assert bench_of(spec_of(text), path).ceiling_MPa == 0.2


def test_no_bench_of_metal_on_the_calibration_of_a_twin(tmp_path: Path) -> None:
    path = tmp_path / "bench.yaml"
    write_bench(path, Bench("lab", gauge="simulated gauge of the twin", date="2026-01-02", calibrated=True))
    with pytest.raises(InputError, match="no pressure of a bench of metal may rest on it"):
        bench_of(spec_of("serial:x"), path)
    assert bench_of(spec_of("twin"), path).name == "lab"


def test_a_replay_has_the_bench_of_its_run(tmp_path: Path) -> None:
    from dataclasses import asdict

    bench = Bench("that one", limit_MPa=0.3, calibrated=True)
    JournalWriter(tmp_path / "a.journal", {"bench": asdict(bench)}).close()
    found = bench_of(spec_of(f"replay:{tmp_path / 'a.journal'}"))
    assert (found.name, found.limit_MPa, found.monitor) == ("that one", 0.3, None) and math.isnan(found.regulator.sd)
    JournalWriter(tmp_path / "b.journal", {"title": "no bench"}).close()
    with pytest.raises(InputError, match="which bench"):
        bench_of(spec_of(f"replay:{tmp_path / 'b.journal'}"))
    with pytest.raises(InputError, match="holds no sample"):
        open_bench(f"replay:{tmp_path / 'a.journal'}", bench)


def test_a_seed_is_the_twins_alone() -> None:
    settings = twin_of(spec_of("twin"), seed=9)
    assert settings is not None and settings.seed == 9 and twin_of(spec_of("emulated"), seed=9) is None
    device = open_bench("twin", twin=settings)
    assert device.about()["seed"] == 9 and device.kind == "twin"
    with pytest.raises(UsageError, match="--fast is virtual time"):
        open_bench("serial:x", fast=True)
