"""`rr-opt simulate [FILE]`: a gait driven for some time, from rest or from the steady state."""

from __future__ import annotations

import rr_opt as rr
from rr_opt.cli import options
from rr_opt.cli.options import show
from rr_opt.cli.steps import Steps


def simulate(
    source: options.Driven = None,
    *,
    amplitude: options.Amplitude = None,
    period: options.Period = None,
    offset: options.Offset = None,
    seconds: options.Seconds = 10.0,
    start: options.From = "rest",
    rate: options.Samples = 100.0,
    out: options.MotionFolder = None,
    kind: options.Trajectory = "csv",
    animate: options.Film = None,
    json: options.Summary = False,
) -> None:
    """Simulate a gait for some time.

    Writes the trajectory, a figure and, on request, an animation.
    """
    with Steps() as steps:
        gait = {"amplitude": amplitude, "period": period, "offset": offset}
        driven = options.read_gait(source, **gait, seconds=seconds, rate=rate)
        folder = options.motion_folder(out, source, kind, animate)
        motion = rr.simulate(driven, None, seconds, start=start, rate=rate, progress=steps)
        files = motion.save(folder, format=kind, film=animate, progress=steps)
    show(motion, files, json=json)
