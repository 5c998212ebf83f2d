"""Pictures of bending actuators whose markers are known to a thousandth of a pixel.

scene -> geometry (arc, camera) -> truth; scene -> paint (coverage, things) -> encode -> planes.

>>> import numpy as np
>>> scene = Scene(width=320, height=180, length_px=200.0, base_px=(40.0, 40.0), marker_radius_px=5.0)
>>> angles = np.deg2rad([0.0, 90.0])
>>> [planes.luma.shape for planes in draw_frames(scene, angles, np.random.default_rng(1))]
[(180, 320), (180, 320)]
>>> marker_truth(scene, angles).positions_px[1, -1].round(2)
array([167.32, 167.32])
"""

from benchlab.vision.synthetic.paint import draw_frame, draw_frames
from benchlab.vision.synthetic.scene import MARKER_RGB, Scene
from benchlab.vision.synthetic.things import Thing
from benchlab.vision.synthetic.truth import MarkerTruth, marker_truth

__all__ = ["MARKER_RGB", "MarkerTruth", "Scene", "Thing", "draw_frame", "draw_frames", "marker_truth"]
