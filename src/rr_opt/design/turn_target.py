"""What turn a user asks for, what it asks of a gait, and both in words.

Left is positive, counter-clockwise seen from above, whichever way the robot drives. A heading
change and the circle it is made on have one sign, so of the two the heading says it.
"""

import math
from dataclasses import dataclass, replace

from rr_opt.design.decisions import reach_before_singularity
from rr_opt.model.gait import SineGait
from rr_opt.model.problem import ANY, Interval, Problem, Turn
from rr_opt.outcome import InputError

LARGEST_RADIUS = 1000.0
"""m; a wider circle is straight to a robot of this kind, and to the solver's tolerance."""


@dataclass(frozen=True)
class Target:
    """A circle, or an arc of one.

    heading   change of heading, rad, positive to the left; None: round and round
    radius    of the circle, m; positive to the left where no heading says the side
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
        """What the gait has to do."""
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
    """So much or more, on the same side."""
    return Interval(value, math.inf) if value > 0 else Interval(-math.inf, value)


def checked(target: Target) -> Target:
    """The target, its radius positive where a heading says the side.

    Raises InputError for what is no target, or for two that contradict each other.
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
    """The problem with the turn, and whether its offset was fixed and is now open: as far as
    the limits and the least amplitude allow, to either side."""
    problem = replace(problem, turn=target.turn)
    if not problem.gait.offset.fixed:
        return problem, False
    limits = problem.limits
    reach = min(limits.angle, reach_before_singularity(problem.robot, limits.singularity), math.pi)
    room = reach - problem.gait.amplitude.low
    if room <= 0:
        return problem, False
    return replace(problem, gait=replace(problem.gait, offset=Interval(-room, room))), True


SURE = 2e-3
"""The search is good to a few parts in ten thousand; what is reported as feasible, is."""


@dataclass(frozen=True)
class Nearest:
    """The gait that comes nearest to a turn within all limits, and what it does.

    speed    signed, m/s
    torque   largest, N m; share: of the ballast's range
    distance from the turn, relative
    """

    gait: SineGait
    share: float
    speed: float
    curvature: float
    yaw_rate: float
    heading: float
    torque: float
    distance: float


def asked_text(turn: Turn) -> str:
    """What is asked, in words."""
    parts = []
    if turn.curvature != ANY:
        parts.append(_radius(_binding(turn.curvature), not turn.curvature.fixed))
    if turn.yaw_rate != ANY:
        rate = _binding(turn.yaw_rate)
        parts.append(f"at least {abs(rate):.4g} rad/s to the {side(rate)}")
    if turn.heading != ANY:
        each = _binding(turn.heading)
        parts.append(f"{abs(each):.4g} rad a period to the {side(each)}")
    return " with ".join(parts)


def reached_text(turn: Turn, nearest: Nearest) -> str:
    """The same of what can be reached, rounded away from what cannot."""
    parts = []
    for name, asked in (
        ("curvature", turn.curvature),
        ("yaw_rate", turn.yaw_rate),
        ("heading", turn.heading),
    ):
        if asked == ANY:
            continue
        value = getattr(nearest, name)
        # Nearer to the asked value is infeasible: a little further away is reported.
        value *= 1 - math.copysign(SURE, (asked.clip(value) - value) * value)
        text = {
            "curvature": _radius(value, False),
            "yaw_rate": f"{abs(value):.4g} rad/s to the {side(value)}",
            "heading": f"{abs(value):.4g} rad a period to the {side(value)}",
        }
        parts.append(text[name])
    return " with ".join(parts)


def side(value: float) -> str:
    """Which way a positive or negative turn goes."""
    return "left" if value > 0 else "right"


def _binding(asked: Interval) -> float:
    """The end of an interval that asks for something: a finite one, the nearest to straight."""
    ends = [end for end in (asked.low, asked.high) if math.isfinite(end)]
    return min(ends, key=abs)


def _radius(curvature: float, at_most: bool) -> str:
    """`a radius of 0.3 m to the left`."""
    most = "at most " if at_most else ""
    return f"a radius of {most}{abs(1 / curvature):.4g} m to the {side(curvature)}"
