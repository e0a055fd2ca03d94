"""The fastest turn: the gait that goes fastest along a requested circle or arc.

A whole number of periods is found by branch and bound: solve for any number, and if the answer is
not whole, branch into the numbers below it and those above it. A branch that is slower than a whole
number already found is pruned.

Left is positive, counter-clockwise seen from above, whether the robot drives forward or backward.
A heading change and its circle have the same sign; if both are given, the heading's sign counts.
"""

import math
from dataclasses import dataclass, replace

from rr_opt.design.decisions import decisions, reach_before_singularity
from rr_opt.design.families import Progress
from rr_opt.design.infeasible import SURE, nearest_turn, posture_clashes
from rr_opt.design.maximize_speed import Optimum, maximize_speed
from rr_opt.model.problem import Interval, Problem, Turn
from rr_opt.motion.servo import for_joint
from rr_opt.motion.steady_cycle import steady_cycle
from rr_opt.outcome import InputError, Status

LARGEST_RADIUS = 1000.0
"""m; a wider circle is straight to a robot of this kind, and to the solver's tolerance."""


@dataclass(frozen=True)
class Target:
    """A circle, or an arc of one.

    heading   change of heading, rad, positive to the left; None: a full circle
    radius    of the circle, m; positive to the left if no heading sets the side
    within    longest time for the heading change, s
    length    longest path for the heading change, m, along the mean circle
    whole     the heading change has to take a whole number of periods
    """

    heading: float | None = None
    radius: float | None = None
    within: float | None = None
    length: float | None = None
    whole: bool = False

    @property
    def turn(self) -> Turn:
        """The turn that the gait has to make."""
        if self.heading is None:
            curvature = 1 / (self.radius or math.inf)
            return Turn(curvature=Interval(curvature, curvature))
        if self.radius is not None:
            curvature = math.copysign(1 / self.radius, self.heading)
            return Turn(curvature=Interval(curvature, curvature))
        if self.within is not None:
            return Turn(yaw_rate=_at_least(self.heading / self.within))
        return Turn(curvature=_at_least(self.heading / (self.length or math.inf)))


def _at_least(value: float) -> Interval:
    """This much or more, on the same side."""
    return Interval(value, math.inf) if value > 0 else Interval(-math.inf, value)


def checked(target: Target) -> Target:
    """The target, its radius positive where a heading sets the side.

    Raises InputError for an invalid or contradictory target.
    """
    given = [n for n in ("radius", "within", "length") if getattr(target, n) is not None]
    for name in ("heading", "radius", "within", "length"):
        value = getattr(target, name)
        if value is not None and (value == 0 or not math.isfinite(value)):
            raise InputError(f"--{name}: Read {value:g}. Expected a finite number other than 0.")
    for name in ("within", "length"):
        if (getattr(target, name) or 1.0) < 0:
            raise InputError(f"--{name}: Read {getattr(target, name):g}. Expected it above 0.")
    if len(given) != 1:
        read = " and ".join(f"--{name}" for name in given) or "none"
        raise InputError(
            f"Read {read} of --radius, --within and --length. A turn is asked for by one of them. "
            "Give --radius alone, or --heading with one of the three."
        )
    if target.heading is None and given != ["radius"]:
        raise InputError(
            f"Read --{given[0]} without --heading. Expected the change of heading that is to be "
            "made within it. Add for example --heading '90 deg'."
        )
    if target.heading is None and target.whole:
        raise InputError(
            "Read --cycles whole without --heading. Expected the change of heading that a whole "
            "number of periods is to make. Add for example --heading '90 deg'."
        )
    return _one_side(target)


def _one_side(target: Target) -> Target:
    radius, heading = target.radius, target.heading
    if radius is None:
        return target
    if abs(radius) > LARGEST_RADIUS:
        raise InputError(
            f"--radius: Read {radius:g} m. Expected at most {LARGEST_RADIUS:g} m: a wider circle "
            "is as good as straight. Ask `maximize-speed` for the fastest straight gait."
        )
    if heading is None:
        return target
    if radius < 0 < heading:
        raise InputError(
            f"Read a heading change of {heading:g} rad, to the left, and a radius of {radius:g} m, "
            "to the right. Expected one side. Give the radius without its sign."
        )
    return replace(target, radius=abs(radius))


def posed(problem: Problem, target: Target) -> tuple[Problem, bool]:
    """The problem with the turn, and whether its fixed offset was freed: as far as the limits and
    the least amplitude allow, on both sides."""
    problem = replace(problem, turn=target.turn)
    if not problem.gait.offset.fixed:
        return problem, False
    limits = problem.limits
    reach = min(limits.angle, reach_before_singularity(problem.robot, limits.singularity), math.pi)
    room = reach - problem.gait.amplitude.low
    if room <= 0:
        return problem, False
    return replace(problem, gait=replace(problem.gait, offset=Interval(-room, room))), True


_WHOLE = 1e-4
"""A number of periods counts as whole within this distance of an integer."""


@dataclass(frozen=True)
class MeanMotion:
    """The mean motion of a gait along the turn: signed speed (m/s), curvature (1/m) and yaw rate
    (rad/s), positive to the left; heading (rad), length (m), time (s) and periods of the arc."""

    speed: float
    curvature: float
    yaw_rate: float
    heading: float
    length: float
    time: float
    periods: float


@dataclass(frozen=True)
class Turned:
    """The answer to a turn.

    optimum   as of `maximize_speed`; its problem has the turn and the free offset
    opened    the problem fixed the offset, and it was freed
    arc       None if there is no gait; a full circle where no heading was given
    """

    target: Target
    optimum: Optimum
    opened: bool
    arc: MeanMotion | None = None


def fastest_turn(problem: Problem, target: Target, progress: Progress = lambda _: None) -> Turned:
    """Solve a turn; the outcomes are those of `maximize_speed`.

    Raises InputError for a robot without a steady cycle.
    """
    asked, opened = posed(for_joint(problem), target)
    optimum = maximize_speed(asked, progress)
    if optimum.status is Status.INFEASIBLE:
        optimum = replace(optimum, message=optimum.message + _sooner(asked, target))
    if target.whole and target.heading and optimum.best:
        optimum = _whole(asked, target.heading, optimum, progress)
    return Turned(target, optimum, opened, arc_of(optimum, target.heading))


def _sooner(problem: Problem, target: Target) -> str:
    """How the closest reachable turn compares with the requested time or length."""
    box = decisions(problem)
    if target.heading is None or target.radius is not None or posture_clashes(problem, box):
        return ""
    nearest = nearest_turn(problem, box)
    reached = nearest.yaw_rate if target.within is not None else nearest.curvature
    if reached * target.heading <= 0:
        return ""
    needed = target.heading / reached * (1 + SURE)
    unit, what = ("s", "within") if target.within is not None else ("m", "length")
    return f" For this change of heading that is --{what} '{needed:.4g} {unit}' or more."


def arc_of(optimum: Optimum, heading: float | None) -> MeanMotion | None:
    """The arc of this heading (rad), or a full circle, driven with an optimum's gait."""
    if optimum.best is None or optimum.robot is None:
        return None
    cycle = steady_cycle(optimum.robot, optimum.best.gait).cycle
    yaw_rate = cycle.dpsi / cycle.period
    turned = math.copysign(2 * math.pi, yaw_rate) if heading is None else heading
    time = turned / yaw_rate
    return MeanMotion(
        speed=cycle.speed,
        curvature=yaw_rate / abs(cycle.speed),
        yaw_rate=yaw_rate,
        heading=turned,
        length=abs(cycle.speed) * time,
        time=time,
        periods=time / cycle.period,
    )


def _whole(problem: Problem, heading: float, relaxed: Optimum, progress: Progress) -> Optimum:
    """The fastest of the gaits that turn by heading/n per period, n = 1, 2, ..."""
    best: Optimum | None = None
    failed: Optimum | None = None
    parts: list[tuple[float, float, Optimum | None]] = [(0, math.inf, relaxed)]
    while parts:
        low, high, optimum = parts.pop(0)
        if optimum is None:
            progress(f"periods: {low:g} to {high:g}")
            optimum = maximize_speed(_with_periods(problem, heading, low, high))
        arc = arc_of(optimum, heading)
        if arc is None or optimum.best is None:
            failed = failed or optimum
            continue
        if best and best.best and abs(optimum.best.speed) <= abs(best.best.speed):
            continue
        nearest = max(round(arc.periods), 1)
        if abs(arc.periods - nearest) <= _WHOLE:
            best = optimum
            continue
        below = math.floor(arc.periods)
        sides = [(max(low, 1), min(below, high)), (max(below + 1, low), high)]
        # A branch that does not contain its own relaxed answer would recur forever.
        parts += [(*side, None) for side in sides if side[0] <= side[1] and side != (low, high)]
    return best or _not_whole(heading, relaxed, failed)


def _with_periods(problem: Problem, heading: float, low: float, high: float) -> Problem:
    """The problem with bounds on the number of periods for the heading."""
    ends = sorted((heading / high, heading / low))
    turn = replace(problem.turn, heading=Interval(*ends)) if problem.turn else None
    return replace(problem, turn=turn)


def _not_whole(heading: float, relaxed: Optimum, failed: Optimum | None) -> Optimum:
    """No whole number of periods reaches the heading; reports the closest that does."""
    arc = arc_of(relaxed, heading)
    if arc is None or (failed and failed.status is not Status.INFEASIBLE):
        return failed or relaxed
    count = max(round(arc.periods), 1)
    nearest = math.degrees(heading / arc.periods * count)
    message = (
        f"No whole number of periods turns by {math.degrees(heading):.6g} deg on this circle "
        f"within the limits. The fastest gait there makes {nearest:.6g} deg in {count} "
        f"period{'s' if count > 1 else ''}. Ask for that heading, or leave out --cycles whole."
    )
    return Optimum(Status.INFEASIBLE, message, relaxed.problem)
