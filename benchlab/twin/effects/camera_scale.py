"""camera_scale: lengths in the picture are taken for f times what they are.

    scale that is told = f · true scale, so κ = κ_true/f, and the angle κ·al with it

f `factor`: chosen 1.02. Affects the scale that is told with the film (mm per pixel), not the picture; who measures by the
distance of the markers does not see it. Off in the twin that comes with benchlab.
"""

from __future__ import annotations

from dataclasses import dataclass

from benchlab.twin.effects.effect import Effect, number


@dataclass(frozen=True)
class CameraScale(Effect):
    """Asked for by name where a film is drawn (workflows/twin_film)."""

    name = "camera_scale"
    factor: float = number(1.02, "", 0.5, 2, "factor f of the scale that is told")
