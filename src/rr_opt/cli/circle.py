"""`rr-opt circle [FILE]`: the circle that a gait drives, and how a start from rest comes to it."""

from __future__ import annotations

import rr_opt as rr
from rr_opt.cli import options
from rr_opt.cli.options import show
from rr_opt.cli.steps import Steps


def circle(
    source: options.Driven = None,
    *,
    amplitude: options.Amplitude = None,
    period: options.Period = None,
    offset: options.Offset = None,
    json: options.Summary = False,
) -> None:
    """Compute the circle of a gait: radius, centre, speed, time for a full turn.

    Also shows how a start from rest approaches it. Left is positive, seen from above.
    """
    with Steps() as steps:
        gait = {"amplitude": amplitude, "period": period, "offset": offset}
        answer = rr.circle(options.read_gait(source, **gait), progress=steps)
    show(answer, json=json)
