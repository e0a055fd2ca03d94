"""A gait, driven: its motion, its circle, and its set points for a controller."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any, Literal, Protocol

from rr_opt.answers.motion import CircleAnswer, MotionAnswer, SetPointsAnswer
from rr_opt.api.arguments import read_arguments
from rr_opt.api.load import PathLike, load_gait
from rr_opt.api.result import Plots, Progress, Result, quiet
from rr_opt.model.gait import Gait
from rr_opt.model.robot import Robot
from rr_opt.motion.circle import circle_of, transient
from rr_opt.motion.dynamics import require_friction
from rr_opt.motion.rollout import measured, rollout
from rr_opt.motion.setpoints import cost, set_points
from rr_opt.motion.steady_cycle import require_regular, steady_cycle
from rr_opt.outcome import InputError
from rr_opt.report.archive import file_for_result, folder_for_results, write_json, write_text


class HasGait(Protocol):
    """A result, or anything else that knows its robot and gait."""

    @property
    def robot(self) -> Robot:
        """The robot."""
        ...

    @property
    def gait(self) -> Gait | None:
        """Its gait; None if none was found."""
        ...


def _driven(robot: Robot | HasGait | PathLike, gait: Gait | None) -> tuple[Robot, Gait, str | None]:
    """Robot, gait, and the status of the result that the gait is from."""
    if isinstance(robot, str | Path):
        robot = load_gait(robot)
    if isinstance(robot, Robot):
        if gait is None:
            raise InputError("Read a robot without a gait. Expected both. Give for example "
                             "`SineGait('30 deg', '1.2 s')`, or a result.")  # fmt: skip
        return robot, gait, None
    if gait is not None:
        return robot.robot, gait, None
    if robot.gait is None:
        raise InputError("Read a result that holds no gait. Expected one of a problem that was "
                         "solved.")  # fmt: skip
    status = getattr(robot, "status", None)
    return robot.robot, robot.gait, None if status is None else str(status)


class SimulatedMotion(Result, MotionAnswer):
    """A simulated motion.

    trajectory  arrays over time: `t`, `x`, `y`, `psi`, `phi`, `v`, `torque` ..., SI
    measured    speed and peak torque over the last period
    """

    def record(self, files: Sequence[Path] = ()) -> dict[str, Any]:
        """Distance, turn, speed and torque."""
        from rr_opt.report.motion import motion_record

        return motion_record(self, files)

    def summary(self, files: Sequence[Path] = ()) -> str:
        """The gait, and how far and how fast it went, as text."""
        from rr_opt.report.motion import motion_summary

        return motion_summary(self, files)

    def plot(self) -> Plots:
        """The path, and speed and torque over time."""
        from rr_opt.report.figures.cycle import motion
        from rr_opt.report.figures.style import styled, svg

        with styled():
            return Plots({"motion": svg(motion(self.robot, self.trajectory, self.gait.period))})

    def save(
        self,
        path: str | Path,
        *,
        figures: bool = True,
        progress: Progress = quiet,
        format: Literal["csv", "netcdf"] = "csv",
        film: Literal["gif", "mp4"] | None = None,
    ) -> list[Path]:
        """Write the trajectory, the figure and, if asked for, a film to a folder.

        Returns the files. Raises InputError for a file that cannot be made here.
        """
        from rr_opt.report.motion import write_motion

        check_files(format, film)
        folder = folder_for_results(Path(path))
        return write_motion(self, folder, kind=format, film=film, progress=progress)


def check_files(format: Literal["csv", "netcdf"], film: Literal["gif", "mp4"] | None) -> None:
    """Raise InputError, before anything is computed, for a file that cannot be made here."""
    from rr_opt.report.motion import check_wishes

    check_wishes(format, film)


def simulate(
    robot: Robot | HasGait | PathLike,
    gait: Gait | None = None,
    seconds: float | str = 10.0,
    *,
    start: Literal["rest", "steady"] = "rest",
    rate: float | str = 100.0,
    progress: Progress = quiet,
) -> SimulatedMotion:
    """A gait driven for some time, from rest or from the speed that it settles to.

    robot  or a result or its file, whose own gait is then driven unless another is given
    rate   samples a second

    Numbers are SI, text has a unit. Raises InputError for a gait through a singular posture, and
    for the steady start of a robot without friction.
    """
    robot, gait, status = _driven(robot, gait)
    read = read_arguments({"seconds": seconds, "rate": rate})
    progress("simulate by CVODES")
    driven = rollout(robot, gait, read["seconds"], start, read["rate"])
    progress("measure")
    return SimulatedMotion(robot, gait, status, start, driven, measured(robot, gait, driven))


class DrivenCircle(Result, CircleAnswer):
    """The circle that a gait drives, and how a start from rest comes to it."""

    def record(self, files: Sequence[Path] = ()) -> dict[str, Any]:
        """Radius, centre, speed and the transient."""
        from rr_opt.report.turn import circle_record

        return circle_record(self)

    def summary(self, files: Sequence[Path] = ()) -> str:
        """The same as text."""
        from rr_opt.report.turn import circle_summary

        return circle_summary(self)

    def plot(self) -> Plots:
        """Nothing to draw."""
        return Plots({})

    def _write(self, folder: Path, figures: bool, progress: Progress) -> list[Path]:
        return [write_json(folder / "circle.json", self.record())]


def circle(
    robot: Robot | HasGait | PathLike, gait: Gait | None = None, *, progress: Progress = quiet
) -> DrivenCircle:
    """The circle of a gait: radius, centre, speed, time for a full turn; left is positive.

    Raises InputError for a robot without friction, and for a gait through a singular posture.
    """
    robot, gait, status = _driven(robot, gait)
    require_friction(robot)
    require_regular(robot, gait)
    progress("steady cycle")
    steady = steady_cycle(robot, gait)
    return DrivenCircle(robot, gait, status, circle_of(steady.cycle), transient(robot, steady))


class ExportedGait(Result, SetPointsAnswer):
    """A gait as set points: `points` has them as arrays, `cost` what they lose in speed."""

    @property
    def text(self) -> str:
        """The content of the file for the controller."""
        from rr_opt.report.setpoints import text_of

        return text_of(self.points, self.format)

    def record(self, files: Sequence[Path] = ()) -> dict[str, Any]:
        """Rate, period and cost; files: the one that was written."""
        from rr_opt.report.setpoints import setpoints_record

        return setpoints_record(self, files[0] if files else None)

    def summary(self, files: Sequence[Path] = ()) -> str:
        """The same as text."""
        from rr_opt.report.setpoints import setpoints_summary

        return setpoints_summary(self, files[0] if files else None)

    def plot(self) -> Plots:
        """Nothing to draw."""
        return Plots({})

    def save(
        self, path: str | Path, *, figures: bool = True, progress: Progress = quiet
    ) -> list[Path]:
        """Write the file for the controller."""
        return [write_text(file_for_result(Path(path)), self.text)]


def setpoints_file(
    path: Path | None, name: str, format: Literal["csv", "c-header", "servo"]
) -> Path:
    """The file of set points: `path`, or out/NAME-... Raises InputError if it cannot be written."""
    from rr_opt.report.setpoints import ENDINGS

    return file_for_result(path or Path("out") / f"{name}{ENDINGS[format]}")


def export(
    robot: Robot | HasGait | PathLike,
    gait: Gait | None = None,
    *,
    format: Literal["csv", "c-header", "servo"] = "csv",
    rate: float | str = 125.0,
    keep_period: bool = False,
    progress: Progress = quiet,
) -> ExportedGait:
    """A gait as set points for a controller, and what they cost in speed.

    format       csv: time and angle; c-header: an array for C; servo: counts of the CDS5516
    rate         set points a second
    keep_period  change the rate and not the period, so that a whole number of them fits in

    Raises InputError for an angle beyond the servo's counts.
    """
    from rr_opt.report.setpoints import text_of

    robot, gait, status = _driven(robot, gait)
    each_second = read_arguments({"rate": rate})["rate"]
    points = set_points(gait, each_second, keep_period=keep_period)
    # Before the work, as an angle may be beyond the counts.
    text_of(points, format)
    progress("what the set points cost")
    lost = cost(robot, points, rounded=format == "servo")
    return ExportedGait(robot, gait, status, points, lost, format)
