"""`benchlab sample-data`: short drawn clips of the five published designs, with the truth beside them."""

from __future__ import annotations

import csv
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from benchlab.actuator import ShellDesign
from benchlab.errors import InputError, UsageError
from benchlab.io.files import reason_of, written_whole
from benchlab.vision.picture import FloatArray
from benchlab.vision.synthetic import Scene
from benchlab.workflows.drawn_film import Progress, write_drawn_film
from benchlab.workflows.sample_data_readme import readme
from benchlab.workflows.sample_explain import measured_rows, simulated_rows
from benchlab.workflows.sample_force import force_files, force_rows
from benchlab.workflows.sample_study import SIMULATED, STUDY, sample_study, write_simulated
from benchlab.workflows.sample_tensile import tensile_text

PUBLISHED_DEG: dict[tuple[int, int], tuple[float, float]] = {
    (3, 5): (110.2, 1.9),
    (3, 10): (125.7, 4.0),
    (3, 20): (60.3, 3.6),
    (9, 10): (79.9, 1.7),
    (15, 10): (56.7, 2.9),
}
"""Measured bending angle at 0.35 MPa, mean and SD of five samples, by (tw, slw) in mm: the paper's Table I."""

SAMPLES = 5
FPS = 30
FRAMES = 90
PEAK_PRESSURE = 0.35
RAMP_START_S, RAMP_S = 0.25, 2.5
CONCAVITY = 0.35


@dataclass(frozen=True)
class SampleClip:
    """One sample of one design: what is drawn, and how far it bends at 0.35 MPa.

    angle_rad: bending angle from the first marker to the last, which lie the actuator's length apart along the body.
    """

    design: ShellDesign
    sample: int
    angle_rad: float
    scale_mm_per_px: float
    scene: Scene

    @property
    def file(self) -> str:
        """Its place in the folder: `videos/tw3_slw10_s1.mp4`."""
        return f"videos/{self.design.name}_s{self.sample}.mp4"

    def angles_rad(self) -> FloatArray:
        """(T,) bending angle of every frame."""
        return self.angle_rad * response(ramp(times_s()) / PEAK_PRESSURE)


def make_sample_data(out: Path, seed: int = 1, progress: Progress | None = None) -> list[Path]:
    """Draw the 25 clips into `out`/videos and write their truth and README; returns the files, in order.

    progress: called with frames drawn and frames in all. The same seed draws the same pictures.
    Raises UsageError for a negative seed, InputError where the disk refuses.
    """
    clips = sample_clips(seed)
    try:
        (out / "videos").mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise InputError(f"cannot make this folder: {reason_of(error)}", file=out) from error
    written = []
    for index, clip in enumerate(clips):
        rng = np.random.default_rng([seed, index])
        write_clip(out / clip.file, clip, rng, _shifted(progress, index * FRAMES, len(clips) * FRAMES))
        written.append(out / clip.file)
    tables = {"truth.csv": truth_rows(clips), "truth_series.csv": series_rows(clips), "pressure_log.csv": log_rows(),
              "truth_force.csv": force_rows(seed), "explain/loops.csv": measured_rows(seed),
              "explain/simulated.csv": simulated_rows()}  # fmt: skip
    for name, rows in tables.items():
        (out / name).parent.mkdir(exist_ok=True)
        _write_csv(out / name, rows)
    texts = sample_texts(clips, seed)
    for name, text in texts.items():
        (out / name).parent.mkdir(exist_ok=True)
        with written_whole(out / name) as temporary:
            temporary.write_bytes(text if isinstance(text, bytes) else text.encode())
    write_simulated(out / SIMULATED, {clip.design for clip in clips})
    return [*written, *(out / name for name in (*tables, *texts, SIMULATED))]


def sample_clips(seed: int) -> tuple[SampleClip, ...]:
    """The 25 clips that a seed stands for: final angles from the published means and SDs, and scenes all unlike.

    Raises UsageError for a negative seed.
    """
    if seed < 0:
        raise UsageError(f"seed {seed} is negative", hint="give 0 or more")
    rng = np.random.default_rng(seed)
    clips: list[SampleClip] = []
    for (tw, slw), (mean, sd) in PUBLISHED_DEG.items():
        design = ShellDesign(strip_width_mm=slw, window_width_mm=tw)
        for sample, angle_deg in enumerate(rng.normal(mean, sd, SAMPLES), start=1):
            scale = round(design.length_mm / rng.uniform(830, 920), 5)
            scene = _scene(rng, design.length_mm / scale, len(clips))
            clips.append(SampleClip(design, sample, float(np.deg2rad(round(angle_deg, 4))), scale, scene))
    return tuple(clips)


def sample_texts(clips: Sequence[SampleClip], seed: int) -> dict[str, str | bytes]:
    """The files beside the clips that are text of their own making, by their place in the folder; bytes where it is not UTF-8."""
    return {
        **force_files(seed),
        "tensile_drawn.csv": tensile_text(seed),
        STUDY: sample_study([(clip.design, clip.sample, clip.file) for clip in clips], seed),
        "README.md": readme(_design_rows(clips), CONCAVITY, seed),
    }


def times_s() -> FloatArray:
    """(T,) time of every frame."""
    return np.arange(FRAMES) / FPS


def ramp(time_s: FloatArray) -> FloatArray:
    """(T,) pressure in MPa: rest, the paper's linear ramp from 0 to 0.35 MPa in 2.5 s, then held."""
    return PEAK_PRESSURE * np.clip((time_s - RAMP_START_S) / RAMP_S, 0, 1)


def response(share: FloatArray) -> FloatArray:
    """(T,) share of the final angle at a share of the final pressure, x·(1 + c·(1 − x)): smooth, rising, concave.

    The paper gives angles at 0.35 MPa; the way there is our choice.
    """
    return share * (1 + CONCAVITY * (1 - share))


def write_clip(path: Path, clip: SampleClip, rng: np.random.Generator, progress: Progress | None = None) -> None:
    """Draw and encode one clip."""
    write_drawn_film(path, clip.scene, clip.angles_rad(), rng, FPS, "`benchlab sample-data`", progress)


def truth_rows(clips: Iterable[SampleClip]) -> list[dict[str, object]]:
    """Rows of truth.csv: one per sample."""
    return [
        {
            "design": clip.design.name,
            "tw_mm": f"{clip.design.window_width_mm:g}",
            "slw_mm": f"{clip.design.strip_width_mm:g}",
            "sample": clip.sample,
            "file": clip.file,
            "length_mm": f"{clip.design.length_mm:g}",
            "scale_mm_per_px": f"{clip.scale_mm_per_px:.5f}",
            "pressure_MPa": PEAK_PRESSURE,
            "angle_deg": f"{np.rad2deg(clip.angle_rad):.4f}",
        }
        for clip in clips
    ]


def series_rows(clips: Iterable[SampleClip]) -> list[dict[str, object]]:
    """Rows of truth_series.csv: one per frame of every clip."""
    times = times_s()
    return [
        {"file": clip.file, "time_s": f"{t:.4f}", "pressure_MPa": f"{p:.4f}", "angle_deg": f"{angle:.4f}"}
        for clip in clips
        for t, p, angle in zip(times, ramp(times), np.rad2deg(clip.angles_rad()), strict=True)
    ]


def log_rows() -> list[dict[str, object]]:
    """Rows of pressure_log.csv: the pressure of all clips at 100 Hz, as a bench would have logged it."""
    times = np.arange(round(100 * FRAMES / FPS) + 1) / 100
    return [{"time_s": f"{t:.2f}", "pressure_kPa": f"{1000 * p:.2f}"} for t, p in zip(times, ramp(times), strict=True)]


def _scene(rng: np.random.Generator, length_px: float, index: int) -> Scene:
    """A bench with a camera and a lamp of its own: held at one of the four corners, bending into the picture."""
    left, up = index % 2 == 0, index // 2 % 2 == 0
    x, y = rng.uniform(330, 470), rng.uniform(190, 270)
    grey = rng.uniform(108, 146)
    tint = rng.normal(0, 2, 3)
    return Scene(
        length_px=length_px,
        base_px=(x if left else 1919 - x, y if up else 1079 - y),
        heading_rad=(0.0 if left else np.pi) + rng.uniform(-0.1, 0.1),
        bend_sign=1 if left == up else -1,
        marker_radius_px=rng.uniform(8, 10),
        body_width_px=rng.uniform(36, 44),
        background_rgb=(grey + tint[0], grey + tint[1], grey + tint[2]),
        light_gradient=rng.uniform(0.05, 0.35),
        blur_px=rng.uniform(0.5, 1.1),
    )


def _shifted(progress: Progress | None, before: int, total: int) -> Progress | None:
    """Progress of one clip told as progress of all."""
    return None if progress is None else lambda done, _: progress(before + done, total)


def _write_csv(path: Path, rows: list[dict[str, object]]) -> None:
    with written_whole(path) as temporary, temporary.open("w", encoding="utf-8", newline="") as file:
        table = csv.DictWriter(file, fieldnames=list(rows[0]), lineterminator="\n")
        table.writeheader()
        table.writerows(rows)


def _design_rows(clips: Iterable[SampleClip]) -> list[tuple[str, float, float, float, float]]:
    """Design, published mean and SD, mean and SD as drawn, all in degrees."""
    clips = list(clips)
    rows = []
    for (tw, slw), (mean, sd) in PUBLISHED_DEG.items():
        name = ShellDesign(strip_width_mm=slw, window_width_mm=tw).name
        drawn = np.rad2deg([clip.angle_rad for clip in clips if clip.design.name == name])
        rows.append((name, mean, sd, float(drawn.mean()), float(drawn.std(ddof=1))))
    return rows
