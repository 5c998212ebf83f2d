"""The calibration that a twin's bench has: exact, since a twin's regulator and sensors are known."""

from __future__ import annotations

from benchlab.bench import Bench
from benchlab.twin.lines import FLEX, MONITOR, REGULATOR, SUPPLY_V
from benchlab.twin.settings import TwinSettings

LIMIT_MPa = 0.35


def twin_bench(settings: TwinSettings | None = None) -> Bench:
    """A bench whose calibration is the truth. settings: of a twin whose curve may end below the limit of 0.35 MPa.

    >>> bench = twin_bench()
    >>> bench.gauge, bench.code(0.35), bench.flex.of(1.0)
    ('none: simulated', 2986, 0.0)
    """
    limit_MPa = LIMIT_MPa if settings is None else min(LIMIT_MPa, settings.curve.last_MPa)
    return Bench(
        name="twin",
        regulator=REGULATOR,
        monitor=MONITOR,
        flex=FLEX,
        limit_MPa=limit_MPa,
        supply_V=SUPPLY_V,
        gauge="none: simulated",
        calibrated=True,
    )
