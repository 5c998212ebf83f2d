"""From candidates frame by frame to tracks: the same marker keeps its place in the row for the whole recording.

The chain of markers is found in a sample of frames; the best of them is the reference, from which markers are followed
forwards and backwards. A marker is taken only where one candidate, of the right size, lies where it is expected and
keeps its distance to its neighbours; anything less certain is left out.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from benchlab.vision.chain import Chain, find_chain
from benchlab.vision.picture import FloatArray

SAMPLED_FRAMES = 32
SHARE_TO_BELIEVE = 0.2  # of the sampled frames with a chain that must show the largest count
GATE = 0.4  # of the spacing: how far from its expected place a marker is looked for
SPACING_CHANGE = 0.25  # logarithm of the ratio of a spacing to its last value
SIZE_RANGE = (0.5, 2.0)  # area against the same marker's last area
AREA_LOSS, AREA_GAIN = 0.06, 0.25  # least deviations from its usual area that tell a covered or a merged marker
CERTAIN_SCORE = 0.4  # of the reference chain's score: a chain that is believed wherever it lies


@dataclass(frozen=True)
class Tracks:
    """N markers over T frames, in order along the body.

    xy: (T, N, 2) pixels, NaN where left out. sd_px: (T, N). reason: T strings, why a frame has no or fewer markers.
    """

    xy: FloatArray
    sd_px: FloatArray
    reason: tuple[str, ...]


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
    chosen = np.full((len(frames), len(chain.order)), -1)
    chosen[start] = chain.order
    for direction in (range(start + 1, len(frames)), range(start - 1, -1, -1)):
        follower = _Follower(frames[start][list(chain.order)], chain.score, stills)  # type: ignore[index]
        for t in direction:
            candidates = frames[t]
            if candidates is not None:
                chosen[t] = follower.follow(candidates)
    xy, sd, area = _gather(frames, chosen)
    odd = np.zeros(area.shape, bool) if stills else _odd_areas(area)
    xy[odd] = np.nan
    return _fixed_end_first(Tracks(xy, np.where(odd, np.nan, sd), _reasons(frames, chosen, odd)))


def _reference(frames: Sequence[NDArray[np.void] | None], count: int | None) -> tuple[int, Chain] | None:
    """The frame to start from and its chain: the best chain of the largest believable count."""
    usable = [t for t, c in enumerate(frames) if c is not None and len(c) >= 3]
    if not usable:
        return None
    picked = [usable[i] for i in np.unique(np.linspace(0, len(usable) - 1, SAMPLED_FRAMES).astype(int))]
    found = [(t, chain) for t in picked if (chain := find_chain(frames[t], count))]  # type: ignore[arg-type]
    if not found and len(picked) < len(usable):
        found = [(t, chain) for t in usable if (chain := find_chain(frames[t], count))]  # type: ignore[arg-type]
    if not found:
        return None
    sizes = [len(chain.order) for _, chain in found]
    enough = max(1, SHARE_TO_BELIEVE * len(found))
    size = max(n for n in set(sizes) if sum(m >= n for m in sizes) >= enough)
    candidates = [(t, chain) for t, chain in found if len(chain.order) == size]
    if not candidates:
        return None
    return max(candidates, key=lambda item: item[1].score)


class _Follower:
    """Follows N markers from one frame to the next, in either direction of time."""

    def __init__(self, members: NDArray[np.void], score: float, stills: bool) -> None:
        self.score, self.stills = score, stills
        self.xy = members["xy"].copy()
        self.velocity = np.zeros_like(self.xy)
        self.area = members["area_px2"].copy()
        self.seen = np.ones(len(members), bool)
        self.gaps = np.hypot(*np.diff(self.xy, axis=0).T)
        self.index = np.arange(len(members))

    def follow(self, candidates: NDArray[np.void]) -> NDArray[np.int64]:
        """(N,) the candidate of each marker in this frame, −1 where left out."""
        found = np.full(len(self.xy), -1) if self.stills else self._near(candidates)
        if (found >= 0).sum() < max(3, len(self.xy) / 2):
            found = self._anywhere(candidates, found)
        self._remember(candidates, found)
        return found

    def _expected(self) -> FloatArray:
        """(N, 2) where the markers should be: carried on by velocity; hidden ones on a parabola through the seen."""
        expected = self.xy + self.velocity
        if self.seen.all() or self.seen.sum() < 3:
            return expected
        along = np.concatenate([[0], np.cumsum(self.gaps)])
        for i in np.flatnonzero(~self.seen):
            near = np.flatnonzero(self.seen)
            near = near[np.argsort(np.abs(near - i), kind="stable")[:5]]
            curve = np.polyfit(along[near] - along[i], expected[near], 2)
            expected[i] = curve[-1]
        return expected

    def _near(self, candidates: NDArray[np.void]) -> NDArray[np.int64]:
        none = np.full(len(self.xy), -1)
        if not len(candidates):
            return none
        apart = candidates["xy"][None] - self._expected()[:, None]
        distance = np.hypot(apart[..., 0], apart[..., 1])
        ratio = candidates["area_px2"][None] / self.area[:, None]
        distance[(ratio < SIZE_RANGE[0]) | (ratio > SIZE_RANGE[1]) | (candidates["roundness"] < 0.3)] = np.inf
        nearest = distance.argmin(axis=1)
        best = distance[self.index, nearest]
        mutual = distance.argmin(axis=0)[nearest] == self.index
        found = np.where(mutual & (best < GATE * self.gaps.min()), nearest, -1)
        if distance.shape[1] > 1:
            second = np.partition(distance, 1, axis=1)[:, 1]
            found[second < 2 * best + 3] = -1
        return self._keeps_spacing(candidates, found)

    def _keeps_spacing(self, candidates: NDArray[np.void], found: NDArray[np.int64]) -> NDArray[np.int64]:
        """Leaves out the markers whose distances to both neighbours (one, at an end) have changed too much."""
        xy = np.where((found >= 0)[:, None], candidates["xy"][found], np.nan)
        gap = np.hypot(*np.diff(xy, axis=0).T)
        wrong = np.abs(np.log(gap / self.gaps)) > SPACING_CHANGE
        if wrong.any():
            left = np.concatenate([[True], wrong | np.isnan(gap)])
            right = np.concatenate([wrong | np.isnan(gap), [True]])
            some = np.concatenate([[False], wrong]) | np.concatenate([wrong, [False]])
            found = np.where(left & right & some, -1, found)
        return found

    def _anywhere(self, candidates: NDArray[np.void], found: NDArray[np.int64]) -> NDArray[np.int64]:
        """A whole chain of all N, wherever it lies; else what was found near, if at least two agree."""
        chain = find_chain(candidates, len(self.xy))
        if chain is None or chain.score < (CERTAIN_SCORE * self.score if not self.stills else -1.0):
            return found
        order = np.array(chain.order)
        ratio = np.log(candidates["area_px2"][order].mean() / self.area.mean())
        if abs(ratio) > np.log(SIZE_RANGE[1]):
            return found
        xy = candidates["xy"]
        forward, backward = (np.hypot(*(xy[o] - self.xy).T).sum() for o in (order, order[::-1]))
        self.velocity[:] = 0
        self.seen[:] = False
        return order if forward <= backward else order[::-1]

    def _remember(self, candidates: NDArray[np.void], found: NDArray[np.int64]) -> None:
        seen = found >= 0
        xy = np.where(seen[:, None], candidates["xy"][found] if len(candidates) else np.nan, self._expected())
        twice = seen & self.seen
        self.velocity = np.where(twice[:, None], xy - self.xy, 0.0)
        hidden = ~seen & self.seen.any()
        if seen.any() or not hidden.all():
            self.xy = np.where(seen[:, None] | (hidden[:, None] & seen.any()), xy, self.xy)
        if seen.any():
            self.area = np.where(seen, candidates["area_px2"][found], self.area)
            both = seen[1:] & seen[:-1]
            self.gaps = np.where(both, np.hypot(*np.diff(self.xy, axis=0).T), self.gaps)
        self.seen = seen


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
    return Tracks(tracks.xy[:, ::-1], tracks.sd_px[:, ::-1], tracks.reason)
