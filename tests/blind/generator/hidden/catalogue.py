"""What can be hidden, by name: effects of the vocabulary, and others that no vocabulary has."""

from __future__ import annotations

from tests.blind.generator.hidden.bladder_stiffness import BladderStiffness
from tests.blind.generator.hidden.camera_scale import CameraScale
from tests.blind.generator.hidden.camera_tilt import CameraTilt
from tests.blind.generator.hidden.clock_offset import ClockOffset
from tests.blind.generator.hidden.dead_pressure import DeadPressure
from tests.blind.generator.hidden.end_caps import EndCaps
from tests.blind.generator.hidden.fabric_compliance import FabricCompliance
from tests.blind.generator.hidden.frame_compliance import FrameCompliance
from tests.blind.generator.hidden.friction import Friction
from tests.blind.generator.hidden.gravity import Gravity
from tests.blind.generator.hidden.hidden import Hidden
from tests.blind.generator.hidden.layer_slip import LayerSlip
from tests.blind.generator.hidden.leakage import Leakage
from tests.blind.generator.hidden.lens_distortion import LensDistortion
from tests.blind.generator.hidden.line_resistance import LineResistance
from tests.blind.generator.hidden.marker_offset import MarkerOffset
from tests.blind.generator.hidden.odd_batch import OddBatch
from tests.blind.generator.hidden.pressure_gain import PressureGain
from tests.blind.generator.hidden.pressure_offset import PressureOffset
from tests.blind.generator.hidden.ratchet import Ratchet
from tests.blind.generator.hidden.regulator_lag import RegulatorLag
from tests.blind.generator.hidden.resonance import Resonance
from tests.blind.generator.hidden.seam_margin import SeamMargin
from tests.blind.generator.hidden.snap_through import SnapThrough
from tests.blind.generator.hidden.softening import Softening
from tests.blind.generator.hidden.stop_contact import StopContact
from tests.blind.generator.hidden.temperature import Temperature
from tests.blind.generator.hidden.viscoelasticity import Viscoelasticity
from tests.blind.generator.hidden.warm_up_drift import WarmUpDrift

_ALL: tuple[type[Hidden], ...] = (
    *(Viscoelasticity, Softening, Friction, SeamMargin, BladderStiffness, FabricCompliance, EndCaps, DeadPressure),
    *(Gravity, Leakage, RegulatorLag, LineResistance, PressureGain, PressureOffset, CameraScale, CameraTilt),
    *(MarkerOffset, ClockOffset, FrameCompliance, Temperature),
    *(WarmUpDrift, LensDistortion, SnapThrough, Ratchet, LayerSlip, StopContact, OddBatch, Resonance),
)
HIDDEN: dict[str, type[Hidden]] = {one.name: one for one in _ALL}
KNOWN: tuple[str, ...] = tuple(name for name, one in HIDDEN.items() if one.known)
"""Of the vocabulary (without flex_hysteresis, as no flex sensor is drawn, and window_ballooning, which asks for another base)."""
UNKNOWN: tuple[str, ...] = tuple(name for name, one in HIDDEN.items() if not one.known)
STRUCTURAL = ("seam_margin", "bladder_stiffness", "fabric_compliance")
