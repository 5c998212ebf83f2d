"""A lab whose bench is the twin: samples drawn about the simulated curves, with the effects of a twin file hidden in all of them."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np

from benchlab.discrepancy.base import Base, DesignBase
from benchlab.discrepancy.measured import Run
from benchlab.discrepancy.trial import of_length
from benchlab.errors import InputError
from benchlab.io.angle_series import read_angle_series
from benchlab.io.journal import Journal
from benchlab.twin.curve import ResponseCurve
from benchlab.twin.effects.camera_scale import CameraScale
from benchlab.twin.effects.clock_offset import ClockOffset
from benchlab.twin.effects.gravity import Gravity
from benchlab.twin.settings import TwinSettings
from benchlab.twin.truth import Truth
from benchlab.units import FloatArray
from benchlab.workflows.analyze import analyze
from benchlab.workflows.explain_lab import Wanted, driven_whole, run_of
from benchlab.workflows.outputs import Outputs
from benchlab.workflows.run_prepare import RunSettings, prepare
from benchlab.workflows.settings import AnalyzeSettings
from benchlab.workflows.twin_film import frame_times_s, write_twin_film

LONGEST_S = 7200.0


@dataclass(frozen=True)
class Scatter:
    """How samples of one design differ, and how well the camera sees: standard deviations, chosen, of the order of the paper's scatter.

    gain: of the angle. shift_deg: of the attitude in which it is mounted. shape: of half a cosine over the pressures, and of a whole one.
    camera_deg: of one frame, where no film is drawn.
    """

    gain: float = 0.02
    shift_deg: float = 0.3
    shape: float = 0.005
    camera_deg: float = 0.2

    @property
    def words(self) -> str:
        return (
            f"samples differ by {100 * self.gain:g} % in gain, {self.shift_deg:g}° in attitude and {100 * self.shape:g} % in shape, "
            f"and a frame by {self.camera_deg:g}° (standard deviations, chosen)"
        )


class TwinLab:
    """Measures on the twin in virtual time. hidden: whose effects all samples have. seed: of samples and noise.

    film: whether each run is drawn as a film and analysed, instead of taking the angle of the twin's camera. Its runs begin rested: a twin
    knows nothing of earlier ones, so no order of runs is told.
    """

    origin = "simulated (twin)"
    remembers = False

    def __init__(
        self, base: Base, hidden: TwinSettings, seed: int = 1, film: bool = False, scatter: Scatter | None = None
    ) -> None:
        self.base, self.hidden, self.seed, self.film = base, hidden, seed, film
        self.scatter = scatter or Scatter()

    @property
    def about(self) -> str:
        return f"simulated, not measured: a twin, seed {self.seed}, {base_words(self.base)}; {self.scatter.words}"

    def measure(self, wanted: Wanted) -> Run:
        wanted = self._mounted(wanted)
        twin = self.twin(wanted)
        settings = RunSettings(bench="twin", out=wanted.folder, name=wanted.stem, fast=True, max_duration_s=LONGEST_S)
        prepared = prepare(str(wanted.protocol), settings)
        bench = replace(prepared.bench, limit_MPa=min(prepared.bench.ceiling_MPa, twin.curve.last_MPa))
        driven, journal = driven_whole(replace(prepared, twin=twin, curve=twin.curve, bench=bench))
        see = self._filmed if self.film else self._seen
        return run_of(wanted, journal, *see(wanted, driven.truth, twin, journal), start_s=None, ordered=False)

    def _mounted(self, wanted: Wanted) -> Wanted:
        """With the mounting that a twin has where none is asked for, so that what is measured tells it."""
        weight = self.hidden.effect(Gravity) or Gravity()
        return replace(wanted, mounting_deg=float(weight.mount_deg)) if math.isnan(wanted.mounting_deg) else wanted

    def twin(self, wanted: Wanted) -> TwinSettings:
        """The twin of a sample, mounted as wanted. A sample is the same in each run, its noise is not."""
        design = of_length(self.base, [wanted.design], wanted.length_ratio).designs[wanted.design]
        effects = dict(self.hidden.effects)
        weight = self.hidden.effect(Gravity)
        if weight is not None and not math.isnan(wanted.mounting_deg):
            effects[Gravity.name] = replace(weight, mount_deg=wanted.mounting_deg)
        curve = sample_curve(design, self.scatter, self._rng(wanted.called, wanted.sample))
        length_mm = self.hidden.length_mm if design.shape is None else design.shape.length_mm
        noise = int(self._rng(wanted.stem).integers(2**31))
        return replace(
            self.hidden,
            curve=curve,
            effects=effects,
            seed=noise,
            design=curve.source,
            length_mm=length_mm,
            own_curve=True,
        )

    def _rng(self, *words: str) -> np.random.Generator:
        return np.random.default_rng([self.seed, *" ".join(words).encode()])

    def _seen(
        self, wanted: Wanted, truth: Truth, twin: TwinSettings, journal: Journal
    ) -> tuple[FloatArray, FloatArray]:
        """Times and angles of the camera's frames."""
        time_s = frame_times_s(truth, twin)
        clock, scale = twin.effect(ClockOffset), twin.effect(CameraScale)
        world = time_s if clock is None else time_s - clock.ahead_s
        angle = np.interp(world, truth.time_s, truth.camera_deg) / (1.0 if scale is None else scale.factor)
        noise = self._rng(wanted.stem, "camera").standard_normal(len(angle))
        return _while_driven(journal, time_s, angle + self.scatter.camera_deg * noise)

    def _filmed(
        self, wanted: Wanted, truth: Truth, twin: TwinSettings, journal: Journal
    ) -> tuple[FloatArray, FloatArray]:
        """The same by drawing the film and analysing it, as a user would."""
        film = write_twin_film(wanted.folder / f"{wanted.stem}.film.mp4", truth, twin)
        settings = AnalyzeSettings(length_mm=twin.length_mm, scale_mm_per_px=film.scale_mm_per_px)
        outputs = Outputs.of(film.path, wanted.folder / "seen")
        analyze(film.path, settings, outputs)
        found = read_angle_series(outputs.run_file)
        return _while_driven(journal, found.time_s + film.start_s, found.angle_deg)


def sample_curve(design: DesignBase, scatter: Scatter, rng: np.random.Generator) -> ResponseCurve:
    """The curve of a sample: θ·g·(1 + a·cos(πp/P) + b·cos(2πp/P)) + δ, drawn. Raises InputError for a design with one pressure.

    Without simulated volumes, that of a tube that fills from 20 mL by 1 mL a MPa takes their place (chosen).
    """
    pressure, angle = design.pressure_MPa, design.curves["angle_deg"]
    if len(pressure) < 2:
        raise InputError(f"design {design.name} was simulated at one pressure", hint="a twin needs a curve from 0 MPa")
    gain, shift = 1 + scatter.gain * rng.standard_normal(), scatter.shift_deg * rng.standard_normal()
    waves = scatter.shape * rng.standard_normal(2)
    place = np.pi * pressure / pressure[-1]
    shape = 1 + waves[0] * np.cos(place) + waves[1] * np.cos(2 * place)
    volume = design.curves.get("volume_mL", 20 + pressure)
    source = f"a sample drawn about {design.name}, simulated"
    return ResponseCurve(pressure, angle * gain * shape + shift, volume, np.ones_like(pressure), source)


def base_words(base: Base) -> str:
    return f"curves of {base.source}"


def _while_driven(journal: Journal, time_s: FloatArray, angle_deg: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Without what was seen after the plan's end."""
    during = time_s <= journal.driven["time_s"][-1] + 1e-9
    return time_s[during], angle_deg[during]
