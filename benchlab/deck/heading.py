"""What a deck says of itself: design, layup, what is approximated, how to read the angle."""

from __future__ import annotations

from dataclasses import asdict

import benchlab
from benchlab.deck.solid import Solid
from benchlab.deck.tube import Tube

UNITS = "Units: mm, N, MPa. Simulated geometry, not measured."
SHAPE = (
    "Half of the tube (mirror plane y = 0), from the mirror plane z = 0 to a stiff end cap; round and free of stress at",
    "first, whatever the layup says of a flat sheet. x = -R is mid strip, x = +R mid window; it bends towards -x.",
)
READING = (
    "Reading the angle: sets RIB_001, RIB_002, ... are the nodes of the rib mid-planes, their undeformed z stands below.",
    "The rotation of each about y, by least squares from its nodes' displacements (printed at every pressure), minus that of",
    "the rib before it is the angle of a cell; times al / (tw + fw) it is the angle of the actuator, as benchlab gives it.",
    "The last one or two cells feel the cap; take the mean of those before.",
)
CALCULIX_SHELLS = (
    "S8R shells, laminates centred on the reference surface. Approximations: where laminates of different thickness meet,",
    "CalculiX ties their edges rigidly (knots), so the film cannot thin there; pressure acts on the inner faces, which step",
    "by half the difference of thickness, so that cells far from the cap bend less than those near it (a tenth in eight cells of",
    "tw3_slw10): for angles take solids or sheets. Film laminated on fabric has Poisson's ratio 0.45 instead of 0.5.",
)
CALCULIX_SHEETS = (
    "S8R shells, one for each layer, on shared nodes and all centred on the reference surface: layers lie in one another. Pressure",
    "acts on the inner face, half a thickness inside of it; film on fabric has Poisson's ratio 0.45 instead of 0.5.",
)
CALCULIX_SOLIDS = (
    "C3D20R solids, one element through each layer; the film is continuous, its middle at R, fabric and strip lie outside of",
    "it. Pressure acts on the film's inner face and the cap, which close a volume; it follows the faces.",
)
ABAQUS = (
    "S4R and S3R shells, laminates centred on the reference surface. *ELASTIC means Hooke's law in logarithmic strain here,",
    "St Venant's and Kirchhoff's in benchlab: alike to the first order in the fabric's strain. The film is incompressible.",
    "The deck's syntax, sets and closed cavity are tested, but it has never been run in Abaqus.",
)


def heading(model: Tube | Solid, last_pressure_MPa: float, engine: str, bulk_over_shear: float | None) -> list[str]:
    """Lines of the comment at the head of a deck for `engine`, "abaqus" or "calculix"."""
    tube = model if isinstance(model, Tube) else model.tube
    design, layup, extent = tube.design, tube.layup, tube.extent
    shells = CALCULIX_SHEETS if tube.overlays else CALCULIX_SHELLS
    kind = ABAQUS if engine == "abaqus" else shells if isinstance(model, Tube) else CALCULIX_SOLIDS
    laminates = [
        f"  {section.name}: "
        + ", ".join(f"{layer.name} {layer.top_mm - layer.bottom_mm:g} mm" for layer in section.layers)
        for section in (*tube.sections, *tube.overlays)
    ]
    return [
        f"benchlab {benchlab.__version__}: {design.name}, layup {_plain(layup.name)}, 0 to {last_pressure_MPa:g} MPa",
        UNITS,
        "Design: " + ", ".join(f"{name} {value:g}" for name, value in asdict(design).items()),
        f"Film: {layup.film}",
        f"Fabric: {layup.fabric}",
        f"Origin of the layup: {_plain(layup.origin)}",
        "Laminates, the inner layer first:",
        *laminates,
        f"{_extent(tube)}; length to the cap {tube.length_mm:g} mm.",
        *SHAPE,
        *kind,
        *([] if bulk_over_shear is None else [f"Film's bulk over shear modulus: {bulk_over_shear:g} (D1 = 2/K)."]),
        *READING,
        *(f"  RIB_{k:03d}: z = {z:g} mm" for k, z in enumerate(tube.rib_z_mm, start=1)),
        f"al / (tw + fw) = {design.length_mm / (design.window_width_mm + design.rib_width_mm):.9g}; {extent.cells} cells.",
    ]


def _extent(tube: Tube) -> str:
    start = "mid window" if tube.extent.from_window else "mid rib"
    margin = f", end margin {tube.extent.margin_mm:g} mm (as a rib)" if tube.extent.margin_mm else ""
    return f"{tube.extent.cells} cells from {start} at z = 0, the last rib whole{margin}"


def _plain(text: str) -> str:
    """One line of ASCII, as the engines read it."""
    return " ".join(text.split()).encode("ascii", "replace").decode()
