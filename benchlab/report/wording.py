"""Words for pictures: names that a font can draw and a title can hold, and the flags of a series counted."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from functools import cache, lru_cache

import numpy as np

from benchlab.errors import printable
from benchlab.vision.series import CurvatureSeries


def drawable(text: str, length: int) -> str:
    """Text as a figure can show it: control characters escaped, signs the font lacks as □, the middle of a long one cut.

    >>> drawable("a" * 20 + ".mp4", 11)
    'aaaaaa….mp4'
    """
    known = _signs()
    text = "".join(c if ord(c) in known else "□" for c in printable(text))
    if len(text) <= length:
        return text
    tail = min(max(4, length // 4), length // 2)
    return text[: length - tail - 1] + "…" + text[-tail:]


@cache
def _signs() -> frozenset[int]:
    """Code points that the font of figures has. Making the list takes as long as drawing a line of text."""
    from matplotlib.font_manager import FontProperties, findfont, get_font

    return frozenset(get_font(findfont(FontProperties())).get_charmap())


@lru_cache(maxsize=4096)
def width_in(text: str, fontsize: float) -> float:
    """Width of a text as a figure draws it, in inches."""
    from matplotlib.font_manager import FontProperties
    from matplotlib.textpath import text_to_path

    return float(text_to_path.get_text_width_height_descent(text, FontProperties(size=fontsize), ismath=False)[0]) / 72


def fitted(text: str, inches: float, fontsize: float) -> str:
    """Text as a figure can show it in so many inches: the middle cut out where it is longer.

    >>> fitted("W" * 30, 0.8, 10), fitted("i" * 20, 0.8, 10)
    ('WW…WW', 'iiiiiiiiiiiiiiiiiiii')
    """
    whole = drawable(text, 10_000)
    width = width_in(whole, fontsize)
    if width <= inches:
        return whole
    length = min(int(len(whole) * inches / width) + 4, len(whole) - 1)
    while length > 3 and width_in(short := drawable(whole, length), fontsize) > inches:
        length -= 1
    return short


def fitted_apart(names: Sequence[str], inches: float, fontsize: float) -> list[str]:
    """Names fitted; those that would look alike then are numbered.

    >>> fitted_apart(["x" * 30 + "1_end", "x" * 30 + "2_end", "short"], 1.0, 10)
    ['xxx…_end #1', 'xxx…_end #2', 'short']
    """
    short = [fitted(name, inches, fontsize) for name in names]
    alike, told = Counter(short), Counter[str]()
    for index, name in enumerate(short):
        if alike[name] > 1:
            told[name] += 1
            tag = f" #{told[name]}"
            short[index] = fitted(names[index], inches - width_in(tag, fontsize), fontsize) + tag
    return short


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
