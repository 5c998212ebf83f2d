"""The head of a run's journal: all that is needed to know what ran, and to run it again."""

from __future__ import annotations

from dataclasses import asdict
from typing import Any

from benchlab.io.nexus import plain
from benchlab.workflows.provenance import made_by
from benchlab.workflows.run_prepare import Prepared


def header_of(prepared: Prepared, about: dict[str, Any]) -> dict[str, Any]:
    """Protocol, plan, bench, device, control, guards and versions, in JSON's own types; a number that is not finite is null."""
    plan, settings = prepared.plan, prepared.settings
    header: dict[str, Any] = {
        "title": plan.title,
        "name": prepared.stem.name,
        "protocol": {"name": prepared.source, "text": prepared.text, "sha256": prepared.sha256},
        "plan": {
            "rate_Hz": plan.rate_Hz,
            "ticks": len(plan.time_s),
            "duration_s": plan.duration_s,
            "limit_MPa": plan.limit_MPa,
            "steps": [asdict(step) for step in plan.steps],
            "events": [asdict(event) for event in plan.events],
        },
        "bench_kind": prepared.spec.kind,
        "bench": asdict(prepared.bench),
        "device": about,
        "control": prepared.control,
        "model": prepared.model,
        "curve": None if prepared.curve is None else asdict(prepared.curve),
        "guards": asdict(prepared.limits),
        "guards_off": list(prepared.limits.off),
        "clock": "virtual" if prepared.fast else "real",
        "pause_limit_s": settings.pause_limit_s,
        "seed": None if prepared.twin is None else prepared.twin.seed,
        "warnings": list(prepared.warnings),
        "provenance": made_by("numpy", "scipy", "serial"),
    }
    return {name: plain(value) for name, value in header.items()}
