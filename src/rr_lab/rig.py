"""The physical robot in the laboratory: its composition, independent of an engine.

A rig without effects is the nominal robot. It is plain data that every engine reads.
"""

import math
from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from rr_opt.array import Array
from rr_opt.model.robot import Robot

WHEELS = ("1L", "1R", "2L", "2R")
"""Platform and side, in the order of every list of four."""

GRAVITY = 9.81

GRIPS = 50.0
"""The grip of wheels that never slide."""

Shaper = Callable[[Array, Array], Array]
"""(times, commanded angles) -> actual angles; rad at equal steps, s."""


@dataclass
class Wheels:
    """The state of the wheels at an instant, and their friction, which a law may change in place.

    t        since the robot was released, s; negative while it settles
    rate     rotation rate of each wheel, rad/s (4,)
    angle    each has turned by, rad (4,)
    places   of the wheels' centres on the floor, m (4, 2)
    heading  of platform 1, rad
    loads    of the wheels on the floor, N (4,)
    damping  N m s (4,), dry N m (4,): friction of the rig
    torque   N m (4,), any other torque on them
    """

    t: float
    rate: Array
    angle: Array
    places: Array
    heading: float
    loads: Array
    damping: Array
    dry: Array
    torque: Array


Law = Callable[[Wheels], None]


@dataclass(frozen=True)
class Tether:
    """A cord from a post at (x, y) to platform 1's centre of mass: it pulls when longer than
    `slack` (m), with `stiffness` (N/m)."""

    x: float
    y: float
    slack: float
    stiffness: float


CABLE_ONSET = 5e-3
"""m/s, onset of a dragged cable's friction, as u/sqrt(u^2 + onset^2)."""


def swing_inertia(robot: Robot) -> float:
    """Inertia of the platforms swinging against each other about a joint at rest, kg m2."""
    one, two = robot.platform1.joint_inertia, robot.platform2.joint_inertia
    return one * two / (one + two)


@dataclass(frozen=True)
class Motor:
    """A servo's loop: its torque on platform 2, with the reaction on platform 1, is
    stiffness * (asked - made) + damping * (feedforward * rate asked - rate made).

    stiffness, damping  N m/rad and N m s/rad
    feedforward         1: follows a steady rate without lag; 0: lags it by damping/stiffness
    """

    stiffness: float
    damping: float
    feedforward: float = 1.0


@dataclass
class Rig:
    """A robot with its hidden effects. Lists of four are by WHEELS, of two by platform.

    robot      its true values
    kappa      viscous friction, N m s; the robot's by default
    quadratic  friction, N m s2
    dry        friction, N m
    J          kg m2, hidden spin inertia
    onset      m/s at the rim, of dry friction; None: the engine's own, as always in MuJoCo
    toe        rad, the axle turned counter-clockwise about its centre
    left       m, the centre of mass to the left of the axis
    mu         grip of the wheels; large by default, so that none slides
    creep      m/(N s), side speed per side force of a wheel
    tilt       downhill components, rad
    play       rad, backlash between servo and platform 2
    gear       N m/rad, stiffness of the backlash's flanks; None: the engine's stiffest
    hinge_dry  N m, dry friction between the two platforms, in the joint itself
    motor      the servo's loop; None: stiff enough to follow its command exactly
    pin        m, the joint pin's clearance
    spring     N m/rad, bending stiffness of each platform half way from joint to axle; None: rigid
    load       mass (kg) and stiffness (N/m) of a shifting load on platform 1; None: no such load
    density    kg/m3, of a medium with drag on the platforms' bodies; see `box_of`
    tether     the cord that holds platform 1; None: no cord
    cable      N, friction of a cable dragged on the floor by the centre of axle 2
    offset     rad, added to the command before it is shaped
    shapers    of the command, in order
    laws       of the wheels' friction, in order: each modifies the result of the previous ones
    tracked    m, place in platform 1's frame of the point taken for P
    clock      s, recording time t is command time t + clock
    """

    robot: Robot
    kappa: list[float] = field(default_factory=list)
    quadratic: list[float] = field(default_factory=lambda: [0.0] * 4)
    dry: list[float] = field(default_factory=lambda: [0.0] * 4)
    J: list[float] = field(default_factory=lambda: [0.0] * 4)
    onset: float | None = None
    toe: list[float] = field(default_factory=lambda: [0.0, 0.0])
    left: list[float] = field(default_factory=lambda: [0.0, 0.0])
    mu: float = GRIPS
    creep: float = 0.0
    tilt: list[float] = field(default_factory=lambda: [0.0, 0.0])
    play: float = 0.0
    gear: float | None = None
    hinge_dry: float = 0.0
    motor: Motor | None = None
    pin: float = 0.0
    spring: float | None = None
    load: tuple[float, float] | None = None
    density: float = 0.0
    tether: Tether | None = None
    cable: float = 0.0
    offset: float = 0.0
    shapers: list[Shaper] = field(default_factory=list)
    laws: list[Law] = field(default_factory=list)
    tracked: list[float] = field(default_factory=lambda: [0.0, 0.0])
    clock: float = 0.0

    def __post_init__(self) -> None:
        if not self.kappa:
            one, two = self.robot.platform1.kappa, self.robot.platform2.kappa
            self.kappa = [one, one, two, two]

    @property
    def gravity(self) -> Any:
        """Gravity along the floor's own axes, m/s2 (3,)."""
        x, y = np.sin(self.tilt)
        return GRAVITY * np.array([x, y, -np.sqrt(1 - x * x - y * y)])


def box_of(m: float, I: float) -> tuple[float, float]:
    """Half the length and breadth, and half the height, m, of a box with a platform's mass and
    moment of inertia (the other two being 0.6 I). Its sides have the drag."""
    return math.sqrt(1.5 * I / m), math.sqrt(0.3 * I / m)


def wheel_loads(rig: Rig) -> Array:
    """Load of each wheel on the floor, N (4,), in the order of WHEELS.

    The robot stands on four wheels, with a joint that turns about the vertical only: a rigid body,
    whose weight and whose two moments on the floor give three equations for four loads. The
    minimum-norm solution is taken: the loads of four equal springs.
    Without an off-axis mass both wheels of an axle carry the same, and those of platform 1

        N1 = g (m1 (c1 + c2 - a1) + m2 a2) / (c1 + c2)

    Assumed: a straight posture (at 0.9 rad the axles carry another half a per cent), a nearly level
    floor, and low masses, so that braking and turning do not shift the load.
    """
    one, two = rig.robot.platform1, rig.robot.platform2
    stands = [(x, side * part.b) for x, part in ((one.c, one), (-two.c, two)) for side in (1, -1)]
    masses = [(one.m, one.joint_to_centre, rig.left[0]), (two.m, -two.joint_to_centre, rig.left[1])]
    if rig.load is not None:
        masses.append((rig.load[0], one.joint_to_centre, 0.0))
    balance = np.array([(1.0, x, y) for x, y in stands]).T
    weight = -rig.gravity[2] * np.array([(m, m * x, m * y) for m, x, y in masses]).sum(0)
    return np.linalg.lstsq(balance, weight)[0]


@dataclass(frozen=True)
class Circle:
    """A round place, m."""

    x: float
    y: float
    radius: float

    def depth(self, x: Any, y: Any) -> Any:
        """Depth of a point inside, m; negative outside. For numbers or expressions."""
        return self.radius - ((x - self.x) ** 2 + (y - self.y) ** 2) ** 0.5


@dataclass(frozen=True)
class Edge:
    """Everything beyond a straight edge through (x, y), m; normal, rad, points into it."""

    x: float
    y: float
    normal: float

    def depth(self, x: Any, y: Any) -> Any:
        """Depth of a point beyond the edge, m; else negative. For numbers or expressions."""
        return (x - self.x) * math.cos(self.normal) + (y - self.y) * math.sin(self.normal)


@dataclass(frozen=True)
class Strip:
    """The same up to a second edge at a distance of `width`, m."""

    edge: Edge
    width: float

    def depth(self, x: Any, y: Any) -> Any:
        """Depth of a point inside, m; negative outside. For numbers or expressions."""
        half = self.width / 2
        return half - ((self.edge.depth(x, y) - half) ** 2) ** 0.5


@dataclass(frozen=True)
class Patch:
    """Friction `times` as large for each wheel inside."""

    times: float
    within: Circle | Edge | Strip

    def __call__(self, wheels: Wheels) -> None:
        """The friction at this instant."""
        # Python floats: a law is evaluated at every step, where arrays of four would cost more.
        for wheel, place in enumerate(wheels.places.tolist()):
            if self.within.depth(*place) > 0:
                wheels.damping[wheel] *= self.times
                wheels.dry[wheel] *= self.times


@dataclass(frozen=True)
class Falling:
    """Dry friction of all wheels that falls from `torque` (N m) to a third of it with speeds above
    `rate` (rad/s)."""

    torque: float
    rate: float

    def __call__(self, wheels: Wheels) -> None:
        """The friction at this instant."""
        wheels.dry += self.torque * (1 + 2 * np.exp(-((wheels.rate / self.rate) ** 2))) / 3


@dataclass(frozen=True)
class Drift:
    """Viscous friction that changes by the fraction `change` with the time constant `time` (s)."""

    change: float
    time: float

    def __call__(self, wheels: Wheels) -> None:
        """The friction at this instant."""
        wheels.damping *= 1 + self.change * (1 - np.exp(-max(wheels.t, 0.0) / self.time))


@dataclass(frozen=True)
class Rub:
    """The left wheel of platform 1 rubs with `torque` (N m) over the first fifth of each turn."""

    torque: float

    def __call__(self, wheels: Wheels) -> None:
        """The friction at this instant."""
        if wheels.angle[0] % (2 * np.pi) < 0.4 * np.pi:
            wheels.dry[0] += self.torque


@dataclass(frozen=True)
class RollingResistance:
    """Dry friction at the rim of each wheel, `mu` of its load."""

    mu: float
    h: float

    def __call__(self, wheels: Wheels) -> None:
        """The friction at this instant."""
        wheels.dry += self.mu * self.h * wheels.loads
