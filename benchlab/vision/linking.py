"""From candidates frame by frame to tracks: the same marker keeps its place in the row for the whole recording.

The chain of markers is found in a sample of frames; the best of them is the reference, from which markers are followed
forwards and backwards. A marker is taken only where one candidate, of the right size, lies where it is expected and
keeps its distance to its neighbours; anything less certain is left out.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from benchlab.vision.chain import Chain, find_chain, is_convincing
from benchlab.vision.picture import FloatArray

SAMPLED_FRAMES = 32
SHARE_TO_BELIEVE = 0.35  # of the sampled frames with a chain that must show the largest count
GATE = 0.4  # of the spacing: how far from its expected place a marker is looked for
IN_LINE = 0.15  # of the spacing: how far a marker may lie from the cubic through its neighbours, on a straight body
MARKER_NOISE = 0.005  # of the spacing
MIN_ROUNDNESS = 0.3
RIVAL = 0.75  # share of the markers that makes a second row worth a warning
RETRY_EVERY = 10  # frames with a marker missing after which the whole row is looked for anew
SIZE_RANGE = (0.5, 2.0)  # area against the same marker's last area
AREA_LOSS, AREA_GAIN = 0.06, 0.25  # least deviations from its usual area that tell a covered or a merged marker
CERTAIN_SCORE = 0.4  # of the reference chain's score: a chain that is believed wherever it lies


@dataclass(frozen=True)
class Tracks:
    """N markers over T frames, in order along the body.

    xy: (T, N, 2) pixels, NaN where left out. sd_px: (T, N). reason: T strings, why a frame has no or fewer markers.
    rival: how many markers a second row has that is in view beside the one followed, 0 if there is none.
    """

    xy: FloatArray
    sd_px: FloatArray
    reason: tuple[str, ...]
    rival: int = 0


def link(frames: Sequence[NDArray[np.void] | None], count: int | None = None, stills: bool = False) -> Tracks:
    """Tracks through T frames of candidates (None where the frame could not be decoded).

    count: the number of markers, when known. stills: successive pictures may differ by more than the spacing.
    With no chain found anywhere, N is 0 and every reason says so.
    """
    reference = _reference(frames, count)
    if reference is None:
        reasons = tuple("damaged" if c is None else "no markers" for c in frames)
        return Tracks(np.full((len(frames), 0, 2), np.nan), np.full((len(frames), 0), np.nan), reasons)
    start, chain = reference
    first = frames[start]
    assert first is not None, "the reference is a frame with candidates"
    members = first[list(chain.order)]
    chosen = np.full((len(frames), len(chain.order)), -1)
    chosen[start] = chain.order
    for direction in (range(start + 1, len(frames)), range(start - 1, -1, -1)):
        follower = _Follower(members, chain.score, stills)
        for t in direction:
            candidates = frames[t]
            if candidates is not None:
                chosen[t] = follower.follow(candidates)
    xy, sd, area = _gather(frames, chosen)
    odd = np.zeros(area.shape, bool) if stills else _odd_areas(area)
    xy[odd] = np.nan
    tracks = Tracks(xy, np.where(odd, np.nan, sd), _reasons(frames, chosen, odd), _rival(first, chain))
    return _fixed_end_first(tracks)


def _reference(frames: Sequence[NDArray[np.void] | None], count: int | None) -> tuple[int, Chain] | None:
    """The frame to start from and its chain: the best chain of the largest believable count."""
    usable = [(t, c) for t, c in enumerate(frames) if c is not None and len(c) >= 3]
    if not usable:
        return None
    picked = [usable[i] for i in np.unique(np.linspace(0, len(usable) - 1, SAMPLED_FRAMES).astype(int))]
    found = [(t, chain) for t, c in picked if (chain := find_chain(c, count)) and is_convincing(chain, c)]
    if not found:
        found = [(t, chain) for t, c in usable if (chain := find_chain(c, count)) and is_convincing(chain, c)]
    if not found:
        return None
    sizes = [len(chain.order) for _, chain in found]
    enough = max(1, SHARE_TO_BELIEVE * len(found))
    size = max(n for n in set(sizes) if sum(m >= n for m in sizes) >= enough)
    candidates = [(t, chain) for t, chain in found if len(chain.order) == size]
    if not candidates:
        return None
    return max(candidates, key=lambda item: item[1].score)


def _rival(candidates: NDArray[np.void], chain: Chain) -> int:
    """Length of a second row among the candidates that are not of the chain, if it is nearly as long."""
    rest = np.delete(candidates, list(chain.order))
    second = find_chain(rest)
    if second is None or not is_convincing(second, rest):
        return 0
    return len(second.order) if len(second.order) >= max(4, RIVAL * len(chain.order)) else 0


class _Follower:
    """Follows N markers from one frame to the next, in either direction of time."""

    def __init__(self, members: NDArray[np.void], score: float, stills: bool) -> None:
        self.score, self.stills = score, stills
        self.xy = members["xy"].copy()
        self.velocity = np.zeros_like(self.xy)
        self.area = members["area_px2"].copy()
        self.seen = np.ones(len(members), bool)
        self.gaps = np.hypot(*np.diff(self.xy, axis=0).T)
        self.along = np.concatenate([[0], np.cumsum(self.gaps)]) / self.gaps.mean()
        self.index = np.arange(len(members))
        self.incomplete = 0
        self._weights: dict[tuple[bytes, int], tuple[FloatArray, FloatArray]] = {}

    def follow(self, candidates: NDArray[np.void]) -> NDArray[np.int64]:
        """(N,) the candidate of each marker in this frame, −1 where left out."""
        found = np.full(len(self.xy), -1) if self.stills else self._near(candidates)
        missing = int((found < 0).sum())
        self.incomplete = self.incomplete + 1 if missing else 0
        if missing > len(found) - max(3, len(found) / 2) or self.incomplete % RETRY_EVERY == RETRY_EVERY - 1:
            found = self._anywhere(candidates, found)
        self._remember(candidates, found)
        return found

    def _neighbours(self, known: NDArray[np.bool_], count: int) -> tuple[FloatArray, FloatArray]:
        """Lagrange's interpolation of each marker from its nearest known ones, itself left out.

        (N, N) weights, and (N,) the product of its distances to them, in spacings: the factor of the remainder.
        """
        key = (known.tobytes(), count)
        if key not in self._weights:
            weights, reach = np.zeros((len(known), len(known))), np.ones(len(known))
            for i in self.index:
                near = np.flatnonzero(known & (self.index != i))
                near = near[np.argsort(np.abs(self.along[near] - self.along[i]), kind="stable")[:count]]
                reach[i] = np.abs(np.prod(self.along[near] - self.along[i]))
                for a in near:
                    others = self.along[near[near != a]]
                    weights[i, a] = np.prod((self.along[i] - others) / (self.along[a] - others))
            self._weights[key] = weights, reach
        return self._weights[key]

    def _moved(self, step: FloatArray, known: NDArray[np.bool_]) -> FloatArray:
        """(N, 2) the row after the known markers moved by `step`; the others move along with their neighbours."""
        if known.all():
            return self.xy + step
        if known.sum() < 3:
            return np.asarray(
                self.xy + np.where(known[:, None], step, step[known].mean(axis=0) if known.any() else 0.0)
            )
        weights, _ = self._neighbours(known, 3)
        return np.asarray(self.xy + np.where(known[:, None], step, weights @ step))

    def _near(self, candidates: NDArray[np.void]) -> NDArray[np.int64]:
        """Candidates of the right size that lie, alone, where a marker is expected."""
        if not len(candidates):
            return np.full(len(self.xy), -1)
        apart = candidates["xy"][None] - self._moved(self.velocity, self.seen)[:, None]
        distance = np.hypot(apart[..., 0], apart[..., 1])
        ratio = candidates["area_px2"][None] / self.area[:, None]
        distance[(ratio < SIZE_RANGE[0]) | (ratio > SIZE_RANGE[1]) | (candidates["roundness"] < MIN_ROUNDNESS)] = np.inf
        nearest = distance.argmin(axis=1)
        best = distance[self.index, nearest]
        mutual = distance.argmin(axis=0)[nearest] == self.index
        found = np.where(mutual & (best < GATE * self.gaps.min()), nearest, -1)
        if distance.shape[1] > 1:
            second = np.partition(distance, 1, axis=1)[:, 1]
            found[second < 2 * best + 3] = -1
        return self._in_line(candidates["xy"], found)

    def _in_line(self, xy: FloatArray, found: NDArray[np.int64]) -> NDArray[np.int64]:
        """Leaves out, worst first, the markers that do not lie in line with their neighbours."""
        found = found.copy()
        for _ in range(len(found) - 4):
            known = found >= 0
            if known.sum() < 5:
                break
            placed = np.where(known[:, None], xy[found], 0.0)
            weights, reach = self._neighbours(known, 4)
            off = np.where(known, np.hypot(*(placed - weights @ placed).T), 0.0)
            if off.max() <= IN_LINE * self.gaps.min():
                break
            links = np.diff(placed[known], axis=0)
            spacing = np.median(np.hypot(*links.T) / np.diff(self.along[known]))
            turn = np.median(
                np.abs(np.diff(np.unwrap(np.arctan2(links[:, 1], links[:, 0])))) / np.diff(self.along[known])[1:]
            )
            # Cubic interpolation of an arc misses by spacing · turn³ · reach / 4! (its remainder), and noise is amplified.
            noise = MARKER_NOISE * np.abs(weights).sum(axis=1)
            over = off / (spacing * (IN_LINE + turn**3 * reach / 24 + noise))
            # An outlier also throws its neighbours' places off; it is itself the furthest.
            worst = int(np.argmax(over))
            if over[worst] <= 1:
                break
            found[worst] = -1
        return found

    def _anywhere(self, candidates: NDArray[np.void], found: NDArray[np.int64]) -> NDArray[np.int64]:
        """A whole chain of all N, wherever it lies; else what was found near."""
        chain = find_chain(candidates, len(self.xy))
        if chain is None or chain.score < (-1.0 if self.stills else CERTAIN_SCORE * self.score):
            return found
        order = np.array(chain.order)
        if abs(np.log(candidates["area_px2"][order].mean() / self.area.mean())) > np.log(SIZE_RANGE[1]):
            return found
        xy = candidates["xy"]
        forward, backward = (np.hypot(*(xy[o] - self.xy).T).sum() for o in (order, order[::-1]))
        self.seen[:] = False
        return order if forward <= backward else order[::-1]

    def _remember(self, candidates: NDArray[np.void], found: NDArray[np.int64]) -> None:
        seen = found >= 0
        if not seen.any():
            self.velocity[:] = 0
            self.seen = seen
            return
        placed = candidates[found]
        step = placed["xy"] - self.xy
        xy = self._moved(step, seen)
        self.velocity = np.where((seen & self.seen)[:, None], step, 0.0)
        if not self.seen.any():
            self.velocity[:] = 0
        self.area = np.where(seen, placed["area_px2"], self.area)
        self.xy, self.seen = xy, seen
        both = seen[1:] & seen[:-1]
        self.gaps = np.where(both, np.hypot(*np.diff(xy, axis=0).T), self.gaps)


def _gather(
    frames: Sequence[NDArray[np.void] | None], chosen: NDArray[np.int64]
) -> tuple[FloatArray, FloatArray, FloatArray]:
    """(T, N, 2) positions, (T, N) standard deviations and areas of the chosen candidates, NaN where none."""
    table = np.full((*chosen.shape, 4), np.nan)
    for t, candidates in enumerate(frames):
        taken = chosen[t] >= 0
        if candidates is not None and taken.any():
            members = candidates[chosen[t][taken]]
            table[t, taken, :2] = members["xy"]
            table[t, taken, 2] = members["sd_px"]
            table[t, taken, 3] = members["area_px2"]
    return table[..., :2], table[..., 2], table[..., 3]


def _odd_areas(area: FloatArray) -> NDArray[np.bool_]:
    """(T, N) markers that show less or more area than they usually do: partly covered, or merged with something."""
    if np.isnan(area).all():
        return np.zeros(area.shape, bool)
    with np.errstate(invalid="ignore"):
        usual = np.nanmedian(area, axis=0)
        relative = area / usual
        together = np.array([np.median(r[np.isfinite(r)]) if np.isfinite(r).any() else 1.0 for r in relative])
        deviation = np.log(relative / together[:, None])
        spread = 1.4826 * np.nanmedian(np.abs(deviation - np.nanmedian(deviation)))
        return (deviation < -max(AREA_LOSS, 5 * spread)) | (deviation > max(AREA_GAIN, 5 * spread))


def _reasons(
    frames: Sequence[NDArray[np.void] | None], chosen: NDArray[np.int64], odd: NDArray[np.bool_]
) -> tuple[str, ...]:
    used = (chosen >= 0) & ~odd
    words = []
    for t, candidates in enumerate(frames):
        if candidates is None:
            words.append("damaged")
        elif not len(candidates):
            words.append("no markers")
        elif used[t].all():
            words.append("")
        else:
            words.append("markers left out")
    return tuple(words)


def _fixed_end_first(tracks: Tracks) -> Tracks:
    """The end that moves less comes first; where neither moves, the one further left, then further up."""
    ends = tracks.xy[:, [0, -1]]
    if not np.isfinite(ends).all(axis=(1, 2)).any():
        return tracks
    travel = np.nanmax(ends, axis=0) - np.nanmin(ends, axis=0)
    first, last = np.hypot(travel[:, 0], travel[:, 1])
    if abs(first - last) > 2.0:
        turned = first > last
    else:
        start = np.nanmean(ends, axis=0)
        turned = tuple(start[1]) < tuple(start[0])
    if not turned:
        return tracks
    return replace(tracks, xy=tracks.xy[:, ::-1], sd_px=tracks.sd_px[:, ::-1])
