"""What each effect of the twin does to the loop of loading and unloading: `python tests/benchmarks/twin_effects_figure.py` draws
docs/images/twin_effects.png. Simulated: each effect alone, at its typical values."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np

from benchlab.cubic import Cubic
from benchlab.io.twin_file import read_twin
from benchlab.report.figures import figure_class, save_png
from benchlab.report.panels import BLUE, GREY
from benchlab.twin.effects.catalogue import EFFECTS, FAULTS
from benchlab.twin.effects.effect import Effect
from benchlab.twin.lines import FLEX
from benchlab.twin.plant import Plant
from benchlab.twin.settings import TwinSettings
from benchlab.units import FloatArray

IMAGE = Path(__file__).resolve().parents[2] / "docs" / "images" / "twin_effects.png"
ORANGE = "#D55E00"
PEAK_MPA = 0.35
RATES = {"0.35 MPa/s": (0.35, ORANGE, 1.3), "0.014 MPa/s": (0.014, BLUE, 1.0)}
CYCLES = 2
WORDS = {
    "": "the twin as it comes",
    "camera_scale": "camera_scale, 2 %",
    "clock_offset": "clock_offset, 50 ms",
}
COLUMNS = ("pressure", "true", "felt", "camera", "monitor")


def loop(settings: TwinSettings, rate: float) -> dict[str, FloatArray]:
    """Two cycles to 0.35 MPa and back at a rate; columns of COLUMNS, and time_s."""
    period = 2 * PEAK_MPA / rate
    times = np.linspace(0, CYCLES * period, 4001)
    asked = PEAK_MPA * (1 - np.abs(1 - (times / period * 2) % 2))
    plant, rows, held = Plant(settings), [], 0.0
    steps = "dac_steps" in settings.effects
    for t, p in zip(times.tolist(), asked.tolist()):
        plant.advance(t)
        felt = FLEX.of(plant.seen("flex_V", FLEX.inverse(plant.felt_deg)))
        seen = plant.seen("camera", plant.angle_deg)
        rows.append((held, plant.angle_deg, felt, seen, plant.seen("monitor", plant.regulator_MPa)))
        step = 0.48 / 4096
        plant.ask(np.floor(p / step + 1e-9) * step if steps else p)
        held = p
    return dict(zip(("time_s", *COLUMNS), [times, *np.array(rows).T]))


def off_curve(name: str, effect: Effect | None, rate: float) -> tuple[FloatArray, FloatArray]:
    """Recorded pressure, and seen angle less the response curve there."""
    base = read_twin(None)
    settings = base if effect is None else replace(base, effects={name: effect})
    found = loop(settings, rate)
    angle = {"marker_offset": "camera", "flex_hysteresis": "felt", "sensor_noise": "felt"}.get(name, "true")
    pressure = found["monitor"] if name.startswith("pressure_") else found["pressure"]
    seen = found[angle]
    if name == "camera_scale":
        seen = seen / effect.factor
    if name == "clock_offset":
        seen = np.interp(found["time_s"] - effect.ahead_s, found["time_s"], seen)
    at_rest = Cubic(base.curve.pressure_MPa, base.curve.angle_deg)
    known = pressure <= base.curve.last_MPa
    return pressure[known], seen[known] - np.array([at_rest.value(p) for p in pressure[known].tolist()])


def draw(path: Path = IMAGE) -> Path:
    names = ["", *(name for name in EFFECTS if name not in FAULTS)]
    figure = figure_class()(figsize=(12.6, 10.2), dpi=105)
    axes = figure.subplots(4, 5, sharex=True).ravel()
    for ax, name in zip(axes, names):
        effect = EFFECTS[name]() if name else None
        for words, (rate, colour, width) in RATES.items():
            pressure, off = off_curve(name, effect, rate)
            ax.plot(1000 * pressure, off, color=colour, lw=width, label=words)
        ax.axhline(0, color=GREY, lw=0.6, zorder=0)
        ax.set_title(WORDS.get(name, name), fontsize=10, fontweight="bold" if not name else None)
        ax.spines[["top", "right"]].set_visible(False)
        ax.tick_params(labelsize=8)
        low, high = ax.get_ylim()
        if high - low < 1:
            middle = (high + low) / 2
            ax.set_ylim(middle - 0.5, middle + 0.5)
    for ax in axes[-5:]:
        ax.set_xlabel("pressure (kPa)", fontsize=9)
    for ax in axes[::5]:
        ax.set_ylabel("angle less curve (°)", fontsize=9)
    last = axes[-1]
    last.axis("off")
    last.legend(*axes[0].get_legend_handles_labels(), loc="center", frameon=False, fontsize=10)
    figure.suptitle(
        "Simulated: what each effect alone, at its typical values, does to two cycles of loading and unloading (tw 3, slw 10)\n"
        "Angle that is seen less the response curve at the pressure that is recorded",
        fontsize=11,
    )
    figure.tight_layout(rect=(0, 0, 1, 0.985))
    save_png(figure, path)
    return path


if __name__ == "__main__":
    print(f"wrote {draw()}")
