"""The drawn tensile test of `benchlab sample-data`: a Yeoh film in the layout of a Bluehill raw-data export."""

from __future__ import annotations

import numpy as np

from benchlab.simulation.laws import Polynomial
from benchlab.simulation.laws.homogeneous import nominal_stress_MPa

LAW = Polynomial(C10=1.5, C20=0.3)
THICKNESS_MM, WIDTH_MM, GAUGE_MM = 0.3, 10.0, 50.0
RATE_MM_PER_S, STEP_S, BREAK_AT = 1.0, 0.2, 1.6
NOISE_N = 0.03
AFTER_BREAK_N = (0.9, 0.05, 0.02)


def tensile_text(seed: int) -> str:
    """The file's text: preamble, header, units and rows up to a stretch of 1.6, where the specimen breaks.

    The first line says that it is drawn, and from which law.

    >>> tensile_text(1).splitlines()[5:7]
    ['Time,Extension,Load', '(s),(mm),(N)']
    """
    time = np.arange(0, (BREAK_AT - 1) * GAUGE_MM / RATE_MM_PER_S + STEP_S / 2, STEP_S)
    extension = RATE_MM_PER_S * time
    force = THICKNESS_MM * WIDTH_MM * nominal_stress_MPa(LAW, 1 + extension / GAUGE_MM)
    force += np.random.default_rng(seed).normal(0, NOISE_N, len(force))
    rows = [*zip(time, extension, force)]
    rows += [
        (time[-1] + i * STEP_S, extension[-1] + i * STEP_S * RATE_MM_PER_S, n) for i, n in enumerate(AFTER_BREAK_N, 1)
    ]
    law = "Yeoh C10 1.5 MPa, C20 0.3 MPa, C30 0"
    head = (
        f'Note : Origin,"Drawn by benchlab, not measured: {law}, noise {NOISE_N} N"',
        f'Specimen : Thickness,"{THICKNESS_MM:.5f}",mm',
        f'Specimen : Width,"{WIDTH_MM:.5f}",mm',
        f'Length,"{GAUGE_MM:.5f}",mm',
        "",
        "Time,Extension,Load",
        "(s),(mm),(N)",
    )
    return "".join(f"{line}\n" for line in (*head, *(f'"{t:.5f}","{x:.5f}","{f:.5f}"' for t, x, f in rows)))
