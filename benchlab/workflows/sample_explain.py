"""The drawn study of `benchlab explain` among the sample data: designs in closed form, and an effect that only the measurements have."""

from __future__ import annotations

import numpy as np

from benchlab.units import FloatArray

FOLDER = "explain"
ORIGIN = "simulated (drawn by benchlab)"

FINAL_DEG = {"narrow": 110.0, "middle": 80.0, "wide": 55.0}
"""Angle at TOP_MPa of three made-up designs."""

TOP_MPa, CONCAVITY = 0.35, 0.35
SAMPLES, RATE_HZ = 4, 8.0

PLAY_DEG_PER_MPa = 14.0
"""Half width of the play between bladder and shell, in proportion to the pressure: what the simulation lacks."""

RUNS = {"slow": (20.0, 1), "fast": (2.0, 2)}
"""Time from 0 to TOP_MPa and back to 0 by half, and cycles."""

GAIN_SD, SHAPE_SD, NOISE_DEG = 0.02, 0.01, 0.2
"""By how much samples differ, and noise of a reading."""


def curve_deg(design: str, pressure_MPa: FloatArray) -> FloatArray:
    """θ = θ_top·x·(1 + c·(1 − x)), x = p/p_top: what both the simulation and the samples have.

    >>> curve_deg("middle", np.array([0.0, 0.35])).tolist()
    [0.0, 80.0]
    """
    x = pressure_MPa / TOP_MPa
    return np.asarray(FINAL_DEG[design] * x * (1 + CONCAVITY * (1 - x)))


def simulated_rows() -> list[dict[str, object]]:
    """Rows of simulated.csv: the curves alone."""
    pressure = np.linspace(0, TOP_MPa, 15)
    return [
        {"design": design, "pressure_MPa": f"{p:g}", "angle_deg": f"{angle:.3f}"}
        for design in FINAL_DEG
        for p, angle in zip(pressure, curve_deg(design, pressure))
    ]


def measured_rows(seed: int) -> list[dict[str, object]]:
    """Rows of loops.csv: every sample runs a slow cycle and two fast ones."""
    rng = np.random.default_rng([seed, 11])
    rows: list[dict[str, object]] = []
    for design in FINAL_DEG:
        for sample in range(1, SAMPLES + 1):
            gain, wave = 1 + GAIN_SD * rng.standard_normal(), SHAPE_SD * rng.standard_normal()
            for run, (half_s, cycles) in RUNS.items():
                time_s, pressure, cycle = _triangles(half_s, cycles)
                shape = gain + wave * np.cos(np.pi * pressure / TOP_MPa)
                angle = played(shape * curve_deg(design, pressure), PLAY_DEG_PER_MPa * pressure)
                seen = angle + NOISE_DEG * rng.standard_normal(len(angle))
                rows += [
                    {
                        "design": design,
                        "sample": f"s{sample}",
                        "run": run,
                        "cycle": n,
                        "time_s": f"{t:g}",
                        "pressure_MPa": f"{p:.4f}",
                        "angle_deg": f"{a:.2f}",
                        "origin": ORIGIN,
                    }
                    for n, t, p, a in zip(cycle.tolist(), time_s, pressure, seen)
                ]
    return rows


def played(wish: FloatArray, half: FloatArray) -> FloatArray:
    """(T,) follows the wish with play ± half: it stands still until the wish has moved by the play.

    >>> played(np.array([0.0, 2.0, 4.0, 3.0, 1.0]), np.full(5, 1.0)).tolist()
    [0.0, 1.0, 3.0, 3.0, 2.0]
    """
    out = np.zeros_like(wish)
    for i in range(1, len(wish)):
        out[i] = np.clip(out[i - 1], wish[i] - half[i], wish[i] + half[i])
    return out


def _triangles(half_s: float, cycles: int) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Times, pressures and the number of the cycle, from 1."""
    time_s = np.arange(round(2 * half_s * cycles * RATE_HZ) + 1) / RATE_HZ
    phase = time_s / half_s % 2
    cycle = np.minimum(time_s // (2 * half_s), cycles - 1).astype(int) + 1
    return time_s, TOP_MPa * np.minimum(phase, 2 - phase), cycle
