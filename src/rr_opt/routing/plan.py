"""From a route to the fastest drive found: path, gaits of its legs, then one program for it all."""

import itertools
import math
from dataclasses import dataclass, replace

import numpy as np
from scipy.optimize import root_scalar

from rr_opt.design.families import Progress
from rr_opt.design.maximize_speed import maximize_speed
from rr_opt.model.gait import SineGait
from rr_opt.model.problem import Interval, Problem
from rr_opt.model.route import Arc, Route
from rr_opt.motion.dynamics import require_friction
from rr_opt.outcome import InputError, Status
from rr_opt.routing.gaits import Chart, Coasting, Way, binding_limits, chart, coasting
from rr_opt.routing.path import Leg, legs_of
from rr_opt.routing.program import BROKEN, DriveProgram, DriveStage, FoundDrive, SolvedDrive, slip

_RADII = 8
"""Radii tried for the arcs to a waypoint."""
_SLOWEST, _SLEWED = 0.9, 0.35
"""A waypoint's circles are driven at no less than this share of the straight-line speed, and with
platform 1 at no more than 20 deg to the path."""
_NEAR = 0.03
"""A drive that violates the program by no more than this may still be within the wider tolerance,
which the replay decides."""
_SWING = 0.4
"""Share of the path tolerance reserved for the swing of P within each period."""
_LATE, _TURNED = (0.0, 0.0), (math.exp(-1), 1 - math.exp(-1))
"""Share of a change of curvature that the initial guess makes before, and on, the last part of a
leg, which is as long as the leading axle is ahead of P. The second choice keeps P on the path."""
_STARTS = (
    (True, (4.0, 2.0), _LATE),
    (True, (4.0, 2.0, 1.4, 1.0), _TURNED),
    (True, (3.0, 1.0), _TURNED),
    (False, (4.0, 2.0), _LATE),
)
"""Different starts lead to different local optima: whether a stage brakes, and the successive
factors on the tolerances. A route with bends tries two, a straight one the last, and more until
there is a drive."""
_ENTRY = 0.1
"""m: length of a transition between curvatures, which has unknowns of its own."""
_LONGEST = 1.2
"""m: longer legs are split into parts with an offset of their own, for steering."""

_CREEP, _CREPT = 0.4, 8.0
"""Fraction of the gait's amplitude for creeping to the end where position matters, at little more
than 1/6 of the speed; and cycles of it."""


@dataclass(frozen=True)
class RoutePlan:
    """The answer to a route.

    problem   the route's, with the robot that drives: a free inertia ratio is set to the fastest
    legs      the path, as driven
    gaits     of each leg, for the initial guess of the drive; speeds in m/s, above 0
    coasting  coasting from the speed on the last leg
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
        """Heading of platform 1 relative to the path, rad."""
        return 0.0 if self.way == "forward" else math.pi

    @property
    def heading(self) -> float:
        """Heading of platform 1 at the end, rad: along the path, or that of steady motion."""
        along = self.legs[-1].end.heading + self.turned
        running = self.route.end == "running"
        beta = slip(self.problem, self.legs[-1].curvature, self.turned)
        return along + beta if running else along


def plan_route(
    route: Route, progress: Progress = lambda _: None, *, creeps: bool = False
) -> RoutePlan:
    """The fastest drive found along a route. creeps: approaching its end slowly.

    The status is OPTIMAL, INFEASIBLE (the message names piece, limit and what can be driven) or
    NOT_CONVERGED. Raises InputError for a robot without friction, and for a route without pieces.
    """
    if not route.pieces:
        raise InputError("Read a route without pieces. Expected at least one: `- straight: 1 m`.")
    require_friction(route.problem.robot)
    problem = route.problem
    ways: tuple[Way, ...] = ("forward", "backward")
    ways = tuple(way for way in ways if route.direction in ("either", way))
    if problem.inertia_ratio:
        progress("inertia ratio")
        fastest = maximize_speed(problem)
        if fastest.robot is None:
            return RoutePlan(fastest.status, fastest.message, route, problem, ways[0])
        problem = replace(problem, inertia_ratio=None).with_robot(fastest.robot)
    problem = _near_the_path(problem, route.tolerance.path)
    progress("gaits")
    charts: dict[Way, Chart] = {way: chart(problem, way) for way in ways}
    paths: dict[Way, list[Leg]] = {way: _path(route, charts[way]) for way in ways}

    def time(way: Way) -> float:
        return sum(leg.length * charts[way].cost(leg.curvature) for leg in paths[way])

    way = min(ways, key=time)
    if not math.isfinite(time(way)):
        return RoutePlan(Status.INFEASIBLE, _why_not(route, charts, paths), route, problem, way)
    legs = tuple(paths[way])
    known = [charts[way].fastest(leg.curvature) for leg in legs]
    gaits, speeds = zip(*(one for one in known if one), strict=True)
    sign = 1 if way == "forward" else -1
    coast = coasting(problem, sign * speeds[-1], route.tolerance.speed)
    plan = RoutePlan(Status.OPTIMAL, "", route, problem, way, legs, gaits, speeds, coast)
    slows = coast if route.end == "rest" else None
    steps = itertools.count(1)

    def step() -> None:
        progress(f"drive, step {next(steps)}")

    doomed = _swings_out(plan) > route.tolerance.path
    bends = any(leg.curvature for leg in legs)
    found = list[tuple[FoundDrive, DriveProgram]]()
    for brakes, eases, turned in _STARTS if bends else reversed(_STARTS):
        stages = _stages(plan, charts[way], slows, turned, brakes=brakes, creeps=creeps)
        if found and stages == found[0][1].stages:
            continue
        program = DriveProgram(
            problem, stages, route.tolerance, route.start, plan.turned, slows is not None
        )
        one = program.find(step, eases)
        found.append((program.hurried(one, step) if bends else one, program))
        driven = any(one.look.violation <= BROKEN for one, _ in found)
        if len(found) > bends and (doomed or driven):
            break
    best, program = min(found, key=lambda one: one[0].rank())
    drive = program.solve(best, step)
    plan = replace(plan, drive=drive)
    if drive.violation > _NEAR:
        return _not_found(plan, drive)
    return replace(plan, message="A drive that is locally the fastest and keeps every bound.")


def _not_found(plan: RoutePlan, drive: SolvedDrive) -> RoutePlan:
    """The plan with a drive that violates bounds: why there is none, and what it would satisfy."""
    told = ""
    if drive.violation <= drive.ease - 1 + BROKEN:
        told = (
            f"With {drive.ease:.3g} times the tolerances of position, heading and path it can be "
            "driven. "
        )
    out, width = _swings_out(plan), plan.route.tolerance.path
    if out > width:
        radius = 1 / abs(plan.legs[0].curvature)
        message = (
            f"The route cannot be driven: on an arc of radius {radius:.4g} m from "
            "rest, forward and without backing up, P swings out until platform 1 has turned into "
            f"it, by {1e3 * out:.0f} mm or more (tolerance.path: {1e3 * width:.4g}). {told}Begin "
            "with a straight line, widen the radius, or widen the tolerance."
        )
        return replace(plan, status=Status.INFEASIBLE, message=message)
    message = (
        f"No drive was found. Piece {drive.piece + 1} comes nearest to failing: its bound on the "
        f"{drive.where} is exceeded by {100 * drive.violation:.2g} %. {told}Lengthen the piece, "
        "widen its radius, or widen the tolerance."
    )
    return replace(plan, status=Status.NOT_CONVERGED, message=message)


def _swings_out(plan: RoutePlan) -> float:
    """`swing_out` of a plan."""
    forward = plan.way == "forward"
    return swing_out(plan.legs[0], plan.problem.robot.platform1.c) if forward else 0.0


def swing_out(leg: Leg, c1: float) -> float:
    """The least distance, m, by which P leaves the path on a leg driven forward from rest, without
    reversing or turning on the spot, for any joint motion.

    Axle 1, c1 ahead of P, starts at rho = sqrt(R^2 + c1^2) from the centre of an arc. It moves
    along platform 1's axis, at an angle alpha outwards: d rho/ds = sin alpha. P is within B = R + w
    of the centre if sin alpha >= (rho^2 + c1^2 - B^2)/(2 c1 rho). If that is positive at the start,
    the axle moves out ever faster, up to rho = B + c1, which it reaches within
    c1 log(2 c1 (B + c1)/(R^2 + 2 c1^2 - B^2)): the arc has to be completed before that.
    """
    if not leg.curvature:
        return 0.0
    R = 1 / abs(leg.curvature)

    def missing(w: float) -> float:
        """Remaining length of the arc, m."""
        B, around = R + w, leg.length / R - math.asin(min(w / R, 1.0)) - math.atan(c1 / R)
        ratio = 2 * c1 * (B + c1) / (R**2 + 2 * c1**2 - B**2)
        return math.hypot(R, c1) * around - c1 * math.log(ratio)

    most = (1 - 1e-9) * (math.hypot(R, math.sqrt(2) * c1) - R)
    if missing(most) > 0:
        return most
    return root_scalar(missing, bracket=(0.0, most)).root if missing(0.0) > 0 else 0.0


def _near_the_path(problem: Problem, width: float) -> Problem:
    """The problem with amplitudes for which the swing of P is within its share of the tolerance.

    When phi swings fast, platform 1 counter-rotates about its axle by c2/(c1 + c2) of it, which
    moves P sideways by c1 times that.
    """
    c1, c2 = problem.robot.platform1.c, problem.robot.platform2.c
    box = problem.gait.amplitude
    most = max(box.low, min(box.high, _SWING * width * (c1 + c2) / (c1 * c2)))
    amplitude = Interval(box.low, most)
    return replace(problem, gait=replace(problem.gait, amplitude=amplitude))


def _path(route: Route, gaits: Chart) -> list[Leg]:
    """The path; waypoints are reached by circles that the robot drives at a useful speed."""
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
    plan: RoutePlan,
    gaits: Chart,
    coast: Coasting | None,
    turned: tuple[float, float],
    *,
    brakes: bool,
    creeps: bool,
) -> list[DriveStage]:
    """The initial guess: each part of a leg with its gait, then stages to brake, creep and coast.
    turned: share of the change of curvature made before, and on, the last part of a leg."""
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
        beta = slip(plan.problem, part.curvature, plan.turned)
        driven = [way for way in ways if way > 0]
        return [DriveStage(max(way / cycle - 1, 0.1), *shape, part, beta, way) for way in driven]

    for k, (part, gait, speed) in enumerate(parts):
        length = min(part.length, max(total - left - driven, 0.05 * part.length))
        driven += part.length
        entry = leave = 0.0
        after = parts[k + 1][0].curvature if k + 1 < len(parts) else 0.0
        if part.curvature != before:
            # Launch or transition: until the angle between P's motion and platform 1 has settled.
            entry = min(0.3 * length, _ENTRY)
        if k + 1 < len(parts) and after != part.curvature:
            # The leading axle reaches the change of curvature before P does.
            leave = min(0.3 * length, lead)
        elif k + 1 == len(parts) and part.curvature and coast:
            # Platform 1 has to align with the path before the robot stops.
            leave = min(0.3 * length, lead + _ENTRY)
        stages += driving(gait, speed, part, entry, length - entry - leave)
        if leave:
            now = slip(plan.problem, part.curvature, plan.turned)
            then = slip(plan.problem, after, plan.turned)
            stages[-1] = replace(stages[-1], slip=now + turned[0] * (then - now))
            mixed = gaits.fastest(part.curvature + turned[1] * (after - part.curvature))
            stages += driving(*(mixed or (gait, speed)), part, leave)
            if sum(turned):
                stages[-1] = replace(stages[-1], slip=then)
        stages[-1] = replace(stages[-1], ends=True)
        before = part.curvature
    if coast:
        part, gait, _ = parts[-1]
        last = replace(stages.pop(), ends=False)
        if part.curvature:
            # Half the offset, in two stages.
            last = replace(last, cycles=max((last.cycles - 1) / 2, 0.1), way=last.way / 2)
            last = replace(last, offset=0.5 * gait.offset)
            stages.append(last)
        stages += [last, *_stopping(part, gait, coast, brakes=brakes, creeps=creeps)]
    return stages


def _stopping(
    part: Leg, gait: SineGait, coast: Coasting, *, brakes: bool, creeps: bool
) -> list[DriveStage]:
    """The stages in which the robot comes to rest."""
    stages, omega = list[DriveStage](), 2 * math.pi / gait.period
    if brakes and not creeps:
        shape = 0.1 * gait.amplitude, 0.5 * gait.offset, omega
        stages.append(DriveStage(0.3 * coast.seconds / gait.period, *shape, part))
    if creeps:
        shape = _CREEP * gait.amplitude, 0.5 * gait.offset, omega
        stages.append(DriveStage(_CREPT, *shape, part, fixed=True, fewest=_CREPT))
    cycles = 0.7 * coast.seconds / gait.period
    last = DriveStage(cycles, 0.0, 0.0, omega, part, fixed=True, straight=creeps)
    if part.curvature and not creeps:
        # A bent joint steers along an arc; bending it again rotates platform 1.
        stages.append(replace(last, cycles=max(0.5 * cycles, 0.1)))
        last = replace(last, cycles=max(0.5 * cycles - 1, 0.1))
    return [*stages, replace(last, ends=True)]


def _why_not(route: Route, charts: dict[Way, Chart], paths: dict[Way, list[Leg]]) -> str:
    """Which piece cannot be driven, because of which limit, and the closest that can."""
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
        by = f" (blocked by {', '.join(f'limits.{name}' for name in limits)})" if limits else ""
        nearest = _nearest(gaits, leg.curvature)
        reasons.append(f"{way}, piece {leg.piece + 1}, {what} {circle}, has no gait{by}; {nearest}")
    return "The route cannot be driven: " + ". And ".join(reasons) + "."


def _nearest(gaits: Chart, curvature: float) -> str:
    """The drivable circle closest to one that is not."""
    same = np.sort(gaits.curvature[np.isfinite(gaits.curvature)])
    for k in same[np.argsort(np.abs(same - curvature))[:2000:20]]:
        if gaits.fastest(float(k)):
            side = "left" if k > 0 else "right"
            return f"the nearest feasible one is a radius of {1 / abs(k):.4g} m to the {side}"
    return "no circle is feasible"
