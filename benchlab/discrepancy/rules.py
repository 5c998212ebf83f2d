"""The few numbers that decide when something is said: chosen on the tuning and calibration studies of tests/blind, not on the scored."""

from __future__ import annotations

from dataclasses import dataclass, replace


@dataclass(frozen=True)
class Rules:
    """first, further: largest p at which a first, a further effect is taken.
    multiplier: by which t must exceed the bootstrap's quantiles (the fitted scatter is itself uncertain).
    rival: a candidate that the best one speaks against with a smaller p is out.
    close, alike: a candidate stays in within this −2 log L of the best, or within this share of what the best explains, as forms are not
    known better.
    adequate: smallest p of the flexible test at which nothing is left.
    doubtful, half: with a p of that test below the first, a model that explains less than the second share is no explanation.
    share: explained share from which one, two, three effects are named although something is left.
    moves: smallest RMS by which a second, a third effect must move the predictions in some part of the gap (parts.PARTS), as a share of it.
    moves_left, moves_least: a second effect also as a share of that of the part that is left, and then of the part.
    part, least: and at least by this share of the whole gap, and of the error of the means.
    alone, together: of one kind of run, a further effect that alone explains this share of what the best does, where both together
    explain no more than the second share beyond it, is a rival.
    clears: where something is left beside a larger model, it must have fallen to this share of what was left before.
    most: effects in one model. beam, near: fits to which a further effect is added, if within this share of what the best explains.
    tries: effects that are tried beside each.
    """

    first: float = 0.05
    further: float = 0.05
    multiplier: float = 1.12
    rival: float = 0.001
    close: float = 2.0
    alike: float = 0.005
    adequate: float = 0.01
    doubtful: float = 0.1
    half: float = 0.65
    share: tuple[float, ...] = (0.75, 0.9, 0.95)
    moves: tuple[float, ...] = (0.25, 0.4)
    moves_left: float = 0.6
    moves_least: float = 0.1
    part: float = 0.05
    least: float = 0.5
    alone: float = 0.7
    together: float = 0.15
    clears: float = 0.5
    most: int = 3
    beam: int = 3
    near: float = 0.05
    tries: int = 8

    def at(self, freedom: float) -> Rules:
        """With the multiplier of a study of so many degrees of freedom: 1 up to 10, all of it from 20, as calibrated."""
        part = min(max((freedom - 10) / 10, 0.0), 1.0)
        return replace(self, multiplier=1 + part * (self.multiplier - 1))
