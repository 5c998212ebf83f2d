"""What `benchlab analyze` reaches: `python tests/benchmarks/see.py [speed] [memory] [accuracy] [real]` prints tables.

Clips are drawn into --cache and kept. Speeds are ratios within one run: each round times ffmpeg, benchlab and the
naive loop one after another, and the median of the rounds' ratios is shown.
"""

from __future__ import annotations

import argparse
import json
import os
import platform
import statistics
import subprocess
import sys
import tempfile
import time
from datetime import date
from pathlib import Path

import numpy as np
from clips import encoded, looped_clip
from scenes import SCENES

from benchlab.vision.circle import fit_circles
from benchlab.vision.synthetic import marker_truth
from benchlab.workflows.measure import measure
from benchlab.workflows.settings import AnalyzeSettings

REAL = Path(__file__).resolve().parents[2].parent / "shared" / "real" / "video"
CLEAN = (
    "clean_0_180",
    "clean_fast",
    "uneven_light",
    "blur",
    "full_range_601",
    "small_markers",
    "straight",
    "near_straight",
    "beyond_180",
)
DISTURBED = ("clutter", "occlusion", "leaves_view")
GEOMETRY = ("perspective", "lens")

NAIVE = """
import sys, cv2, numpy as np
video = cv2.VideoCapture(sys.argv[1]); kernel = np.ones((5, 5), np.uint8); count = 0
while True:
    good, bgr = video.read()
    if not good: break
    hsv = cv2.cvtColor(bgr, cv2.COLOR_BGR2HSV)
    mask = cv2.inRange(hsv, (0, 90, 60), (12, 255, 255)) | cv2.inRange(hsv, (168, 90, 60), (180, 255, 255))
    mask = cv2.morphologyEx(mask, cv2.MORPH_OPEN, kernel)
    contours, _ = cv2.findContours(mask, cv2.RETR_EXTERNAL, cv2.CHAIN_APPROX_SIMPLE)
    points = []
    for contour in contours:
        m = cv2.moments(contour)
        if m["m00"] > 20: points.append((m["m10"] / m["m00"], m["m01"] / m["m00"]))
    count += len(points)
"""


def timed(command: list[str | Path]) -> float:
    started = time.perf_counter()
    subprocess.run(command, check=True, capture_output=True)
    return time.perf_counter() - started


def analyze_command(clip: Path, *options: str) -> list[str | Path]:
    out = tempfile.mkdtemp()
    return [sys.executable, "-m", "benchlab", "analyze", clip, "--out", out, "--overwrite", *options]


def speed(cache: Path, rounds: int, sizes: list[int]) -> None:
    """Whole command, files and start-up included, against ffmpeg's null decode and the naive OpenCV loop."""
    print(
        "\n| clip | ffmpeg -f null, frames/s | benchlab | benchlab --fast | naive OpenCV | benchlab / ffmpeg | --fast / ffmpeg | benchlab / naive |"
    )
    print("|---|---|---|---|---|---|---|---|")
    for lines, fps, frames, megabits in ((1080, 60, 3600, 40), (2160, 30, 900, 80)):
        if lines not in sizes:
            continue
        clip = looped_clip(cache, lines, fps, frames, megabits)
        rows = []
        for _ in range(rounds):
            rows.append(
                (
                    timed(["ffmpeg", "-v", "error", "-i", clip, "-f", "null", "-"]),
                    timed(analyze_command(clip)),
                    timed(analyze_command(clip, "--fast")),
                    timed([sys.executable, "-c", NAIVE, clip]),
                )
            )
        rate = [frames / statistics.median(column) for column in zip(*rows)]
        ratio = [statistics.median(row[a] / row[b] for row in rows) for a, b in ((0, 1), (0, 2), (3, 1))]
        size = clip.stat().st_size * 8 / (frames / fps) / 1e6
        print(f"| {lines}p{fps}, {frames} frames, {size:.0f} Mb/s | " + " | ".join(f"{r:.0f}" for r in rate) + " | "
              + " | ".join(f"**{r:.2f}**" for r in ratio) + " |", flush=True)  # fmt: skip


def memory(cache: Path) -> None:
    """Largest resident memory of the whole command."""
    peak = {}
    for frames in (1000, 10_000):
        clip = looped_clip(cache, 1080, 60, frames, 10)
        command = ["-c", "import resource,runpy,sys; sys.argv=sys.argv[1:]\ntry: runpy.run_module('benchlab', run_name='__main__')\n"
                   "except SystemExit: pass\nprint(resource.getrusage(resource.RUSAGE_SELF).ru_maxrss)"]  # fmt: skip
        done = subprocess.run(
            [sys.executable, *command, *analyze_command(clip)[2:]], check=True, capture_output=True, text=True
        )
        peak[frames] = int(done.stdout.split()[-1]) / 1024
    print(
        f"\nmemory: {peak[1000]:.0f} MiB for 1,000 frames, {peak[10_000]:.0f} MiB for 10,000: **{peak[10_000] / peak[1000]:.2f} ×**"
    )


def accuracy(cache: Path) -> dict[str, dict[str, float]]:
    """Against drawn truth, after encoding; the scale is given, as it is known."""
    print(
        "\n| scene | frames | measured | centroid mean / p95 px | θ error mean / p95 / max ° | largest unflagged ° | within ±2 sd | median sd ° |"
    )
    print("|---|---|---|---|---|---|---|---|")
    results = {}
    for name, (scene, angles, fps) in SCENES.items():
        clip = encoded(cache, name, scene, angles, fps)
        series = measure(clip, AnalyzeSettings(scale_mm_per_px=180.0 / scene.length_px)).series
        truth = marker_truth(scene, angles).positions_px
        results[name] = row = _compare(series, truth, np.degrees(angles))
        print(f"| {name} | {len(angles)} | {row['measured']:.0%} | {row['px_mean']:.3f} / {row['px_p95']:.3f} | {row['mean']:.3f} / {row['p95']:.3f} / {row['max']:.2f} "
              f"| {row['max_unflagged']:.2f} | {row['coverage']:.1%} | {row['sd']:.3f} |", flush=True)  # fmt: skip
    return results


def _compare(series, truth: np.ndarray, angle_deg: np.ndarray) -> dict[str, float]:
    found = series.markers_px
    if found.shape[1] == truth.shape[1]:
        both = [np.hypot(*np.moveaxis(found - t, -1, 0)) for t in (truth, truth[:, ::-1])]
        apart = min(both, key=np.nanmean)
        apart = apart[np.isfinite(apart)]
    else:
        apart = np.array([np.nan])
    got = np.degrees(series.angle_rad)
    error = np.abs(got - angle_deg)
    seen = series.measured
    plain = seen & np.array([not f for f in series.flag])
    sd = np.degrees(series.angle_sd_rad)
    inside = error[seen] <= 2 * sd[seen]
    return {
        "measured": seen.mean(), "px_mean": float(apart.mean()), "px_p95": float(np.percentile(apart, 95)),
        "mean": float(error[seen].mean()), "p95": float(np.percentile(error[seen], 95)), "max": float(error[seen].max()),
        "max_unflagged": float(error[plain].max(initial=0)), "coverage": float(inside.mean()), "sd": float(np.median(sd[seen])),
        "frames": int(seen.sum()), "inside": int(inside.sum()),
    }  # fmt: skip


def summary(results: dict[str, dict[str, float]]) -> None:
    """The bars of the issue, from the scenes above."""

    def pooled(names: tuple[str, ...], key: str) -> float:
        return max(results[name][key] for name in names if name in results)

    clean = [results[n] for n in CLEAN if n in results]
    weight = [r["frames"] for r in clean]
    print("\n| bar | figure |\n|---|---|")
    print(
        f"| centroid, clean scenes, mean / p95 (worst scene) | {np.average([r['px_mean'] for r in clean], weights=weight):.3f} / {pooled(CLEAN, 'px_p95'):.3f} px |"
    )
    print(
        f"| θ, clean scenes, mean / p95 (worst scene) | {np.average([r['mean'] for r in clean], weights=weight):.3f} / {pooled(CLEAN, 'p95'):.3f} ° |"
    )
    print(f"| θ, clutter and occlusion, p95 (worst scene) | {pooled(DISTURBED, 'p95'):.3f} ° |")
    print(
        f"| largest unflagged error, all scenes but the bent geometry | {pooled(CLEAN + DISTURBED, 'max_unflagged'):.2f} ° |"
    )
    print(f"| coverage of ±2 sd, clean scenes together | {sum(r['inside'] for r in clean) / sum(weight):.1%} |")


def real() -> None:
    """The seven real stills, and the published circle."""
    if (REAL / "red_pins").is_dir():
        series = measure(REAL / "red_pins", AnalyzeSettings(scale_mm_per_px=0.176)).series
        print("\n| still | pins | fit rms px | flag |\n|---|---|---|---|")
        for name, n, rms, flag in zip(
            series.names, np.isfinite(series.markers_px[..., 0]).sum(axis=1), series.fit_rms_px, series.flag
        ):
            print(f"| {name} | {n} | {rms:.2f} | {flag} |")
    else:
        print("\nreal stills: absent, skipped")
    points = np.array([(1, 7), (2, 6), (5, 8), (7, 7), (9, 5), (3, 7)], float)[None]
    fit = fit_circles(points, method="geometric")
    print(
        f"\nGander–Golub–Strebel: centre ({fit.centre[0, 0]:.4f}, {fit.centre[0, 1]:.4f}), radius {fit.radius[0]:.4f}"
    )


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("parts", nargs="*", default=["speed", "memory", "accuracy", "real"])
    parser.add_argument("--cache", type=Path, default=Path(tempfile.gettempdir()) / "benchlab-clips")
    parser.add_argument("--rounds", type=int, default=3)
    parser.add_argument("--lines", type=int, nargs="*", default=[1080, 2160], help="picture heights to time")
    parser.add_argument("--save", type=Path, help="also write the accuracy figures as JSON")
    chosen = parser.parse_args()
    print(f"{date.today()}, {platform.machine()}, {os.cpu_count()} cores, Python {platform.python_version()}")
    if "accuracy" in chosen.parts:
        results = accuracy(chosen.cache)
        summary(results)
        if chosen.save:
            chosen.save.write_text(json.dumps(results, indent=1))
    if "real" in chosen.parts:
        real()
    if "memory" in chosen.parts:
        memory(chosen.cache)
    if "speed" in chosen.parts:
        speed(chosen.cache, chosen.rounds, chosen.lines)


if __name__ == "__main__":
    main()
