"""A small study file for tests of what reads it."""

from __future__ import annotations

from pathlib import Path

GOOD = """\
title: A study
pressure_MPa: 0.35
analysis: {ramp: "0:0.35:2.5"}
designs:
  tw3_slw5:
    shell: {tw_mm: 3, slw_mm: 5}
    samples:
      s1: a1.mp4
      s2: [a2.mp4, a2b.mp4]
  tw3_slw10:
    shell: tw3_slw10
    samples:
      s1: b1.mp4
sets:
  slw: [tw3_slw5, tw3_slw10]
"""


def write_study(folder: Path, text: str | bytes = GOOD) -> Path:
    path = folder / "study.yaml"
    path.write_bytes(text if isinstance(text, bytes) else text.encode())
    return path
