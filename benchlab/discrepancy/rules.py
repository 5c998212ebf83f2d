"""The few numbers that decide when something is said. Chosen on the tuning and calibration studies of tests/blind, not on those that are scored."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class Rules:
    """first, further: largest p at which a first, a further effect is taken. multiplier: by which t must exceed the bootstrap's quantiles
    (the fitted scatter is itself uncertain). rival: a candidate that the best one speaks against with a smaller p is out.
    close: a candidate within this −2 log L of the best stays in; alike: or within this share of what the best explains, as forms are not
    known better. adequate: smallest p of the flexible test at which nothing is left.
    share: explained share from which one, two, three effects are named although something is left. moves: smallest RMS that a further effect must move,
    as a share of the first one's. most: effects in one model. beam: fits that are carried on.
    """

    first: float = 0.05
    further: float = 0.01
    multiplier: float = 1.12
    rival: float = 0.003
    close: float = 2.0
    alike: float = 0.0025
    adequate: float = 0.01
    share: tuple[float, ...] = (0.75, 0.9, 0.95)
    moves: float = 0.25
    most: int = 3
    beam: int = 3
    tries: int = 6
