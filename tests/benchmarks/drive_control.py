"""Curvature control on the twin: `python tests/benchmarks/drive_control.py [--seeds 20]` prints what is reached.

The way of docs/control.md without its files: flex calibration, identification run, tuning, then the sine of `protocols/sine_tracking.yaml` with PI,
with PI found by hand, and with PI and feed-forward. Line and gains come from runs with other seeds than those that are judged, and are
kept where the twin is changed. Errors are told against the flex sensor and against the twin's truth, after the approach.
"""

from __future__ import annotations

import argparse
import math
from collections.abc import Callable, Iterator
from dataclasses import dataclass, fields, replace
from typing import Any

import numpy as np

from benchlab.actuator import ShellDesign
from benchlab.bench import Bench
from benchlab.control.controller import Controller
from benchlab.control.feed_forward import FeedForward, InverseCurve
from benchlab.control.flex import FlexCalibration, calibrate_flex
from benchlab.control.pi import PI
from benchlab.control.plant import Identification, identify
from benchlab.control.tracking import Tracking, track
from benchlab.control.tuning import Tuning, tune
from benchlab.devices.twin.bench import twin_bench
from benchlab.devices.twin.twin import Twin
from benchlab.io.journal import SAMPLE
from benchlab.io.protocol_file import read_protocol
from benchlab.io.twin_file import read_twin
from benchlab.protocol.curvature import AngleHold, AngleRamp, AngleSine
from benchlab.protocol.plan import Plan
from benchlab.protocol.unroll import unroll
from benchlab.runner.clock import VirtualClock
from benchlab.runner.guards.limits import Limits
from benchlab.runner.run import execute
from benchlab.twin.effects.catalogue import EFFECTS
from benchlab.twin.effects.effect import Effect
from benchlab.twin.settings import TwinSettings
from benchlab.units import FloatArray
from benchlab.workflows.run_curve import simulated_curve

CALIBRATION_SEED, IDENTIFICATION_SEED = 1001, 1002
SETTLE_S = 10.0
"""The approach and its hold: what is judged is the sine alone."""

HAND = (0.0016, 0.032)
"""MPa/°, MPa/(°·s), by hand on the twin: both doubled until it swung (0.0128, 0.256), and three steps back. The paper does not publish its own."""

PAPER_AMPLITUDE_DEG = 6.72 * math.sqrt(2 / 0.04)
"""Of the sine to which R² 0.96 and RMSE 6.72° belong: 47.5°."""

STRENGTHS = {
    "regulator_lag": ("lag_s", "deadband_MPa"),
    "line_resistance": ("resistance_MPa_s_per_mL",),
    "viscoelasticity": ("share_1", "share_2"),
    "friction": ("half_width_deg", "half_width_deg_per_MPa"),
    "sensor_noise": ("flex_sd_V", "monitor_sd_V"),
}
"""What is made larger and smaller of each effect; the steps of the DAC stay."""

Maker = Callable[[], Controller]


class Kept:
    """A journal that is kept in memory."""

    def __init__(self) -> None:
        self.rows: list[tuple[Any, ...]] = []

    def sample(self, *values: Any) -> None:
        self.rows.append(values)

    def event(self, kind: str, **content: Any) -> None:
        pass


@dataclass(frozen=True)
class Run:
    """Samples of the journal, and the true angle at each."""

    samples: np.ndarray
    true_deg: FloatArray

    def __getitem__(self, name: str) -> FloatArray:
        return np.asarray(self.samples[name], dtype=float)


def run(plan: Plan, settings: TwinSettings, bench: Bench, controller: Controller | None = None) -> Run:
    """A plan on a twin in virtual time, by the runner's own loop with its guards. RuntimeError where it does not complete."""
    twin, kept = Twin(settings, bench), Kept()
    end = execute(plan, twin, bench, kept, VirtualClock(), controller, limits=Limits(empty_s=math.inf))
    if end.reason != "completed":
        raise RuntimeError(f"the run ended by {end.reason}: {end.cause.words}")
    return Run(np.array(kept.rows, SAMPLE), twin.truth.angle_deg)


@dataclass(frozen=True)
class Tuned:
    """A bench that went through flex calibration and tuning."""

    bench: Bench
    twin: TwinSettings
    flex: FlexCalibration
    plant: Identification
    tuning: Tuning

    def makers(self, curve: tuple[FloatArray, FloatArray] | None = None) -> dict[str, Maker]:
        """The three controllers; curve: for the feed-forward, in place of the twin's own."""
        tuning, top = self.tuning, self.bench.ceiling_MPa
        gains = tuning.kp_MPa_per_deg, tuning.ki_MPa_per_deg_s
        points = (self.twin.curve.pressure_MPa, self.twin.curve.angle_deg) if curve is None else curve
        return {
            "PI by hand": lambda: PI(*HAND, top),
            "PI": lambda: PI(*gains, top),
            "PI + feed-forward": lambda: FeedForward(PI(*gains, top), InverseCurve(*points, top), tuning.lead_s),
        }


def tuned(twin: TwinSettings | None = None) -> Tuned:
    """From a fresh bench to gains; on the twin that comes with benchlab where None."""
    twin = read_twin(None) if twin is None else twin
    plan, bench = read_protocol("flex_calibration"), replace(twin_bench(), flex=None)
    seen = run(plan, replace(twin, seed=CALIBRATION_SEED), bench)
    flex = calibrate_flex(seen["time_s"], seen["command_MPa"], seen["flex_V"], seen["time_s"], seen.true_deg)
    bench = replace(bench, flex=flex.bench_line)
    seen = run(plan, replace(twin, seed=IDENTIFICATION_SEED), bench)
    plant = identify(seen["time_s"], seen["command_MPa"], seen["angle_deg"])
    return Tuned(bench, twin, flex, plant, tune([each.cautious for each in plant.plants], plan.rate_Hz))


def sine(frequency_Hz: float = 0.2, amplitude_deg: float = 30.0) -> Plan:
    """The shipped sine, or one like it."""
    shipped = read_protocol("sine_tracking")
    if (frequency_Hz, amplitude_deg) == (0.2, 30.0):
        return shipped
    cycles = max(2, round(40 * frequency_Hz))
    segments = (AngleRamp(60.0, 5.0), AngleHold(60.0, 5.0), AngleSine(60.0, amplitude_deg, frequency_Hz, cycles))
    return unroll(segments, "sine", shipped.rate_Hz, shipped.limit_MPa, shipped.control)


def scaled(twin: TwinSettings, factor: float) -> TwinSettings:
    """All effects so many times as strong."""

    def one(effect: Effect) -> Effect:
        chosen = STRENGTHS.get(effect.name, ())
        return replace(effect, **{f.name: factor * getattr(effect, f.name) for f in fields(effect) if f.name in chosen})

    return replace(twin, effects={name: one(effect) for name, effect in twin.effects.items()})


@dataclass(frozen=True)
class Judged:
    """Tracking of several runs against the flex sensor and against the truth."""

    measured: list[Tracking]
    true: list[Tracking]

    @property
    def r_squared(self) -> float:
        """The least of all runs, against either."""
        return min(one.r_squared for one in (*self.measured, *self.true))

    @property
    def rmse_deg(self) -> float:
        """The largest of all runs, against either."""
        return max(one.rmse_deg for one in (*self.measured, *self.true))


def judged(plan: Plan, twin: TwinSettings, bench: Bench, maker: Maker, seeds: int) -> Judged:
    """`seeds` runs of a closed loop."""
    found: tuple[list[Tracking], list[Tracking]] = ([], [])
    for seed in range(1, seeds + 1):
        seen = run(plan, replace(twin, seed=seed), bench, maker())
        for angle, kept in zip((seen["angle_deg"], seen.true_deg), found):
            kept.append(
                track(seen["time_s"], seen["reference_deg"], angle, seen["command_MPa"], bench.ceiling_MPa, SETTLE_S)
            )
    return Judged(*found)


def rows(seeds: int = 20) -> Iterator[tuple[str, str, bool]]:
    """The bars of control: bar, figure, whether it is met. The worst of all seeds, of sensor and truth, counts."""
    known = tuned()
    bars = {"PI": (0.96, 6.72), "PI + feed-forward": (0.995, 2.0)}
    for name, (least, most) in bars.items():
        for amplitude in (30.0, PAPER_AMPLITUDE_DEG):
            found = judged(sine(amplitude_deg=amplitude), known.twin, known.bench, known.makers()[name], seeds)
            bar = f"sine 0.2 Hz ± {amplitude:.3g}°, {name}: R² ≥ {least:g}, RMSE ≤ {most:g}°"
            figure = f"R² {found.r_squared:.4f}, RMSE {found.rmse_deg:.2f}° (worst of {seeds} seeds)"
            yield bar, figure, found.r_squared >= least and found.rmse_deg <= most


def controllers(known: Tuned, seeds: int) -> None:
    print(f"\n0.2 Hz, 60° ± 30°, {seeds} seeds: mean (worst), against the flex sensor and against the truth; effort")
    for name, maker in known.makers().items():
        found = judged(sine(), known.twin, known.bench, maker, seeds)
        words = []
        for each in (found.measured, found.true):
            r, e = np.array([one.r_squared for one in each]), np.array([one.rmse_deg for one in each])
            words.append(f"R² {r.mean():.4f} ({r.min():.4f}) RMSE {e.mean():.2f}° ({e.max():.2f}°)")
        one = found.true[0]
        print(f"  {name:18} {words[0]} | {words[1]} | lag {1000 * one.lag_s:4.0f} ms, max {one.max_deg:.2f}°, "
              f"tip {one.tip_rmse_mm:.2f} mm, {one.variation_MPa_per_s:.3f} MPa/s")  # fmt: skip


def robustness(known: Tuned, seeds: int) -> None:
    """Line and gains stay those of the twin as it is."""
    twin, curve = known.twin, (known.twin.curve.pressure_MPa, known.twin.curve.angle_deg)
    cases: list[tuple[str, Plan, TwinSettings, tuple[FloatArray, FloatArray]]] = [("as it is", sine(), twin, curve)]
    cases += [(f"effects × {f:g}", sine(), scaled(twin, f), curve) for f in (0.5, 1.5, 2.0)]
    cases += [(f"{f:g} Hz", sine(f), twin, curve) for f in (0.1, 0.3, 0.4, 0.5)]
    cases += [("± 47.5°", sine(amplitude_deg=PAPER_AMPLITUDE_DEG), twin, curve)]
    cases += [(f"curve × {f:g}", sine(), twin, (curve[0], f * curve[1])) for f in (0.9, 1.1)]
    for design in (ShellDesign(10, 9), ShellDesign(5, 3)):
        other = simulated_curve(design)
        cases.append((f"curve of {design.name}", sine(), twin, (other.pressure_MPa, other.angle_deg)))
    print(f"\nthe worst of {seeds} seeds, of sensor and truth: R², RMSE")
    print(f"  {'':22}" + "".join(f"{name:>22}" for name in known.makers()))
    for name, plan, changed, own in cases:
        words = []
        for maker in known.makers(own).values():
            found = judged(plan, changed, known.bench, maker, seeds)
            words.append(f"{found.r_squared:.4f} {found.rmse_deg:6.2f}°")
        print(f"  {name:22}" + "".join(f"{word:>22}" for word in words))


def true_margins(known: Tuned) -> None:
    """By what factor the tuned gains can be multiplied before the twin swings, beside the computed gain margin."""
    tuning, top = known.tuning, known.bench.ceiling_MPa
    curve = known.twin.curve
    print(
        "\ngain margin: computed from the plant, and found on the twin by holding an angle with larger and larger gains"
    )
    for level in (20.0, 60.0, 100.0):
        pressure = float(np.interp(level, curve.angle_deg, curve.pressure_MPa))
        near = sorted(zip(known.plant.plants, tuning.margins), key=lambda pair: abs(pair[0].pressure_MPa - pressure))[
            :2
        ]
        computed = min(margins.gain_margin for _, margins in near)
        plan = unroll((AngleRamp(level, 2.0), AngleHold(level, 6.0)), "hold", 100.0, 0.35)
        low, high = 1.0, 10.0
        while high - low > 0.1:
            factor = (low + high) / 2
            pi = PI(factor * tuning.kp_MPa_per_deg, factor * tuning.ki_MPa_per_deg_s, top)
            seen = run(plan, known.twin, known.bench, pi)
            swings = float(seen.true_deg[seen["time_s"] > 5].std()) > 1.0
            low, high = (low, factor) if swings else (factor, high)
        print(f"  {level:4.0f}° ({pressure:.3f} MPa): computed {computed:.2f}, on the twin {low:.1f}")


class BackCalculation(PI):
    """Anti-windup by back-calculation: I' = ki·e + (given − wanted)/Tt (Åström and Hägglund 2006, section 3.5)."""

    tracking_s = 0.01

    def _integrate(self, rest_MPa: float, error: float, dt_s: float) -> bool:
        self._integral += self.ki * dt_s * error
        wanted = rest_MPa + self._integral
        over = wanted - min(max(wanted, 0.0), self.ceiling_MPa)
        self._integral -= over * min(1.0, dt_s / self.tracking_s)
        return over != 0


class WindsUp(PI):
    """None at all."""

    def _integrate(self, rest_MPa: float, error: float, dt_s: float) -> bool:
        self._integral += self.ki * dt_s * error
        return False


def windup(known: Tuned) -> None:
    """A sine of 70° ± 70°, the top of which is beyond reach."""
    segments = (AngleRamp(70.0, 5.0), AngleHold(70.0, 5.0), AngleSine(70.0, 70.0, 0.2, 6))
    plan = unroll(segments, "beyond reach", 100.0, 0.35)
    gains = known.tuning.kp_MPa_per_deg, known.tuning.ki_MPa_per_deg_s
    integral_s = gains[0] / gains[1]
    print("\na sine beyond reach, PI: RMSE and largest error, of angles that can be reached")
    kinds: list[tuple[str, type[PI], float]] = [("conditional integration", PI, 0.0)]
    kinds += [(f"back-calculation, {t:.3g} s", BackCalculation, t) for t in (0.01, integral_s, 5 * integral_s, 0.5)]
    for name, kind, tracking_s in [*kinds, ("none", WindsUp, 0.0)]:
        pi = kind(*gains, known.bench.ceiling_MPa)
        if isinstance(pi, BackCalculation):
            pi.tracking_s = tracking_s
        seen = run(plan, known.twin, known.bench, pi)
        reach = known.twin.curve.angle_deg[-1] - 8
        used = (seen["time_s"] > SETTLE_S) & (seen["reference_deg"] < reach)
        error = (seen["reference_deg"] - seen.true_deg)[used]
        print(f"  {name:28} {np.sqrt(np.mean(error**2)):6.2f}° {np.abs(error).max():6.2f}°")


def further_effects(known: Tuned, seeds: int) -> None:
    """Physics that the default twin leaves out, with its typical values; line and gains stay."""
    print(f"\nfurther effects of the twin, worst of {seeds} seeds: RMSE against the flex sensor / against the truth")
    several = ("softening", "leakage", "temperature", "gravity")
    for added in (several, ("flex_hysteresis",)):
        twin = replace(known.twin, effects={**known.twin.effects, **{name: EFFECTS[name]() for name in added}})
        words = []
        for name, maker in known.makers().items():
            found = judged(sine(), twin, known.bench, maker, seeds)
            sides = (max(one.rmse_deg for one in each) for each in (found.measured, found.true))
            words.append(f"{name} {' / '.join(f'{side:.2f}°' for side in sides)}")
        print(f"  {', '.join(added)}: {', '.join(words)}")


def slower(seeds: int) -> None:
    """A regulator that is several times as slow, with line and gains found on it."""
    twin = read_twin(None)
    print(f"\nslower regulators, each tuned anew, ± 47.5°, worst of {seeds} seeds: R², RMSE")
    for factor in (2, 5, 10):
        lag = twin.effects["regulator_lag"]
        changed = replace(lag, **{"lag_s": factor * lag.lag_s})
        known = tuned(replace(twin, effects={**twin.effects, lag.name: changed}))
        words = []
        for name in ("PI", "PI + feed-forward"):
            plan = sine(amplitude_deg=PAPER_AMPLITUDE_DEG)
            found = judged(plan, known.twin, known.bench, known.makers()[name], seeds)
            words.append(f"{name} {found.r_squared:.4f} {found.rmse_deg:5.2f}°")
        print(f"  {factor * lag.lag_s:.2f} s: {', '.join(words)}")


def variants(known: Tuned, seeds: int) -> None:
    """Of the feed-forward: without preview, with the error against the plant's own response, with the reference of the tick before."""
    tuning, top = known.tuning, known.bench.ceiling_MPa
    lag = float(np.median([p.lag_s.value for p in known.plant.plants]))
    dead = float(np.median([p.dead_time_s.value for p in known.plant.plants]))
    print(f"\nvariants of the feed-forward, worst of {seeds} seeds: RMSE with the twin's curve, × 0.9, × 1.1")
    kinds: dict[str, tuple[Callable[..., FeedForward], float]] = {
        "plain": (FeedForward, tuning.lead_s),
        "without preview": (FeedForward, 0.0),
        "error against a model": (lambda *a: Modelled(lag, dead, *a), tuning.lead_s),
        "reference of the tick before": (Paired, tuning.lead_s),
    }
    curve = known.twin.curve
    for name, (kind, lead) in kinds.items():
        words = []
        for factor in (1.0, 0.9, 1.1):

            def maker(
                factor: float = factor, kind: Callable[..., FeedForward] = kind, lead: float = lead
            ) -> Controller:
                pi = PI(tuning.kp_MPa_per_deg, tuning.ki_MPa_per_deg_s, top)
                return kind(pi, InverseCurve(curve.pressure_MPa, factor * curve.angle_deg, top), lead)

            words.append(f"{judged(sine(), known.twin, known.bench, maker, seeds).rmse_deg:6.2f}°")
        print(f"  {name:30}" + " ".join(words))


class Paired(FeedForward):
    """Compares the angle, which is of the tick before, with the reference of then."""

    before_deg = math.nan

    def pressure_MPa(self, reference_deg: float, ahead_deg: float, angle_deg: float, dt_s: float) -> float:
        then = reference_deg if math.isnan(self.before_deg) else self.before_deg
        self.before_deg = reference_deg
        return self.pi.around(self.inverse(ahead_deg), then, angle_deg, dt_s)


class Modelled(FeedForward):
    """Compares the angle with what the identified plant would do on the feed-forward, as in internal model control."""

    def __init__(self, lag_s: float, dead_s: float, *others: Any) -> None:
        super().__init__(*others)
        self.lag_s, self.dead_s = lag_s, dead_s
        self.asked: list[float] = []
        self.model_deg = math.nan

    def pressure_MPa(self, reference_deg: float, ahead_deg: float, angle_deg: float, dt_s: float) -> float:
        self.asked.append(ahead_deg)
        late = self.asked[max(0, len(self.asked) - 2 - round(self.dead_s / dt_s))]
        if math.isnan(self.model_deg):
            self.model_deg = reference_deg if math.isnan(angle_deg) else angle_deg
        self.model_deg += (late - self.model_deg) * (1 - math.exp(-dt_s / self.lag_s))
        return self.pi.around(self.inverse(ahead_deg), self.model_deg, angle_deg, dt_s)


def main() -> None:
    asked = argparse.ArgumentParser(description=__doc__)
    asked.add_argument("--seeds", type=int, default=20)
    seeds = asked.parse_args().seeds
    known = tuned()
    tuning, worst = known.tuning, known.tuning.margins[known.tuning.worst]
    print(
        f"flex: gain {known.flex.line.gain.value:.4f} °/V, sd {known.flex.sd_deg:.3f}°; {len(known.plant.plants)} operating points"
    )
    print(f"tuned: kp {tuning.kp_MPa_per_deg:.3g} MPa/°, ki {tuning.ki_MPa_per_deg_s:.3g} MPa/(°·s), lead {tuning.lead_s:.3f} s; worst gain margin "
          f"{worst.gain_margin:.2f}, phase margin {worst.phase_margin_deg:.0f}°, Ms {worst.max_sensitivity:.2f}")  # fmt: skip
    print(f"by hand: kp {HAND[0]:g}, ki {HAND[1]:g}")
    controllers(known, seeds)
    robustness(known, max(3, seeds // 4))
    further_effects(known, max(2, seeds // 4))
    slower(max(2, seeds // 4))
    variants(known, max(3, seeds // 4))
    windup(known)
    true_margins(known)
    print()
    for bar, figure, met in rows(seeds):
        print(f"{'met    ' if met else 'NOT MET'} {bar}: {figure}")


if __name__ == "__main__":
    main()
