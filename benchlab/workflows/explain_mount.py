"""A lab with a bench of metal: somebody mounts each sample when asked to."""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import replace

import numpy as np

from benchlab.discrepancy.measured import Run
from benchlab.errors import InputError
from benchlab.workflows.explain_lab import Wanted, driven_whole, run_of
from benchlab.workflows.run_prepare import RunSettings, prepare


class MountedLab:
    """Each run as `benchlab run` makes it, with its checks and guards. ask: shows a line and returns when it is done, or raises
    KeyboardInterrupt. The angle is that of the bench's flex sensor. Clock of start_s: since this lab was opened."""

    origin = "bench"
    remembers = True

    def __init__(self, settings: RunSettings, ask: Callable[[str], object]) -> None:
        self.settings, self.ask = settings, ask
        self._began = time.monotonic()
        self._mounted: tuple[str, str, str] | None = None

    @property
    def about(self) -> str:
        return f"measured on {self.settings.bench}, angles by its flex sensor"

    def measure(self, wanted: Wanted) -> Run:
        """Raises also InputError for a bench that measures no angle, before anything moves."""
        settings = replace(self.settings, out=wanted.folder, name=wanted.stem)
        prepared = prepare(str(wanted.protocol), settings)
        if prepared.bench.flex is None:
            hint = "calibrate it with `benchlab control flex`, or film the runs and explain the films"
            raise InputError("the flex sensor of this bench is not calibrated: no angle is measured", hint=hint)
        self._mount(wanted)
        start_s = time.monotonic() - self._began
        _, journal = driven_whole(prepared)
        samples = journal.driven
        seen = np.isfinite(samples["angle_deg"])
        if not seen.any():
            raise InputError("the flex sensor gave no angle in this run", file=prepared.path(".h5"))
        return run_of(wanted, journal, samples["time_s"][seen], samples["angle_deg"][seen], start_s, ordered=True)

    def _mount(self, wanted: Wanted) -> None:
        """Ask for what has to change since the run before, and for the rest."""
        how = "as before" if np.isnan(wanted.mounting_deg) else f"at {wanted.mounting_deg:g}°"
        mounted = (wanted.called, wanted.sample, how)
        if mounted != self._mounted:
            self.ask(f"mount sample {wanted.sample} of {wanted.called}, {how}, then press Enter")
        elif wanted.rest_s:
            self.ask(f"leave {wanted.called} {wanted.sample} vented for {wanted.rest_s:g} s, then press Enter")
        self._mounted = mounted
