"""`rr-opt export [FILE]`: a gait as set points for a controller, and what they cost in speed."""

from __future__ import annotations

import rr_opt as rr
from rr_opt.cli import options
from rr_opt.cli.options import show
from rr_opt.cli.steps import Steps


def export(
    source: options.Driven = None,
    *,
    kind: options.SetPoints = "csv",
    rate: options.PointRate = 125.0,
    keep_period: options.KeepPeriod = False,
    amplitude: options.Amplitude = None,
    period: options.Period = None,
    offset: options.Offset = None,
    out: options.PointFile = None,
    json: options.Summary = False,
) -> None:
    """Write a gait as set points for a controller.

    A period holds a whole number of set points. The loss of speed is reported separately for
    the adjusted period, the straight lines between set points, and rounding to counts.
    """
    with Steps() as steps:
        gait = {"amplitude": amplitude, "period": period, "offset": offset}
        driven = options.read_gait(source, **gait, rate=rate)
        file = options.setpoints_file(out, source, kind)
        points = rr.export(driven, format=kind, rate=rate, keep_period=keep_period, progress=steps)
        files = points.save(file)
    show(points, files, json=json)
