"""benchlab: bench software for soft-robotics labs.

The house has floors, and imports only go down (checked by import-linter in the tests):

    cli         parses, calls one workflow, prints
    workflows   open, compute, save: one file per verb
    report      draws and tabulates
    io          disk: video, tables, result files
    vision      numeric kernels: picture -> markers -> tracks -> circle -> curvature
    actuator    the fabric-shelled design
    units       what a pressure or a length may be written in
    errors      what can go wrong, and with which exit code

See:  video -> frames -> markers -> linked tracks -> circle -> curvature series -> result file -> picture.
"""

from importlib.metadata import version

__version__ = version("benchlab")
