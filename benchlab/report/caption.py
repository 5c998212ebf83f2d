"""Words in a picture, drawn with OpenCV alone: its stroke font has no θ, ° and ±, so these are drawn as strokes too."""

from __future__ import annotations

from collections.abc import Sequence

import cv2
import numpy as np

from benchlab.errors import printable
from benchlab.vision.picture import UInt8Array

_FONT = cv2.FONT_HERSHEY_SIMPLEX
_CAPITAL = 21.0  # height in pixels of a capital letter at scale 1
_WHITE = (255, 255, 255)
_DRAWN = "θ°±"
_WIDTHS = {"θ": 0.9, "°": 0.6, "±": 1.05}  # of the drawn signs, in capital heights
_ASCII = str.maketrans({"–": "-", "−": "-", "…": "...", "×": "x", "κ": "k", "µ": "u"})


def write_caption(picture: UInt8Array, lines: Sequence[str]) -> None:
    """Write lines into the upper left corner of a picture (H, W, 3), in place, white on a darkened ground.

    The first line is the largest. Lines too wide for the picture are written smaller, and cut with ... below a size.
    """
    height, width = picture.shape[:2]
    edge = max(4, round(height / 60))
    capital = max(10.0, height / 36)
    written = []
    y = float(edge)
    for index, line in enumerate(lines):
        text, tall = _fitted(line, capital if index == 0 else 0.72 * capital, width - 4 * edge)
        y += 1.75 * tall
        written.append((text, tall, y))
    ground = picture[
        edge : round(y + 0.9 * capital), edge : round(3 * edge + max((_width(t, c) for t, c, _ in written), default=0))
    ]
    ground[:] = (ground * np.float32(0.3)).astype(np.uint8)
    for text, tall, base in written:
        _write(picture, text, 2.0 * edge, base, tall)


def _fitted(line: str, capital: float, room: float) -> tuple[str, float]:
    """The line as it can be drawn, and the height of its capitals so that it has room."""
    text = "".join(c if c.isascii() or c in _DRAWN else "?" for c in printable(line).translate(_ASCII))
    smallest = max(7.0, 0.6 * capital)
    capital = max(smallest, min(capital, capital * room / max(1.0, _width(text, capital))))
    while len(text) > 4 and _width(text, capital) > room:
        text = text[:-4].rstrip(".") + "..." if text.endswith("...") else text[:-3] + "..."
    return text, capital


def _runs(text: str) -> list[str]:
    """Text split into stretches of the font's own letters and single signs that are drawn."""
    runs: list[str] = []
    for letter in text:
        if letter in _DRAWN or not runs or runs[-1] in _DRAWN:
            runs.append(letter)
        else:
            runs[-1] += letter
    return runs


def _stroke(capital: float) -> int:
    return max(1, round(capital / 9))


def _run_width(run: str, capital: float) -> float:
    if run in _WIDTHS:
        return _WIDTHS[run] * capital
    return float(cv2.getTextSize(run, _FONT, capital / _CAPITAL, _stroke(capital))[0][0])


def _width(text: str, capital: float) -> float:
    return sum(_run_width(run, capital) for run in _runs(text))


def _write(picture: UInt8Array, text: str, x: float, base: float, capital: float) -> None:
    thick = _stroke(capital)
    for run in _runs(text):
        if run in _DRAWN:
            _draw_sign(picture, run, x, base, capital, thick)
        else:
            cv2.putText(picture, run, (round(x), round(base)), _FONT, capital / _CAPITAL, _WHITE, thick, cv2.LINE_AA)
        x += _run_width(run, capital)


def _draw_sign(picture: UInt8Array, sign: str, x: float, base: float, capital: float, thick: int) -> None:
    middle = x + _WIDTHS[sign] * capital / 2

    def at(right: float, up: float) -> tuple[int, int]:
        return round(middle + right * capital), round(base - up * capital)

    def line(right: float, up: float, to_right: float, to_up: float) -> None:
        cv2.line(picture, at(right, up), at(to_right, to_up), _WHITE, thick, cv2.LINE_AA)

    if sign == "θ":
        cv2.ellipse(
            picture, at(0, 0.5), (round(0.3 * capital), round(0.5 * capital)), 0, 0, 360, _WHITE, thick, cv2.LINE_AA
        )
        line(-0.3, 0.5, 0.3, 0.5)
    elif sign == "°":
        cv2.circle(picture, at(-0.02, 0.85), max(2, round(0.16 * capital)), _WHITE, thick, cv2.LINE_AA)
    else:
        line(-0.32, 0.52, 0.32, 0.52)
        line(0, 0.2, 0, 0.84)
        line(-0.32, 0.0, 0.32, 0.0)
