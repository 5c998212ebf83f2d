"""An identifier that knows nothing: it answers by the RMS gap alone.

It shows that the scorer works, and what is scored without thought.
"""

from __future__ import annotations

from typing import Any

import numpy as np
import pandas as pd

from tests.blind.generator.bench import plain_curve

PROTOCOL = """title: one slow and one fast cycle
limit_MPa: 0.35
segments:
  - triangle: {low_MPa: 0, high_MPa: 0.3, rate_MPa_per_s: 0.03, cycles: 1}
  - triangle: {low_MPa: 0, high_MPa: 0.3, rate_MPa_per_s: 0.3, cycles: 1}
"""


def explain_frame(frame: pd.DataFrame, designs: pd.DataFrame, seed: int, every_fit: bool = False) -> dict[str, Any]:
    """`agree` where the mean gap is small, a scale with a rival where it is large; the form of `benchlab explain --json`."""
    made = designs.set_index("design")
    gaps, scales = [], []
    for design, rows in frame[frame["angle_deg"].notna()].groupby("design"):
        size = made.loc[design]
        curve = plain_curve(float(size["tw_mm"]), float(size["slw_mm"]), float(size["length_mm"]))
        angle = curve(rows["pressure_MPa"].to_numpy())
        gaps.append(rows["angle_deg"].to_numpy() - angle)
        scales.append((angle @ rows["angle_deg"].to_numpy()) / (angle @ angle))
    before, factor = float(np.sqrt(np.mean(np.concatenate(gaps) ** 2))), float(np.mean(scales))
    named = before > 3
    parameter = {"value": 1 / factor, "low": 0.98 / factor, "high": 1.02 / factor, "unit": ""}
    found = {
        "verdict": "ambiguous" if named else "agree",
        "where": [],
        "effects": [{"name": "camera_scale", "parameters": {"scale": parameter}, "share_explained": 0.5}] if named else [],
        "rivals": [["end_caps"]] if named else [],
        "gap": dict.fromkeys(("rmse_before", "heldout_before", "rmse_after", "heldout_after", "noise_floor"), before),
        "next_experiment": {"protocol": PROTOCOL, "separates": ["camera_scale", "end_caps"], "expected_sd": 0.1} if named else None,
        "model": "",
        "warnings": [],
    }  # fmt: skip
    if every_fit:
        angles = [[1.0, 2.0], [1.1, 2.1], [0.9, 2.2]]
        fit = {"effect": "", "parameters": 0, "predicted": angles}
        found["every_fit"] = {
            "measured": angles[::-1],
            "design": ["a"] * 3,
            "fits": [fit, fit | {"effect": "friction", "parameters": 1}],
        }
    return found
