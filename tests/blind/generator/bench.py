"""From a command to what is written down: pressure as recorded, angle or force as read.

command -> (the sensor by which the regulator works) -> pressure at its outlet -> (leak, tube, lag) -> pressure inside
-> (friction, slack, creep, softening) -> the cell's curve -> (gravity, caps, creep) -> the sample's gain -> (camera)
-> offset and noise, stamped by the camera's clock.
"""

from __future__ import annotations

import functools
from collections.abc import Sequence

import numpy as np
from scipy.interpolate import PchipInterpolator

from tests.blind.generator.hidden.frame_compliance import LEVER_MM
from tests.blind.generator.hidden.hidden import Hidden
from tests.blind.generator.scatter import People
from tests.blind.generator.solved import DESIGNS, base, curve_deg
from tests.blind.generator.station import FloatArray, Station


def pressures(command_MPa: FloatArray, hidden: Sequence[Hidden], at: Station) -> tuple[FloatArray, FloatArray]:
    """As recorded and as effective, (T, S) each, for a command (T,). The regulator makes its sensor read what is commanded."""
    p = np.repeat(command_MPa[:, None], len(at.samples), axis=1)
    for one in hidden:
        p = one.supplied(p, at)
    recorded = p
    for one in hidden:
        recorded = one.recorded(recorded, at)
    for one in hidden:
        p = one.inside(p, at)
    for one in hidden:
        p = one.effective(p, at)
    return recorded, p


def angles(effective: FloatArray, people: People, hidden: Sequence[Hidden], at: Station) -> FloatArray:
    """(T, S) as the camera would see them, in degrees, without noise and on the pressure's clock."""
    acting = effective + people.deviation_MPa(effective)
    angle = np.empty(at.shape)
    changed = tuple(one for one in hidden if one.family(*DESIGNS[0]) is not None)
    for (tw, slw, length), columns in at.designs().items():
        angle[:, columns] = _curve(tw, slw, length, changed)(np.clip(acting[:, columns], -0.09, 0.6))
    for one in hidden:
        angle = one.bent(angle, acting, at)
    angle = people.gain * angle
    for one in hidden:
        angle = one.seen(angle, at)
    return _stamped(angle, at.time_s, sum(one.ahead_s for one in hidden))


def forces(effective: FloatArray, people: People, hidden: Sequence[Hidden], at: Station) -> FloatArray:
    """(T, S) blocked forces in N: the straight-held moment at a lever arm."""
    acting = np.clip(effective + people.deviation_MPa(effective), 0, 0.45)
    force = np.empty(at.shape)
    for (tw, slw, _), columns in at.designs().items():
        cell = base(tw, slw)
        moment = PchipInterpolator(np.r_[0.0, cell.pressure_MPa], np.r_[0.0, cell.moment_Nmm[0]])
        force[:, columns] = moment(acting[:, columns]) / LEVER_MM
    for one in hidden:
        force = one.pressed(force, acting, at)
    return np.asarray(people.force_gain * force)


@functools.cache
def plain_curve(tw_mm: float, slw_mm: float, length_mm: float) -> PchipInterpolator:
    """Angle over pressure of the cell as it is."""
    cell = base(tw_mm, slw_mm)
    return curve_deg(cell.pressure_MPa, cell.angle_rad_per_mm[0], length_mm)


@functools.lru_cache(maxsize=64)
def _curve(tw: float, slw: float, length: float, hidden: tuple[Hidden, ...]) -> PchipInterpolator:
    """With all that changes the cell; several changes add up."""
    cell = base(tw, slw)
    angle = cell.angle_rad_per_mm[0].copy()
    for one in hidden:
        if (found := one.family(tw, slw)) is not None:
            cells, value = found
            plain = np.interp(cells.pressure_MPa, cell.pressure_MPa, cell.angle_rad_per_mm[0])
            angle += np.interp(cell.pressure_MPa, cells.pressure_MPa, cells.at(value) - plain)
    return curve_deg(cell.pressure_MPa, angle, length)


def _stamped(angle: FloatArray, time_s: FloatArray, ahead_s: float) -> FloatArray:
    if ahead_s == 0:
        return angle
    return np.stack([np.interp(time_s - ahead_s, time_s, column) for column in angle.T], axis=1)
