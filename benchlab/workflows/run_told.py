"""What a run would do, in JSON's own types, without a bench."""

from __future__ import annotations

from dataclasses import asdict
from typing import Any

import numpy as np

from benchlab.io.nexus import plain
from benchlab.workflows.run_prepare import Prepared


def planned(prepared: Prepared) -> dict[str, Any]:
    """Plan, bench, guards, control, warnings and the files that would be written."""
    plan, bench = prepared.plan, prepared.bench
    known = plan.pressure_MPa[np.isfinite(plan.pressure_MPa)]
    slews = [step.slew_MPa_per_s for step in plan.steps if step.slew_MPa_per_s is not None]
    found: dict[str, Any] = {
        "dry_run": True,
        "protocol": prepared.source,
        "sha256": prepared.sha256,
        "plan": {
            "title": plan.title,
            "rate_Hz": plan.rate_Hz,
            "ticks": len(plan.time_s),
            "duration_s": plan.duration_s,
            "steps": len(plan.steps),
            "limit_MPa": plan.limit_MPa,
            "peak_MPa": known.max() if len(known) else None,
            "slew_MPa_per_s": max(slews, default=None),
            "closed_loop": plan.closed_loop,
        },
        "bench_spec": str(prepared.spec),
        "bench": {**asdict(bench), "ceiling_MPa": bench.ceiling_MPa, "ceiling_V": bench.volts(bench.ceiling_code)},
        "guards": [guard.name for guard in prepared.guards()],
        "guards_off": list(prepared.limits.off),
        "limits": asdict(prepared.limits),
        "control": prepared.control,
        "warnings": list(prepared.warnings),
        "would_write": [str(prepared.path(suffix)) for suffix in prepared.suffixes],
    }
    return {name: plain(value) for name, value in found.items()}
