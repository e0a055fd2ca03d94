"""The folder of a simulated motion: trajectory, figure, film."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Literal

from rr_opt.motion.rollout import Trajectory
from rr_opt.report.archive import remove, write_text
from rr_opt.report.trajectory_file import write_csv, write_netcdf
from rr_opt.robot.gait import Gait
from rr_opt.robot.parameters import Robot

Format = Literal["csv", "netcdf"]
Film = Literal["gif", "mp4"]

_NAMES = ("trajectory.csv", "trajectory.nc", "motion.svg", "motion.gif", "motion.mp4")


def check_wishes(kind: Format, film: Film | None) -> None:
    """Raise InputError, before anything is computed, for a file that cannot be made here."""
    if kind == "netcdf":
        from rr_opt.report.trajectory_file import netcdf_writer  # noqa: PLC0415

        netcdf_writer()
    if film:
        from rr_opt.report.film import check_film  # noqa: PLC0415

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
    from rr_opt.report.figures.motion import motion  # noqa: PLC0415
    from rr_opt.report.figures.style import styled, svg  # noqa: PLC0415

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
        from rr_opt.report.film import write_film  # noqa: PLC0415

        written.append(write_film(folder / f"motion.{film}", robot, trajectory, film, progress))
    return written
