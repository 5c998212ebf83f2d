"""The next experiment on disk: as a protocol file that `benchlab run` takes."""

from __future__ import annotations

import math
from dataclasses import replace
from pathlib import Path

from benchlab.discrepancy.experiment import Experiment
from benchlab.discrepancy.explanation import NextExperiment
from benchlab.io.experiment_protocol import protocol_of
from benchlab.io.files import written_whole
from benchlab.io.protocol_file import read_protocol

LIMIT_MPa = 0.35
"""Of the protocol file, the paper's, unless the experiment itself goes beyond it."""

LONGEST_S = 7200.0


def next_name(experiment: Experiment) -> str:
    """Of its protocol file."""
    return f"next_{experiment.name}.yaml"


def write_next(folder: Path, proposed: NextExperiment) -> NextExperiment:
    """Write `next_NAME.yaml`, replacing one that is there; `protocol` of what comes back is its path.

    Where there is no experiment, nothing is written and it comes back as it is. What is written has been read back as `benchlab run`
    reads it. Raises InputError where the disk refuses.
    """
    experiment = proposed.experiment
    if experiment is None:
        return proposed
    path = folder / next_name(experiment)
    top_MPa = float(experiment.trace()[1].max())
    expected = None if math.isnan(proposed.expected_sd) else proposed.expected_sd
    with written_whole(path) as temporary:
        text = protocol_of(experiment, max(LIMIT_MPa, top_MPa), proposed.separates, expected)
        temporary.write_text(text, encoding="utf-8")
        read_protocol(temporary, LONGEST_S)
    return replace(proposed, protocol=str(path))
