"""What is in front of the camera, and what the camera does to it."""

from __future__ import annotations

from dataclasses import dataclass

from benchlab.errors import UsageError
from benchlab.vision.synthetic.encode import MATRIX, SITING
from benchlab.vision.synthetic.things import RGB, Thing

MARKER_RGB: dict[str, RGB] = {
    "red": (196.0, 36.0, 44.0),
    "green": (38.0, 150.0, 62.0),
    "blue": (36.0, 72.0, 190.0),
}


@dataclass(frozen=True)
class Scene:
    """An actuator with markers on a bench, seen by one camera. Lengths in pixels, colours gamma-coded R, G, B 0–255.

    The body leaves `base_px` in the direction `heading_rad` (0 to the right, clockwise on the screen) and bends into a
    circular arc of length `length_px` from the first marker to the last, clockwise on the screen if `bend_sign` is 1,
    the other way if −1.

    marker_offset_px: one (along, across) placement error per marker; empty for none.
    body_shading: 0 for a flat colour, 1 for a strongly rounded look.
    highlight: opacity of a bright spot on each marker.
    light_gradient: 0 for even light; 0.4 leaves 60 % in the darkest corner.
    blur_px: standard deviation of the defocus. exposure_fraction: share of the frame interval that the shutter is open.
    noise_sd: white sensor noise of red, green and blue each, in 8-bit levels, before encoding.
    tilt_rad, tilt_axis_rad: the bench plane turned about an axis through the middle of the picture, of this direction
        in the picture, seen with focal length `focal_px`; along the axis the scale stays that of the untilted picture.
    lens_k1, lens_k2: radial distortion in OpenCV's convention, r in units of `focal_px` from the middle of the picture.
    clutter: drawn behind the actuator. occluders: drawn over it.
    chroma_siting: "left" (MPEG) or "centre" (JPEG). matrix, full_range: as in `Planes`.
    """

    width: int = 1920
    height: int = 1080
    markers: int = 10
    marker_radius_px: float = 9.0
    marker_rgb: RGB = MARKER_RGB["red"]
    marker_offset_px: tuple[tuple[float, float], ...] = ()
    length_px: float = 900.0
    base_px: tuple[float, float] = (420.0, 220.0)
    heading_rad: float = 0.0
    bend_sign: int = 1
    body_width_px: float = 38.0
    body_rgb: RGB = (222.0, 220.0, 212.0)
    body_shading: float = 0.35
    background_rgb: RGB = (128.0, 130.0, 132.0)
    clamp: bool = True
    highlight: float = 0.0
    light_gradient: float = 0.15
    blur_px: float = 0.7
    exposure_fraction: float = 0.25
    noise_sd: float = 1.5
    tilt_rad: float = 0.0
    tilt_axis_rad: float = 0.0
    focal_px: float = 2800.0
    lens_k1: float = 0.0
    lens_k2: float = 0.0
    clutter: tuple[Thing, ...] = ()
    occluders: tuple[Thing, ...] = ()
    chroma_siting: str = "left"
    full_range: bool = False
    matrix: str = "bt709"

    def __post_init__(self) -> None:
        demands = {
            "width and height of at least 16": min(self.width, self.height) >= 16,
            "markers of at least 2": self.markers >= 2,
            "marker_radius_px, length_px, body_width_px and focal_px above 0": min(
                self.marker_radius_px, self.length_px, self.body_width_px, self.focal_px
            )
            > 0,
            "one marker_offset_px per marker, or none": len(self.marker_offset_px) in (0, self.markers),
            "a bend_sign of 1 or -1": self.bend_sign in (1, -1),
            "body_shading, highlight, light_gradient and exposure_fraction from 0 to 1": all(
                0 <= share <= 1
                for share in (self.body_shading, self.highlight, self.light_gradient, self.exposure_fraction)
            ),
            "blur_px and noise_sd of 0 or more": min(self.blur_px, self.noise_sd) >= 0,
            "a tilt_rad between -1.2 and 1.2": abs(self.tilt_rad) <= 1.2,
            f"a chroma_siting of {' or '.join(SITING)}": self.chroma_siting in SITING,
            f"a matrix of {' or '.join(MATRIX)}": self.matrix in MATRIX,
        }
        for demand, met in demands.items():
            if not met:
                raise UsageError(f"a scene needs {demand}")
