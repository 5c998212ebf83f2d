"""What each effect of the vocabulary does to a simulated curve: `python -m tests.benchmarks.effects_figure` draws docs/images/effects.png.

The base is the one of the tests, in closed form; each effect is alone, plain, at its typical values.
"""

from __future__ import annotations

from pathlib import Path

from benchlab.discrepancy.effects.catalogue import built_in
from benchlab.discrepancy.effects.effect import Active, Effect
from benchlab.discrepancy.predict import predict
from benchlab.report.figures import figure_class, save_png
from benchlab.report.panels import BLUE, GREY
from benchlab.units import FloatArray
from tests.unit.discrepancy.scenes import base, scene

IMAGE = Path(__file__).resolve().parents[2] / "docs" / "images" / "effects.png"
ORANGE = "#D55E00"
LINES = {
    "tw 3, 3 cycles at 0.14 MPa/s": (1, ORANGE, "-", 1.0),
    "tw 3, one at 0.012 MPa/s": (0, BLUE, "-", 1.3),
    "tw 15, one at 0.012 MPa/s": (2, BLUE, ":", 1.3),
}
"""Column of the scene, colour, line and width."""


def change(effect: Effect) -> tuple[str, FloatArray, FloatArray, FloatArray]:
    """Quantity that is looked at; recorded pressure, change of the quantity, and which points are of the runs, (T, R) each."""
    on = base(5, kind="beam")
    designs = {name: on.designs[name] for name in ("tw3_slw10", "tw15_slw10")}
    runs = scene(("slow", "fast"), 2, on=type(on)(designs, "beam", on.source), start_s=0.0, points=4)
    quantity = "angle_deg" if "angle_deg" in effect.seen_in else effect.seen_in[0]
    values = {parameter.name: parameter.typical for parameter in effect.parameters}
    changed = predict(runs, [Active(effect, values)], (quantity,))[quantity]
    return quantity, runs.pressure_MPa, changed - predict(runs, [], (quantity,))[quantity], runs.real


def draw(path: Path = IMAGE) -> Path:
    figure = figure_class()(figsize=(13.5, 9.2), dpi=105)
    axes = figure.subplots(4, 6, sharex=True).ravel()
    for ax, (name, effect) in zip(axes, built_in().items()):
        quantity, pressure, off, real = change(effect)
        for words, (run, colour, line, width) in LINES.items():
            mine = real[:, run]
            ax.plot(1000 * pressure[mine, run], off[mine, run], color=colour, ls=line, lw=width, label=words)
        ax.axhline(0, color=GREY, lw=0.6, zorder=0)
        ax.set_title(name + {"force_N": " (N)", "flex_V": " (felt)"}.get(quantity, ""), fontsize=9.5)
        ax.spines[["top", "right"]].set_visible(False)
        ax.tick_params(labelsize=8, labelbottom=True)
    for ax in [*axes[18:22], *axes[16:18]]:
        ax.set_xlabel("pressure (kPa)", fontsize=8.5)
    for ax in axes[::6]:
        ax.set_ylabel("change (°)", fontsize=9)
    for ax in axes[22:]:
        ax.axis("off")
    axes[22].legend(*axes[0].get_legend_handles_labels(), loc="center left", frameon=False, fontsize=10)
    figure.suptitle(
        "Simulated: what each effect alone, plain and at its typical values, changes in the curve over recorded pressure",
        fontsize=11,
    )
    figure.tight_layout(rect=(0, 0, 1, 0.985))
    save_png(figure, path)
    return path


if __name__ == "__main__":
    print(f"wrote {draw()}")
