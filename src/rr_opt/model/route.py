"""A route as plain data: where the robot starts, what it drives along, and how exactly."""

import math
from dataclasses import dataclass, field
from typing import Literal

from rr_opt.model.fields import SI, data, declared
from rr_opt.model.problem import Direction, Problem
from rr_opt.units import Number

_PLACE = Number("m", "1.5 m")
_HEADING = Number("rad", "90 deg")


@data
class Pose:
    """A place of the joint P (m) with a heading (rad): the direction in which the path leads."""

    x: SI = declared(_PLACE, "x of the joint P, m.", default=0.0)
    y: SI = declared(_PLACE, "y of the joint P, m.", default=0.0)
    heading: SI = declared(_HEADING, "Direction of the path, rad.", default=0.0)


@data
class Straight:
    """A straight line ahead, m."""

    length: SI = declared(Number("m", "2 m", above=0, at_most=1000), "Length, m.")


@data
class Arc:
    """An arc that begins ahead."""

    radius: SI = declared(
        Number("m", "0.6 m", above=0, at_most=1000), "Radius of P's mean path, m."
    )
    angle: SI = declared(
        Number("rad", "90 deg", at_least=-20 * math.pi, at_most=20 * math.pi),
        "Change of heading, rad, positive to the left; at most ten turns.",
    )


@data
class Waypoint:
    """A pose to be reached, over arcs and a straight line of the planner's choice."""

    x: SI = declared(_PLACE, "x of the joint P, m.")
    y: SI = declared(_PLACE, "y of the joint P, m.")
    heading: SI = declared(_HEADING, "Direction in which the path arrives, rad.")

    @property
    def pose(self) -> Pose:
        """As a pose."""
        return Pose(self.x, self.y, self.heading)


Piece = Straight | Arc | Waypoint


@data
class Tolerance:
    """How exactly the route is to be driven."""

    position: SI = declared(Number("m", "2 cm", above=0), "Of P at the end, m.", default=0.02)
    heading: SI = declared(
        Number("rad", "5 deg", above=0, below=math.pi),
        "Of platform 1 at the end, rad.",
        default=math.radians(5),
    )
    path: SI = declared(
        Number("m", "5 cm", above=0), "Of P on the way, from the path, m.", default=0.05
    )
    speed: SI = declared(
        Number("m/s", "2 mm/s", above=0), "At rest the robot is slower, m/s.", default=0.002
    )


@dataclass(frozen=True)
class Route:
    """What is to be driven.

    direction  `forward`: platform 1 leads, its axis along the path; `backward`: platform 2 leads,
               and platform 1's axis is opposed to the path
    end        `rest`, or `running`: the robot passes the end at speed

    sha256     fingerprint of the files that it was read from; empty if it was made in Python
    """

    problem: Problem
    pieces: tuple[Piece, ...]
    start: Pose = field(default_factory=Pose)
    tolerance: Tolerance = field(default_factory=Tolerance)
    direction: Direction = "either"
    end: Literal["rest", "running"] = "rest"
    name: str = field(default="route", compare=False)
    sha256: str = field(default="", compare=False, repr=False)
