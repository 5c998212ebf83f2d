"""benchlab: bench software for soft-robotics labs.

The house has floors, and imports only go down (checked by import-linter in the tests):

    cli         parses, calls one workflow, prints
    workflows   open, compute, save: one file per verb
    runner      executes a plan on a bench | report: draws and tabulates
    devices     benches: serial, emulated firmware, twin, replay | io: disk: video, tables, result files, protocols, journals
    deck        the actuator as an input deck of another finite-element engine
    vision      picture -> markers -> tracks -> circle -> curvature
    simulation  design + layup -> shell cell -> angle, volume, moment against pressure
    cutting     design -> outlines for the laser
    force       force trace -> peak of each cycle -> blocked force against pressure
    stats       values of samples -> do designs differ, how well do they repeat
    protocol    segments -> plan: pressure or reference angle, tick by tick
    control     flex sensor, plant -> gains; PI and feed-forward; tracking
    twin        response curve + effects -> a simulated bench
    discrepancy where simulation and measurement disagree, and which effect is missing
    actuator    the fabric-shelled design
    bench       volts <-> pressure, sensors, limits, as calibrated
    cubic       a monotone curve through points, one cheap value at a time
    units       what a pressure or a length may be written in
    errors      what can go wrong, and with which exit code

(runner and report are one floor, devices and io another, and vision to discrepancy a floor of numeric kernels; rooms on one floor
do not see each other.)

See:      video -> frames -> markers -> linked tracks -> circle -> curvature series -> result file -> picture.
Measure:  export of a testing machine -> columns in N, mm, s -> cycles -> blocked force against pressure -> files, figure.
Compare:  study file -> angle of each cycle of each sample -> ANOVA, pairs, components -> report.
Drive:    protocol file -> plan -> checks -> runner -> device + journal -> drive file -> picture.
Predict:  design + layup -> pieces -> laminates on a mesh -> cell -> path of states -> response curves -> files, pictures.
Explain:  runs of samples + simulated curves -> features -> scatter of samples -> effects fitted -> verdict -> model, report, protocol.
"""

from importlib.metadata import version

__version__ = version("benchlab")
