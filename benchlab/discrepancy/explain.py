"""The whole way: what was measured and what was simulated, in; where they disagree, what is missing, and how much of it is closed, out."""

from __future__ import annotations

import operator
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from benchlab.discrepancy.base import Base
from benchlab.discrepancy.candidates import p_enough
from benchlab.discrepancy.describe import NOT_JUDGED, described
from benchlab.discrepancy.effects.effect import Effect
from benchlab.discrepancy.explanation import Curves, Explanation, Found, Gap, HeldOut, Tried
from benchlab.discrepancy.fit import nothing
from benchlab.discrepancy.heldout import held_out, noise_floor, together
from benchlab.discrepancy.identify import Identified, gained_share, identify
from benchlab.discrepancy.intervals import estimates
from benchlab.discrepancy.locate import gap_p, gaps, regions
from benchlab.discrepancy.measured import Measured, Summary
from benchlab.discrepancy.prepare import prepared
from benchlab.discrepancy.problem import Problem
from benchlab.discrepancy.remainder import remainder_words, unit_of
from benchlab.discrepancy.rules import Rules
from benchlab.units import FloatArray


@dataclass(frozen=True)
class Explained:
    """The explanation, and what further steps need: the problem that was solved and the fits."""

    explanation: Explanation
    problem: Problem
    identified: Identified


def explain(
    measured: Measured | Summary,
    base: Base,
    effects: Mapping[str, Effect],
    seed: int = 1,
    rules: Rules | None = None,
    progress: Callable[[str], None] | None = None,
) -> Explained:
    """Explain the gap between what was measured and the base; where nothing scatters, describe it. seed: of the bootstrap.

    Raises InputError where nothing can be compared.
    """
    tell = progress or (lambda _: None)
    tell("features and scatter of the samples")
    problem, warnings = prepared(measured, base)
    generator = np.random.default_rng(seed)
    summary = isinstance(measured, Summary)
    tested = problem.scatter.freedom > 0
    refused = {name: reason for name, effect in effects.items() if (reason := _cannot_show(effect, problem))}
    usable = [effect for name, effect in effects.items() if name not in refused]
    found = identify(problem, usable, generator, rules, progress) if tested else described(problem)
    tell("where they disagree")
    bare = problem.base_cells
    gap = gaps(problem, bare)
    p = gap_p(problem, bare, generator) if tested else np.full(len(gap), np.nan)
    tell("held-out samples, designs and rates")
    parts = _held_out(problem, found, summary) if tested else ()
    if note := _no_better(problem, found, parts, summary):
        nobody = Identified("unexplained", nothing(problem), (), (), (), found.p_gap, found.p_left, 0.0)
        found, parts, warnings = nobody, _held_out(problem, nobody, summary), (*warnings, note)
    after = gaps(problem, problem.cells(found.best.actives))
    explanation = Explanation(
        verdict=found.verdict,
        where=regions(problem, gap, p),
        effects=_effects(problem, found),
        rivals=tuple(one.names for one in found.rivals) if found.verdict == "ambiguous" else (),
        gap=_gap(problem, gap, after, parts, summary),
        p_gap=found.p_gap,
        false_naming=(rules or Rules()).first if tested else np.nan,
        tried=_tried(problem, found),
        judged_not=refused,
        remainder=remainder_words(problem, found, after),
        held_out=parts,
        curves=_curves(problem, gap, after, p, measured),
        warnings=warnings,
        base=base.source,
        source=measured.source,
        simulated=isinstance(measured, Measured) and measured.simulated,
        samples=_samples(problem) if summary else problem.samples,
        left_out=_left_out(measured, base, problem),
    )
    return Explained(explanation, problem, found)


def _held_out(problem: Problem, found: Identified, summary: bool) -> tuple[HeldOut, ...]:
    return tuple(part for part in held_out(problem, found.best) if part.kind == "design" or not summary)


def _no_better(problem: Problem, found: Identified, parts: Sequence[HeldOut], summary: bool) -> str:
    """Why what fits best is not named: it does not predict what the fit has not seen. Empty where it does, or that is not known."""
    if found.verdict not in ("named", "ambiguous"):
        return ""
    names = " and ".join(found.best.names)
    for kind in ("design",) if summary else ("sample", "design"):
        before, after = (together(parts, kind, operator.attrgetter(name)) for name in ("before", "after"))
        if after >= before:
            told = f"held-out {kind}s are predicted no better with it ({before:.3g} → {after:.3g}{unit_of(problem)})"
            return f"{names} fits best and is not named: {told}"
    return ""


def _cannot_show(effect: Effect, problem: Problem) -> str:
    """Why these data cannot show the effect, in words; empty where they can."""
    quantities = problem.features.quantities
    if not set(effect.seen_in) & set(quantities):
        return f"it does not show in {' and '.join(quantities)}"
    if lacking := [curve for curve in effect.needs if not problem.scene.has(curve)]:
        return f"the simulation has no {' and no '.join(lacking)}"
    return effect.cannot_show(problem.scene) or ("" if problem.scatter.freedom > 0 else NOT_JUDGED)


def _left_out(measured: Measured | Summary, base: Base, problem: Problem) -> dict[str, str]:
    """Measured designs that are not compared, with the reason."""
    names = dict.fromkeys(measured.design) if isinstance(measured, Summary) else measured.designs
    reasons = {**dict.fromkeys(base.designs, "no value where there is a simulated curve"), **base.missing}
    return {name: reasons.get(name, "no simulated curve") for name in names if name not in problem.scene.names}


def _samples(problem: Problem) -> int:
    """Behind a table of means: of each design the most behind one mean."""
    features = problem.features
    return int(sum(features.count[features.sample == design].max() for design in range(len(features.sample_names))))


def _effects(problem: Problem, found: Identified) -> tuple[Found, ...]:
    """The effects of the best model; none where there is no name to give."""
    if found.verdict in ("agree", "unexplained") or not found.best.actives:
        return ()
    numbers = estimates(problem, list(found.forms) or [found.best])
    order = [active.name for active in (found.forms[0] if found.forms else found.best).actives]
    out, shares = [], _shares(problem, found)
    for place, active in enumerate(found.best.actives):
        others = tuple(
            {a.form for one in found.forms[1:] for a in one.actives if a.name == active.name} - {active.form}
        )
        out.append(
            Found(active.name, active.form, numbers[order.index(active.name)], shares[place], tuple(sorted(others)))
        )
    return tuple(out)


def _shares(problem: Problem, found: Identified) -> list[float]:
    """Of each effect: the share that all explain together, divided by how far each moves the predictions when it is switched off."""
    actives = found.best.actives
    whole = problem.cells(actives)
    moved = np.array(
        [np.mean((whole - problem.cells(actives[:i] + actives[i + 1 :])) ** 2) for i in range(len(actives))]
    )
    return [float(share) for share in found.share * moved / max(float(moved.sum()), 1e-300)]


def _gap(problem: Problem, gap: FloatArray, after: FloatArray, parts: tuple, summary: bool) -> Gap:
    rms_before, rms_after = (float(np.sqrt(np.mean(values**2))) for values in (gap, after))
    variance = problem.variance_of_means
    floor = problem.error_of_means if summary else noise_floor(problem)
    kind = "design" if summary else "sample"
    return Gap(
        rmse_before=rms_before,
        rmse_after=rms_after,
        heldout_before=together(parts, kind, lambda part: part.before),
        heldout_after=together(parts, kind, lambda part: part.after),
        noise_floor=floor,
        ceiling=float(np.clip(1 - np.mean(variance) / max(rms_before**2, 1e-300), 0.0, 1.0)),
    )


def _tried(problem: Problem, found: Identified) -> tuple[Tried, ...]:
    if not found.tried:
        return ()
    bare = nothing(problem)
    rows = []
    for one in found.tried:
        p, t = p_enough(problem, one, found.best)
        inside = any(one is rival for rival in found.rivals)
        reason = (
            "the best"
            if one is found.best
            else "not told apart from the best"
            if inside
            else f"its residual points to the best by {t:.1f} standard errors"
        )
        form = ", ".join(active.form for active in one.actives)
        rows.append(
            Tried(
                one.names,
                form,
                one.misfit - bare.misfit,
                gained_share(bare, one, found.best, found.share),
                p,
                inside,
                reason,
            )
        )
    return tuple(rows)


def _curves(
    problem: Problem, gap: FloatArray, after: FloatArray, p: FloatArray, measured: Measured | Summary
) -> Curves:
    features, kinds = problem.features, problem.features.kinds
    rows = features.features
    number = np.bincount(features.feature, minlength=len(rows))
    mean = problem.mean_over_samples(features.value)
    squares = np.bincount(features.feature, (features.value - mean[features.feature]) ** 2, minlength=len(rows))
    sd = np.where(number > 1, np.sqrt(squares / np.maximum(number - 1, 1)), np.nan)
    if isinstance(measured, Summary):
        own = {(d, float(p)): s for d, p, s in zip(measured.design, measured.pressure_MPa, measured.sd)}
        sd = np.array([own[problem.scene.names[row.design], row.pressure_MPa] for row in rows])
        number = features.count.astype(int)
    return Curves(
        design=np.array([problem.scene.names[row.design] for row in rows]),
        quantity=np.array([row.quantity for row in rows]),
        kind=np.array(
            [kinds[row.kind].words + (f", run {row.occurrence + 1} of these" if row.occurrence else "") for row in rows]
        ),
        direction=np.array([row.direction for row in rows]),
        cycle=np.array([row.cycle for row in rows]),
        rate_MPa_s=np.array([kinds[row.kind].told_rate(row.rate_MPa_s) for row in rows]),
        pressure_MPa=np.array([row.pressure_MPa for row in rows]),
        time_s=np.array([row.time_s for row in rows]),
        measured=mean,
        sd=sd,
        n=number.astype(float),
        simulated=mean - gap,
        explained=mean - after,
        p=p,
    )
