"""benchlab: bench software for soft-robotics labs.

The house has floors, and imports only go down (checked by import-linter in the tests):

    cli         parses, calls one workflow, prints
    workflows   open, compute, save: one file per verb
    report      draws and tabulates
    io          disk: video, tables, result files, drawings; other engines
    deck        the actuator as an input deck of another finite-element engine
    vision      picture -> markers -> tracks -> circle -> curvature
    simulation  design + layup -> shell cell -> angle, volume, moment against pressure
    cutting     design -> outlines for the laser
    actuator    the fabric-shelled design
    units       what a pressure or a length may be written in
    errors      what can go wrong, and with which exit code

(vision, simulation and cutting are one floor of numeric kernels and do not see each other.)

See:      video -> frames -> markers -> linked tracks -> circle -> curvature series -> result file -> picture.
Predict:  design + layup -> pieces -> laminates on a mesh -> cell -> path of states -> response curves -> files, pictures.
"""

from importlib.metadata import version

__version__ = version("benchlab")
