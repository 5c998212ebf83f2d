"""From a frame of the decoder to the planes that the kernels read, without a copy wherever the format allows it."""

from __future__ import annotations

from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import cv2
import numpy as np
from av.video.frame import VideoFrame
from av.video.plane import VideoPlane
from av.video.reformatter import ColorRange, Colorspace, Interpolation, VideoReformatter

from benchlab.errors import InputError
from benchlab.io.recording_base import RecordingInfo
from benchlab.vision.picture import Planes, UInt8Array

CHROMA_STEP: dict[str, tuple[int, int]] = {
    "yuv420p": (2, 2),
    "yuvj420p": (2, 2),
    "yuv422p": (2, 1),
    "yuvj422p": (2, 1),
    "yuv444p": (1, 1),
    "yuvj444p": (1, 1),
}
BY_STEP = {(2, 2): "yuv420p", (2, 1): "yuv422p"}
SITING: dict[str, tuple[float, float]] = {  # AVChromaLocation of 4:2:0, in luma pixels
    "left": (0.0, 0.5),
    "center": (0.5, 0.5),
    "topleft": (0.0, 0.0),
    "top": (0.5, 0.0),
    "bottomleft": (0.0, 1.0),
    "bottom": (0.5, 1.0),
}
MATRIX_BY_TAG = {
    1: "bt709",
    4: "bt601",
    5: "bt601",
    6: "bt601",
    9: "bt2020",
    10: "bt2020",
}  # AVColorSpace (ITU-T H.273)
UNKNOWN_MATRIX = 2
COLORSPACE = {"bt601": Colorspace.ITU601, "bt709": Colorspace.ITU709, "bt2020": Colorspace.BT2020}
LUMA_WEIGHTS = {"bt601": (0.299, 0.114), "bt709": (0.2126, 0.0722), "bt2020": (0.2627, 0.0593)}  # (kR, kB)
HD_LINES = 720
COLOUR_COMPONENTS = 3  # fewer are gray, with or without alpha
EXACT = (
    Interpolation.BILINEAR | Interpolation.ACCURATE_RND | Interpolation.FULL_CHR_H_INP | Interpolation.FULL_CHR_H_INT
)


@dataclass(frozen=True)
class ColourTags:
    """How the planes of a recording are to be understood.

    is_rgb: the stored picture is RGB, and `matrix` and `full_range` are those it is converted to.
    siting: where the chroma samples of 4:2:0 and 4:2:2 sit, as AVChromaLocation names it.
    """

    full_range: bool
    matrix: str
    siting: str = "left"
    is_rgb: bool = False


def read_tags(frame: VideoFrame, siting: str, file: Path, *, still: bool = False) -> ColourTags:
    """The colour tags of a decoded frame, with the usual defaults where the file says nothing.

    Untagged film is limited-range, BT.709 from 720 lines on (upright or on its side) and BT.601 below; untagged stills
    are full-range BT.601. RGB is converted to full-range BT.601, as JPEG does it.
    Raises InputError for a picture without colour and for a matrix that is none of BT.601, 709, 2020.
    """
    pixel_format = frame.format
    is_rgb = pixel_format.is_rgb or pixel_format.has_palette or pixel_format.is_bayer
    if not is_rgb and len(pixel_format.components) < COLOUR_COMPONENTS:
        raise InputError(
            "the picture has no colour",
            file=file,
            where=pixel_format.name,
            hint="markers are found by colour: film in colour",
        )
    if is_rgb:
        return ColourTags(full_range=True, matrix="bt601", siting=siting, is_rgb=True)
    full = pixel_format.name.startswith("yuvj") or frame.color_range == ColorRange.JPEG
    if frame.colorspace in MATRIX_BY_TAG:
        return ColourTags(full, MATRIX_BY_TAG[frame.colorspace], siting)
    if frame.colorspace != UNKNOWN_MATRIX:
        raise InputError(
            f"colour matrix {frame.colorspace} is none of BT.601, BT.709, BT.2020",
            file=file,
            hint="convert it to BT.709",
        )
    if still:
        return ColourTags(full or frame.color_range != ColorRange.MPEG, "bt601", siting)
    return ColourTags(full, "bt709" if min(frame.width, frame.height) >= HD_LINES else "bt601", siting)


def plane_view(plane: VideoPlane) -> UInt8Array:
    """(height, width) view of a plane's samples in the decoder's memory; its rows are wider than the picture."""
    stride = plane.line_size
    shape = (plane.height, plane.width)
    memory: Any = plane  # supports the buffer protocol; where rows run upwards it starts at the last of them
    return np.ndarray(shape, np.uint8, memory, 0 if stride > 0 else -stride * (shape[0] - 1), (stride, 1))


@dataclass
class PlaneReader:
    """Takes the planes out of decoded frames; formats other than 8-bit planar YCbCr are converted by swscale first."""

    tags: ColourTags
    _converters: dict[str, tuple[str, VideoReformatter]] = field(default_factory=dict)
    _rest: dict[tuple[int, int], dict[str, Any]] = field(default_factory=dict)

    def __call__(self, frame: VideoFrame) -> Planes:
        """The planes of one frame, views that live until the next one is decoded."""
        name = frame.format.name
        step = CHROMA_STEP.get(name)
        if step is None:
            frame = self._converted(frame, name)
            step = CHROMA_STEP[frame.format.name]
        luma, cb, cr = (plane_view(plane) for plane in frame.planes[:3])
        rest = self._rest.get(step) or self._described(step)
        return Planes(luma, cb, cr, **rest)

    def _described(self, step: tuple[int, int]) -> dict[str, Any]:
        x, y = SITING[self.tags.siting]
        offset = (x if step[0] == 2 else 0.0, y if step[1] == 2 else 0.0)
        rest = {
            "chroma_step": step,
            "chroma_offset": offset,
            "full_range": self.tags.full_range,
            "matrix": self.tags.matrix,
        }
        self._rest[step] = rest
        return rest

    def _converted(self, frame: VideoFrame, name: str) -> VideoFrame:
        if name not in self._converters:
            step = (16 // frame.format.chroma_width(16), 16 // frame.format.chroma_height(16))
            self._converters[name] = (
                "yuv444p" if self.tags.is_rgb else BY_STEP.get(step, "yuv444p"),
                VideoReformatter(),
            )
        target, reformatter = self._converters[name]
        out_range = ColorRange.JPEG if self.tags.full_range else ColorRange.MPEG
        colorspace = COLORSPACE[self.tags.matrix]
        return reformatter.reformat(
            frame,
            format=target,
            src_colorspace=None if self.tags.is_rgb else colorspace,
            dst_colorspace=colorspace,
            src_color_range=ColorRange.JPEG if self.tags.is_rgb else out_range,
            dst_color_range=out_range,
            interpolation=EXACT,
        )


def bgr_transform(matrix: str, full_range: bool) -> np.ndarray[Any, np.dtype[np.float64]]:
    """(3, 4): [B, G, R] = M · [Y, Cb, Cr, 1], all 0–255, for planes of this matrix and range (BT.601, 709, 2020)."""
    k_r, k_b = LUMA_WEIGHTS[matrix]
    k_g = 1 - k_r - k_b
    luma, chroma, black = (1.0, 1.0, 0.0) if full_range else (255 / 219, 255 / 224, 16.0)
    blue, red = 2 * (1 - k_b) * chroma, 2 * (1 - k_r) * chroma
    linear = np.array([[luma, blue, 0.0], [luma, -blue * k_b / k_g, -red * k_r / k_g], [luma, 0.0, red]])
    return np.hstack([linear, -(linear @ np.array([[black], [128.0], [128.0]]))])


def planes_to_bgr(planes: Planes) -> UInt8Array:
    """(height, width, 3) blue, green, red of stored planes, chroma interpolated from where its samples sit."""
    height, width = planes.luma.shape
    full = [np.ascontiguousarray(planes.luma)]
    for chroma in (planes.cb, planes.cr):
        if planes.chroma_step == (1, 1):
            full.append(np.ascontiguousarray(chroma))
            continue
        (step_x, step_y), (x0, y0) = planes.chroma_step, planes.chroma_offset
        to_chroma = np.array([[1 / step_x, 0, -x0 / step_x], [0, 1 / step_y, -y0 / step_y]])
        flags = cv2.INTER_LINEAR | cv2.WARP_INVERSE_MAP
        contiguous = np.ascontiguousarray(chroma)
        full.append(
            np.asarray(
                cv2.warpAffine(contiguous, to_chroma, (width, height), flags=flags, borderMode=cv2.BORDER_REPLICATE),
                dtype=np.uint8,
            )
        )
    merged = cv2.merge(full)
    return np.asarray(cv2.transform(merged, bgr_transform(planes.matrix, planes.full_range)), dtype=np.uint8)


def display_bgr(planes: Planes, info: RecordingInfo) -> UInt8Array:
    """(info.height, info.width, 3) blue, green, red as displayed: stretched, mirrored and turned as tagged."""
    picture = planes_to_bgr(planes)
    if info.sample_aspect != 1:
        wide = info.width if info.rotation_deg in {0, 180} else info.height
        picture = np.asarray(
            cv2.resize(picture, (wide, picture.shape[0]), interpolation=cv2.INTER_LINEAR), dtype=np.uint8
        )
    if info.mirrored:
        picture = picture[:, ::-1]
    return np.ascontiguousarray(np.rot90(picture, -info.rotation_deg // 90))
