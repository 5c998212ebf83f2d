"""The vocabulary: every effect by its name, those of users too."""

from __future__ import annotations

from collections.abc import Mapping
from functools import cache
from importlib.metadata import EntryPoint, entry_points
from types import MappingProxyType

from benchlab.discrepancy.effects.bladder_stiffness import BladderStiffness
from benchlab.discrepancy.effects.camera_scale import CameraScale
from benchlab.discrepancy.effects.camera_tilt import CameraTilt
from benchlab.discrepancy.effects.clock_offset import ClockOffset
from benchlab.discrepancy.effects.dead_pressure import DeadPressure
from benchlab.discrepancy.effects.effect import Effect
from benchlab.discrepancy.effects.end_caps import EndCaps
from benchlab.discrepancy.effects.fabric_compliance import FabricCompliance
from benchlab.discrepancy.effects.flex_hysteresis import FlexHysteresis
from benchlab.discrepancy.effects.foreign import Foreign
from benchlab.discrepancy.effects.frame_compliance import FrameCompliance
from benchlab.discrepancy.effects.friction import Friction
from benchlab.discrepancy.effects.gravity import Gravity
from benchlab.discrepancy.effects.leakage import Leakage
from benchlab.discrepancy.effects.line_resistance import LineResistance
from benchlab.discrepancy.effects.marker_offset import MarkerOffset
from benchlab.discrepancy.effects.pressure_gain import PressureGain
from benchlab.discrepancy.effects.pressure_offset import PressureOffset
from benchlab.discrepancy.effects.regulator_lag import RegulatorLag
from benchlab.discrepancy.effects.seam_margin import SeamMargin
from benchlab.discrepancy.effects.softening import Softening
from benchlab.discrepancy.effects.temperature import Temperature
from benchlab.discrepancy.effects.viscoelasticity import Viscoelasticity
from benchlab.discrepancy.effects.window_ballooning import WindowBallooning
from benchlab.errors import InputError

GROUP = "benchlab.effects"
"""Entry points of this group name effects of users: each a class, or an instance, of Effect."""

_OURS: tuple[Effect, ...] = (
    Viscoelasticity(),
    Softening(),
    Friction(),
    SeamMargin(),
    BladderStiffness(),
    FabricCompliance(),
    EndCaps(),
    DeadPressure(),
    Gravity(),
    Leakage(),
    RegulatorLag(),
    LineResistance(),
    PressureGain(),
    PressureOffset(),
    CameraScale(),
    CameraTilt(),
    MarkerOffset(),
    ClockOffset(),
    FrameCompliance(),
    FlexHysteresis(),
    Temperature(),
    WindowBallooning(),
)


def built_in() -> Mapping[str, Effect]:
    """The effects that come with benchlab, by name.

    >>> len(built_in()), list(built_in())[:3]
    (22, ['viscoelasticity', 'softening', 'friction'])
    """
    return MappingProxyType({effect.name: effect for effect in _OURS})


@cache
def effects() -> Mapping[str, Effect]:
    """All effects by name: those of benchlab in the order of the vocabulary, then those of installed packages by name.

    InputError, which names the distribution, for one that cannot be loaded, is no Effect, lacks a part, or has a name that is taken.
    """
    found = dict(built_in())
    for point in sorted(entry_points(group=GROUP), key=lambda point: point.name):
        effect = _loaded(point)
        if effect.name in found:
            raise _refused(point, f"its name {effect.name!r} is taken", "give it another name")
        found[effect.name] = effect
    return MappingProxyType(found)


def _loaded(point: EntryPoint) -> Effect:
    try:
        effect = point.load()
        effect = effect() if isinstance(effect, type) else effect
        problem = faults(effect) if isinstance(effect, Effect) else ""
    except Exception as error:  # whatever a plugin may do
        raise _refused(
            point, f"it cannot be loaded ({type(error).__name__}: {error})", "repair or uninstall it"
        ) from error
    if not isinstance(effect, Effect):
        raise _refused(
            point, f"{point.value} is no Effect", "derive it from benchlab.discrepancy.effects.effect.Effect"
        )
    if problem:
        raise _refused(point, problem, "see docs/effects.md")
    return Foreign(effect, _package(point))


def _refused(point: EntryPoint, what: str, hint: str) -> InputError:
    return InputError(f"effect {point.name!r} of {_package(point)} is refused: {what}", hint=hint)


def _package(point: EntryPoint) -> str:
    return "an unknown package" if point.dist is None else f"{point.dist.name} {point.dist.version}"


def faults(effect: Effect) -> str:
    """What an effect lacks, in words; empty where it is complete.

    >>> faults(Friction())
    ''
    """
    for part in ("name", "acts_on", "physics", "looks_like", "shown_by", "parameters"):
        if not getattr(effect, part, None):
            return f"it has no {part}"
    for parameter in effect.parameters:
        p = parameter
        if not p.low < p.high:
            return f"bounds of {p.name} are {p.low:g} and {p.high:g}"
        for value in (p.typical, *p.starts, *([] if p.neutral is None else [p.neutral])):
            if not p.low <= value <= p.high:
                return f"{p.name} has {value:g} outside of its bounds {p.low:g} to {p.high:g}"
        if not p.starts:
            return f"{p.name} has no starts"
    if all(p.neutral is None for p in effect.parameters):
        return "no parameter has a neutral value, at which the effect is absent"
    return ""
