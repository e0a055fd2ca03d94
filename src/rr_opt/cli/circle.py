"""`rr-opt circle [FILE]`: the circle that a gait drives, and how a start from rest comes to it."""

from __future__ import annotations

from rr_opt.cli.options import Amplitude, Driven, Offset, Period, Summary, read_gait, read_options
from rr_opt.cli.show import show
from rr_opt.cli.steps import Steps


def circle(
    source: Driven = None,
    *,
    amplitude: Amplitude = None,
    period: Period = None,
    offset: Offset = None,
    json: Summary = False,
) -> None:
    """Compute the circle of a gait: radius, centre, speed, time for a full turn.

    Also shows how a start from rest approaches it. Left is positive, seen from above.
    """
    with Steps() as steps:
        options = read_options(amplitude=amplitude, period=period, offset=offset)
        driven = read_gait(source, options)
        from rr_opt.api import drive

        answer = drive.circle(driven, progress=steps)
    show(answer, json=json)
