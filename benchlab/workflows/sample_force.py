"""The drawn force records of `benchlab sample-data`: three actuators held against a load cell, each as another machine exports it."""

from __future__ import annotations

import math

import numpy as np

from benchlab.force.synthetic import CycleShape, DrawnTrace, draw_trace
from benchlab.io.published import BLOCKED_FORCE
from benchlab.units import FloatArray

STEPS_MPA = tuple(round(0.035 * step, 3) for step in range(1, 11))
CYCLES = 5
PUBLISHED_N = (BLOCKED_FORCE.mean_N, BLOCKED_FORCE.sd_N)

RATE_HZ = 20.0
CYCLE_N = 0.15
"""Standard deviation of cycles about their actuator's force. Our choice."""

NOISE_N = 0.04
ZERO_N = (1.4, -0.6, 0.2)
DRIFT_N_PER_S = (0.002, -0.001, 0.003)
SHAPE = CycleShape(rise_s=0.5, hold_s=1.5, fall_s=0.4, rest_s=1.6)
LBF_N, KN_N = 4.4482216152605, 1000.0
ORIGIN = "drawn by benchlab, not measured"


def actuators_N(seed: int) -> FloatArray:
    """(3,) blocked force of each actuator at 0.35 MPa."""
    return np.random.default_rng([seed, 3]).normal(*PUBLISHED_N, len(ZERO_N)).round(4)


def drawn_record(seed: int, actuator: int) -> DrawnTrace:
    """The record of one actuator (0, 1, 2): ten steps of five cycles, with the true peaks."""
    rng = np.random.default_rng([seed, 5, actuator])
    levels = np.repeat(STEPS_MPA, CYCLES)
    peaks = actuators_N(seed)[actuator] * levels / STEPS_MPA[-1] + rng.normal(0, CYCLE_N, len(levels))
    return draw_trace(
        peaks.tolist(), levels.tolist(), rng, rate_Hz=RATE_HZ, noise_N=NOISE_N, offset_N=ZERO_N[actuator],
        drift_N_per_s=DRIFT_N_PER_S[actuator], uneven=0.05, shape=SHAPE,
    )  # fmt: skip


def force_files(seed: int) -> dict[str, str | bytes]:
    """The files by their place in the folder: English in N, German in kN (CP1252), imperial in lbf. Each says that it is drawn.

    >>> list(force_files(1))
    ['force/tw3_slw10_a1.csv', 'force/tw3_slw10_a2.csv', 'force/tw3_slw10_a3.csv']
    """
    english, german, imperial = (drawn_record(seed, actuator) for actuator in range(3))
    return {
        "force/tw3_slw10_a1.csv": _english(english),
        "force/tw3_slw10_a2.csv": _german(german).encode("cp1252"),
        "force/tw3_slw10_a3.csv": _imperial(imperial),
    }


def force_rows(seed: int) -> list[dict[str, object]]:
    """Rows of truth_force.csv: one per cycle of every actuator, without noise and zero."""
    return [
        {
            "file": f"force/tw3_slw10_a{actuator + 1}.csv",
            "cycle": cycle,
            "pressure_MPa": f"{level:g}",
            "peak_N": f"{peak:.4f}",
        }
        for actuator in range(3)
        for drawn in [drawn_record(seed, actuator)]
        for cycle, (level, peak) in enumerate(zip(drawn.levels_MPa, drawn.peaks_N), start=1)
    ]


def _english(drawn: DrawnTrace) -> str:
    head = (
        "Specimen properties : Specimen label,tw3_slw10 a1",
        f'Specimen properties : Specimen note 1,"{ORIGIN}"',
        "Specimen properties : Test,blocked force: 10 steps of 5 cycles to 0.35 MPa",
        "",
        "Time,Displacement,Force",
        "(s),(mm),(N)",
    )
    rows = (f'"{t:.4f}","{0:.4f}","{force:.4f}"' for t, force in zip(drawn.time_s, drawn.force_N))
    return _lines(*head, *rows)


def _german(drawn: DrawnTrace) -> str:
    head = (
        'Texteingaben : Probenbeschriftung;"tw3_slw10 a2"',
        f'Texteingaben : Anmerkung;"gezeichnet von benchlab, nicht gemessen ({ORIGIN})"',
        'Texteingaben : Prüfung;"Blockierkraft: 10 Stufen zu 5 Zyklen bis 0,35 MPa"',
        "",
        "Zeit;Traversenweg;Last",
        "(sec);(mm);(kN)",
    )
    rows = (f"{t:.3f};{0:.4f};{force / KN_N:.7f}".replace(".", ",") for t, force in zip(drawn.time_s, drawn.force_N))
    return _lines(*head, *rows)


def _imperial(drawn: DrawnTrace) -> str:
    head = (
        'Specimen properties : Specimen label,"tw3_slw10 a3"',
        f'Specimen properties : Comments,"{ORIGIN}"',
        "",
        "Time,Extension,Load",
        "(s),(in),(lbf)",
    )
    rows = (f'"{t:.5f}","{0:.5f}","{force / LBF_N:.5f}"' for t, force in zip(drawn.time_s, drawn.force_N))
    return _lines(*head, *rows)


def _lines(*lines: str) -> str:
    return "".join(f"{line}\n" for line in lines)


def drawn_words(seed: int) -> str:
    """The three forces at 0.35 MPa as drawn, in words."""
    forces = actuators_N(seed)
    spread = math.sqrt(float(np.square(forces - forces.mean()).sum()) / (len(forces) - 1))
    return f"{', '.join(f'{force:.2f}' for force in forces)} N: {forces.mean():.2f} ± {spread:.2f} N"
