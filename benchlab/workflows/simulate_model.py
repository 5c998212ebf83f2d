"""`benchlab simulate --model`: a design with a model's effects; its curves beside those of the base, and their picture, out."""

from __future__ import annotations

import time
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

import numpy as np
from threadpoolctl import threadpool_limits

from benchlab.actuator import ShellDesign
from benchlab.errors import InputError
from benchlab.io.files import sha256
from benchlab.io.layup_file import layup_document
from benchlab.io.nexus import plain
from benchlab.io.response_file import read_response_provenance, write_response_csv, write_response_file
from benchlab.units import FloatArray
from benchlab.workflows.model_curves import Model, model_base, model_provenance, modelled
from benchlab.workflows.outputs import Outputs
from benchlab.workflows.provenance import made_by
from benchlab.workflows.simulated import Conditions, code_digest

STATEMENT = "simulated with a model file, not measured"


@dataclass(frozen=True)
class ModelOutputs(Outputs):
    """`<stem>.h5`, `.csv` and `.png`; the response file of an earlier simulation vouches for the others."""

    def _written_before(self) -> dict[str, str]:
        provenance = read_response_provenance(self.run_file)
        return {} if provenance is None else {self.run_file.name: "any", **provenance.get("outputs_sha256", {})}


@dataclass(frozen=True)
class ModelResponse:
    """Columns of a response file, (P,) each, NaN where the model does not know them; the angle of the base alone; what was noted."""

    columns: dict[str, FloatArray]
    bare: dict[str, FloatArray]
    limit_pressure_MPa: float | None
    notes: tuple[str, ...]
    base: str
    seconds: float


def model_response(design: ShellDesign, conditions: Conditions, cache: Path | None = None) -> ModelResponse:
    """A design as the model of `conditions` has it, loaded slowly for the first time. Raises UsageError and InputError."""
    started, model = time.perf_counter(), conditions.model
    assert model is not None
    with threadpool_limits(1):
        base = model_base(
            model,
            {design.name: design},
            conditions.pressures_MPa[-1],
            forces=conditions.blocked,
            fixture=conditions.fixture,
            cache=cache,
        )
        if design.name not in base.designs:
            raise InputError(base.missing[design.name], hint="take another design, or a stiffer material")
        largest = base.largest_pressure_MPa(design.name)
        reached = [pressure for pressure in conditions.pressures_MPa if pressure <= largest * (1 + 1e-9)]
        if not reached:
            what = f"{design.name} is simulated up to {largest:.4g} MPa, below {conditions.pressures_MPa[0]:g} MPa"
            raise InputError(what, hint=f"ask for pressures up to {largest:.4g} MPa")
        found = modelled(base, design.name, model.file.actives, reached)
    short = len(reached) < len(conditions.pressures_MPa)
    return ModelResponse(
        _columns(conditions, found.pressure_MPa, found.curves),
        found.bare,
        largest if short else None,
        (*found.notes, *base.warnings),
        base.source,
        time.perf_counter() - started,
    )


def model_columns(design: ShellDesign, conditions: Conditions) -> dict[str, Any]:
    """The same as `simulate_design` gives it, for sweeps."""
    from benchlab.workflows.explain_cache import default_cache

    found = model_response(design, conditions, default_cache())
    missing = np.full(len(conditions.pressures_MPa) - len(found.columns["pressure_MPa"]), np.nan)
    columns = {name: np.append(values, missing) for name, values in found.columns.items()}
    columns["peak_film_strain"] = np.full(len(conditions.pressures_MPa), np.nan)
    return {"columns": columns, "limit_pressure_MPa": found.limit_pressure_MPa, "seconds": found.seconds}


def simulate_model(
    design: ShellDesign, conditions: Conditions, out: Path, name: str | None = None, overwrite: bool = False
) -> dict[str, Any]:
    """Write NAME.h5, .csv and .png into `out`, all or none. name: of the files, design and model where None.

    Returns what was found, as `--json` shows it. Raises UsageError and InputError; then nothing was written.
    """
    from benchlab.workflows.explain_cache import default_cache
    from benchlab.workflows.simulate import checked_name

    model = conditions.model
    assert model is not None
    outputs = ModelOutputs(out, checked_name(name or f"{design.name}_{model.path.stem}"), overwrite)
    outputs.check(overlay=False, inputs=(model.path,))
    with outputs.locked():
        found = model_response(design, conditions, default_cache())
        about = _about(design, conditions, model, found)
        _save(design, conditions, model, found, about, outputs)
    rows: Any = plain(
        [
            {**dict(zip(found.columns, values)), "base_angle_deg": float(bare)}
            for *values, bare in zip(*found.columns.values(), found.bare["angle_deg"])
        ]
    )
    return {**about, "points": rows, "outputs": [str(path) for path in outputs.paths(overlay=False)]}


def _columns(conditions: Conditions, pressure: FloatArray, curves: dict[str, FloatArray]) -> dict[str, FloatArray]:
    """By the names of a response file. Curvature and stretch are of a cell's state, which effects on load and angle do not have."""
    unknown = np.full(len(pressure), np.nan)
    force, arm = curves.get("force_N", unknown), conditions.fixture.lever_arm_mm
    return {
        "pressure_MPa": pressure,
        "angle_deg": curves["angle_deg"],
        "curvature_per_mm": unknown,
        "axial_stretch": unknown,
        "volume_mL": curves.get("volume_mL", unknown),
        "moment_Nmm": unknown if arm is None else force * arm,
        "blocked_force_N": force,
    }


def _about(design: ShellDesign, conditions: Conditions, model: Model, found: ModelResponse) -> dict[str, Any]:
    warnings = list(found.notes)
    if found.limit_pressure_MPa is not None:
        reached, asked = len(found.columns["pressure_MPa"]), len(conditions.pressures_MPa)
        warnings.append(
            f"limit pressure: nothing is simulated beyond {found.limit_pressure_MPa:.4g} MPa; {reached} of {asked} pressures have a result"
        )
    return {
        "design": {"name": design.name, **asdict(design), "window_length_mm": design.window_length_mm},
        "material": {"name": conditions.layup.name, "origin": conditions.layup.origin},
        "model": {**model.as_json(), "base_words": found.base},
        "statement": STATEMENT,
        "fixture": {**asdict(conditions.fixture), "words": str(conditions.fixture)},
        "cap_mm": 0.0,
        "limit_pressure_MPa": found.limit_pressure_MPa,
        "seconds": round(found.seconds, 3),
        "warnings": warnings,
    }


def _save(
    design: ShellDesign,
    conditions: Conditions,
    model: Model,
    found: ModelResponse,
    about: dict[str, Any],
    outputs: ModelOutputs,
) -> None:
    """Write table, figure and the response file that vouches for them, all or none."""
    from benchlab.report.figures import save_png
    from benchlab.report.model_figure import draw_model_figure

    simulation = {key: value for key, value in about.items() if key not in ("design", "material", "warnings")}
    with outputs.staged() as stage:
        write_response_csv(stage.table, found.columns)
        save_png(draw_model_figure(design.name, model.words, found.columns, found.bare), stage.figure)
        digests = {path.name: sha256(path) for path in (stage.table, stage.figure)}
        write_response_file(
            stage.run_file,
            found.columns,
            extras={"base_angle_deg": found.bare["angle_deg"]},
            design=about["design"],
            material=layup_document(conditions.layup),
            simulation={**simulation, "conditions": conditions.as_json()},
            provenance={
                **made_by("numpy", "scipy", "h5py"),
                "model": model_provenance(model),
                "code_sha256": code_digest("simulation", "discrepancy"),
                "outputs_sha256": digests,
            },
            warnings=about["warnings"],
        )
