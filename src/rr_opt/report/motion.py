"""A simulated motion: in some lines of text, and as a folder with trajectory, figure, film."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Literal

from rr_opt.answers.quantities import QUANTITIES, number, speed_text
from rr_opt.files.gait_record import gait_record
from rr_opt.model.gait import Gait
from rr_opt.model.robot import Robot
from rr_opt.motion.rollout import Measured, Trajectory
from rr_opt.report.archive import remove, write_text
from rr_opt.report.text import columns, gait_formula, gait_lines
from rr_opt.report.trajectory_file import write_csv, write_netcdf

EXCEEDED = 1e-4
"""By so much, relative, an optimum on a limit may be past it without a warning."""


@dataclass(frozen=True)
class Motion:
    """A gait that was driven, and what came of it.

    start   `rest` or `steady`
    status  of the result that the gait was taken from; None if it was not taken from one
    """

    gait: Gait
    start: str
    driven: Trajectory
    measured: Measured
    status: str | None


def motion_summary(motion: Motion, files: Iterable[Path]) -> str:
    """The gait, how far it went and how fast at the end, and the files."""
    record = motion_record(motion, files)
    begun = "rest" if motion.start == "rest" else "the steady state"
    degrees = math.degrees(record["turned"])
    rows = [
        ("gait", gait_formula(motion.gait)),
        *gait_lines(motion.gait),
        ("time", f"{number(record['seconds'])} s from {begun}"),
        ("moved", f"{number(record['distance'])} m, turned by {number(degrees)} deg"),
        *_speed_lines(motion.measured),
        ("torque", f"{number(record['peak_torque'])} N m at most"),
        *(("files" if not i else "", file) for i, file in enumerate(record["files"])),
    ]
    return "\n".join(columns(rows)) + "\n"


def motion_record(motion: Motion, files: Iterable[Path]) -> dict[str, Any]:
    """The same for scripts, SI; of the last period, `last_speed` is the mean of v, and
    `last_circle_speed` the speed along its mean circle, null of a shorter motion."""
    driven, measured = motion.driven, motion.measured
    return {
        "gait": gait_record(motion.gait),
        "status": motion.status,
        "start": motion.start,
        "seconds": float(driven.t[-1]),
        "distance": math.hypot(driven.x[-1] - driven.x[0], driven.y[-1] - driven.y[0]),
        "turned": float(driven.psi[-1] - driven.psi[0]),
        "last_speed": measured.mean_v,
        "last_circle_speed": measured.speed,
        "peak_torque": measured.peak_torque,
        "files": [str(file) for file in files],
    }


def _speed_lines(measured: Measured) -> list[tuple[str, ...]]:
    mean = f"{speed_text(measured.mean_v)}, mean v of axle 1"
    if measured.speed is None:
        return [("speed", f"{mean}, less than a period")]
    return [
        ("speed", f"{speed_text(measured.speed)}, along the mean circle of the last period"),
        ("", f"{mean} over the last period"),
    ]


def beyond_servo(robot: Robot, gait: Gait, measured: Measured) -> list[str]:
    """A warning for each limit of the servo that the motion passes; the model drives it anyway."""
    reached = {
        "angle": (gait.peak_angle, robot.servo.angle_limit),
        "rate": (gait.peak_rate, robot.servo.rate_limit),
        "torque": (measured.peak_torque, robot.servo.torque_limit),
    }
    return [
        f"warning: the gait needs {QUANTITIES[name].both(value)}, and the servo's {name} limit is "
        f"{QUANTITIES[name].both(limit)}. It is simulated as if the servo could."
        for name, (value, limit) in reached.items()
        if value > limit * (1 + EXCEEDED)
    ]


Format = Literal["csv", "netcdf"]
Film = Literal["gif", "mp4"]

_NAMES = ("trajectory.csv", "trajectory.nc", "motion.svg", "motion.gif", "motion.mp4")


def check_wishes(kind: Format, film: Film | None) -> None:
    """Raise InputError, before anything is computed, for a file that cannot be made here."""
    if kind == "netcdf":
        from rr_opt.report.trajectory_file import netcdf_writer

        netcdf_writer()
    if film:
        from rr_opt.report.film import check_film

        check_film(film)


def write_motion(
    robot: Robot,
    gait: Gait,
    trajectory: Trajectory,
    folder: Path,
    *,
    kind: Format,
    film: Film | None,
    progress: Callable[[str], None],
) -> list[Path]:
    """Write everything; returns the files. Those of an earlier run are removed before."""
    from rr_opt.report.figures.cycle import motion
    from rr_opt.report.figures.style import styled, svg

    remove(folder, _NAMES)
    if kind == "csv":
        written = [write_csv(folder / "trajectory.csv", trajectory)]
    else:
        written = [write_netcdf(folder / "trajectory.nc", trajectory)]
    progress("figure")
    with styled():
        written.append(
            write_text(folder / "motion.svg", svg(motion(robot, trajectory, gait.period)))
        )
    if film:
        from rr_opt.report.film import write_film

        written.append(write_film(folder / f"motion.{film}", robot, trajectory, film, progress))
    return written
