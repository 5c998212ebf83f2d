"""What is said to a value in another unit than its key has."""

import pytest

from benchlab.io.yaml_units import in_unit_of_key

KEYS = {
    "to_MPa",
    "to_deg",
    "duration_s",
    "hold_s",
    "rate_MPa_per_s",
    "rate_deg_per_s",
    "frequency_Hz",
    "times",
    "title",
}


@pytest.mark.parametrize(
    ("key", "value", "wanted"),
    [
        ("to", "10 psi", "to_MPa: 0.0689"),  # 1 psi is 6.8948 kPa
        ("to", "2.5bar", "to_MPa: 0.25"),
        ("to_kPa", 35, "to_MPa: 0.035"),
        ("to_bar", 1e-1, "to_MPa: 0.01"),
        ("to_MPa", "350 kPa", "to_MPa: 0.35"),
        ("to_MPa", "0.35 MPa", "to_MPa: 0.35"),
        ("to", "90°", "to_deg: 90"),
        ("to_rad", 3.14159265, "to_deg: 180"),
        ("duration", "2 min", "duration_s: 120"),
        ("hold_ms", 250, "hold_s: 0.25"),
        ("rate", "20 kPa/s", "rate_MPa_per_s: 0.02"),
        ("rate_kPa_per_min", 60, "rate_MPa_per_s: 0.001"),
        ("rate_rad_per_s", 1, "rate_deg_per_s: 57.3"),
        ("frequency_mHz", 200, "frequency_Hz: 0.2"),
    ],
)
def test_is_told_what_to_write(key: str, value: object, wanted: str) -> None:
    assert in_unit_of_key(key, value, KEYS) == wanted


@pytest.mark.parametrize(
    ("key", "value"),
    [
        ("to", 10),  # no unit: nothing to convert from
        ("to_MPa", "0.35"),
        ("to_MPa", True),
        ("to_MPa", "high"),
        ("to_mm", 3),  # no such quantity
        ("to", "3 mm"),
        ("times_kPa", 3),
        ("title", "10 psi"),
        ("to_kPa", None),
        ("to_kPa", [1]),
    ],
)
def test_is_left_to_other_words(key: str, value: object) -> None:
    assert in_unit_of_key(key, value, KEYS) is None
