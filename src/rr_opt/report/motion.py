"""A simulated motion: in some lines of text, and as a folder with trajectory, figure, film."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable
from pathlib import Path
from typing import Any, Literal

from rr_opt.answers.motion import MotionAnswer
from rr_opt.answers.quantities import number, speed_text
from rr_opt.files.gait_record import gait_record
from rr_opt.motion.rollout import Measured
from rr_opt.report.archive import remove, write_text
from rr_opt.report.document import Fact
from rr_opt.report.gait import gait_facts
from rr_opt.report.text import facts_text
from rr_opt.report.trajectory_file import write_csv, write_netcdf


def motion_summary(motion: MotionAnswer, files: Iterable[Path]) -> str:
    """The gait, how far it went and how fast at the end, and the files."""
    record = motion_record(motion, files)
    begun = "rest" if motion.start == "rest" else "the steady state"
    degrees = number(math.degrees(record["turned"]))
    return facts_text(
        *gait_facts(motion.gait),
        Fact("time", f"{number(record['seconds'])} s from {begun}"),
        Fact("moved", f"{number(record['distance'])} m, turned by {degrees} deg"),
        *_speed_facts(motion.measured),
        Fact("torque", f"{number(record['peak_torque'])} N m at most"),
        *(Fact("files" if not i else "", file) for i, file in enumerate(record["files"])),
    )


def motion_record(motion: MotionAnswer, files: Iterable[Path]) -> dict[str, Any]:
    """The same for scripts, SI; of the last period, `last_speed` is the mean of v, and
    `last_circle_speed` the speed along its mean circle, null of a shorter motion."""
    driven, measured = motion.trajectory, motion.measured
    return {
        "gait": gait_record(motion.gait),
        "status": motion.source_status,
        "start": motion.start,
        "seconds": float(driven.t[-1]),
        "distance": math.hypot(driven.x[-1] - driven.x[0], driven.y[-1] - driven.y[0]),
        "turned": float(driven.psi[-1] - driven.psi[0]),
        "last_speed": measured.mean_v,
        "last_circle_speed": measured.speed,
        "peak_torque": measured.peak_torque,
        "files": [str(file) for file in files],
    }


def _speed_facts(measured: Measured) -> list[Fact]:
    mean = f"{speed_text(measured.mean_v)}, mean v of axle 1"
    if measured.speed is None:
        return [Fact("speed", f"{mean}, less than a period")]
    circle = f"{speed_text(measured.speed)}, along the mean circle of the last period"
    return [Fact("speed", circle), Fact("", f"{mean} over the last period")]


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
    motion: MotionAnswer,
    folder: Path,
    *,
    kind: Format,
    film: Film | None,
    progress: Callable[[str], None],
) -> list[Path]:
    """Write everything; returns the files. Those of an earlier run are removed before."""
    from rr_opt.report.figures.cycle import motion as draw
    from rr_opt.report.figures.style import styled, svg

    robot, trajectory = motion.robot, motion.trajectory

    remove(folder, _NAMES)
    if kind == "csv":
        written = [write_csv(folder / "trajectory.csv", trajectory)]
    else:
        written = [write_netcdf(folder / "trajectory.nc", trajectory)]
    progress("figure")
    with styled():
        written.append(
            write_text(folder / "motion.svg", svg(draw(robot, trajectory, motion.gait.period)))
        )
    if film:
        from rr_opt.report.film import write_film

        written.append(write_film(folder / f"motion.{film}", robot, trajectory, film, progress))
    return written
