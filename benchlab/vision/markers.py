"""From spots to candidate markers, each with a sub-pixel centroid.

A spot is measured in a small window of the colour plane, and again in the luma plane at full resolution; the two
centroids are combined by their precision, so that luma counts where the spot stands out plainly from an even surround,
and chroma where it lies on an edge or carries a highlight.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from benchlab.vision.colour import MarkerColour
from benchlab.vision.picture import FloatArray, Planes
from benchlab.vision.spots import Cut, Region, Spot, find_spots
from benchlab.vision.window import Measured, centred, measure_windows

CANDIDATE = np.dtype(
    [
        ("xy", np.float64, 2),  # centroid, luma pixels
        ("sd_px", np.float64),  # of each coordinate, from the noise around the spot
        ("area_px2", np.float64),  # colour-weighted area, luma pixels
        ("roundness", np.float64),  # smaller over larger principal axis of the spot, 1 for a disc
        ("contrast", np.float64),  # chroma levels of the spot above its surround
        ("level", np.float64),  # chroma level of the spot itself
        ("isolation", np.float64),  # 1 for an even surround, 0 where it varies as much as the spot stands out
        ("hue_rad", np.float64),  # direction of the spot's chroma
    ]
)

LEAST_CONTRAST = 10.0  # chroma levels above the surround: less is not told from noise, texture and compression
HUE_REACH = 0.7  # rad between a spot's hue and the colour looked for: skin and wood are out, a warm lamp is not


def find_candidates(
    planes: Planes, colour: MarkerColour, threshold: float, region: Region | None = None
) -> NDArray[np.void]:
    """All candidate markers of one picture, as an array of CANDIDATE records (n,), in no particular order.

    threshold: level of the colour plane (128 is grey) above which a chroma sample belongs to a spot.
    """
    spots = find_spots(planes, colour, threshold, region)
    return measure_spots([spots], colour, planes.chroma_step, planes.chroma_offset)[0]


def measure_spots(
    pictures: Sequence[list[Spot]],
    colour: MarkerColour,
    chroma_step: tuple[int, int],
    chroma_offset: tuple[float, float],
) -> list[NDArray[np.void]]:
    """The candidates (CANDIDATE records) among the spots of several pictures; many at once cost little more than one."""
    spots = [spot for picture in pictures for spot in picture]
    step, offset = np.array(chroma_step, float), np.array(chroma_offset, float)
    radii = np.array([spot.radius for spot in spots])
    found = np.zeros(len(spots), CANDIDATE)
    if spots:
        colour_cuts, luma_cuts = [spot.colour for spot in spots], [spot.luma for spot in spots]
        boxes = np.array([(spot.x, spot.y) for spot in spots])
        in_colour = _measured(colour_cuts, _measured(colour_cuts, boxes).xy)
        coarse = in_colour.xy * step + offset
        in_luma = _measured(luma_cuts, coarse)
        colour_variance = in_colour.variance * step.prod()
        share = colour_variance / (colour_variance + in_luma.variance)
        apart = np.hypot(*(in_luma.xy - coarse).T) > 0.5 * radii * step[0]
        share[apart] = 0.0
        found["xy"] = coarse + share[:, None] * (in_luma.xy - coarse)
        found["sd_px"] = np.sqrt(np.where(apart, colour_variance, share * in_luma.variance))
        found["area_px2"] = in_colour.area * step.prod()
        for name in ("roundness", "contrast", "level", "isolation"):
            found[name] = getattr(in_colour, name)
        found["hue_rad"] = [spot.hue_rad for spot in spots]
    hue_off = np.abs(np.angle(np.exp(1j * (found["hue_rad"] - colour.hue_rad))))
    kept = (found["contrast"] >= LEAST_CONTRAST) & (hue_off <= HUE_REACH)
    ends = np.cumsum([len(picture) for picture in pictures])[:-1]
    return [part[keep] for part, keep in zip(np.split(found, ends), np.split(kept, ends), strict=True)]


def _measured(cuts: list[Cut], near: FloatArray) -> Measured:
    """Spots measured in their windows, those of one radius class together, in samples of the plane.

    near: (n, 2) where they are thought to be.
    """
    sizes = np.array([cut.size for cut in cuts])
    middles = np.array([cut.middle for cut in cuts], float)
    parts: dict[str, FloatArray] = {}
    for size in np.unique(sizes):
        rows = np.flatnonzero(sizes == size)
        windows, shifts = centred(np.stack([cuts[i].window for i in rows]), near[rows] - middles[rows])
        middles[rows] += shifts
        for name, values in vars(measure_windows(windows, int(size))).items():
            whole = parts.setdefault(name, np.zeros((len(cuts), *values.shape[1:])))
            whole[rows] = values
    parts["xy"] += middles
    return Measured(**parts)
