"""Which of the candidate spots of one picture are the markers: those that follow one another along a smooth curve.

A chain is judged link by link. Going from spot to spot, a good chain keeps its spacing, its turning angle, its spot
size and its colour; each link earns 1 less the squared relative change of these, and a chain's score is the sum. Clutter of the
right colour and shape fails on spacing and direction.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from benchlab.vision.picture import FloatArray

SPACING_TOLERANCE = 0.35  # of the logarithm of the ratio of two neighbouring spacings
TURN_TOLERANCE = 0.55  # rad, change of the turning angle from link to link, and as a share of that angle
SIZE_TOLERANCE = 0.45  # of the logarithm of the ratio of areas
COLOUR_TOLERANCE = 0.35  # rad of hue, and of the logarithm of the ratio of contrasts
MAX_TURN = 2.2  # rad from one link to the next
MAX_WINDING = (
    6.8  # rad from the first link to the last: a body that closes a full circle, and no spiral through clutter
)
MAX_CONSIDERED = 40
LEAST_SCORE, LEAST_ISOLATION, LEAST_ROUNDNESS = 0.3, 0.65, 0.4  # of a chain that is believed; the score a link
STARTS = 150
LONG, LEAST_ISOLATION_OF_LONG = 6, 0.4  # so many markers in a row are no accident, whatever they lie on
MAX_LOSS = -3.0  # the worst link that completes a chain of known length


@dataclass(frozen=True)
class Chain:
    """Indices of the chosen candidates in order along the curve, and the score of the choice."""

    order: tuple[int, ...]
    score: float


def find_chain(candidates: NDArray[np.void], count: int | None = None) -> Chain | None:
    """The best chain of at least three candidates (n,), or None. With `count`, a chain of exactly that many.

    The direction along the chain is arbitrary; `linking` settles it by motion.
    """
    if len(candidates) < max(3, count or 3):
        return None
    shown = np.argsort(-candidates["roundness"] * candidates["isolation"], kind="stable")[:MAX_CONSIDERED]
    chosen = candidates[shown]
    best: Chain | None = None
    likeness = _likeness(chosen)
    for start in _starts(chosen["xy"], likeness):
        order, score = _grow(chosen["xy"], likeness, start, count)
        if (count is None or len(order) == count) and (best is None or score > best.score):
            best = Chain(tuple(int(shown[i]) for i in order), score)
    return best


def is_convincing(chain: Chain, candidates: NDArray[np.void]) -> bool:
    """Whether a chain is markers on its own evidence: links that earn their keep, round spots that stand out evenly."""
    members = candidates[list(chain.order)]
    isolation = LEAST_ISOLATION if len(members) < LONG else LEAST_ISOLATION_OF_LONG
    plain = np.median(members["isolation"]) >= isolation and np.median(members["roundness"]) >= LEAST_ROUNDNESS
    return bool(plain and chain.score >= LEAST_SCORE * (len(chain.order) - 2))


def _likeness(candidates: NDArray[np.void]) -> FloatArray:
    """(n, n) squared differences of size and colour between candidates, in units of their tolerances."""
    size, contrast = np.log(candidates["area_px2"]), np.log(np.maximum(candidates["contrast"], 1e-3))
    turn = candidates["hue_rad"][:, None] - candidates["hue_rad"]
    hue = np.angle(np.exp(1j * turn))
    return (
        ((size[:, None] - size) / SIZE_TOLERANCE) ** 2
        + ((contrast[:, None] - contrast) / COLOUR_TOLERANCE) ** 2
        + (hue / COLOUR_TOLERANCE) ** 2
    )


def _starts(xy: FloatArray, likeness: FloatArray) -> list[tuple[int, int, int]]:
    """The most chain-like triples (i, j, k), i < k, best first; short spacings first among equals."""
    n = len(xy)
    step = xy[None] - xy[:, None]
    length = np.hypot(step[..., 0], step[..., 1]) + np.eye(n)
    # First link i -> j, second link j -> k.
    change = np.log(length[None] / length[:, :, None]) / SPACING_TOLERANCE
    cross = step[:, :, None, 0] * step[None, :, :, 1] - step[:, :, None, 1] * step[None, :, :, 0]
    dot = (step[:, :, None] * step[None]).sum(-1)
    turn = np.arctan2(cross, dot)
    cost = change**2 + (turn / MAX_TURN) ** 2 + likeness[:, :, None] + likeness[None]
    i, j, k = np.indices((n, n, n))
    good = (i != j) & (j != k) & (i < k) & (cost < 2) & (np.abs(turn) < MAX_TURN)
    index = np.flatnonzero(good)
    # A chain that skips every second marker is as even as the true one: prefer the shorter links.
    rank = cost.ravel()[index] + 0.5 * np.log(
        length[i.ravel()[index], j.ravel()[index]] / length[good.any(2)].min(initial=1e9)
    )
    index = index[np.argsort(rank, kind="stable")[:STARTS]]
    return [(int(a), int(b), int(c)) for a, b, c in zip(*np.unravel_index(index, (n, n, n)))]


def _grow(
    xy: FloatArray, likeness: FloatArray, start: tuple[int, int, int], count: int | None
) -> tuple[list[int], float]:
    """Extend a triple at whichever end gains most, until no link earns anything; to a known `count`, also at a loss."""
    order = list(start)
    score = 1.0 - _link_cost(xy, likeness, order[:2], None)[order[2]]
    while count is None or len(order) < count:
        best_gain, best_end, best_next = (0.0 if count is None else MAX_LOSS), 0, -1
        for end in (0, 1):
            path = order if end else order[::-1]
            cost = _link_cost(xy, likeness, path[-2:], path[-3])
            cost[order] = np.inf
            nearest = int(np.argmin(cost))
            if 1 - cost[nearest] > best_gain:
                best_gain, best_end, best_next = float(1 - cost[nearest]), end, nearest
        if best_next < 0:
            break
        longer = [*order, best_next] if best_end else [best_next, *order]
        if _winding(xy[longer]) > MAX_WINDING:
            break
        order, score = longer, score + best_gain
    return order, float(score)


def _link_cost(xy: FloatArray, likeness: FloatArray, last: list[int], before: int | None) -> FloatArray:
    """(n,) cost of going on from the link `last` to each candidate, given the one before it (its turning angle)."""
    here = xy[last[1]] - xy[last[0]]
    there = xy - xy[last[1]]
    length = np.hypot(there[:, 0], there[:, 1])
    known = float(np.hypot(*here))
    with np.errstate(divide="ignore"):
        change = np.log(length / known) / SPACING_TOLERANCE
    turn = np.arctan2(here[0] * there[:, 1] - here[1] * there[:, 0], there @ here)
    if before is None:
        bend = (turn / MAX_TURN) ** 2
    else:
        earlier = xy[last[0]] - xy[before]
        expected = np.arctan2(earlier[0] * here[1] - earlier[1] * here[0], here @ earlier)
        tolerance = TURN_TOLERANCE * (1 + np.maximum(np.abs(turn), abs(expected)))
        bend = ((turn - expected) / tolerance) ** 2
    cost = change**2 + bend + likeness[last[1]]
    return np.asarray(np.where(np.abs(turn) < MAX_TURN, cost, np.inf))


def _winding(xy: FloatArray) -> float:
    """How far a chain (N, 2) turns from its first link to its last, rad."""
    along = np.diff(xy, axis=0)
    cross = along[:-1, 0] * along[1:, 1] - along[:-1, 1] * along[1:, 0]
    return float(np.abs(np.arctan2(cross, (along[:-1] * along[1:]).sum(axis=1)).sum()))
