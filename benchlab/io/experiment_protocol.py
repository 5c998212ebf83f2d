"""An experiment as a protocol file for `benchlab run`: data, with what it separates and how to use it in comments."""

from __future__ import annotations

import json
import textwrap
from collections.abc import Iterator

from benchlab.discrepancy.experiment import Experiment, Hold, Leg, Ramp, Triangle

REST_S = 2
"""Vented at the beginning and the end of a run, chosen: the angle at 0 MPa is seen."""

DECIMALS, WIDTH = 6, 118


def protocol_of(experiment: Experiment, limit_MPa: float, separates: str = "", expected_sd: float | None = None) -> str:
    """The text of the protocol, that `read_protocol` takes. expected_sd: None where it was not chosen for a pair of rivals.

    >>> from benchlab.discrepancy.experiment import Triangle
    >>> text = protocol_of(Experiment("cycle", "one cycle", (Triangle(0, 0.3, 0.1),)), 0.35, "friction from softening", 7.2)
    >>> print(text.splitlines()[0])
    # Proposed by `benchlab explain`. Separates friction from softening, by an expected 7.2 standard deviations.
    >>> text.splitlines()[-4:-2]
    ['  - mark: cycle at 0.1 MPa/s', '  - triangle: {low_MPa: 0, high_MPa: 0.3, rate_MPa_per_s: 0.1, cycles: 1}']
    """
    heading = [_what(separates, expected_sd), _use(experiment)]
    comments = [line for words in heading for line in textwrap.wrap(words, WIDTH)]
    segments = [
        "mark: at rest",
        f"vent: {{duration_s: {REST_S}}}",
        *(line for leg in experiment.legs for line in _segments(leg)),
        "mark: end",
        f"vent: {{duration_s: {REST_S}}}",
    ]
    lines = [
        *(f"# {line}" for line in comments),
        f"title: {json.dumps(experiment.what[:1].upper() + experiment.what[1:], ensure_ascii=False)}",
        "about: >",
        *(f"  {line}" for line in textwrap.wrap(_about(experiment), WIDTH)),
        f"limit_MPa: {limit_MPa:g}",
        "",
        "segments:",
        "  - trigger: camera",
        *(f"  - {line}" for line in segments),
    ]
    return "\n".join(lines) + "\n"


def _what(separates: str, expected_sd: float | None) -> str:
    if expected_sd is None:
        return f"Proposed by `benchlab explain`. Shows {separates or 'more than the data so far'}."
    return (
        f"Proposed by `benchlab explain`. Separates {separates}, by an expected {expected_sd:.3g} standard deviations."
    )


def _use(experiment: Experiment) -> str:
    setup = f" Beside it: {experiment.setup}." if experiment.setup else ""
    return (
        f"Run it on each sample: `benchlab run THIS.yaml --bench … --name DESIGN_SAMPLE`, filmed from the trigger on.{setup} Then give "
        "`benchlab explain` the new runs together with the old ones."
    )


def _about(experiment: Experiment) -> str:
    ways = f"{experiment.setup[:1].upper()}{experiment.setup[1:]}. " if experiment.setup else ""
    return f"The next experiment: {experiment.what}. {ways}One run takes {experiment.run_s + 2 * REST_S:.4g} s."


def _segments(leg: Leg) -> Iterator[str]:
    match leg:
        case Ramp():
            yield f"ramp: {{to_MPa: {_number(leg.to_MPa)}, rate_MPa_per_s: {_number(leg.rate_MPa_s)}}}"
        case Hold():
            yield f"hold: {{duration_s: {_number(leg.duration_s)}}}"
        case Triangle():
            low, high, rate = _number(leg.low_MPa), _number(leg.high_MPa), _number(leg.rate_MPa_s)
            yield f"mark: cycle{'s' * (leg.cycles > 1)} at {rate} MPa/s"
            yield f"triangle: {{low_MPa: {low}, high_MPa: {high}, rate_MPa_per_s: {rate}, cycles: {leg.cycles}}}"


def _number(value: float) -> str:
    return f"{round(value, DECIMALS):.10g}"
