"""The results of driving a gait: a simulated motion and its files, and the circle of the gait."""

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Any, Literal

from rr_opt.documents import document as doc
from rr_opt.documents.archive import (
    folder_for_results,
    netcdf_writer,
    remove,
    write_dataset,
    write_text,
)
from rr_opt.formatting import QUANTITIES, number, side_text, speed_text, with_unit
from rr_opt.model.gait import Gait
from rr_opt.model.problem import LARGEST_EXCESS
from rr_opt.model.robot import Robot, Servo
from rr_opt.motion.circle import Circle, Transient
from rr_opt.motion.rollout import Measured, Trajectory
from rr_opt.motion.servo import servo_made
from rr_opt.results.gait import gait_facts, ignored_effects, speed_fact
from rr_opt.results.result import Progress, Result, picked, quiet
from rr_opt.version import __version__

Format = Literal["csv", "netcdf"]

Film = Literal["gif", "mp4"]


@dataclass(frozen=True, repr=False)
class GaitResult(Result):
    """The result of driving a gait.

    source_status  of the result that the gait was taken from; None if it was not taken from one
    """

    robot: Robot
    gait: Gait
    source_status: str | None

    @cached_property
    def joint(self) -> Gait:
        """The joint motion that the servo makes of the gait."""
        return servo_made(self.robot, self.gait)

    @property
    def warnings(self) -> tuple[str, ...]:
        """Which effects of the robot the motion ignores, and which servo limits it exceeds."""
        return (*ignored_effects(self.robot, commanded=True), *self.beyond_servo)

    @property
    def beyond_servo(self) -> tuple[str, ...]:
        """A sentence on each servo limit that the gait exceeds."""
        return ()


def beyond_servo(
    servo: Servo, angle: float, rate: float, torque: float
) -> list[tuple[str, float, float]]:
    """Name, value and limit, SI, of the peaks of a motion that exceed the servo's limits."""
    needed = {"angle": angle, "rate": rate, "torque": torque}
    able = {name: getattr(servo, f"{name}_limit") for name in needed}
    return [
        (name, value, able[name])
        for name, value in needed.items()
        if value > able[name] * (1 + LARGEST_EXCESS)
    ]


@dataclass(frozen=True, repr=False)
class SimulatedMotion(GaitResult):
    """A simulated motion.

    start       `rest` or `steady`
    trajectory  arrays at equal time steps: `t`, `x`, `y`, `psi`, `phi`, `v`, `torque`, SI
    measured    speed and peak torque over the last period
    """

    DRAW = "rr_opt.results.figures.motion.draw_motion"
    CAPTIONS = doc.captions("motion")

    start: str
    trajectory: Trajectory
    measured: Measured

    @property
    def beyond_servo(self) -> tuple[str, ...]:
        """A sentence on each servo limit that the motion exceeds; it is simulated anyway."""
        joint, torque = self.joint, self.measured.peak_torque
        beyond = beyond_servo(self.robot.servo, joint.peak_angle, joint.peak_rate, torque)
        return tuple(
            f"The gait needs {QUANTITIES[name].both(value)}, but the servo's {name} limit is "
            f"{QUANTITIES[name].both(limit)}. The simulation ignores this limit."
            for name, value, limit in beyond
        )

    def record(self, files: Sequence[Path] = ()) -> dict[str, Any]:
        """Distance, turn, speed and torque, SI. For the last period, `last_speed` is the mean of v,
        and `last_circle_speed` the speed along its mean circle, null if the motion is shorter."""
        return super().record() | {"files": [str(file) for file in files]}

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
            written = [write_text(folder / "trajectory.csv", trajectory_csv(self.trajectory))]
        else:
            written = [write_netcdf(folder / "trajectory.nc", self.trajectory)]
        for one in self.drawn(progress):
            written.append(write_text(folder / f"{one.name}.svg", one.svg))
        if film:
            from rr_opt.results.figures.motion import write_film

            place = folder / f"motion.{film}"
            written.append(write_film(place, self.robot, self.trajectory, film, progress))
        return written

    def document(self, figures: Sequence[doc.Figure] = ()) -> doc.Document:
        """Gait, distance, speed and torque, for a terminal."""
        return doc.facts_alone(_facts(self))

    def _record(self) -> dict[str, Any]:
        driven, measured = self.trajectory, self.measured
        return {
            **picked(self, "gait start"),
            "status": self.source_status,
            "seconds": driven.t[-1],
            "distance": math.hypot(driven.x[-1] - driven.x[0], driven.y[-1] - driven.y[0]),
            "turned": driven.psi[-1] - driven.psi[0],
            "last_speed": measured.mean_v,
            "last_circle_speed": measured.speed,
            "peak_torque": measured.peak_torque,
        }


@dataclass(frozen=True, repr=False)
class DrivenCircle(GaitResult):
    """The circle that a gait drives, and how a start from rest converges to it."""

    circle: Circle
    transient: Transient

    def _record(self) -> dict[str, Any]:
        """Radius, centre, speed and the transient, SI; null where a straight gait has none."""
        circle, start = self.circle, self.transient
        return {
            "gait": self.gait,
            **picked(circle, "speed curvature radius centre yaw_rate"),
            "heading_per_period": circle.heading,
            "time_for_full_turn": circle.time_round,
            "periods_for_full_turn": circle.periods_round,
            "from_rest": {
                "time_constant": start.constant,
                "factor_per_period": start.factor,
                "distance_lost": start.lost,
                "delay": start.delay,
            },
        }

    def document(self, figures: Sequence[doc.Figure] = ()) -> doc.Document:
        """The circle and the start from rest, for a terminal."""
        return doc.facts_alone(_circle_facts(self))


_COLUMNS = {
    "t": ("s", "time"),
    "x": ("m", "joint P along the floor's x axis"),
    "y": ("m", "joint P along the floor's y axis"),
    "psi": ("rad", "heading of platform 1"),
    "phi": ("rad", "angle of platform 2 relative to platform 1"),
    "v": ("m/s", "speed of axle 1 along platform 1"),
    "torque": ("N m", "servo torque on platform 2"),
}


def trajectory_csv(trajectory: Trajectory) -> str:
    """t,x,y,psi,phi,v,torque in SI units, under a header row that has them."""
    head = [doc.heading(name, unit) for name, (unit, _) in _COLUMNS.items()]
    return doc.csv_columns(head, (getattr(trajectory, name) for name in _COLUMNS))


def write_netcdf(path: Path, trajectory: Trajectory) -> Path:
    """Write the same as netCDF variables over t, with their units and meanings."""
    data = netcdf_writer().Dataset(
        {name: ("t", getattr(trajectory, name)) for name in _COLUMNS if name != "t"},
        coords={"t": trajectory.t},
        attrs={"title": "Roller Racer trajectory", "source": f"rr-opt {__version__}"},
    )
    for name, (unit, meaning) in _COLUMNS.items():
        data[name].attrs.update(units=unit, long_name=meaning)
    return write_dataset(path, data)


def _facts(motion: SimulatedMotion) -> Iterator[doc.Fact]:
    data, measured = motion._record(), motion.measured
    begun = "rest" if motion.start == "rest" else "the steady state"
    degrees = number(math.degrees(data["turned"]))
    mean = f"{speed_text(measured.mean_v)}, mean v of axle 1"
    yield from gait_facts(motion.gait)
    yield doc.Fact("time", f"{number(data['seconds'])} s from {begun}")
    yield doc.Fact("moved", f"{number(data['distance'])} m, turned by {degrees} deg")
    if measured.speed is None:
        yield doc.Fact("speed", f"{mean}, less than a period")
    else:
        circle = f"{speed_text(measured.speed)}, along the mean circle of the last period"
        yield doc.Fact("speed", circle)
        yield doc.Fact("", f"{mean} over the last period")
    yield doc.Fact("torque", f"{number(measured.peak_torque)} N m at most")


def check_files(format: Format, film: Film | None) -> None:
    """Raise InputError, before anything is computed, for a file that cannot be made here."""
    if format == "netcdf":
        netcdf_writer()
    if film:
        from rr_opt.results.figures.motion import check_film

        check_film(film)


def _circle_facts(driven: DrivenCircle) -> Iterator[doc.Fact]:
    circle, start = driven.circle, driven.transient
    yield from gait_facts(driven.gait)
    yield speed_fact(circle.speed)
    if circle.centre is None:
        yield doc.Fact("circle", f"straight: it turns by {circle.heading:.1e} rad a period")
    else:
        x, y = (with_unit(value, "m") for value in circle.centre)
        degrees, rate = (number(math.degrees(a)) for a in (circle.heading, circle.yaw_rate))
        radius, side = with_unit(circle.radius, "m"), side_text(circle.heading)
        periods = f"{number(circle.periods_round, 6)} periods"
        at = f"x = {x}, y = {y} in platform 1's axes at phase 0, P at the origin"
        yield doc.Fact("circle", f"radius {radius}", f"to the {side}")
        yield doc.Fact("curvature", f"{number(circle.curvature)} 1/m")
        yield doc.Fact("centre", at)
        yield doc.Fact("heading", f"{degrees} deg a period", f"{rate} deg/s")
        yield doc.Fact("full turn", with_unit(circle.time_round, "s"), periods)
    yield doc.Fact(
        "from rest",
        f"the deviation falls to 1/e in {with_unit(start.constant, 's')}, by "
        f"{number(100 * (1 - start.factor), 3)} % a period",
    )
    ahead = "behind" if start.lost >= 0 else "ahead of"
    yield doc.Fact(
        "lost",
        f"{with_unit(abs(start.lost), 'm')} {ahead} a robot that is steady from the start, "
        f"{with_unit(abs(start.delay), 's')}",
    )
