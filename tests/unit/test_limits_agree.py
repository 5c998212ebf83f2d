"""The limit stands in four places, plan, bench, firmware and twin: they agree for every bench."""

import re

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from benchlab.bench import Bench, LimitError
from benchlab.devices.firmware import firmware_text
from benchlab.devices.twin.twin import Twin
from benchlab.errors import InputError
from benchlab.io.twin_file import read_twin
from benchlab.protocol.checks import check_limits
from benchlab.protocol.segments import Hold
from benchlab.protocol.unroll import unroll
from tests.unit.test_bench import benches


def allowed(call, error: type[Exception]) -> bool:
    try:
        call()
    except error:
        return False
    return True


@settings(max_examples=60, deadline=None)
@given(benches(), st.floats(0.5, 1.5))
def test_plan_and_bench_allow_the_same_pressures(bench: Bench, part: float) -> None:
    pressure = part * bench.ceiling_MPa
    if not 0.001 < pressure < 1 or abs(part - 1) < 1e-6:
        return
    plan = unroll([Hold(0.1, pressure)], "a", 100.0, 1.0)
    by_plan = allowed(lambda: check_limits(plan, bench), InputError)
    assert by_plan == allowed(lambda: bench.code(pressure), LimitError) == (part < 1)


@given(benches())
def test_the_firmware_takes_every_code_of_its_bench_and_none_above(bench: Bench) -> None:
    (ceiling,) = re.findall(r"#define CEILING_CODE (\d+) ", firmware_text(bench))
    assert bench.code(bench.ceiling_MPa) <= bench.ceiling_code == int(ceiling)


@pytest.mark.parametrize("calibrated", [True, False])
def test_the_twin_refuses_what_its_bench_refuses(calibrated: bool) -> None:
    bench = Bench("twin", calibrated=calibrated)
    twin = Twin(read_twin(None), bench)
    twin.arm()
    twin.exchange(0.0, bench.ceiling_MPa)
    for pressure in (bench.ceiling_MPa + 1e-6, -1e-6, float("nan"), float("inf")):
        with pytest.raises(LimitError):
            twin.exchange(0.1, pressure)
    twin.vent()
