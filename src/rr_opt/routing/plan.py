"""From a route to the fastest drive found: path, gaits of its legs, then one program of all."""

import math
from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np

from rr_opt.design.maximize_speed import maximize_speed
from rr_opt.model.gait import SineGait
from rr_opt.model.problem import Interval, Problem
from rr_opt.model.route import Arc, Route
from rr_opt.motion.dynamics import require_friction
from rr_opt.outcome import InputError, Status
from rr_opt.routing.gaits import Chart, Coasting, Way, binding_limits, chart, coasting
from rr_opt.routing.path import Leg, legs_of
from rr_opt.routing.program import BROKEN, DriveProgram, DriveStage, SolvedDrive, slip

Progress = Callable[[str], None]

_RADII = 8
"""Radii that are tried for the arcs to a waypoint."""
_SLOWEST, _SLEWED = 0.9, 0.35
"""A waypoint's circles are driven at no less than this share of the speed straight ahead, and with
platform 1 at no more than 20 deg to the path."""
_NEAR = 0.03
"""A drive that breaks a bound of the program by no more may yet be within the tolerance, which is
wider: the replay decides."""
_SWING = 0.4
"""Of the tolerance of the way, so much is for the swing of P with each period."""
_ENTRY = 0.1
"""m: a transition between curvatures has unknowns of its own for about so long."""
_LONGEST = 1.2
"""m: longer parts of a leg get an offset of their own, with which the drive is steered."""

_CREEP, _CREPT = 0.4, 8.0
"""Of the gait's amplitude, with which the robot comes to its end if it is to be steered there, as
what is left is driven at little more than 1/6 of the speed; and cycles of it."""


@dataclass(frozen=True)
class RoutePlan:
    """The answer to a route.

    problem   the route's, with the robot that drives: of a free inertia ratio the fastest
    legs      the path, as driven
    gaits     of each leg, as the drive begins from them; speeds in m/s, above 0
    coasting  what coasting alone takes, from the speed on the last leg
    """

    status: Status
    message: str
    route: Route
    problem: Problem
    way: Way
    legs: tuple[Leg, ...] = ()
    gaits: tuple[SineGait, ...] = ()
    speeds: tuple[float, ...] = ()
    coasting: Coasting | None = None
    drive: SolvedDrive | None = None

    @property
    def turned(self) -> float:
        """Heading of platform 1 against that of the path, rad."""
        return 0.0 if self.way == "forward" else math.pi

    @property
    def heading(self) -> float:
        """Of platform 1 at the end, rad: along the path, or as it is in steady motion."""
        along = self.legs[-1].end.heading + self.turned
        running = self.route.end == "running"
        return along + slip(self.problem, self.legs[-1], self.turned) if running else along


def plan_route(
    route: Route, progress: Progress = lambda _: None, *, creeps: bool = False
) -> RoutePlan:
    """The fastest drive found along a route. creeps: that comes to its end slowly.

    The status is OPTIMAL, INFEASIBLE (the message names piece, limit and what can be driven) or
    NOT_CONVERGED. Raises InputError for a robot without friction, and for a route without pieces.
    """
    if not route.pieces:
        raise InputError("Read a route without pieces. Expected at least one: `- straight: 1 m`.")
    require_friction(route.problem.robot)
    problem = route.problem
    if problem.inertia_ratio:
        progress("inertia ratio")
        fastest = maximize_speed(problem)
        problem = replace(problem, inertia_ratio=None)
        problem = problem.with_robot(fastest.robot) if fastest.robot else problem
    problem = _near_the_path(problem, route.tolerance.path)
    ways: tuple[Way, ...] = ("forward", "backward")
    ways = tuple(way for way in ways if route.direction in ("either", way))
    progress("gaits")
    charts: dict[Way, Chart] = {way: chart(problem, way) for way in ways}
    paths: dict[Way, list[Leg]] = {way: _path(route, charts[way]) for way in ways}

    def time(way: Way) -> float:
        return sum(leg.length * charts[way].cost(leg.curvature) for leg in paths[way])

    way = min(ways, key=time)
    if not math.isfinite(time(way)):
        return RoutePlan(Status.INFEASIBLE, _why_not(route, charts, paths), route, problem, way)
    legs = tuple(paths[way])
    found = [charts[way].fastest(leg.curvature) for leg in legs]
    gaits, speeds = zip(*(one for one in found if one), strict=True)
    sign = 1 if way == "forward" else -1
    coast = coasting(problem, sign * speeds[-1], route.tolerance.speed)
    plan = RoutePlan(Status.OPTIMAL, "", route, problem, way, legs, gaits, speeds, coast)
    best: SolvedDrive | None = None
    for brakes in (True, False) if route.end == "rest" else (False,):
        stages = _stages(plan, coast if route.end == "rest" else None, brakes=brakes, creeps=creeps)
        program = DriveProgram(
            problem, stages, route.tolerance, route.start, plan.turned, route.end == "rest"
        )
        drive = program.solve(progress)
        if best is None or _rank(drive) < _rank(best):
            best = drive
        if best.violation <= BROKEN:
            break
    assert best is not None
    plan = replace(plan, drive=best)
    if best.violation > _NEAR:
        message = (
            f"No drive was found. Piece {best.piece + 1} comes nearest to failing: its bound on "
            f"the {best.where} is exceeded by {100 * best.violation:.2g} %. "
            f"{_nearest_drive(plan, best)}Lengthen the piece, widen its radius, or widen the "
            "tolerance."
        )
        return replace(plan, status=Status.NOT_CONVERGED, message=message)
    return replace(plan, message="A drive that is locally the fastest and keeps every bound.")


def _nearest_drive(plan: RoutePlan, drive: SolvedDrive) -> str:
    """What the drive found keeps to instead, and why an arc from rest may need it.

    Forward, the axle of platform 1 leads. Until platform 1 points into the arc the axle moves away
    from the centre, at first at sqrt(R^2 + c1^2) from it; when it does no longer, P is c1 behind it
    and at right angles to its radius, so at sqrt(R^2 + 2 c1^2) at least.
    """
    told = ""
    if drive.violation <= drive.ease - 1 + BROKEN:
        told = (
            f"With {drive.ease:.3g} times the tolerances of position, heading and path it can be "
            "driven. "
        )
    first, c1 = plan.legs[0], plan.problem.robot.platform1.c
    width = plan.route.tolerance.path
    if plan.way == "forward" and first.curvature:
        radius = 1 / abs(first.curvature)
        out = math.hypot(radius, math.sqrt(2) * c1) - radius
        if out > width:
            told += (
                "Forward, on an arc from rest, P swings out until platform 1 has turned into it: "
                f"by {1e3 * out:.0f} mm or more at a radius of {radius:.4g} m (tolerance.path: "
                f"{1e3 * width:.4g}), by less from {c1**2 / width - width / 2:.3g} m on. Begin "
                "with a straight line. "
            )
    return told


def _near_the_path(problem: Problem, width: float) -> Problem:
    """The problem with amplitudes at which P swings by no more than its share of the tolerance.

    Where phi swings fast, platform 1 turns against it by c2/(c1 + c2) of it about its axle, which
    swings P by c1 of that.
    """
    c1, c2 = problem.robot.platform1.c, problem.robot.platform2.c
    box = problem.gait.amplitude
    most = max(box.low, min(box.high, _SWING * width * (c1 + c2) / (c1 * c2)))
    amplitude = Interval(box.low, most)
    return replace(problem, gait=replace(problem.gait, amplitude=amplitude))


def _rank(drive: SolvedDrive) -> tuple[bool, float]:
    broken = drive.violation > BROKEN
    return broken, drive.violation if broken else drive.command.seconds


def _path(route: Route, gaits: Chart) -> list[Leg]:
    """The path; waypoints by circles that the robot drives at a useful speed."""
    low, high = gaits.tightest
    most = min(-low, high)
    if most <= 0:
        return legs_of(route, gaits.cost, np.array([1.0]))
    most = min(0.97 * most, _SLEWED / gaits.problem.robot.platform1.c)
    curvatures = np.linspace(most / _RADII, most, _RADII)
    straight = gaits.cost(0.0)
    useful = [k for k in curvatures if gaits.cost(k) * _SLOWEST <= straight]
    return legs_of(route, gaits.cost, 1 / np.array(useful or [curvatures[0]]))


def _stages(
    plan: RoutePlan, coast: Coasting | None, *, brakes: bool, creeps: bool
) -> list[DriveStage]:
    """A guess: each part of a leg with its gait, then stages to brake, to creep, and to coast."""
    stages = list[DriveStage]()
    left = coast.distance if coast else 0.0
    parts = [
        (part, gait, speed)
        for leg, gait, speed in zip(plan.legs, plan.gaits, plan.speeds, strict=True)
        for part in leg.parts(_LONGEST)
    ]
    total = sum(part.length for part, *_ in parts)
    left = min(left, 0.7 * total)
    robot = plan.problem.robot
    lead = robot.platform1.c if plan.way == "forward" else robot.platform2.c
    driven, before = 0.0, math.nan

    def driving(gait: SineGait, speed: float, part: Leg, *ways: float) -> list[DriveStage]:
        shape = gait.amplitude * 0.999, gait.offset, 2 * math.pi / gait.period
        cycle = speed * gait.period
        return [DriveStage(max(way / cycle - 1, 0.1), *shape, part, way) for way in ways if way > 0]

    for k, (part, gait, speed) in enumerate(parts):
        length = min(part.length, max(total - left - driven, 0.05 * part.length))
        driven += part.length
        entry = leave = 0.0
        if part.curvature != before:
            # The launch, or a transition: until P moves at another angle to platform 1.
            entry = min(0.3 * length, _ENTRY)
        if k + 1 < len(parts) and parts[k + 1][0].curvature != part.curvature:
            # The axle that leads comes to the change of curvature before P does.
            leave = min(0.3 * length, lead)
        elif k + 1 == len(parts) and part.curvature and coast:
            # Platform 1 has to turn into the path before the robot stops.
            leave = min(0.3 * length, lead + _ENTRY)
        ways = [entry, length - entry - leave, leave]
        stages += driving(gait, speed, part, *ways)
        stages[-1] = replace(stages[-1], ends=True)
        before = part.curvature
    if coast:
        part, gait, speed = parts[-1]
        stages[-1] = replace(stages[-1], ends=False)
        if part.curvature:
            last = stages.pop()
            halves = driving(gait, speed, part, last.way / 2, last.way / 2)
            stages += [replace(one, offset=0.5 * gait.offset) for one in halves]
        omega = 2 * math.pi / gait.period
        if brakes and not creeps:
            shape = 0.1 * gait.amplitude, 0.5 * gait.offset, omega
            stages.append(DriveStage(0.3 * coast.seconds / gait.period, *shape, part))
        if creeps:
            shape = _CREEP * gait.amplitude, 0.5 * gait.offset, omega
            stages.append(DriveStage(_CREPT, *shape, part, fixed=True, fewest=_CREPT))
        cycles = 0.7 * coast.seconds / gait.period
        last = DriveStage(cycles, 0.0, 0.0, omega, part, fixed=True, straight=creeps)
        if part.curvature and not creeps:
            # Bent, the joint leads along an arc; bent anew, it turns platform 1.
            stages.append(replace(last, cycles=max(0.5 * cycles, 0.1)))
            last = replace(last, cycles=max(0.5 * cycles - 1, 0.1))
        stages.append(replace(last, ends=True))
    return stages


def _why_not(route: Route, charts: dict[Way, Chart], paths: dict[Way, list[Leg]]) -> str:
    """Which piece cannot be driven, by which limit, and the nearest that can."""
    reasons = []
    for way, gaits in charts.items():
        bad = [leg for leg in paths[way] if not math.isfinite(gaits.cost(leg.curvature))]
        low, high = gaits.tightest
        if low == high == 0:
            reasons.append(f"no gait within the limits drives {way}")
            continue
        leg = bad[0]
        what = "an arc" if isinstance(route.pieces[leg.piece], Arc) else "the way"
        circle = f"of radius {1 / abs(leg.curvature):.4g} m" if leg.curvature else "straight ahead"
        limits = binding_limits(gaits.problem, way, leg.curvature)
        by = f" (in the way: {', '.join(f'limits.{name}' for name in limits)})" if limits else ""
        nearest = _nearest(gaits, leg.curvature)
        reasons.append(f"{way}, piece {leg.piece + 1}, {what} {circle}, has no gait{by}; {nearest}")
    return "The route cannot be driven: " + ". And ".join(reasons) + "."


def _nearest(gaits: Chart, curvature: float) -> str:
    """The circle nearest to one that cannot be driven."""
    same = np.sort(gaits.curvature[np.isfinite(gaits.curvature)])
    for k in same[np.argsort(np.abs(same - curvature))[:2000:20]]:
        if gaits.fastest(float(k)):
            side = "left" if k > 0 else "right"
            return f"the nearest that has one is a radius of {1 / abs(k):.4g} m to the {side}"
    return "no circle has one"
