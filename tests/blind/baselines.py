"""Rules that others would take, on the same studies: lowest RMSE, iid BIC, leave-one-sample-out with one SE, and a sparse regression.

The first three choose among fits that the identifier hands over, one for the simulation as it is and one for every effect of its library:

    every_fit: {"measured": (samples × features), "design": [of each sample],
                "fits": [{"effect": "", "parameters": 0, "predicted": (samples × features), "left_out": (samples × features)}, …]}

effect "": the simulation as it is. left_out: predicted for each sample from fits to the others; without it `predicted` is taken,
which flatters every fit. None where nothing was measured. The sparse regression needs the table alone, and the curves of the cell.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import Any

import numpy as np
import pandas as pd

from tests.blind.generator.bench import plain_curve
from tests.blind.generator.station import FloatArray

Fit = Mapping[str, Any]


def lowest_rmse(every_fit: Mapping[str, Any]) -> str:
    """The effect whose fit comes nearest; "" for the simulation as it is."""
    measured = _array(every_fit["measured"])
    return min(every_fit["fits"], key=lambda fit: np.nansum((_array(fit["predicted"]) - measured) ** 2))["effect"]


def iid_bic(every_fit: Mapping[str, Any]) -> str:
    """As if every feature of every sample were independent: n ln(RSS/n) + k ln n."""
    measured = _array(every_fit["measured"])
    count = int(np.isfinite(measured).sum())

    def bic(fit: Fit) -> float:
        rss = np.nansum((_array(fit["predicted"]) - measured) ** 2)
        return count * float(np.log(rss / count)) + fit["parameters"] * float(np.log(count))

    return str(min(every_fit["fits"], key=bic)["effect"])


def leave_one_out(every_fit: Mapping[str, Any]) -> str:
    """Of the fits whose error on samples left out is within one standard error of the best: the one of fewest parameters, then of least
    error.
    """
    measured = _array(every_fit["measured"])
    errors = [
        np.nanmean((_array(fit.get("left_out", fit["predicted"])) - measured) ** 2, axis=1) for fit in every_fit["fits"]
    ]
    means = [float(np.mean(error)) for error in errors]
    best = int(np.argmin(means))
    within = means[best] + float(np.std(errors[best], ddof=1)) / np.sqrt(len(errors[best]))
    kept = [(fit["parameters"], mean, fit["effect"]) for fit, mean in zip(every_fit["fits"], means) if mean <= within]
    return str(min(kept)[2])


RULES: dict[str, Callable[[Mapping[str, Any]], str]] = {
    "lowest RMSE": lowest_rmse,
    "iid BIC": iid_bic,
    "leave-one-sample-out, one SE": leave_one_out,
}

TERMS = {
    "constant": "",
    "angle": "camera_scale",
    "angle²": "marker_offset",
    "sin angle": "gravity",
    "slope": "pressure_offset",
    "p·slope": "pressure_gain",
    "rate·slope": "regulator_lag",
    "direction·angle": "friction",
    "late angle": "viscoelasticity",
    "largest so far·angle": "softening",
    "session·angle": "temperature",
}
"""Terms of the sparse regression, and the name that each is closest to. A constant has none."""


def sparse_regression(frame: pd.DataFrame, designs: pd.DataFrame) -> str:
    """In the manner of SINDy (Brunton, Proctor and Kutz 2016): what the simulation misses, as few terms of a library.

    Sequentially thresholded least squares on mean angles of the samples, over thresholds from 2 % to 50 % of the largest term; of these
    the least BIC. The name is that of the term that moves the prediction most, "" where that is a constant or nothing is left.
    """
    X, y = _library(frame, designs)
    best, chosen = len(y) * float(np.log(np.mean(y**2))), np.zeros(X.shape[1])
    for threshold in (0.02, 0.05, 0.1, 0.2, 0.35, 0.5):
        w = _thresholded(X, y, threshold)
        bic = len(y) * float(np.log(np.mean((y - X @ w) ** 2))) + np.count_nonzero(w) * float(np.log(len(y)))
        if bic < best:
            best, chosen = bic, w
    moves = np.sqrt(np.mean((X * chosen) ** 2, axis=0))
    return list(TERMS.values())[int(np.argmax(moves))] if moves.any() else ""


def _thresholded(X: FloatArray, y: FloatArray, threshold: float) -> FloatArray:
    size = np.sqrt(np.mean(X**2, axis=0)) + 1e-12
    kept = size > 1e-9
    w = np.zeros(X.shape[1])
    for _ in range(10):
        w[:] = 0
        w[kept] = np.linalg.lstsq(X[:, kept] / size[kept], y, rcond=1e-8)[0]
        strong = kept & (np.abs(w) >= threshold * np.abs(w).max())
        if (strong == kept).all():
            break
        kept = strong
    return np.asarray(w / size)


def _library(frame: pd.DataFrame, designs: pd.DataFrame) -> tuple[FloatArray, FloatArray]:
    """Terms (N, K) and what the simulation misses (N,), at every third reading of every run, means over samples."""
    made = designs.set_index("design")
    blocks, misses = [], []
    angles = frame[frame["angle_deg"].notna()].assign(session=frame.get("start_s", 0.0))
    for (design, _), rows in angles.groupby(["design", "run"]):
        mean = rows.groupby("time_s")[["pressure_MPa", "angle_deg", "session"]].mean()
        t = mean.index.to_numpy(float)
        p = pd.Series(mean["pressure_MPa"]).rolling(5, center=True, min_periods=1).mean().to_numpy()
        size = made.loc[design]
        curve = plain_curve(float(size["tw_mm"]), float(size["slw_mm"]), float(size["length_mm"]))
        angle, slope, rate = curve(p), curve.derivative()(p), np.gradient(p, t)
        late = _late(angle, t) - angle
        columns = {
            "constant": np.ones_like(p),
            "angle": angle,
            "angle²": angle**2,
            "sin angle": np.sin(np.radians(angle)),
            "slope": slope,
            "p·slope": p * slope,
            "rate·slope": rate * slope,
            "direction·angle": np.tanh(rate / 0.003) * angle,
            "late angle": late,
            "largest so far·angle": (np.maximum.accumulate(p) - p) * angle,
            "session·angle": (mean["session"].to_numpy(float) + t) * angle,
        }
        blocks.append(np.stack([columns[name] for name in TERMS], axis=1)[::3])
        misses.append((mean["angle_deg"].to_numpy(float) - angle)[::3])
    return np.concatenate(blocks), np.concatenate(misses)


def _late(x: FloatArray, t: FloatArray, time_s: float = 5.0) -> FloatArray:
    """x behind a first-order lag."""
    found = np.empty_like(x)
    found[0] = x[0]
    for i in range(1, len(x)):
        found[i] = x[i] + (found[i - 1] - x[i]) * np.exp(-(t[i] - t[i - 1]) / time_s)
    return found


def _array(values: Sequence[Sequence[float | None]]) -> FloatArray:
    return np.array([[np.nan if v is None else v for v in row] for row in values], dtype=float)
