"""Words for pictures: names that a font can draw and a title can hold, and the flags of a series counted."""

from __future__ import annotations

import numpy as np

from benchlab.errors import printable
from benchlab.vision.series import CurvatureSeries


def drawable(text: str, length: int) -> str:
    """Text as a figure can show it: control characters escaped, signs the font lacks as □, the middle of a long one cut.

    >>> drawable("a" * 20 + ".mp4", 11)
    'aaaaaa….mp4'
    """
    from matplotlib.font_manager import FontProperties, findfont, get_font

    known = get_font(findfont(FontProperties())).get_charmap()
    text = "".join(c if ord(c) in known else "□" for c in printable(text))
    if len(text) <= length:
        return text
    tail = min(max(4, length // 4), length // 2)
    return text[: length - tail - 1] + "…" + text[-tail:]


def flag_groups(series: CurvatureSeries, most: int) -> list[tuple[str, np.ndarray]]:
    """The words of the flags, the commonest first: what to call each in a legend, and the frames (indices) that have it.

    Beyond `most` of them, the last stands for the rest. Words of frames without an angle say so.
    """
    frames: dict[str, list[int]] = {}
    for index, flag in enumerate(series.flag):
        for word in dict.fromkeys(part.strip() for part in flag.split(";")):
            if word:
                frames.setdefault(word, []).append(index)
    ranked = sorted(frames.items(), key=lambda item: (-len(item[1]), item[0]))
    if len(ranked) > most:
        rest = sorted({index for _, indices in ranked[most - 1 :] for index in indices})
        ranked = [*ranked[: most - 1], (f"{len(ranked) - most + 1} other reasons", rest)]
    return [(_legend(word, np.array(indices), series), np.array(indices)) for word, indices in ranked]


def _legend(word: str, frames: np.ndarray, series: CurvatureSeries) -> str:
    missing = int((~series.measured[frames]).sum())
    count = f"{len(frames)} frame" + ("" if len(frames) == 1 else "s")
    if missing == len(frames):
        count += ", not measured"
    elif missing:
        count += f", {missing} not measured"
    return f"{drawable(word, 34)} ({count})"
