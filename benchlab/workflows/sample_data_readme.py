"""The README of the sample data."""

from __future__ import annotations

from collections.abc import Iterable

from benchlab.workflows.sample_force import drawn_words

TEXT = """# Sample data: drawn, not filmed

These 25 clips show no real actuator. They are drawn by benchlab, so that the bending angle in every frame is known
exactly and what the tracker says can be checked against it. Made, and made again, by

    benchlab sample-data --out sample_data{seed}

## What they follow
Five designs of the fabric-shelled bending actuator, five samples each. The bending angle of a sample at 0.35 MPa is
drawn from a normal distribution with the mean and standard deviation that the paper "Design and Modeling of
Fabric-Shelled Pneumatic Bending Soft Actuators" gives for its five measured samples (Table I). Five draws do not have
exactly the mean they come from:

| design | published mean ± SD, deg | as drawn, mean ± SD, deg |
|---|---|---|
{rows}

tw is the width of the TPU windows along the axis, slw that of the strain-limiting layer around the circumference, both
in mm.

## What is our choice
How the angle grows with pressure is not taken from any measurement; only its value at 0.35 MPa is. Pressure rests at 0
for 0.25 s, rises linearly to 0.35 MPa in 2.5 s (the paper's loading) and is held. The angle follows without delay, as
x·(1 + {concavity}·(1 − x)) of its final value, x being the share of the final pressure. The body is a perfect circular
arc, flat in the picture plane, under a camera without distortion. Position, direction, light, focus, colours and
scale differ from clip to clip. Ten red markers lie evenly along the 180 mm of the actuator, the first and the last at
its ends.

## Files
- `videos/<design>_s<sample>.mp4`: 1920×1080, 30 frames/s, 90 frames, H.264, BT.709, limited range, chroma sited left.
  Title and comment of each file say that it is drawn.
- `truth.csv`, one row per clip: `design`, `tw_mm`, `slw_mm`, `sample`, `file`, `length_mm` (actuator length al, first
  marker to last), `scale_mm_per_px`, `pressure_MPa`, and `angle_deg`, the true bending angle at that pressure. Angles
  are positive whichever way the body bends.
- `truth_series.csv`, one row per frame: `file`, `time_s`, `pressure_MPa`, `angle_deg`, in the middle of the exposure.
- `pressure_log.csv`, the same pressure at 100 Hz as a bench would log it, for `benchlab analyze --pressure`: `time_s`,
  `pressure_kPa`. Drawn too.
- `tensile_drawn.csv`: a tensile test as a testing machine exports it, for `benchlab fit-material`. Drawn: a Yeoh film whose
  coefficients, and the noise, stand in its first line.
- `force/tw3_slw10_a1.csv`, `_a2`, `_a3`: blocked force of three actuators as three machines export it (English in N, German in kN,
  imperial in lbf), for `benchlab force`. Drawn: forces linear in pressure, at 0.35 MPa from a normal distribution with the published
  37.72 ± 1.56 N of three actuators ({force}); ten steps from 0.035 to 0.35 MPa, five cycles each. Our choice: cycles scatter by 0.15 N, the
  load cell's zero is off and drifts, noise 0.04 N. Each says in its preamble that it is drawn.
- `truth_force.csv`, one row per cycle of these: `file`, `cycle`, `pressure_MPa`, `peak_N`, without noise and zero.
- `study.yaml`: all of these as one study, for `benchlab study check` and `benchlab report`: the designs, their samples with their clips,
  the slw set at tw 3 and the tw set at slw 10, and the force records.
- `simulated.h5`: simulated, not measured: angles of these designs against pressure as `benchlab sweep --tw-mm 3,9,15 --slw-mm 5,10,20
  --no-blocked` simulates them, with a film identified from the paper's FEM angles. Its numbers do not depend on the clips.
- `explain/loops.csv`, `explain/simulated.csv`: simulated, not measured: a study for `benchlab explain`. Three made-up designs bend by
  the curve above to 110, 80 and 55° at 0.35 MPa, which simulated.csv has. loops.csv has four samples of each in one slow cycle and two fast
  ones; they differ by 2 % in gain and 1 % in shape, a reading scatters by 0.2°, and all have a play of ±14 °/MPa between bladder and
  shell, which the curves lack.

The same seed draws the same pictures; the files are the same bytes only with the same version of the encoder.
"""


def readme(designs: Iterable[tuple[str, float, float, float, float]], concavity: float, seed: int) -> str:
    """The text beside the clips.

    designs: name, published mean and SD, mean and SD as drawn, in degrees. concavity: c of x·(1 + c·(1 − x)).
    """
    rows = "\n".join(
        f"| {name} | {mean:.1f} ± {sd:.1f} | {got_mean:.1f} ± {got_sd:.1f} |"
        for name, mean, sd, got_mean, got_sd in designs
    )
    return TEXT.format(
        rows=rows, concavity=concavity, force=drawn_words(seed), seed="" if seed == 1 else f" --seed {seed}"
    )
