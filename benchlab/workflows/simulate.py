"""`benchlab simulate`: one design in, its response curves and pictures out."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

import numpy as np
from threadpoolctl import threadpool_limits

from benchlab.actuator import ShellDesign, tip_position_mm
from benchlab.errors import InputError, UsageError
from benchlab.io.files import sha256
from benchlab.io.layup_file import layup_document
from benchlab.io.nexus import plain
from benchlab.io.response_file import read_response_provenance, write_response_csv, write_response_file
from benchlab.simulation.actuator_response import ActuatorResponse, actuator_response, tip_force_N
from benchlab.simulation.deformed import extremes, layer_stresses, unstable_share
from benchlab.simulation.film_strain import peak_film_strain
from benchlab.simulation.laws.law import FloatArray
from benchlab.simulation.response import SMALLEST_STEP_MPa, hold
from benchlab.workflows.outputs import Outputs
from benchlab.workflows.provenance import made_by
from benchlab.workflows.simulated import Conditions, code_digest

LARGEST_TIP_ANGLE_DEG = 350.0
LONGEST_NAME = 200
STATEMENT = "simulated with a finite-element cell of the shell, not measured"


@dataclass(frozen=True)
class SimulateOutputs(Outputs):
    """`<stem>.h5`, `.csv`, `.png` and `.cell.png`; the response file of an earlier simulation vouches for the others."""

    @property
    def cell_figure(self) -> Path:
        return self.folder / f"{self.stem}.cell.png"

    def paths(self, overlay: bool = False) -> list[Path]:
        return [self.run_file, self.table, self.figure, self.cell_figure]

    def _written_before(self) -> dict[str, str]:
        provenance = read_response_provenance(self.run_file)
        return {} if provenance is None else {self.run_file.name: "any", **provenance.get("outputs_sha256", {})}


def simulate(
    design: ShellDesign,
    conditions: Conditions,
    out: Path,
    name: str | None = None,
    tip_force_at_deg: float | None = None,
    overwrite: bool = False,
    progress: Callable[[int, int], None] | None = None,
) -> dict[str, Any]:
    """Simulate a design at the pressures of `conditions`, and write NAME.h5, .csv, .png and .cell.png into `out`, all or none.

    name: of the files, the design's where None. tip_force_at_deg: also the force of the tip when held at this angle. Returns
    what was found, as `--json` shows it. Pressures beyond a limit have no result; a warning names it.
    Raises UsageError, and InputError where the first pressure is beyond the limit; then nothing was written.
    """
    outputs = SimulateOutputs(out, checked_name(name or design.name), overwrite)
    if tip_force_at_deg is not None and not abs(tip_force_at_deg) <= LARGEST_TIP_ANGLE_DEG:
        raise UsageError(
            f"--tip-force-at-deg is {tip_force_at_deg:g}", hint=f"give an angle up to {LARGEST_TIP_ANGLE_DEG:g} degrees"
        )
    outputs.check(overlay=False, inputs=())
    with outputs.locked(), threadpool_limits(1):
        response = actuator_response(
            design,
            conditions.layup,
            conditions.pressures_MPa,
            conditions.fixture,
            conditions.cap_mm,
            conditions.blocked,
            progress,
        )
        if not len(response.pressure_MPa):
            raise _no_state(design, conditions, response)
        layers = [layer_stresses(response.cell, point.state) for point in response.free.points]
        unstable = np.array([unstable_share(found) for found in layers])
        extras = _extras(response, layers, tip_force_at_deg)
        warnings = [*_warnings(conditions, response, unstable), *_beyond(conditions, response, extras)]
        about = _about(response, warnings, tip_force_at_deg)
        _save(response, conditions, extras, about, outputs)
    points = {**response.columns(), **_tip(response), "straight_tip_force_N": _straight_tip_force_N(response), **extras}
    rows: Any = plain([dict(zip(points, values)) for values in zip(*points.values())])
    return {**about, "points": rows, "outputs": [str(path) for path in outputs.paths()]}


def checked_name(name: str) -> str:
    """The name, if files can have it. Raises UsageError."""
    if name != Path(name).name or name.startswith(".") or not name.isprintable() or len(name.encode()) > LONGEST_NAME:
        raise UsageError(
            f"{name[:60]!r} is no name for files",
            hint=f"give --name without folders, up to {LONGEST_NAME} bytes, and --out for the folder",
        )
    return name


def _no_state(design: ShellDesign, conditions: Conditions, response: ActuatorResponse) -> InputError:
    limit = response.limit_pressure_MPa or 0.0
    if not limit:
        return InputError(
            f"{design.name} with material {conditions.layup.name} has no stable state at {conditions.pressures_MPa[0]:g} MPa, "
            f"and none was found below: its limit pressure, if it has one, is under {SMALLEST_STEP_MPa:g} MPa",
            hint="check dimensions and thicknesses (mm) and coefficients (MPa), or take a stiffer material",
        )
    return InputError(
        f"{design.name} with material {conditions.layup.name} has no stable state at {conditions.pressures_MPa[0]:g} MPa; the last one "
        f"found is at {limit:.4g} MPa, its limit pressure",
        hint=f"ask for pressures up to {limit:.4g} MPa, or take a stiffer material",
    )


def _extras(response: ActuatorResponse, layers: list[Any], tip_force_at_deg: float | None) -> dict[str, FloatArray]:
    found = [extremes(each) for each in layers]
    extras = {
        "max_film_stretch": np.array([each.film_stretch for each in found]),
        "peak_film_strain": np.array([peak_film_strain(response.cell, point.state) for point in response.free.points]),
        "max_fabric_stress_MPa": np.array([each.fabric_stress_MPa for each in found]),
    }
    if tip_force_at_deg is not None:
        extras["tip_force_N"] = _tip_forces(response, math.radians(tip_force_at_deg))
    return extras


def _tip_forces(response: ActuatorResponse, angle_rad: float) -> FloatArray:
    """Force at the end of the bending length, held at an angle; NaN where no stable state was found."""
    bent = response.design.length_mm - 2 * response.cap_mm
    held = [hold(response.cell, point, angle_rad / bent) for point in response.free.points]
    return np.array(
        [
            np.nan if at is None else tip_force_N(np.array(at.moment_Nmm), np.array(angle_rad), at.state.lam * bent)
            for at in held
        ],
        dtype=float,
    )


def _straight_tip_force_N(response: ActuatorResponse) -> FloatArray:
    """Force of the tip of the actuator held straight, across it: the fixture of a finger that presses with its end."""
    return tip_force_N(
        response.moment_Nmm, np.zeros(len(response.moment_Nmm)), response.design.length_mm - response.cap_mm * 2
    )


def _tip(response: ActuatorResponse) -> dict[str, FloatArray]:
    """Where the tip is: an arc of constant curvature between two straight caps, the base at the origin."""
    cap, angle = response.cap_mm, response.angle_rad
    arc = tip_position_mm(angle, response.axial_stretch * (response.design.length_mm - 2 * cap))
    return {
        "tip_towards_strip_mm": arc[:, 0] + cap * np.sin(angle),
        "tip_along_mm": arc[:, 1] + cap * (1 + np.cos(angle)),
    }


def _warnings(conditions: Conditions, response: ActuatorResponse, unstable: FloatArray) -> list[str]:
    found = []
    reached, asked = len(response.pressure_MPa), len(conditions.pressures_MPa)
    if response.limit_pressure_MPa is not None:
        found.append(
            f"limit pressure: no stable state was found beyond {response.limit_pressure_MPa:.4g} MPa, where the film bursts or the "
            f"shell snaps to another shape; {reached} of {asked} pressures have a result"
        )
    straight = np.isfinite(response.moment_Nmm)
    if conditions.blocked and not straight.all():
        first = response.pressure_MPa[int(np.argmin(straight))]
        found.append(
            f"held straight, no stable state was found from {first:g} MPa on: no moment and no blocked force there"
        )
    if (unstable > 0).any():
        at = int(np.argmax(unstable > 0))
        found.append(
            f"the film law of material {conditions.layup.name} is not stable (Drucker) at {100 * unstable[-1]:.2g} % of the film's "
            f"points at {response.pressure_MPa[-1]:g} MPa, the first at {response.pressure_MPa[at]:g} MPa: results from there on may be "
            "those of the law alone; fit it to larger stretches, biaxial ones too"
        )
    return found


def _beyond(conditions: Conditions, response: ActuatorResponse, extras: dict[str, FloatArray]) -> list[str]:
    """Warnings of results that no actuator or no test stands for."""
    found = []
    if (turned := float(np.abs(response.angle_deg).max())) > 360:
        found.append(f"an angle of {turned:.0f} deg: the actuator would lie on itself, which is not simulated")
    tested, strain = conditions.layup.film_largest_stretch, extras["peak_film_strain"]
    if tested is not None and 1 + strain.max() > tested:
        at = response.pressure_MPa[int(np.argmax(1 + strain > tested))]
        found.append(
            f"from {at:g} MPa on the film is stretched beyond {tested:g}, the largest stretch that its law was fitted to (to "
            f"{1 + strain.max():.2f}): test the film further"
        )
    return found


def _about(response: ActuatorResponse, warnings: list[str], tip_force_at_deg: float | None) -> dict[str, Any]:
    """What was simulated and how, without the curves."""
    design, layup, mesh = response.design, response.layup, response.cell.mesh
    return {
        "design": {"name": design.name, **asdict(design), "window_length_mm": design.window_length_mm},
        "material": {"name": layup.name, "origin": layup.origin},
        "statement": STATEMENT,
        "fixture": {**asdict(response.fixture), "words": str(response.fixture)},
        "cap_mm": response.cap_mm,
        "tip_force_at_deg": tip_force_at_deg,
        "mesh": {"elements": len(mesh.elements), "nodes": len(mesh.nodes_mm)},
        "limit_pressure_MPa": response.limit_pressure_MPa,
        "seconds": round(response.seconds, 3),
        "warnings": warnings,
    }


def _save(
    response: ActuatorResponse,
    conditions: Conditions,
    extras: dict[str, FloatArray],
    about: dict[str, Any],
    outputs: SimulateOutputs,
) -> None:
    """Write table, figures and the response file that vouches for them, all or none."""
    from benchlab.report.figures import save_png
    from benchlab.report.response_figure import draw_cell_figure, draw_response_figure

    simulation = {key: value for key, value in about.items() if key not in ("design", "material", "warnings")}
    with outputs.staged() as stage:
        write_response_csv(stage.table, response)
        save_png(draw_response_figure(response), stage.figure)
        save_png(draw_cell_figure(response), stage.cell_figure)
        digests = {path.name: sha256(path) for path in (stage.table, stage.figure, stage.cell_figure)}
        write_response_file(
            stage.run_file,
            response,
            extras=extras,
            design=about["design"],
            material=layup_document(conditions.layup),
            simulation={**simulation, "conditions": conditions.as_json()},
            provenance={
                **made_by("numpy", "scipy", "skfem", "h5py"),
                "code_sha256": code_digest(),
                "outputs_sha256": digests,
            },
            warnings=about["warnings"],
        )
