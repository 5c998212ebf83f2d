"""Pictures of a simulated shell: the true deformed surface, the film coloured by its stretch, fabric and strip in their own colours."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from benchlab.report.painter import Faces, Painting, View, paint
from benchlab.report.panels import GREY
from benchlab.simulation.surface import Surface

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

COLOUR_MAP = "viridis"
FABRIC, STRIP, CAP = "#e9e4d8", "#3d5a80", "#6c7075"
PIECES = {"rib": FABRIC, "weld": FABRIC, "strip": STRIP, "cap": CAP}
"""Colours of the outermost layer; film is coloured by its stretch."""

SIDE = View.of((0.40, 1.0, -0.22), (1, 0, 0))
"""The bending plane nearly face on, the side of the windows above."""

OBLIQUE = View.of((0.55, 0.75, -0.75), (1, 0, 0))


@dataclass(frozen=True)
class StretchScale:
    """Film stretches from 1 to `top`, as colours."""

    top: float

    @classmethod
    def of(cls, surface: Surface) -> StretchScale:
        """Up to what all but 0.5 % of the film stays below; at least 1.05."""
        known = surface.stretch[np.isfinite(surface.stretch)]
        return cls(max(1.05, float(np.quantile(known, 0.995)) if known.size else 1.05))

    @property
    def mappable(self) -> Any:
        from matplotlib.cm import ScalarMappable
        from matplotlib.colors import Normalize

        return ScalarMappable(Normalize(1.0, self.top), COLOUR_MAP)

    def colours(self, stretch: NDArray[np.float64]) -> NDArray[np.float64]:
        return np.asarray(self.mappable.to_rgba(np.nan_to_num(stretch, nan=1.0))[..., :3])


def paint_surface(
    surface: Surface, scale: StretchScale, view: View, size_px: tuple[int, int], closed: bool
) -> Painting:
    """A surface seen from `view`; closed: with its ends closed, otherwise one looks into it."""
    faces = _faces_of(surface, scale)
    if closed:
        for column in (0, -1):
            faces = faces.joined(_end(surface.points_mm[:, column], surface.points_mm[:, 1 if column == 0 else -2]))
        faces = faces.towards(view)
    return paint(faces, view, size_px)


def _faces_of(surface: Surface, scale: StretchScale) -> Faces:
    from matplotlib.colors import to_rgb

    points, piece = surface.points_mm, surface.piece
    film = scale.colours(surface.stretch.ravel())
    outer = film.copy()
    for name, colour in PIECES.items():
        outer[piece.ravel() == name] = to_rgb(colour)
    inner = np.where(np.isfinite(surface.stretch).ravel()[:, None], film, outer)
    normal = np.cross(np.gradient(points, axis=0), np.gradient(points, axis=1))
    seam = normal[0] + normal[-1]
    normal[0] = normal[-1] = seam
    centre = normal[:-1, :-1] + normal[1:, :-1] + normal[1:, 1:] + normal[:-1, 1:]
    centre = centre.reshape(-1, 3) / np.linalg.norm(centre, axis=-1).reshape(-1, 1)
    quads = surface.quads_mm
    flat = np.cross(quads[:, 2] - quads[:, 0], quads[:, 3] - quads[:, 1])
    centre *= np.sign((centre * flat).sum(axis=1, keepdims=True)) * _outwards(surface)
    return Faces(quads, centre, outer, inner, _borders(piece))


def _outwards(surface: Surface) -> float:
    """Whether the faces' own normals point outwards (1) or inwards (−1)."""
    quads = surface.quads_mm
    ring = surface.points_mm[:-1].mean(axis=0)
    axis = np.tile((ring[:-1] + ring[1:]) / 2, (len(surface.piece), 1))
    flat = np.cross(quads[:, 2] - quads[:, 0], quads[:, 3] - quads[:, 1])
    return float(np.sign((flat * (quads.mean(axis=1) - axis)).sum()))


def _borders(piece: NDArray[np.str_]) -> NDArray[np.bool_]:
    """Edges (faces, 4) where one piece meets another; corners go as Surface.quads_mm says."""
    lines = np.zeros((*piece.shape, 4), dtype=bool)
    along, around = piece[:, 1:] != piece[:, :-1], piece[1:] != piece[:-1]
    lines[:, 1:, 0], lines[:, :-1, 2] = along, along  # corners 0-1 on the near column, 2-3 on the far one
    lines[1:, :, 3], lines[:-1, :, 1] = around, around
    return lines.reshape(-1, 4)


def _end(ring: NDArray[np.float64], beside: NDArray[np.float64]) -> Faces:
    """A plane face over an end ring, as triangles about its middle."""
    from matplotlib.colors import to_rgb

    middle = ring[:-1].mean(axis=0)
    corners = np.stack([np.broadcast_to(middle, ring[:-1].shape), ring[:-1], ring[1:], ring[1:]], axis=1)
    normal = middle - beside[:-1].mean(axis=0)
    normal /= np.linalg.norm(normal)
    count = len(corners)
    colour = np.tile(to_rgb(CAP), (count, 1))
    return Faces(corners, np.tile(normal, (count, 1)), colour, colour, np.zeros((count, 4), dtype=bool))


def show_painting(figure: Figure, painting: Painting, left_px: int, bottom_px: int) -> None:
    """Put a painting onto a figure, pixel by pixel, without axes."""
    height, width = painting.rgba.shape[:2]
    whole = figure.get_size_inches() * figure.dpi
    box = (left_px / whole[0], bottom_px / whole[1], width / whole[0], height / whole[1])
    ax = figure.add_axes(box, zorder=-1)
    ax.imshow(painting.rgba, interpolation="nearest", aspect="auto")
    ax.set_axis_off()


def draw_scale_bar(figure: Figure, painting: Painting, left_px: float, bottom_px: float, length_mm: float) -> None:
    """A bar of `length_mm` as long as it is in the painting."""
    from matplotlib.lines import Line2D

    width, height = figure.get_size_inches() * figure.dpi
    x, y = left_px / width, bottom_px / height
    end = x + length_mm * painting.px_per_mm / width
    figure.add_artist(Line2D([x, end], [y, y], color=GREY, linewidth=2, solid_capstyle="butt"))
    figure.text((x + end) / 2, y + 6 / height, f"{length_mm:g} mm", ha="center", va="bottom", fontsize=9, color=GREY)


def draw_stretch_bar(figure: Figure, scale: StretchScale, box: tuple[float, float, float, float]) -> Axes:
    """The colour bar of film stretches, upright in `box` (left, bottom, width, height as shares of the figure)."""
    ax = figure.add_axes(box)
    bar = figure.colorbar(scale.mappable, cax=ax, extend="max")
    bar.outline.set_visible(False)
    bar.set_label("largest stretch of the film", fontsize=9.5)
    ax.tick_params(labelsize=9, color=GREY)
    return ax


def nice_length_mm(span_mm: float) -> float:
    """A round length of about a fifth of a span.

    >>> nice_length_mm(180.0), nice_length_mm(14.0)
    (50.0, 2.0)
    """
    aim = max(span_mm / 5, 1e-6)
    step = 10.0 ** np.floor(np.log10(aim))
    return float(step * min((1, 2, 5, 10), key=lambda n: abs(np.log(n * step / aim))))
