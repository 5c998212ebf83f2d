"""What is checked about a film: options, picture size, and the account of its frames, settled at the end."""

from __future__ import annotations

import math
from collections.abc import Callable
from pathlib import Path

from av.video.frame import VideoFrame

from benchlab.errors import InputError, UsageError
from benchlab.io.recording_base import RecordingInfo

MAX_FPS = 1e6
MAX_TICK_S = 0.01
DAMAGED = "damaged"
AFTER_DAMAGE = "predicted from a damaged frame"
NOT_ADVANCING = "time stamp does not advance"


def check_rates(fps: float | None, capture_fps: float | None) -> None:
    """Raises UsageError unless the rates are finite, above 0 and at most 10⁶ frames a second."""
    for name, rate in (("--fps", fps), ("--capture-fps", capture_fps)):
        if rate is not None and not (math.isfinite(rate) and 0 < rate <= MAX_FPS):
            raise UsageError(f"{name} {rate:g} is out of range", hint=f"give a number above 0 and at most {MAX_FPS:g}")
    if fps is not None and capture_fps is not None:
        raise UsageError("--fps and --capture-fps exclude each other", hint="--fps sets the time of frame i to i/fps")


def check_size(path: Path, width: int, height: int, max_pixels: int) -> None:
    """Raises InputError for a picture of more pixels than the limit."""
    if width * height > max_pixels:
        raise InputError(
            f"{width}×{height} = {width * height / 1e6:.0f} Mpx > limit {max_pixels / 1e6:g} Mpx",
            file=path,
            hint="raise it with --max-pixels if the memory allows",
        )


class Account:
    """Counts frames, damage and time steps while a film is read, in constant memory."""

    def __init__(self, info: RecordingInfo, allow_partial: bool, tick_s: float) -> None:
        self.info, self.allow_partial = info, allow_partial
        self.jitter_s = min(tick_s, MAX_TICK_S) + 0.0015
        self.frames = self.lost = self.stuck = self.tainted = 0
        self.first_lost_s = self.last_lost_s = self.last_s = self._latest_s = math.nan
        self.shortest_s, self.longest_s = math.inf, 0.0
        self.interlaced = False
        self._taint = False
        self._step_known = False

    def damaged(self, time_s: float) -> None:
        """A frame that could not be decoded, or was decoded with errors."""
        self.frames += 1
        self.lost += 1
        if self.lost == 1:
            self.first_lost_s = time_s
        self.last_lost_s = time_s
        self._taint = True
        self._step_known = False

    def good(self, time_s: float, picture: VideoFrame) -> str:
        """A decoded frame; returns what is doubtful about it, mostly nothing.

        Every frame from a damaged one to the next key frame counts as predicted from it.
        """
        self.frames += 1
        self.interlaced = self.interlaced or picture.interlaced_frame
        if self._taint:
            self._taint = not picture.key_frame
            self.tainted += self._taint
        last = self._latest_s
        if time_s <= last:
            self.stuck += 1
            self._step_known = False
            return NOT_ADVANCING
        if self._step_known:
            step = time_s - last
            self.shortest_s = min(step, self.shortest_s)
            self.longest_s = max(step, self.longest_s)
        self._latest_s = time_s
        self._step_known = True
        return AFTER_DAMAGE if self._taint else ""

    @property
    def decoded(self) -> int:
        """Frames that came out whole."""
        return self.frames - self.lost

    def settle(self, warn: Callable[[str], None], *, truncated: bool, decode_errors: int) -> None:
        """Say what is doubtful; raise InputError for loss unless it is allowed."""
        if self.interlaced:
            warn("interlaced: the two fields of a frame are half a frame apart in time")
        if self.stuck:
            warn(f"{self.stuck} of {self.frames} frames have time stamps that do not advance; they are not measured")
        if self.longest_s > 1.1 * self.shortest_s + self.jitter_s:
            warn(f"variable frame rate, {1e3 * self.shortest_s:.0f}–{1e3 * self.longest_s:.0f} ms")
        if self.decoded == 0:
            raise InputError("no frames decoded", file=self.info.path, hint="copy it again from the camera")
        for what, where in self._losses(truncated, decode_errors):
            if not self.allow_partial:
                hint = "copy it again, or keep what is whole with --allow-partial"
                raise InputError(what, file=self.info.path, where=where, hint=hint)
            warn(f"{what} ({where})")
        if self.tainted:
            warn(f"{self.tainted} frames after damaged ones are predicted from them and may carry their damage")

    def _losses(self, truncated: bool, decode_errors: int) -> list[tuple[str, str]]:
        losses = []
        if truncated:
            claimed = self.info.frame_count
            of = f" of {claimed}" if claimed and claimed > self.decoded else ""
            end = f" to {self.info.duration_s:.2f}" if self.info.duration_s else ""
            where = f"missing from {self._latest_s:.2f}{end} s"
            losses.append((f"truncated: decoded {self.decoded}{of} frames", where))
        if self.lost:
            span = f"between {self.first_lost_s:.2f} and {self.last_lost_s:.2f} s"
            losses.append((f"{self.lost} of {self.frames} frames damaged", span))
        elif decode_errors and not truncated:
            losses.append((f"{decode_errors} packets could not be decoded", f"{self.decoded} frames could"))
        return losses
