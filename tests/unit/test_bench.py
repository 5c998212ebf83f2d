"""Pressure, volts and codes: whatever the calibration, nothing that is asked for crosses the limit."""

import math

import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from benchlab.bench import DAC_CODES, NOMINAL_GAIN_MPA_PER_V, Bench, LimitError, Line, new_bench
from benchlab.errors import InputError

TINY_MPA = 1e-9


@st.composite
def benches(draw: st.DrawFn) -> Bench:
    gain = draw(st.floats(0.01, 1.0))
    offset = draw(st.floats(-2 * gain, 0.05 * gain))
    full_scale = (5 * gain + offset) * draw(st.floats(0.92, 1.08))
    limit = draw(st.floats(0.1, 1.0)) * min(1.0, full_scale)
    assume(offset <= 0.1 * limit and offset >= -1)
    supply, calibrated = draw(st.floats(4.5, 5.5)), draw(st.booleans())
    line = Line(gain, offset)
    return Bench(
        "any",
        line,
        limit_MPa=limit,
        limit_reason="a test",
        full_scale_MPa=full_scale,
        supply_V=supply,
        calibrated=calibrated,
    )


@given(benches(), st.floats(0, 1))
def test_a_code_never_gives_more_than_was_asked_for_nor_than_the_limit(bench: Bench, part: float) -> None:
    asked = part * bench.ceiling_MPa
    code = bench.code(asked)
    assert 0 <= code <= bench.ceiling_code < DAC_CODES
    # At code 0 nothing is asked of the regulator; its own offset is all that is left.
    assert bench.pressure_MPa(code) <= max(asked, bench.regulator.offset) + TINY_MPA
    assert bench.pressure_MPa(bench.ceiling_code) <= bench.limit_MPa + TINY_MPA


@given(benches(), st.floats(0, 1))
def test_a_code_is_the_last_that_does_not_give_more(bench: Bench, part: float) -> None:
    asked = part * bench.ceiling_MPa
    code = bench.code(asked)
    assume(asked > 0 and code < bench.ceiling_code)
    assert bench.regulator.of(bench.volts(code + 1)) > asked - TINY_MPA


@given(benches(), st.floats(0, 1), st.floats(0, 1))
def test_more_pressure_is_never_a_smaller_code(bench: Bench, one: float, other: float) -> None:
    low, high = sorted((one * bench.ceiling_MPa, other * bench.ceiling_MPa))
    assert bench.code(low) <= bench.code(high)


@given(benches(), st.floats(4.5, 5.25))
def test_without_a_calibration_the_limit_holds_whatever_the_usb_supply(bench: Bench, true_supply_V: float) -> None:
    assume(not bench.calibrated)
    assert bench.volts(bench.ceiling_code) <= 3.50
    true_volts = true_supply_V * bench.ceiling_code / DAC_CODES
    assert true_volts <= 3.50 + TINY_MPA or bench.supply_V > 5.25
    if bench.ceiling_code and bench.supply_V <= 5.25:
        assert bench.regulator.of(true_volts) <= bench.limit_MPa + TINY_MPA


@given(benches(), st.floats(allow_nan=True, allow_infinity=True))
def test_what_is_outside_is_refused_and_never_clipped(bench: Bench, pressure: float) -> None:
    assume(not 0 <= pressure <= bench.ceiling_MPa + TINY_MPA)
    with pytest.raises(LimitError):
        bench.code(pressure)


def test_the_paper_s_limit_is_code_2986_and_what_that_gives_at_other_supplies() -> None:
    bench = Bench("paper", calibrated=True)
    assert bench.ceiling_code == bench.code(0.35) == 2986
    assert bench.volts(2986) == pytest.approx(3.646, abs=1e-3)
    for supply, pressure_kPa in ((4.5, 315), (5.25, 367)):
        real_volts = supply * 2986 / DAC_CODES
        assert 1000 * NOMINAL_GAIN_MPA_PER_V * real_volts == pytest.approx(pressure_kPa, abs=0.6)
    assert 1000 * bench.pressure_MPa(1) == pytest.approx(0.117, abs=5e-4)


@pytest.mark.parametrize(("supply_V", "code"), [(4.5, 3318), (5.25, 2844)])
def test_a_measured_supply_changes_the_code_so_that_the_pressure_stays(supply_V: float, code: int) -> None:
    bench = Bench("measured", supply_V=supply_V, calibrated=True)
    assert bench.code(0.35) == code  # floor(3.6458 V / supply · 4096)
    assert bench.pressure_MPa(code) == pytest.approx(0.35, abs=0.48 / 4096 * 1.05)


def test_without_a_calibration_less_is_given() -> None:
    bench = Bench("new")
    assert bench.ceiling_code == 2730  # 0.35 MPa on 5.25 V by a regulator of 0.5 MPa at 5 V
    assert pytest.approx(0.35, abs=0.0001) == 0.1 * 5.25 * 2730 / DAC_CODES
    assert bench.ceiling_MPa == pytest.approx(0.32)
    with pytest.raises(LimitError, match="calibrate the bench"):
        bench.code(0.35)
    weak = new_bench("weak", limit_MPa=0.2, full_scale_MPa=0.2)
    assert weak.volts(weak.ceiling_code) == pytest.approx(3.5 * 5 / 5.25, abs=0.002)


@pytest.mark.parametrize(
    ("changes", "named"),
    [
        ({"limit_MPa": 0.0}, "limit_MPa"),
        ({"limit_MPa": math.nan}, "limit_MPa"),
        ({"limit_MPa": 350.0}, "limit_MPa"),
        ({"limit_MPa": 0.36}, "limit_reason"),
        ({"limit_MPa": 0.5, "limit_reason": "a test"}, "full_scale_MPa"),
        ({"regulator": Line(0.084, 0.0)}, "label"),
        ({"regulator": Line(0.108, 0.0)}, "label"),
        ({"supply_V": 3.3}, "supply_V"),
        ({"supply_V": math.nan}, "supply_V"),
        ({"regulator": Line(-0.096, 0.0)}, "gain"),
        ({"regulator": Line(96.0, 0.0)}, "gain"),
        ({"regulator": Line(math.nan, 0.0)}, "gain"),
        ({"regulator": Line(0.096, math.nan)}, "offset_MPa"),
        ({"regulator": Line(0.096, 0.2)}, "vents at 0 V"),
        ({"monitor": Line(math.inf, 0.0)}, "monitor"),
        ({"monitor": Line(0.1, math.nan)}, "monitor"),
        ({"flex": Line(0.0, 1.0)}, "flex"),
        ({"flex": Line(math.nan, 1.0)}, "flex"),
        ({"flex": Line(30.0, math.inf)}, "flex"),
    ],
)
def test_numbers_that_no_bench_has_are_refused(changes: dict, named: str) -> None:
    with pytest.raises(InputError, match=named):
        Bench("odd", **changes)


def test_a_regulator_that_starts_at_one_volt_is_driven_from_there_and_vented_by_zero() -> None:
    bench = Bench("1 to 5 V", Line(0.12, -0.12), calibrated=True)
    assert bench.code(1e-6) == math.floor(4096 / 5)
    assert bench.code(0.0) == 0 and bench.pressure_MPa(0) == 0.0
