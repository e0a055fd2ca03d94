"""A gait problem as frozen data: which gaits are allowed on which robot, and what is wanted."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import Literal

from rr_opt.model.ballast import About, By, Loads, inertia_ratio
from rr_opt.model.fields import SI, Bounds, Count, Interval, OptionalSI, Range, data, declared
from rr_opt.model.gait import AMPLITUDE, OFFSET, PERIOD
from rr_opt.model.robot import ANGLE_LIMIT, RATE_LIMIT, TORQUE_LIMIT, Robot
from rr_opt.model.servo_command import CommandBounds
from rr_opt.units import Number

Direction = Literal["forward", "backward", "either"]
Shape = Literal["sine", "fourier", "free"]
Objective = Literal["speed", "cost_of_transport"]


@data
class GaitBounds:
    """Where amplitude (rad), period (s) and offset (rad) of the gait may lie, and its shape.

    A fourier or free gait has the mean angle offset, its first harmonic has at least the least
    amplitude, and it never leaves the offset by more than the largest: every sine within the
    bounds is allowed, and other shapes with it.

    harmonics  of a `fourier` gait
    intervals  of a `free` gait, on each of which the servo's acceleration is constant
    """

    amplitude: Bounds = declared(Range(AMPLITUDE), "Amplitude, rad.", default=Interval(0.05, 2.6))
    period: Bounds = declared(Range(PERIOD), "Period, s.", default=Interval(0.3, 3.0))
    offset: Bounds = declared(
        Range(OFFSET),
        "Offset, rad: phi swings about it, and if it is not 0 the robot turns.",
        default=Interval(0.0, 0.0),
    )
    shape: Shape = declared(
        None,
        "The shape of phi(t): sine; fourier, of several harmonics; or free, with a "
        "constant acceleration on each of many intervals of the period.",
        default="sine",
    )
    harmonics: int = declared(Count(1, 16), "Of a fourier gait; 3 if left out.", default=3)
    intervals: int = declared(
        Count(16, 384, even=True), "Of a free gait, an even number; 96 if left out.", default=96
    )


@data
class RatioChoice:
    """J20/J10 as a decision: its bounds, its definition and its realisation."""

    bounds: Bounds = declared(Range(Number("", "0.2", above=0)), "J20/J10, dimensionless.")
    about: About = declared(
        None, "The J are taken about the joint P, or each centre of mass.", default="joint"
    )
    by: By = declared(None, "Realised by I of platform 2 alone, or by loads.", default="inertia")
    loads: Loads = field(
        default_factory=Loads,
        metadata={"description": "The loads, if the ratio is realised by loads."},
    )


LARGEST_EXCESS = 1e-4
"""Relative excess over a limit up to which a gait still counts as keeping it."""

CANCELLED = 1e-3
"""Share of the largest speed along a cycle below which back and forth motion nearly cancels. An
error of the mean speed is then relative to that share. CVODES keeps 1e-12 of the largest speed in
each of up to a thousand steps: a mean is known to 1e-9 of it, so 1e-6 of the mean can be requested
down to here. The sweep's C code has the same number."""


LEAST = ("singularity", "speed")
"""Limits that are lower bounds; all others are upper bounds."""

GRIP_LIMIT = Number("", "0.5", above=0, endless=True)

NEEDS_GRIP = 0.5
"""Side force over load above which a warning is given: rubber on a dry floor has 0.6 to 1, hard
wheels or dust less."""


@data
class Limits:
    """|phi| <= angle (rad), |dphi/dt| <= rate (rad/s), |torque| <= torque (N m),
    S1 = c1 cos phi + c2 >= singularity (m), |side force of an axle| <= grip * its load,
    mean positive power of the servo <= power (W), that per metre and weight <= cost_of_transport,
    |mean speed| >= speed (m/s).

    A limit that is left out (None) is the robot's servo's; the Problem fills it in.
    """

    angle: OptionalSI = declared(ANGLE_LIMIT, "Largest |phi|, rad, below pi.", default=None)
    rate: OptionalSI = declared(
        RATE_LIMIT, "Largest |dphi/dt|, rad/s; .inf: no limit.", default=None
    )
    torque: OptionalSI = declared(
        TORQUE_LIMIT, "Largest |torque|, N m; .inf: no limit.", default=None
    )
    singularity: SI = declared(
        Number("m", "20 mm", above=0), "The least S1 = c1 cos phi + c2 allowed, m.", default=0.020
    )

    grip: SI = declared(
        GRIP_LIMIT,
        "Largest side force of an axle over the load on it: the coefficient of friction that its "
        "wheels may need; .inf: no limit.",
        default=math.inf,
    )
    power: SI = declared(
        Number("W", "0.5 W", above=0, endless=True),
        "Largest mean of the servo's positive power torque dphi/dt over a period, W: what it gets "
        "back while it brakes does not count; .inf: no limit.",
        default=math.inf,
    )
    cost_of_transport: SI = declared(
        Number("", "0.2", above=0, endless=True),
        "Largest cost of transport: the servo's positive work per metre over the robot's weight; "
        ".inf: no limit.",
        default=math.inf,
    )
    speed: SI = declared(
        Number("m/s", "50 mm/s", at_least=0.0), "Least mean speed, m/s, either way.", default=0.0
    )

    @property
    def economy(self) -> dict[str, float]:
        """The limits that are set on totals over a whole period, by name."""
        names = ("power", "cost_of_transport", "speed")
        given = {name: getattr(self, name) for name in names}
        return {name: limit for name, limit in given.items() if 0 < limit < math.inf}

    def worst(self, reached: Mapping[str, float]) -> tuple[str, float]:
        """The limit that is broken most, or kept most narrowly, and its excess relative to it;
        ("", -inf) where none is set.

        reached: the extreme of what each limit bounds, by the limit's name, SI.
        """
        limits = {name: getattr(self, name) for name in reached}
        excess = {
            name: (limit - reached[name] if name in LEAST else reached[name] - limit) / abs(limit)
            for name, limit in limits.items()
            if limit and math.isfinite(limit)
        }
        name = max(excess, key=lambda one: excess[one], default="")
        return name, excess.get(name, -math.inf)


ANY = Interval(-math.inf, math.inf)


@data
class Turn:
    """Which circles a gait may go round; what is not asked may be anything.

    Positive is to the left (counter-clockwise, seen from above), wherever the robot goes.
    """

    curvature: Bounds = declared(
        Range(Number("1/m", "0.5")),
        "Heading gained per metre along the mean circle, 1/m.",
        default=ANY,
    )
    yaw_rate: Bounds = declared(
        Range(Number("rad/s", "10 deg/s")), "Heading gained per second, rad/s.", default=ANY
    )
    heading: Bounds = declared(
        Range(Number("rad", "90 deg")), "Heading gained per period, rad.", default=ANY
    )


_SHARE = Number("", "5 %", at_least=0.0, below=1.0)


@data
class Spreads:
    """How well a robot is known: of both platforms, each for itself, the standard deviation of the
    logarithm of a value, which for a small one is that of the value, relative."""

    m: SI = declared(_SHARE, "Of the masses, a share of the nominal value.", default=0.0)
    I: SI = declared(_SHARE, "Of the moments of inertia, likewise.", default=0.0)
    a: SI = declared(_SHARE, "Of the distances from axle to centre of mass.", default=0.0)
    kappa: SI = declared(_SHARE, "Of the viscous friction of the wheels.", default=0.0)

    def of(self, parameters: Sequence[str]) -> dict[int, float]:
        """The spreads above 0 of parameters of the equations of motion, by their index."""
        own = {"m": self.m, "I": self.I, "a": self.a, "k": self.kappa}
        found = {i: own.get(name[:-1], 0.0) for i, name in enumerate(parameters)}
        return {i: spread for i, spread in found.items() if spread}


@dataclass(frozen=True)
class Problem:
    """Which gait drives `robot` fastest within `gait`, `inertia_ratio`, `limits` and `turn`, or at
    the least cost of transport?

    `inertia_ratio` None: the robot as it is; `turn` None: straight or on any circle.

    robust   None: the robot is what it says; else a gait is sought too that is fast on most of the
             robots that it may be
    command  None: gaits are commands to the servo; else they are motions of the joint
    sha256  fingerprint of the files it was read from; empty if it was made or changed in Python
    """

    robot: Robot
    limits: Limits = field(default_factory=Limits)
    gait: GaitBounds = field(default_factory=GaitBounds)
    inertia_ratio: RatioChoice | None = None
    direction: Direction = "either"
    objective: Objective = "speed"
    turn: Turn | None = None
    command: CommandBounds | None = None
    robust: Spreads | None = None
    name: str = field(default="", compare=False)
    sha256: str = field(default="", init=False, compare=False, repr=False)

    def __post_init__(self) -> None:
        servo, given = self.robot.servo, self.limits
        able = {"angle": servo.angle_limit, "rate": servo.rate_limit, "torque": servo.torque_limit}
        left_out = {name: value for name, value in able.items() if getattr(given, name) is None}
        if left_out:
            object.__setattr__(self, "limits", replace(given, **left_out))

    @property
    def bounds_command(self) -> bool:
        """Whether the amplitude of the command is bounded, and not that of the joint."""
        return bool(self.command and self.command.servo.lags and self.gait.shape == "sine")

    @property
    def economy(self) -> bool:
        """Whether the energy or the least speed of a gait counts."""
        return self.objective != "speed" or bool(self.limits.economy)

    def merit(self, speed: float, cost_of_transport: float) -> float:
        """What is maximised: |speed|, m/s, or the distance per energy, weights times metres."""
        return abs(speed) if self.objective == "speed" else 1 / cost_of_transport

    def read_from(self, name: str, sha256: str) -> Problem:
        """The problem with its name and the fingerprint of its files."""
        read = replace(self, name=name)
        object.__setattr__(read, "sha256", sha256)
        return read

    def with_robot(self, robot: Robot) -> Problem:
        """The same problem for another robot, with limits no wider than that robot's servo's."""
        servo, given = robot.servo, self.limits
        limits = replace(
            given,
            angle=min(given.angle, servo.angle_limit),
            rate=min(given.rate, servo.rate_limit),
            torque=min(given.torque, servo.torque_limit),
        )
        choice = self.inertia_ratio
        return replace(
            self,
            robot=robot,
            limits=limits,
            inertia_ratio=reachable(choice, robot) if choice else None,
        )


_ROUNDING = 1e-9


def reachable(choice: RatioChoice, robot: Robot) -> RatioChoice:
    """The choice without the ratios below the robot's own, if loads realise it: they only add."""
    own = inertia_ratio(robot, choice.about)
    low, high = choice.bounds.low, choice.bounds.high
    if choice.by == "inertia" or low >= own or high < own * (1 - _ROUNDING):
        return choice
    return replace(choice, bounds=Interval(own, max(own, high)))
