"""What driving a given gait gives: a simulated motion, and the circle that it goes round."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any, ClassVar, Literal

from rr_opt.files.record import plain
from rr_opt.formatting import QUANTITIES, number, side_text, speed_text, with_unit
from rr_opt.model.gait import Gait
from rr_opt.model.problem import LARGEST_EXCESS
from rr_opt.model.robot import Robot
from rr_opt.motion.circle import Circle, Transient
from rr_opt.motion.rollout import Measured, Trajectory
from rr_opt.report.archive import folder_for_results, remove, write_text
from rr_opt.report.document import Captions, Document, Fact, Facts, Figure, Section
from rr_opt.report.gait import gait_facts, ignored_effects, speed_fact
from rr_opt.report.result import Progress, Result, quiet
from rr_opt.report.trajectory_file import netcdf_writer, trajectory_csv, write_netcdf

Format = Literal["csv", "netcdf"]
Film = Literal["gif", "mp4"]


@dataclass(frozen=True, repr=False)
class GaitResult(Result):
    """What comes of driving a gait.

    source_status  of the result that the gait was taken from; None if it was not taken from one
    """

    robot: Robot
    gait: Gait
    source_status: str | None

    @property
    def warnings(self) -> tuple[str, ...]:
        """Which effects of the robot the motion ignores, and which servo limits it exceeds."""
        return (*ignored_effects(self.robot), *self.beyond_servo)

    @property
    def beyond_servo(self) -> tuple[str, ...]:
        """A sentence on each limit of the servo that the gait exceeds."""
        return ()

    def document(self, figures: Sequence[Figure] = ()) -> Document:
        """All of it as facts."""
        return Document("", "", "", "", (Section("", (Facts(tuple(self._facts())),)),))

    def _facts(self) -> Iterator[Fact]:
        return iter(())


@dataclass(frozen=True, repr=False)
class SimulatedMotion(GaitResult):
    """A simulated motion.

    start       `rest` or `steady`
    trajectory  arrays at equal time steps: `t`, `x`, `y`, `psi`, `phi`, `v`, `torque`, SI
    measured    speed and peak torque over the last period
    """

    CAPTIONS: ClassVar[Captions] = {
        "motion": (
            "The simulated motion",
            "Path of the joint, and angle, speed and torque over time",
            "P's path with the robot at a few instants; below, angle, speed of axle 1 and torque.",
        )
    }

    start: str
    trajectory: Trajectory
    measured: Measured

    @property
    def beyond_servo(self) -> tuple[str, ...]:
        """A sentence on each limit of the servo that the motion exceeds; it is simulated anyway."""
        servo = self.robot.servo
        reached = {
            "angle": (self.gait.peak_angle, servo.angle_limit),
            "rate": (self.gait.peak_rate, servo.rate_limit),
            "torque": (self.measured.peak_torque, servo.torque_limit),
        }
        return tuple(
            f"The gait needs {QUANTITIES[name].both(value)}, and the servo's {name} limit is "
            f"{QUANTITIES[name].both(limit)}. It is simulated as if the servo could."
            for name, (value, limit) in reached.items()
            if value > limit * (1 + LARGEST_EXCESS)
        )

    def record(self, files: Sequence[Path] = ()) -> dict[str, Any]:
        """Distance, turn, speed and torque, SI. Of the last period `last_speed` is the mean of v,
        and `last_circle_speed` the speed along its mean circle, null of a shorter motion."""
        driven, measured = self.trajectory, self.measured
        record = {
            "gait": self.gait,
            "status": self.source_status,
            "start": self.start,
            "seconds": driven.t[-1],
            "distance": math.hypot(driven.x[-1] - driven.x[0], driven.y[-1] - driven.y[0]),
            "turned": driven.psi[-1] - driven.psi[0],
            "last_speed": measured.mean_v,
            "last_circle_speed": measured.speed,
            "peak_torque": measured.peak_torque,
            "files": [str(file) for file in files],
        }
        return plain(record)

    def _facts(self) -> Iterator[Fact]:
        record, measured = self.record(), self.measured
        begun = "rest" if self.start == "rest" else "the steady state"
        degrees = number(math.degrees(record["turned"]))
        mean = f"{speed_text(measured.mean_v)}, mean v of axle 1"
        yield from gait_facts(self.gait)
        yield Fact("time", f"{number(record['seconds'])} s from {begun}")
        yield Fact("moved", f"{number(record['distance'])} m, turned by {degrees} deg")
        if measured.speed is None:
            yield Fact("speed", f"{mean}, less than a period")
        else:
            circle = f"{speed_text(measured.speed)}, along the mean circle of the last period"
            yield Fact("speed", circle)
            yield Fact("", f"{mean} over the last period")
        yield Fact("torque", f"{number(measured.peak_torque)} N m at most")

    def _drawn(self) -> dict[str, str]:
        from rr_opt.report.figures.cycle import motion
        from rr_opt.report.figures.style import styled, svg

        with styled():
            return {"motion": svg(motion(self.robot, self.trajectory, self.gait.period))}

    def save(
        self,
        path: str | Path,
        *,
        figures: bool = True,
        progress: Progress = quiet,
        format: Format = "csv",
        film: Film | None = None,
    ) -> list[Path]:
        """Write the trajectory, the figure and, if asked for, a film to a folder.

        Returns the files. Raises InputError for a file that cannot be made here.
        """
        check_files(format, film)
        folder = folder_for_results(Path(path))
        films = [f"motion.{kind}" for kind in ("gif", "mp4")]
        remove(folder, ("trajectory.csv", "trajectory.nc", "motion.svg", *films))
        if format == "csv":
            text = trajectory_csv(self.trajectory)
            written = [write_text(folder / "trajectory.csv", text)]
        else:
            written = [write_netcdf(folder / "trajectory.nc", self.trajectory)]
        progress("figure")
        written += self.plot().save(folder)
        if film:
            from rr_opt.report.film import write_film

            place = folder / f"motion.{film}"
            written.append(write_film(place, self.robot, self.trajectory, film, progress))
        return written


def check_files(format: Format, film: Film | None) -> None:
    """Raise InputError, before anything is computed, for a file that cannot be made here."""
    if format == "netcdf":
        netcdf_writer()
    if film:
        from rr_opt.report.film import check_film

        check_film(film)


@dataclass(frozen=True, repr=False)
class DrivenCircle(GaitResult):
    """The circle that a gait drives, and how a start from rest converges to it."""

    RECORD = "circle.json"

    circle: Circle
    transient: Transient

    def record(self, files: Sequence[Path] = ()) -> dict[str, Any]:
        """Radius, centre, speed and the transient, SI; null for what a straight gait lacks."""
        circle, start = self.circle, self.transient
        record = {
            "gait": self.gait,
            "speed": circle.speed,
            "curvature": circle.curvature,
            "radius": circle.radius,
            "centre": circle.centre,
            "heading_per_period": circle.heading,
            "yaw_rate": circle.yaw_rate,
            "time_for_full_turn": circle.time_round,
            "periods_for_full_turn": circle.periods_round,
            "from_rest": {
                "time_constant": start.constant,
                "factor_per_period": start.factor,
                "distance_lost": start.lost,
                "delay": start.delay,
            },
        }
        return plain(record)

    def _facts(self) -> Iterator[Fact]:
        circle, start = self.circle, self.transient
        yield from gait_facts(self.gait)
        yield speed_fact(circle.speed)
        if circle.centre is None:
            yield Fact("circle", f"straight: it turns by {circle.heading:.1e} rad a period")
        else:
            x, y = (with_unit(value, "m") for value in circle.centre)
            degrees, rate = (number(math.degrees(a)) for a in (circle.heading, circle.yaw_rate))
            radius, side = with_unit(circle.radius, "m"), side_text(circle.heading)
            periods = f"{number(circle.periods_round, 6)} periods"
            at = f"x = {x}, y = {y} in platform 1's axes at phase 0, P at the origin"
            yield Fact("circle", f"radius {radius}", f"to the {side}")
            yield Fact("curvature", f"{number(circle.curvature)} 1/m")
            yield Fact("centre", at)
            yield Fact("heading", f"{degrees} deg a period", f"{rate} deg/s")
            yield Fact("full turn", with_unit(circle.time_round, "s"), periods)
        yield Fact(
            "from rest",
            f"the deviation falls to 1/e in {with_unit(start.constant, 's')}, by "
            f"{number(100 * (1 - start.factor), 3)} % a period",
        )
        ahead = "behind" if start.lost >= 0 else "ahead of"
        yield Fact(
            "lost",
            f"{with_unit(abs(start.lost), 'm')} {ahead} a robot that is steady from the start, "
            f"{with_unit(abs(start.delay), 's')}",
        )
