"""`benchlab fit-material`: tensile tests in, a material file and a picture of the fit out."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import asdict, dataclass, field, replace
from pathlib import Path
from typing import Any

import benchlab
from benchlab.errors import InputError, UsageError, printable
from benchlab.io.files import cannot_write, check_new_file, sha256, written_whole
from benchlab.io.layup_file import write_layup
from benchlab.io.tensile import SpecimenSize, read_tensile
from benchlab.report.figures import save_png
from benchlab.report.material_figure import draw_material_figure
from benchlab.simulation.layup import Layup
from benchlab.simulation.tensile.curve import loading_curve
from benchlab.simulation.tensile.fit_law import LawFit, Specimen, fit_laws, recommended, thinned
from benchlab.simulation.tensile.models import SOLVERS

WORST_R_SQUARED, POOR_R_SQUARED = 0.5, 0.95
"""Below the first a law is not written; below the second it is written with a warning."""


@dataclass(frozen=True)
class FitSettings:
    """How tests are read and fitted. law: one of SOLVERS, or "all". columns: see `read_tensile`. max_stretch: fit up to here.
    film_thickness_mm: of the film in the shell; None is the specimen's."""

    size: SpecimenSize = field(default_factory=SpecimenSize)
    law: str = "all"
    columns: str | None = None
    true_stress: bool = False
    keep_slack: bool = False
    max_stretch: float | None = None
    film_thickness_mm: float | None = None
    decimal: str | None = None
    encoding: str | None = None

    def __post_init__(self) -> None:
        if self.max_stretch is not None and not (math.isfinite(self.max_stretch) and self.max_stretch > 1.01):
            raise UsageError(
                f"--max-stretch is {self.max_stretch}", hint="give a stretch (length over first length) above 1.01"
            )


@dataclass(frozen=True)
class _Test:
    path: Path
    sha256: str
    specimen: Specimen
    points: int
    notes: tuple[str, ...]


def fit_material(
    sources: Sequence[Path], out: Path | None, settings: FitSettings, overwrite: bool = False
) -> dict[str, Any]:
    """Fit laws to all `sources` together and write `out` (default: the first file's name, .yaml, beside it) and a PNG of its name.

    The file is a whole layup: the film is the fitted law, as thick as the specimen where `settings.size` says so, all else is a
    layup's default. Returns what was found, as `--json` shows it. Raises UsageError and InputError; then nothing was written.
    """
    out = out or sources[0].with_suffix(".yaml")
    picture = out.with_suffix(".png")
    _check_outputs((out, picture), sources, overwrite)
    tests = [_read(path, settings) for path in sources]
    _refuse_copies(tests)
    fits = fit_laws([test.specimen for test in tests], tuple(SOLVERS) if settings.law == "all" else (settings.law,))
    chosen = recommended(fits) if settings.law == "all" else fits[0]
    if chosen.r_squared < WORST_R_SQUARED:
        raise InputError(
            f"{chosen.name} describes the tests with R² {chosen.r_squared:.2f}: that is no description",
            file=sources[0],
            hint="check --columns, sizes and units; leave out tests of another material; or --max-stretch",
        )
    layup = _layup(out, tests, chosen, settings)
    found = _summary(tests, fits, chosen, out, picture)
    title = f"{chosen.name} fitted to {', '.join(test.path.name for test in tests)}"
    figure = draw_material_figure([(t.path.name, t.specimen) for t in tests], fits, chosen.name, title)
    with written_whole(picture) as temporary:
        try:
            save_png(figure, temporary)
        except OSError as error:
            raise cannot_write(error, picture) from error
        write_layup(out, layup, _comment(chosen, found["warnings"]))
    return found


def _check_outputs(paths: Sequence[Path], sources: Sequence[Path], overwrite: bool) -> None:
    if paths[0].suffix.lower() not in (".yaml", ".yml"):
        raise UsageError("is not a .yaml file", file=paths[0], hint="give --out a name that ends in .yaml")
    read = {source.resolve() for source in sources}
    for path in paths:
        if path.resolve() in read:
            raise UsageError("is read here and would be replaced", file=path, hint="choose another --out")
        check_new_file(path, overwrite)


def _read(path: Path, settings: FitSettings) -> _Test:
    test = read_tensile(
        path, settings.size, settings.columns, settings.true_stress, settings.decimal, settings.encoding
    )
    try:
        curve = loading_curve(test.stretch, test.stress_MPa, not settings.keep_slack, settings.max_stretch)
        specimen = thinned(curve.stretch, curve.stress_MPa)
    except InputError as error:
        raise InputError(error.what, file=path, where=error.where, hint=error.hint) from error
    notes = [*test.notes, *curve.notes]
    if len(specimen.stretch) < len(curve.stretch):
        notes.append(f"{len(curve.stretch)} points averaged to {len(specimen.stretch)} over equal steps of stretch")
    return _Test(path, sha256(path), specimen, len(curve.stretch), tuple(notes))


def _refuse_copies(tests: Sequence[_Test]) -> None:
    seen: dict[str, Path] = {}
    for test in tests:
        if test.sha256 in seen:
            what = f"has the same content as {seen[test.sha256].name}"
            raise UsageError(what, file=test.path, hint="one specimen counts once: leave one of them out")
        seen[test.sha256] = test.path


def _layup(out: Path, tests: Sequence[_Test], chosen: LawFit, settings: FitSettings) -> Layup:
    low, high = chosen.stretch_range
    files = "; ".join(f"{printable(test.path.name)} (sha256 {test.sha256})" for test in tests)
    origin = (
        f"film: {chosen.name} fitted by benchlab {benchlab.__version__} to uniaxial tension, stretches {low:.4g} to {high:.4g}, "
        f"RMSE {chosen.rmse_MPa:.3g} MPa, of {files}; fabric and strip not measured: the defaults of a layup"
    )
    layup = Layup(name=out.stem.lower(), origin=origin, film=chosen.law, film_largest_stretch=float(f"{high:.4g}"))
    thickness = settings.film_thickness_mm or settings.size.thickness_mm
    return layup if thickness is None else replace(layup, film_thickness_mm=thickness)


def _comment(chosen: LawFit, warnings: Sequence[str]) -> str:
    lines = ["Written by benchlab fit-material; for benchlab simulate --material.", ""]
    lines += [
        f"{c.name} = {c.value:.4g} {c.unit}, 95 % interval {c.low:.4g} to {c.high:.4g}" for c in chosen.coefficients
    ]
    ranges = (f"{one.mode} {one.low:.3g} to {one.high:.3g}" for one in chosen.stable)
    lines += [f"Drucker-stable at stretches: {', '.join(ranges)}", *map(printable, warnings)]
    return "\n".join(line.replace(" ,", ",") for line in lines)


def _summary(
    tests: Sequence[_Test], fits: Sequence[LawFit], chosen: LawFit, out: Path, picture: Path
) -> dict[str, Any]:
    warnings = list(chosen.notes)
    if chosen.r_squared < POOR_R_SQUARED:
        warnings.insert(0, f"{chosen.name} describes the tests badly: R² {chosen.r_squared:.2f}")
    if not chosen.stable_over_data:
        warnings.insert(
            0, f"{chosen.name} is not stable over the stretches of the test: a simulation that reaches them may fail"
        )
    return {
        "material": str(out),
        "law": chosen.name,
        "tests": [
            {
                "file": str(test.path),
                "sha256": test.sha256,
                "points": test.points,
                "stretch": [float(test.specimen.stretch.min()), float(test.specimen.stretch.max())],
                "notes": list(test.notes),
            }
            for test in tests
        ],
        "laws": [_law(fit) for fit in fits],
        "warnings": warnings,
        "outputs": [str(out), str(picture)],
    }


def _law(fit: LawFit) -> dict[str, Any]:
    return {
        "law": fit.name,
        "coefficients": [asdict(c) for c in fit.coefficients],
        "shear_modulus_MPa": fit.law.shear_modulus_MPa,
        "r_squared": fit.r_squared,
        "rmse_MPa": fit.rmse_MPa,
        "aicc": fit.aicc,
        "condition_number": fit.condition_number if math.isfinite(fit.condition_number) else None,
        "not_separated": list(fit.not_separated),
        "effective_points": fit.effective_points,
        "stable_over_data": fit.stable_over_data,
        "biaxial_factor": fit.biaxial_factor if math.isfinite(fit.biaxial_factor) else None,
        "stable_stretch": {one.mode: [one.low, one.high] for one in fit.stable},
        "notes": list(fit.notes),
    }
