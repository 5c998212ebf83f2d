"""The study of the sample data: five drawn designs, five samples each, what is simulated of them, and the drawn force records."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterable
from pathlib import Path

from benchlab.actuator import ShellDesign
from benchlab.io.layup_file import DEFAULT_LAYUP, read_layup
from benchlab.io.study_text import DesignDraft, StudyDraft, study_text
from benchlab.io.study_values import StudySet
from benchlab.io.sweep_file import write_sweep_file
from benchlab.simulation.actuator_response import Fixture
from benchlab.workflows.sample_force import CYCLES, STEPS_MPA, force_files
from benchlab.workflows.simulated import Conditions
from benchlab.workflows.study_sets import proposed_sets
from benchlab.workflows.sweep import simulated_sweep

STUDY, SIMULATED = "study.yaml", "simulated.h5"
PRESSURE_MPA = 0.35
PRESSURES_MPA = (0.0, *STEPS_MPA)
TITLE = "Sample study: drawn, not measured"
NOTES = """\
Clips and force records are drawn by benchlab, not measured: their angles and forces at 0.35 MPa come from normal distributions with the
means and standard deviations that the paper gives. The simulated angles are benchlab's own, of a film that was identified from the
paper's FEM angles."""


def sample_study(clips: Iterable[tuple[ShellDesign, int, str]], seed: int) -> str:
    """The text of the study file. clips: design, number of the sample, file."""
    shells: dict[str, ShellDesign] = {}
    samples: dict[str, dict[str, list[str]]] = defaultdict(dict)
    for shell, number, file in clips:
        shells[shell.name] = shell
        samples[shell.name][f"s{number}"] = [file]
    force = list(force_files(seed))
    steps = {"steps_MPa": list(STEPS_MPA), "cycles": CYCLES}
    designs = [
        DesignDraft(name, shell, samples[name], SIMULATED, [file for file in force if f"/{name}_" in file], steps)
        for name, shell in shells.items()
    ]
    analysis = {"ramp": "0:0.35:2.5", "marker_span_mm": ShellDesign.length_mm}
    return study_text(StudyDraft(TITLE, PRESSURE_MPA, analysis, designs, _sets(shells), NOTES), STUDY)


def write_simulated(path: Path, shells: Iterable[ShellDesign]) -> None:
    """Simulate all combinations of the designs' windows and strips, as `benchlab sweep --no-blocked` does, into a sweep file."""
    known = list(shells)
    axes = {
        "tw_mm": tuple(sorted({float(shell.window_width_mm) for shell in known})),
        "slw_mm": tuple(sorted({float(shell.strip_width_mm) for shell in known})),
        "fw_mm": (ShellDesign.rib_width_mm,),
        "perimeter_mm": (ShellDesign.perimeter_mm,),
        "length_mm": (ShellDesign.length_mm,),
    }
    write_sweep_file(
        path, simulated_sweep(axes, Conditions(read_layup(DEFAULT_LAYUP), PRESSURES_MPA, Fixture(), blocked=False))
    )


def _sets(shells: dict[str, ShellDesign]) -> tuple[StudySet, ...]:
    """The slw set first, as in the paper."""
    return tuple(sorted(proposed_sets(shells), key=lambda chosen: chosen.name))
