"""`benchlab analyze`."""

from __future__ import annotations

import functools
import json
import time
from pathlib import Path
from typing import Any

import click

from benchlab.cli.options import Finite, Numbers
from benchlab.errors import BatchError, BenchlabError, InputError, printable

NUMBER = Finite()


@click.command(short_help="Curvature and bending angle from videos of marked actuators.")
@click.argument("inputs", metavar="VIDEO...", nargs=-1, required=True, type=click.Path(path_type=Path))
@click.option(
    "--out",
    type=click.Path(path_type=Path, file_okay=True),
    help="Folder for the results. [default: beside each video]",
)
@click.option(
    "--length-mm", type=NUMBER, default=180.0, show_default=True, help="Actuator length al: angle = curvature x al."
)
@click.option("--markers", type=int, help="How many markers the actuator carries. [default: found from the pictures]")
@click.option(
    "--colour",
    "--color",
    default="red",
    show_default=True,
    help="Of the markers: red, orange, yellow, green, cyan, blue, magenta.",
)
@click.option(
    "--threshold", type=NUMBER, help="Level of the marker colour, 128 grey to 255. [default: found from the pictures]"
)
@click.option(
    "--roi",
    "roi_px",
    type=Numbers("LEFT", "TOP", "WIDTH", "HEIGHT"),
    help="Look only here; pixels of the picture as displayed.",
)
@click.option(
    "--fit",
    type=click.Choice(["kasa", "pratt", "taubin", "hyper", "geometric"]),
    default="taubin",
    show_default=True,
    help="Circle fit.",
)
@click.option(
    "--flip",
    is_flag=True,
    help="Turn the sign of the angle round. It is positive towards the side of the largest bend.",
)
@click.option("--scale-mm-per-px", type=NUMBER, help="Millimetres a pixel. Give this or one of the next three.")
@click.option("--reference-mm", type=NUMBER, help="Known distance between the two points of --reference-px.")
@click.option(
    "--reference-px", type=Numbers("X1", "Y1", "X2", "Y2"), help="Two points picked in the picture as displayed."
)
@click.option("--marker-span-mm", type=NUMBER, help="Length of the body from the first to the last marker.")
@click.option("--aruco-mm", type=NUMBER, help="Side of an ArUco marker in view, in the plane of the actuator.")
@click.option(
    "--aruco-dictionary", default="4x4_50", show_default=True, help="Which ArUco markers: 4x4_50, 5x5_100, 6x6_250, ..."
)
@click.option("--lens", type=click.Path(), help="Lens file made by `benchlab calibrate camera`.")
@click.option("--pressure", type=click.Path(), help="CSV (units in the header) or run file with time and pressure.")
@click.option("--ramp", metavar="START:END:SECONDS", help="Linear pressure ramp in MPa, as 0:0.35:2.5.")
@click.option(
    "--sync",
    metavar="SECONDS|onset",
    help="Video time at which the pressure record or ramp starts, or `onset` of motion. [default: 0 for --pressure, or by the "
    "camera trigger of a run; onset for --ramp]",
)
@click.option("--overlay", is_flag=True, help="Also write a video with markers, circle and angle drawn in.")
@click.option("--stream", type=click.IntRange(0), default=0, show_default=True, help="Which video stream of the file.")
@click.option("--fps", type=NUMBER, help="Frame rate, for stills and for files without time stamps.")
@click.option("--capture-fps", type=NUMBER, help="True rate of a slow-motion file that is tagged with a lower one.")
@click.option("--fast", is_flag=True, help="Skip the decoder's deblocking filter: faster, pixels differ slightly.")
@click.option("--allow-partial", is_flag=True, help="Use what can be read of a damaged or truncated recording.")
@click.option("--max-pixels", type=int, default=64_000_000, show_default=True, help="Largest picture that is opened.")
@click.option(
    "--max-missing", type=NUMBER, default=1.0, show_default=True, help="Largest share of frames that may go unmeasured."
)
@click.option(
    "--jobs",
    type=click.IntRange(1),
    default=1,
    show_default=True,
    help="Videos at once. One already uses all cores to decode.",
)
@click.option("--overwrite", is_flag=True, help="Analyse again, and replace files that are not benchlab's.")
@click.option("--strict", is_flag=True, help="Exit with 3 if there is any warning.")
@click.option("--json", "as_json", is_flag=True, help="One JSON document on standard output.")
def analyze(
    inputs: tuple[Path, ...], out: Path | None, jobs: int, overwrite: bool, strict: bool, as_json: bool, **options: Any
) -> int:
    """Find the markers on a bending actuator in each VIDEO (or folder of stills), fit a circle through them in every
    frame, and write its curvature and bending angle, with their uncertainty, against time.

    \b
    Writes, beside each video or in --out:
      NAME.csv   a row a frame: time_s, angle_deg, angle_sd_deg, curvature_per_mm, ... and a flag
      NAME.h5    the same with marker tracks, fits, settings and provenance (HDF5, NXdata)
      NAME.png   angle over time, and over pressure where that is known

    \b
    Examples:
      benchlab analyze trial.mp4
      benchlab analyze *.mov --length-mm 150 --ramp 0:0.35:2.5 --out results --jobs 2
      benchlab analyze stills/ --scale-mm-per-px 0.176 --markers 5
    """
    from benchlab.cli.progress import progress
    from benchlab.workflows.batch import Outcome, run_batch
    from benchlab.workflows.outputs import Outputs, refuse_same_names
    from benchlab.workflows.recordings import expand

    started = time.monotonic()
    settings = _settings(options)
    settings.check()
    sources = expand(inputs)
    refuse_same_names([Outputs.of(source, out, overwrite) for source in sources])
    work = functools.partial(_work, settings=settings, out=out, overwrite=overwrite, quiet=jobs > 1)
    outcomes: list[Outcome[Path]] = []
    with progress("recordings", quiet=jobs == 1) as report:
        try:
            for outcome in run_batch(sources, work, jobs):
                outcomes.append(outcome)
                _tell(outcome, len(sources))
                if report:
                    report(len(outcomes), len(sources))
                if outcome.result and outcome.result["status"] == "partial":
                    break
        except KeyboardInterrupt:
            finished = f"{len(outcomes)} of {len(sources)} recordings are done"
            click.echo(f"benchlab: {finished}; those under way are kept as far as they got, marked partial", err=True)
            raise
    done = [o.result for o in outcomes if o.result]
    failed = [o.error for o in outcomes if o.error]
    if len(sources) == 1 and failed:
        raise failed[0]
    if as_json:
        document = {
            "videos": done,
            "failed": [e.as_json()["error"] for e in failed],
            "seconds": round(time.monotonic() - started, 3),
        }
        click.echo(json.dumps(document, indent=2, allow_nan=False))
    return _exit_code(done, failed, len(sources), strict)


def _settings(options: dict[str, Any]) -> Any:
    from benchlab.workflows.settings import AnalyzeSettings

    sync = options.pop("sync")
    onset = sync == "onset"
    seconds = None if sync is None or onset else NUMBER.convert(sync, None, click.get_current_context())
    return AnalyzeSettings(**options, sync=seconds, sync_onset=onset)


def _work(source: Path, settings: Any, out: Path | None, overwrite: bool, quiet: bool) -> dict[str, Any]:
    """One recording, in this process or in a worker."""
    from benchlab.cli.progress import progress
    from benchlab.workflows.analyze import analyze as analyze_recording
    from benchlab.workflows.outputs import Outputs

    with progress(source.name, quiet) as report:
        return analyze_recording(source, settings, Outputs.of(source, out, overwrite), report)


def _tell(outcome: Any, of: int) -> None:
    """One block of lines on standard error for what became of a recording."""
    if outcome.error:
        if of > 1:
            click.echo(f"benchlab: {_placed(outcome.error, outcome.item)}", err=True)
        return
    result = outcome.result
    name = printable(result["video"])
    if result["status"] == "current":
        click.echo(f"{name}: current, skipped (--overwrite to analyse again); {_largest(result)}", err=True)
        return
    partial = "PARTIAL, interrupted; " if result["status"] == "partial" else ""
    click.echo(
        f"{name}: {partial}{result['frames_measured']} of {result['frames']} frames measured; "
        f"{result['markers']} markers; {_largest(result)}",
        err=True,
    )
    for warning in result["warnings"]:
        click.echo(f"  warning: {printable(warning)}", err=True)
    for path in result["outputs"]:
        click.echo(f"  wrote {printable(path)}", err=True)


def _largest(result: dict[str, Any]) -> str:
    sd = result["max_angle_sd_deg"]
    spread = "of unknown uncertainty" if sd is None else f"± {sd:.2f} deg (1 sd)"
    return f"largest angle {result['max_angle_deg']:.2f} {spread}"


def _placed(error: BenchlabError, source: Path) -> str:
    return str(error) if error.file else f"{printable(source)}: {error}"


def _exit_code(done: list[Any], failed: list[BenchlabError], wanted: int, strict: bool) -> int:
    if any(result["status"] == "partial" for result in done):
        click.echo("benchlab: interrupted; what was measured is kept, marked partial", err=True)
        return 130
    if failed:
        click.echo(f"benchlab: {len(done)} of {wanted} recordings analysed, {len(failed)} failed (above)", err=True)
        return BatchError.exit_code
    if strict and any(result["warnings"] for result in done):
        click.echo("benchlab: there are warnings, and --strict was given", err=True)
        return InputError.exit_code
    return 0
