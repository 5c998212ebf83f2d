"""Scenes for tests: five designs with curves in closed form, driven slowly, fast and with a hold."""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np

from benchlab.actuator import ShellDesign
from benchlab.discrepancy.base import Base, DesignBase, Knob
from benchlab.discrepancy.scene import Scene

TOP_MPa = 0.35
SHAPES = [(3, 10), (3, 5), (3, 20), (9, 10), (15, 10)]
"""(tw, slw) of the designs, in the order in which they are taken."""

KINDS: dict[str, tuple[tuple[float, ...], tuple[float, ...], int]] = {
    "slow": ((0, 30, 60), (0, TOP_MPa, 0), 121),
    "fast": ((0, 2.5, 5, 7.5, 10, 12.5, 15), (0, TOP_MPa, 0, TOP_MPa, 0, TOP_MPa, 0), 151),
    "hold": ((0, 5, 25, 30), (0, 0.3, 0.3, 0), 151),
    "up": ((0, 30), (0, TOP_MPa), 61),
    "still": ((0,), (TOP_MPa,), 1),
}
"""Corners in time (s) and pressure (MPa), and number of points, of each kind of run."""

KNOBS = {
    "film_modulus": np.array([0.5, 0.75, 1.0, 1.3, 1.6]),
    "fabric_modulus": np.array([0.25, 0.5, 1.0, 2.0, 3.0]),
    "seam_margin_mm": np.array([0.0, 0.3, 0.6, 0.9, 1.2]),
    "bladder_N_per_mm": np.array([0.0, 0.5, 1.0, 2.0, 3.0]),
    "ballooning": np.array([0.0, 0.25, 0.5, 0.75, 1.0]),
}


def angle_deg(pressure_MPa: np.ndarray | float, slw_mm: float = 10, tw_mm: float = 3) -> np.ndarray:
    """Angle in closed form: steep at first, 110° at the top for tw 3, slw 10."""
    full = 110 * np.exp(-((slw_mm - 9) ** 2) / 200) * (3 / tw_mm) ** 0.35
    return np.asarray(full * (1 - np.exp(-np.asarray(pressure_MPa) / 0.2)) / (1 - np.exp(-TOP_MPa / 0.2)))


def knob(name: str, pressure_MPa: np.ndarray, slw_mm: float, tw_mm: float) -> Knob:
    """Factors of plausible size, which differ between designs and grow with pressure."""
    values = KNOBS[name]
    grow = 0.8 + 0.4 * pressure_MPa / TOP_MPa
    power: dict[str, Callable[[np.ndarray], np.ndarray]] = {
        "film_modulus": lambda v: -(0.6 + 0.02 * tw_mm) * np.log(v),
        "fabric_modulus": lambda v: -0.1 * (1 + slw_mm / 20) * np.log(v),
        "seam_margin_mm": lambda v: -0.4 * v / tw_mm * 3,
        "bladder_N_per_mm": lambda v: -(0.1 + 0.01 * tw_mm) * v,
        "ballooning": lambda v: -0.03 * tw_mm * v,
    }
    factor = np.exp(power[name](values)[:, None] * grow)
    return Knob(values, {"angle_deg": factor, "volume_mL": factor**0.3, "force_N": factor**0.2})


def base(designs: int = 5, *, knobs: Sequence[str] = tuple(KNOBS), known: bool = True, kind: str = "cell") -> Base:
    """Base in closed form; known: whether the designs' dimensions are (else no shapes, no knobs)."""
    pressure = np.linspace(0, TOP_MPa, 36)
    found = {}
    for tw, slw in SHAPES[:designs]:
        shape = ShellDesign(strip_width_mm=slw, window_width_mm=tw)
        curves = {
            "angle_deg": angle_deg(pressure, slw, tw),
            "volume_mL": 15 + (4 + 0.2 * tw) * (1 - np.exp(-pressure / 0.15)) + 5 * pressure,
            "force_N": 100 * pressure * (1 - slw / 100),
            "stiffness_Nmm2": (8000 + 300 * slw) * (1 + pressure),
        }
        own = {name: knob(name, pressure, slw, tw) for name in knobs} if known else {}
        found[shape.name] = DesignBase(shape.name, pressure, curves, shape if known else None, own)
    return Base(found, kind, "closed form, for tests")


def scene(
    protocol: Sequence[str] = ("slow", "fast", "hold"),
    designs: int = 5,
    samples: int = 1,
    *,
    on: Base | None = None,
    ordered: bool = True,
    points: int = 1,
    command: bool = False,
    start_s: float | None = None,
    orientation_deg: float | None = None,
    temperature_C: float | None = None,
) -> Scene:
    """Each sample of each design does the runs of `protocol` (keys of KINDS) one after another.

    points: each step of time is cut into so many. command: the command is known, and is what was recorded. start_s: of a sample's first
    run; the next begin 100 s apart.
    """
    on = on or base(designs)
    times = [_times(kind, points) for kind in protocol]
    runs = designs * samples * len(protocol)
    length = max(len(t) for t in times)
    time, pressure, real = np.empty((length, runs)), np.empty((length, runs)), np.zeros((length, runs), bool)
    for run in range(runs):
        at = times[run % len(protocol)]
        corners_s, corners_MPa, _ = KINDS[protocol[run % len(protocol)]]
        time[:, run] = np.append(at, np.full(length - len(at), at[-1]))
        pressure[:, run] = np.interp(time[:, run], corners_s, corners_MPa)
        real[: len(at), run] = True
    index = np.arange(runs)
    place = (index % len(protocol)).astype(float)
    nan = np.full(runs, np.nan)
    return Scene(
        base=on,
        names=tuple(on.designs)[:designs],
        design=index // (samples * len(protocol)),
        sample=index // len(protocol),
        order=place if ordered else nan,
        time_s=time,
        pressure_MPa=pressure,
        command_MPa=pressure.copy() if command else np.full_like(pressure, np.nan),
        temperature_C=np.full_like(pressure, np.nan if temperature_C is None else temperature_C),
        real=real,
        start_s=nan if start_s is None else start_s + 100 * place,
        orientation_deg=nan if orientation_deg is None else np.full(runs, orientation_deg),
    )


def _times(kind: str, points: int) -> np.ndarray:
    corners_s, _, number = KINDS[kind]
    return np.linspace(0, corners_s[-1], (number - 1) * points + 1)
