"""A driven route: the drive that was found, and its replay."""

import math
import textwrap
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Any

import numpy as np

from rr_opt.documents import document as doc
from rr_opt.documents.archive import strict_json
from rr_opt.files.record import plain
from rr_opt.formatting import number, side_text, with_unit
from rr_opt.model.command import Command
from rr_opt.model.problem import LARGEST_EXCESS
from rr_opt.model.robot import Robot
from rr_opt.motion.setpoints import CENTRE, COUNT
from rr_opt.outcome import Status
from rr_opt.results.gait import ignored_effects
from rr_opt.results.limits import ACTIVE, LIMIT_NAMES, LimitRow, limits_table, slippery
from rr_opt.results.motion import Film, check_files, trajectory_csv
from rr_opt.results.result import Check, Progress, Result, picked, quiet
from rr_opt.routing import feedback as feedback_constants
from rr_opt.routing.feedback import Feedback
from rr_opt.routing.plan import RoutePlan
from rr_opt.routing.replay import RouteReplay
from rr_opt.version import __version__

_RATE = 125.0
"""Set points per second."""
_OPTIMAL = 1e-2
"""Largest stationarity residual for which prices are shown without a warning: converged drives
leave less than a tenth of it, prematurely stopped ones ten times as much and more."""
_WIDTH = 100
"""Line width of the C code."""


@dataclass(frozen=True)
class RouteLimit(LimitRow):
    """A limit, and how close a drive comes to it, on which piece (from 1) and when, s. Its price is
    the time saved, s, per SI unit by which it is raised."""

    piece: int = 0
    time: float = math.nan


@dataclass(frozen=True, repr=False)
class DrivenRoute(Result):
    """The fastest drive found along a route.

    plan    path, gaits and drive; `plan.drive.command` is the servo's angle over time
    replay  the drive by CVODES from rest; None if there is no drive
    feedback  the controller that keeps the robot on it, if requested
    """

    FILE = "route.json"
    OTHERS = (
        *("trajectory.csv", "setpoints.csv", "feedback.json", "feedback.c"),
        *("motion.gif", "motion.mp4"),
    )
    DRAW = "rr_opt.results.figures.motion.draw_route"
    CAPTIONS = doc.captions("route")

    name: str
    sha256: str
    plan: RoutePlan
    replay: RouteReplay | None
    feedback: Feedback | None = None

    @property
    def robot(self) -> Robot:
        """The robot that drives."""
        return self.plan.problem.robot

    @property
    def command(self) -> Command | None:
        """The servo's angle over time; None if there is no drive."""
        return self.plan.drive.command if self.plan.drive else None

    @property
    def seconds(self) -> float | None:
        """Time of the drive, s."""
        return self.command.seconds if self.command else None

    @property
    def status(self) -> Status:
        """OPTIMAL if a drive was found that passes every check."""
        if self.plan.status is Status.OPTIMAL and not all(check.passed for check in self.checks):
            return Status.NOT_CONVERGED
        return self.plan.status

    @property
    def message(self) -> str:
        """The outcome in a sentence."""
        if self.plan.status is not Status.OPTIMAL or self.seconds is None:
            return self.plan.message
        failed = [check.sentence for check in self.checks if not check.passed]
        if failed:
            return "The drive failed a check: " + " ".join(failed)
        length = sum(leg.length for leg in self.plan.legs)
        return (
            f"The fastest drive found goes {self.plan.way} and takes "
            f"{with_unit(self.seconds, 's')} for {with_unit(length, 'm')}."
        )

    @property
    def checks(self) -> list[Check]:
        """Checks of the replay: the end, the path, and the limits."""
        return list(self._checks())

    def _checks(self) -> Iterator[Check]:
        replay, asked = self.replay, self.plan.route.tolerance
        if replay is None:
            return
        worst = self.plan.problem.limits.worst(replay.reached)[0]
        end = replay.position <= asked.position and replay.heading <= asked.heading
        yield Check(
            end,
            f"End point by CVODES: P is {1e3 * replay.position:.1f} mm from its place (at most "
            f"{1e3 * asked.position:.4g}), and the heading is off by "
            f"{math.degrees(replay.heading):.2f} deg (at most {math.degrees(asked.heading):.4g}).",
        )
        yield Check(
            replay.path <= asked.path,
            f"Path by CVODES: P stays within {1e3 * replay.path:.1f} mm of the path (at most "
            f"{1e3 * asked.path:.4g}).",
        )
        kept = f"all are kept, the tightest with {-100 * replay.excess:.2f} % to spare."
        if replay.excess > 0:
            kept = f"{worst} is exceeded by {100 * replay.excess:.2g} %."
        limits = f"Limits of rate, angle, torque, singularity and grip: {kept}"
        yield Check(replay.excess <= LARGEST_EXCESS, limits)
        if self.plan.route.end == "rest":
            yield Check(
                replay.speed <= asked.speed,
                f"Rest: the robot is slower than {1e3 * asked.speed:.4g} mm/s at the end "
                f"({1e3 * replay.speed:.2f}).",
            )

    @cached_property
    def limits(self) -> dict[str, RouteLimit]:
        """By name (angle, rate, torque, singularity, grip): the peak of the drive, where, and the
        shadow price."""
        drive, replay, rows = self.plan.drive, self.replay, dict[str, RouteLimit]()
        good = self.status is Status.OPTIMAL  # without an optimum there are no prices
        if drive is None or replay is None:
            return rows
        for name in LIMIT_NAMES:
            limit = getattr(self.plan.problem.limits, name)
            price, when = drive.prices[name] if good else 0.0, replay.when[name]
            active = math.isfinite(limit) and abs(price * limit) > ACTIVE * drive.command.seconds
            segment = int(np.searchsorted(drive.command.times[1:-1], when))
            rows[name] = RouteLimit(
                name, limit, replay.reached[name], active, price if active else 0.0,
                drive.pieces[segment] + 1, when,
            )  # fmt: skip
        return rows

    @property
    def warnings(self) -> tuple[str, ...]:
        """Which effects of the robot the drive ignores, grip that wheels rarely have, and
        unreliable shadow prices."""
        drive, grip = self.plan.drive, self.replay.reached["grip"] if self.replay else 0.0
        short = drive is not None and drive.stationarity > _OPTIMAL
        prices = "The solver stopped short of an optimum: the shadow prices are unreliable."
        return (*ignored_effects(self.robot), *slippery(grip), *([prices] if short else []))

    def _record(self) -> dict[str, Any]:
        plan, replay, command = self.plan, self.replay, self.command
        return {
            **picked(self, "status message seconds"),
            "direction": plan.way,
            "length": sum(leg.length for leg in plan.legs),
            "path": [plain(leg) for leg in plan.legs],
            "gaits": [
                {**picked(gait, "amplitude period offset"), "speed": v}
                for gait, v in zip(plan.gaits, plan.speeds, strict=True)
            ],
            "coasting_alone": plain(plan.coasting) if plan.coasting else None,
            "command": command
            and {
                "durations": command.durations.tolist(),
                "amplitude": command.knots[0].tolist(),
                "offset": command.knots[1].tolist(),
                "omega": command.knots[2].tolist(),
            },
            "limits": [plain(row) for row in self.limits.values()],
            "check": replay and picked(replay, "position heading speed path reached excess"),
            "solver": plan.drive and picked(plan.drive, "ease stationarity"),
            "tolerance": plain(plan.route.tolerance),
            "robot": plain(self.robot),
        }

    def document(self, figures: Sequence[doc.Figure] = ()) -> doc.Document:
        """The report."""
        limits = self.limits
        where = {name: f"piece {row.piece}, {row.time:.2f} s" for name, row in limits.items()}
        return self._outcome(
            "route",
            self.message.removesuffix("."),
            f"No drive: {self.status.words}",
            doc.section("", doc.facts(_facts(self))),
            doc.section("Path", _legs(self)),
            doc.section("Limits", limits_table(limits.values(), True, "time", where)),
            doc.section("Checks", doc.checks(self.checks)),
            doc.gallery(figures),
        )

    def save(
        self,
        path: str | Path,
        *,
        figures: bool = True,
        progress: Progress = quiet,
        film: Film | None = None,
    ) -> list[Path]:
        """Write the result and, if asked for and there is a drive, a film: motion.gif or .mp4.

        Returns the files. Raises InputError for a file that cannot be made here.
        """
        check_files("csv", film)
        written = super().save(path, figures=figures, progress=progress)
        if film and self.replay:
            from rr_opt.results.figures.motion import write_film

            place, motion = Path(path) / f"motion.{film}", self.replay.trajectory
            written.append(write_film(place, self.robot, motion, film, progress))
        return written

    def _tables(self) -> Mapping[str, str]:
        """trajectory.csv, and the set points of a drive that passes every check."""
        command = self.command
        if self.replay is None or command is None:
            return {}
        tables = {"trajectory.csv": trajectory_csv(self.replay.trajectory)}
        if self.status is not Status.OPTIMAL:
            return tables
        t = np.arange(math.ceil(command.seconds * _RATE) + 1) / _RATE
        phi = command.angle(np.minimum(t, command.seconds))
        counts = np.round(CENTRE + phi / COUNT).astype(int)
        head = ("t [s]", "phi [rad]", "phi [deg]", "count")
        tables["setpoints.csv"] = doc.csv_columns(head, (t, phi, np.degrees(phi), counts))
        if self.feedback:
            tables["feedback.json"] = strict_json(plain(self.feedback))
            tables["feedback.c"] = c_text(self.feedback)
        return tables


def c_text(control: Feedback) -> str:
    """The controller as a C header."""

    def array(values: Any) -> str:
        if np.ndim(values):
            return "{" + ", ".join(map(array, values)) + "}"
        return f"{values:.12g}"

    template = doc.templates("rr_opt", "data").get_template("feedback.c")
    context = {"c": control, "version": __version__, "constants": feedback_constants}
    lines = list[str]()
    for row in template.render(array=array, **context).splitlines():
        # An array in lines of a readable width.
        long = len(row) > _WIDTH
        lines += textwrap.wrap(row, _WIDTH, subsequent_indent="    ") if long else [row]
    return "\n".join(lines) + "\n"


def _facts(result: DrivenRoute) -> Iterator[doc.Fact]:
    plan, replay = result.plan, result.replay
    if replay is None or result.seconds is None:
        return
    length = sum(leg.length for leg in plan.legs)
    yield doc.Fact("time", with_unit(result.seconds, "s"), f"{number(length)} m of path")
    leads = "platform 1 leads" if plan.way == "forward" else "platform 2 leads"
    yield doc.Fact("direction", plan.way, leads)
    if result.feedback:
        count = len(result.feedback.F)
        yield doc.Fact("feedback", f"{count} periods", "corrected at the end of each")
    yield doc.Fact("end", f"{1e3 * replay.position:.1f} mm from its place")
    yield doc.Fact("", f"{math.degrees(replay.heading):.2f} deg from its heading")
    yield doc.Fact("way", f"within {1e3 * replay.path:.1f} mm of the path")
    if plan.route.end == "rest":
        yield doc.Fact("speed at the end", f"{1e3 * replay.speed:.2f} mm/s")
        coast = plan.coasting
        if coast:
            text = f"{number(coast.seconds)} s and {number(coast.distance)} m to stop"
            yield doc.Fact("coasting alone", text)


def _legs(result: DrivenRoute) -> doc.Table:
    rows = []
    plan = result.plan
    for leg, gait, speed in zip(plan.legs, plan.gaits, plan.speeds, strict=True):
        way = "straight"
        if leg.curvature:
            turn = number(math.degrees(abs(leg.curvature) * leg.length))
            radius, side = number(1 / abs(leg.curvature)), side_text(leg.curvature)
            way = f"radius {radius} m, {turn} deg to the {side}"
        sizes = gait.amplitude, gait.period, gait.offset
        rows.append((str(leg.piece + 1), way, leg.length, *sizes, 1e3 * speed))
    head = (
        *("piece", "way", "length, m", "amplitude, rad", "period, s", "offset, rad"),
        "steady speed, mm/s",
    )
    note = "The steady gaits that the plan starts from; it then changes all of them together."
    return doc.table(head, rows, note)
