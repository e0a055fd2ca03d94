"""The decision variables of a gait problem on the unit box, and the robots that they define.

A requested turn is a row that the search can penalise. Curvature itself makes a poor row: it grows
without bound as the mean velocity V passes near zero, where |V| also has almost a kink. With the
yaw rate omega and a length L,

    s = omega L / sqrt((omega L)^2 + V^2)

is equivalent, and smooth in V and omega. L is the requested radius, so that s is most sensitive
near the target, but is capped at a few robot lengths: otherwise s would be almost a step between
left and right.

For a sine, three of the limits bound the amplitude alone once period and offset are chosen:

    alpha <= rate T/(2 pi)      alpha <= angle - |phi0|      alpha <= phi_s - |phi0|

where S1 = c1 cos phi + c2 reaches the singularity margin at phi_s. So the bounds on T and phi0 are
tightened until every choice leaves a feasible amplitude, and the amplitude is scaled by the range
that remains. Every point of the box then satisfies these limits; only the torque is unchecked.
"""

import math
from dataclasses import dataclass, replace

import numpy as np

from rr_opt.array import Array
from rr_opt.design.landscape import Landscape
from rr_opt.model.ballast import Loads, load_count, with_load_count
from rr_opt.model.problem import ANY, Interval, Problem, RatioChoice, Turn
from rr_opt.model.robot import Robot
from rr_opt.model.servo_command import CommandBounds
from rr_opt.motion.dynamics import Dynamics, dynamics_of

_LENGTHS = 5.0
_SLOWEST = 1e-12
"""Slower speeds, m/s, count as this one in a denominator."""


@dataclass(frozen=True)
class TurnRows:
    """Rows of a Turn: the quantities it asks for, scaled."""

    turn: Turn
    length: float

    @property
    def names(self) -> tuple[str, ...]:
        """The quantity of each row."""
        asked = self.turn
        return tuple(n for n in ("curvature", "yaw_rate", "heading") if getattr(asked, n) != ANY)

    @property
    def intervals(self) -> tuple[Interval, ...]:
        """The interval of each row."""
        asked = {name: getattr(self.turn, name) for name in self.names}
        rows = {
            n: Interval(*(end / _size(one) for end in (one.low, one.high)))
            for n, one in asked.items()
        }
        if "curvature" in asked:
            ends = (self.turn.curvature.low, self.turn.curvature.high)
            rows["curvature"] = Interval(*(math.sin(math.atan(end * self.length)) for end in ends))
        return tuple(rows.values())

    def values(self, speed: Array, turn: Array, period: Array) -> list[Array]:
        """The rows of gaits with this speed (m/s), heading per period (rad) and period (s)."""
        across = turn / period * self.length
        rows = {
            "curvature": across / np.maximum(np.hypot(across, speed), _SLOWEST),
            "yaw_rate": turn / period / _size(self.turn.yaw_rate),
            "heading": turn / _size(self.turn.heading),
        }
        return [rows[name] for name in self.names]

    def slopes(self, speed: float, turn: float, period: float) -> dict[str, float]:
        """Derivative of each row by its quantity, at a gait."""
        tangent = turn / period / abs(speed) * self.length
        found = {name: 1 / _size(getattr(self.turn, name)) for name in self.names}
        return found | {"curvature": self.length / (1 + tangent**2) ** 1.5}


def turn_rows(turn: Turn, robot: Robot) -> TurnRows:
    """The rows of the turn requested of this robot."""
    longest = _LENGTHS * (robot.platform1.c + robot.platform2.c)
    asked = turn.curvature != ANY and 1 / _size(turn.curvature)
    return TurnRows(turn, min(asked or longest, longest))


def _size(asked: Interval) -> float:
    """Scale of a requested interval; 1 if it only asks for straight."""
    ends = [abs(end) for end in (asked.low, asked.high) if math.isfinite(end)]
    return max(ends, default=0.0) or 1.0


SQUARE = math.pi / 4
"""Ratio of peak to first harmonic of a square wave, the least of any waveform. A shape of given
first harmonic needs at least this fraction of the sine's angle and rate."""

NO_ROOM = 1e-7
"""Intervals narrower than this, relative, count as a point."""


@dataclass(frozen=True)
class Decisions:
    """Bounds of the decisions of a problem, tightened by the limits.

    period, offset   tightened intervals (s, rad); low > high where no gait keeps the limits
    amplitude        the problem's bounds, rad
    ballast          I2 (kg m2) or number of loads
    reach            largest |phi| that angle and singularity allow, rad
    turn             the requested turn; it bounds no decision by itself
    command          bounds of the commanded amplitude, where the servo lags
    two_sided        the robot is left-right symmetric: gaits at phi0 and -phi0 are mirror images
    """

    period: Interval
    offset: Interval
    amplitude: Interval
    ballast: Interval
    reach: float
    rate: float
    turn: TurnRows | None = None
    command: CommandBounds | None = None
    two_sided: bool = True

    @property
    def amplitude_pinned(self) -> bool:
        """The limits leave the amplitude no room above its lower bound."""
        if self.command:
            return self.amplitude.fixed
        least_offset = abs(self.offset.clip(0.0))
        most = min(
            self.amplitude.high,
            self.reach - least_offset,
            self.rate * self.period.high / (2 * math.pi),
        )
        return most - self.amplitude.low <= NO_ROOM * most

    @property
    def empty(self) -> bool:
        """No gait within the bounds keeps the limits on rate, angle and singularity."""
        return self.period.low > self.period.high or self.offset.low > self.offset.high

    @property
    def free(self) -> list[int]:
        """Which of (period, offset, amplitude, ballast) are free."""
        intervals = (self.period, self.offset, self.amplitude, self.ballast)
        return [i for i, interval in enumerate(intervals) if not interval.fixed]

    @property
    def mirrored(self) -> bool:
        """Every gait's mirror image is in the box too and performs equally well; not if a turn is
        requested, as one of the two turns the wrong way."""
        symmetric = not self.offset.fixed and self.offset.low == -self.offset.high
        return symmetric and self.turn is None and self.two_sided

    def physical(self, unit: Array) -> Array:
        """Unit-box points (K, 4) -> amplitude, period, offset, ballast share, (4, K)."""
        period = self.period.low * (self.period.high / self.period.low) ** unit[:, 0]
        offset = self.offset.low + unit[:, 1] * (self.offset.high - self.offset.low)
        low, high = self.amplitude.low, self.amplitude.high
        if self.command:
            low, high = self.command.joint_amplitude(period)
        most = np.minimum(
            np.minimum(high, self.reach - np.abs(offset)), self.rate * period / (2 * math.pi)
        )
        amplitude = low + unit[:, 2] * np.maximum(most - low, 0.0)
        return np.array([amplitude, period, offset, unit[:, 3]])

    def unit(self, amplitude: float, period: float, offset: float, share: float) -> Array:
        """The unit-box point (4,) at or nearest to a gait; 0 for fixed decisions."""
        point = np.zeros(4)
        if not self.period.fixed:
            point[0] = math.log(period / self.period.low) / math.log(
                self.period.high / self.period.low
            )
        if not self.offset.fixed:
            point[1] = (offset - self.offset.low) / (self.offset.high - self.offset.low)
        low, most = self.physical(np.array([[*point[:2], k, 0.0] for k in (0.0, 1.0)]))[0]
        if most > low:
            point[2] = (amplitude - low) / (most - low)
        point[3] = share
        return np.clip(point, 0.0, 1.0)


def decisions(problem: Problem) -> Decisions:
    """The decisions of a problem with their bounds tightened by its limits."""
    gait, limits = problem.gait, problem.limits
    reach = min(limits.angle, reach_before_singularity(problem.robot, limits.singularity))
    amplitude, period, offset = gait.amplitude, gait.period, gait.offset
    least = amplitude.low * (1.0 if gait.shape == "sine" else SQUARE)
    least_period = 2 * math.pi * least / limits.rate
    room = reach - least
    return Decisions(
        period=_tightened(Interval(max(period.low, least_period), period.high)),
        offset=_tightened(Interval(max(offset.low, -room), min(offset.high, room))),
        amplitude=amplitude,
        ballast=ballast_interval(problem.robot, problem.inertia_ratio),
        reach=reach,
        rate=limits.rate,
        turn=turn_rows(problem.turn, problem.robot) if problem.turn else None,
        command=problem.command if problem.bounds_command else None,
        two_sided=dynamics_of(problem.robot).mirrored,
    )


def _tightened(interval: Interval) -> Interval:
    """The interval, collapsed to a point where limits and bounds agree to within rounding."""
    low, high = interval.low, interval.high
    if abs(high - low) <= NO_ROOM * max(abs(low), abs(high)):
        return Interval(high, high)
    return interval


def reach_before_singularity(robot: Robot, margin: float) -> float:
    """Largest |phi| with c1 cos phi + c2 >= margin, rad; -inf if not even phi = 0 has it."""
    cosine = (margin - robot.platform2.c) / robot.platform1.c
    if cosine > 1:
        return -math.inf
    return math.acos(max(cosine, -1.0))


def ballast_interval(robot: Robot, choice: RatioChoice | None) -> Interval:
    """The range of I2 (kg m2), or of the number of loads, that gives the wanted ratios."""
    if choice is None:
        return Interval(robot.platform2.I, robot.platform2.I)
    ends = (choice.bounds.low, choice.bounds.high)
    if choice.by == "loads":
        low, high = (load_count(robot, r, choice.about, choice.loads) for r in ends)
        return Interval(max(low, 0.0), high)
    two = robot.platform2
    if choice.about == "joint":
        offset, scale = two.m * two.joint_to_centre**2, robot.platform1.joint_inertia
    else:
        offset, scale = 0.0, robot.platform1.I
    low, high = (r * scale - offset for r in ends)
    return Interval(max(low, 1e-6 * scale), high)


def share_per_ratio(robot: Robot, choice: RatioChoice) -> float:
    """Change of the ballast's share per unit of J20/J10, at the upper bound."""

    def amount(ratio: float) -> float:
        return ballast_interval(robot, replace(choice, bounds=Interval(ratio, ratio))).high

    span, high = ballast_interval(robot, choice), choice.bounds.high
    if span.fixed:
        return 0.0
    return (amount(high) - amount(high * (1 - 1e-6))) / (high * 1e-6) / (span.high - span.low)


def share_of(problem: Problem, box: Decisions, ratio: float | None) -> float:
    """The share of the ballast's range that gives this J20/J10."""
    choice, span = problem.inertia_ratio, box.ballast.high - box.ballast.low
    if choice is None or ratio is None or not span:
        return 0.0
    at = ballast_interval(problem.robot, replace(choice, bounds=Interval(ratio, ratio))).low
    return float(np.clip((at - box.ballast.low) / span, 0.0, 1.0))


@dataclass(frozen=True)
class Setting:
    """A problem, ready to be solved from any start.

    ballast      range of I2 (kg m2) or of the number of loads
    fixed_share  position in that range, where the ballast is fixed to a whole number of loads
    """

    problem: Problem
    dynamics: Dynamics
    landscape: Landscape
    ballast: Interval
    fixed_share: float | None = None


def settings_of(problem: Problem, box: Decisions) -> list[Setting]:
    """One setting, or one for each whole number of loads."""
    choice = problem.inertia_ratio
    by, loads = (choice.by, choice.loads) if choice else ("inertia", Loads())
    dynamics = dynamics_of(problem.robot)
    low, high = box.ballast.low, box.ballast.high
    landscape = Landscape(dynamics, problem.robot, by, loads, box.ballast)
    setting = Setting(problem, dynamics, landscape, box.ballast)
    if not (by == "loads" and loads.whole):
        return [setting]
    counts = range(math.ceil(low - 1e-9), math.floor(high + 1e-9) + 1)
    width = (high - low) or 1.0
    return [replace(setting, fixed_share=(count - low) / width) for count in counts]


def scanned(setting: Setting, box: Decisions) -> Decisions:
    """The box to scan: a whole number of loads fixes the ballast."""
    if setting.fixed_share is None:
        return box
    count = box.ballast.low + setting.fixed_share * (box.ballast.high - box.ballast.low)
    return replace(box, ballast=Interval(count, count))


def robot_of(setting: Setting, share: float) -> Robot:
    """The problem's robot with the ballast at this share of its range."""
    return with_ballast(setting.problem, setting.ballast, share)


def with_ballast(problem: Problem, span: Interval, share: float) -> Robot:
    """The problem's robot with the ballast at this share of a range."""
    robot, choice = problem.robot, problem.inertia_ratio
    amount = span.low + share * (span.high - span.low)
    if choice and choice.by == "loads":
        return replace(robot, platform2=with_load_count(robot.platform2, choice.loads, amount))
    return replace(robot, platform2=replace(robot.platform2, I=amount))
