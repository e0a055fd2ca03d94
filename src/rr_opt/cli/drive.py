"""Verbs that drive a given gait: its motion, its circle, its set points for a controller."""

import rr_opt as rr
from rr_opt.cli import options
from rr_opt.cli.options import show
from rr_opt.cli.steps import StepDisplay


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
    with StepDisplay() as steps:
        with options.naming(source):
            gait = {"amplitude": amplitude, "period": period, "offset": offset}
            driven = options.read_gait(source, **gait, seconds=seconds, rate=rate)
        name = f"{options.result_name(source)}-motion"
        folder = options.motion_folder(out, name, animate, kind)
        with options.naming(source):
            motion = rr.simulate(driven, None, seconds, start=start, rate=rate, progress=steps)
    show(motion, steps, folder, json=json, format=kind, film=animate)


def circle(
    source: options.Driven = None,
    *,
    amplitude: options.Amplitude = None,
    period: options.Period = None,
    offset: options.Offset = None,
    json: options.Summary = False,
) -> None:
    """Compute the circle that a gait drives.

    Prints radius, centre, speed, the time for a full turn, and how a start from rest approaches
    the circle. Left is positive, seen from above.
    """
    with StepDisplay() as steps, options.naming(source):
        gait = {"amplitude": amplitude, "period": period, "offset": offset}
        answer = rr.circle(options.read_gait(source, **gait), progress=steps)
    show(answer, json=json)


def export(
    source: options.Driven = None,
    *,
    kind: options.SetPoints = "csv",
    rate: options.PointRate = None,
    keep_period: options.KeepPeriod = False,
    within_limits: options.WithinLimits = True,
    amplitude: options.Amplitude = None,
    period: options.Period = None,
    offset: options.Offset = None,
    out: options.PointFile = None,
    json: options.Summary = False,
) -> None:
    """Write a gait as set points for a controller.

    The period is adjusted to a whole number of set points. If the gait or a step between set points
    is beyond the limits, the amplitude is lowered. The loss of speed is reported separately for the
    adjusted period, the straight lines between set points, and rounding to counts.
    """
    with StepDisplay() as steps:
        with options.naming(source):
            gait = {"amplitude": amplitude, "period": period, "offset": offset}
            driven = options.read_gait(source, **gait, rate=rate)
        file = options.setpoints_file(out, source, kind)
        with options.naming(source):
            points = rr.export(
                driven,
                format=kind,
                rate=rate,
                keep_period=keep_period,
                within_limits=within_limits,
                progress=steps,
            )
    show(points, steps, file, json=json)
