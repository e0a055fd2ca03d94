"""A controller that keeps the robot on its drive, updated once per period from a camera pose.

The drive is cut into periods. The state at the start of a period is linearised about the drive,

    z' = F (z, v lack) + B u,      y = H (z, v lack) + G u

except for one product, with z = (x, y, psi, v, lack, bias, A, o): the deviations of pose and speed
from the plan, in the planned frame of platform 1; two constants to be estimated, the missing
fraction of the friction and an offset error; and the corrections of amplitude and offset in force.
u are those at the period's end, y the pose observed `delay` before it. The speed lost to friction
is proportional to both, and if the friction is far from nominal, so is the speed: hence the
product.

A Kalman filter estimates z, a finite-horizon linear-quadratic regulator gives u, and its cost-to-go
tells whether to repeat or skip periods of a stage. Corrections saturate at the servo's limits.
The drive ends by coasting for as long as the robot is seen to move; its end is where it comes to
rest. The coasting distance is proportional to speed over friction, so v and the lack of friction
are divided by 1 - lack when corrections are chosen.
"""

import math
from dataclasses import dataclass, replace

import numpy as np

from rr_opt.array import Array
from rr_opt.model.command import Command
from rr_opt.model.problem import Problem
from rr_opt.model.route import Route, Tolerance
from rr_opt.motion.dynamics import dynamics_of
from rr_opt.routing.plan import RoutePlan
from rr_opt.routing.rollout import stepped
from rr_opt.verify.grid import reach

DELAY, NOISE = 0.05, (1e-3, 1e-3, 3e-3)
"""Delay, s, and noise (m, m, rad; 1 sigma) of the capture system."""
_LACK, _BIAS = 0.2, 0.02
"""Initial uncertainty of the lack of friction (relative) and of the offset error (rad), 1 sigma."""
_UNMODELLED = np.array([1e-3, 1e-3, 3e-3, 6e-3, 0.01, 1e-3])
"""Process noise: 1 sigma per period in the first six of z."""
_ACCURATE, _ON_THE_WAY = 3.0, 0.3
"""Tolerance over the error of cost 1: a third of it at the end, three times it on the way."""
_AMPLITUDE, _LEAST, _OFFSET, PERIOD = 0.07, 1e-3, 0.1, 0.2
"""Corrections of cost 1: of the amplitude, relative and in rad, as it stays between 0 and the rate
limit; of the offset, rad. And the cost of a period's time."""
_STEPS, _LATE = 13, 3
"""Integration steps in a period: until its pose is observed, and after."""
LOOKS, MARGIN = 96, 0.998
"""Places per period where limits are checked; and their share, as peaks lie in between."""
WAYS_BACK = 8
"""Steps back towards the offset in force that are tried to find a correction within limits."""
_RATE, _PLACE = 0.95, 0.5
"""Shares of the rate limit and of the end tolerance that the plan may use."""
_SHORT = 0.25
"""Aim point, as a share of the tolerance before the end: the robot can drive further, but cannot
brake."""
_COAST, _REST = 6, 4.0
"""Cycles of coasting after the robot is observed at rest, given the noise; and the time, relative
to coasting from the drive's speed, in which every robot comes to rest."""
LONGEST = 1.5
"""Most periods driven, relative to those planned, before the drive proceeds to its end."""
_STATES = 8
SLIPPERY = 0.2
"""Lowest credible friction, relative to nominal."""
_CHANGE = 1e-4
"""Relative change of the masses for finite differences."""


@dataclass(frozen=True)
class Feedback:
    """The controller of a drive of K periods.

    delay     s, from the time of a pose to the start of the period that uses it
    rest      m/s, below which the robot is at rest;  hold  the period repeated until it is
    limits    (3,): |phi| (rad), |dphi/dt| (rad/s), |d2phi/dt2| (rad/s2), the last for the torque
    command   the drive, a segment for each period
    group     (K + 1,): periods with the same number above 0 are interchangeable
    place     (K + 1, 3): x (m), y (m), psi (rad) where periods begin; speed (K + 1,), m/s, there
    seen      (K, 3): the planned pose, `delay` before the end of a period
    F, B, H, G    (K, 4, 9), (K, 4, 2), (K, 3, 9), (K, 3, 2); L (K, 6, 3) of the filter
    gain      (K, 2, 9): u = -gain (z, 1);  value (K + 1, 9, 9): matrix of the cost-to-go
    """

    delay: float
    rest: float
    hold: int
    limits: Array
    command: Command
    group: Array
    place: Array
    speed: Array
    seen: Array
    F: Array
    B: Array
    H: Array
    G: Array
    L: Array
    gain: Array
    value: Array


def controller(plan: RoutePlan, problem: Problem, delay: float = DELAY) -> Feedback:
    """The controller of a plan's drive. problem: with the limits on the corrections.

    Raises ValueError if the plan has no drive.
    """
    if plan.drive is None:
        raise ValueError("The plan has no drive.")
    rests = plan.route.end == "rest"
    command, group = _periods(plan.drive.command, rests=rests)
    count = len(group) - 1
    dynamics = dynamics_of(problem.robot)
    p = dynamics.values(problem.robot)
    inert = np.isin(dynamics.parameters, ("m1", "m2", "I1", "I2"))
    start = plan.route.start
    v, pose = 0.0, np.array([start.x, start.y, start.heading + plan.turned])
    place, speed, seen, maps = [pose], [v], [], []
    driven = list(command.segments.T)
    if rests and plan.coasting:
        coasts = np.array([0, 0, 1, 0, 0, 1, 0, _REST * plan.coasting.seconds])
        driven.append(coasts)
    for u in driven:
        late = max(0.0, 1 - delay / u[7])
        steps = math.ceil(_STEPS * max(1.0, u[7] * u[2] / (2 * math.pi)))
        grid = np.append(np.linspace(0, late, steps), np.linspace(late, 1, _LATE + 1)[1:])
        out, heavy, light = (
            stepped(dynamics.effects, np.where(inert, p * (1 + e), p), v, u, grid)
            for e in (0.0, _CHANGE, -_CHANGE)
        )
        # More mass acts like less friction, for any friction law.
        by_lack = (heavy[:2] - light[:2]) / (2 * _CHANGE)
        (H, G), ends = (_map(out[:, :, k], by_lack[:, :, k]) for k in (steps - 2, -1))
        # A pose from before the period carries no information on it.
        maps.append((*ends, H[:3] * (late > 0), G[:3] * (late > 0)))
        seen.append(moved(pose, out[0, :, steps - 2]))
        pose, v = moved(pose, out[0, :, -1]), float(out[0, 0, -1])
        place.append(pose)
        speed.append(v)
    F, B, H, G = (np.array(part) for part in zip(*maps, strict=True))
    last = plan.legs[-1]
    aim = last.at(last.length - _SHORT * plan.route.tolerance.position)
    miss = -apart(np.array([aim.x, aim.y, plan.heading]), pose)
    amplitude = np.pad(command.knots[0], (0, 1))
    gain, value = _regulator(F, B, amplitude, miss, plan.route.tolerance)
    bend = _bend(problem, command, max(map(abs, speed)))
    box = np.array([reach(problem), problem.limits.rate, bend])
    at, of = slice(count + 1), slice(count)
    return Feedback(
        delay, plan.route.tolerance.speed, count - 1 - _COAST if rests else count, box, command,
        group, np.array(place)[at], np.array(speed)[at], np.array(seen)[of],
        F[of], B[of], H[of], G[of], _filter(F, H)[of], gain[of], value[at],
    )  # fmt: skip


def with_reserve(route: Route) -> Route:
    """The route to plan for, with reserves in rate and position for the corrections."""
    limits, tolerance = route.problem.limits, route.tolerance
    limits = replace(limits, rate=_RATE * limits.rate)
    tolerance = replace(tolerance, position=_PLACE * tolerance.position)
    return replace(route, problem=replace(route.problem, limits=limits), tolerance=tolerance)


def _periods(command: Command, *, rests: bool) -> tuple[Command, Array]:
    """The same drive cut into cycles, and which cycles are interchangeable. rests: the final
    coasting lasts some cycles more, all of them whole, and none may be skipped."""
    durations, knots, group = list[float](), [command.knots[:, 0]], [0]
    for number, u in enumerate(command.segments.T, 1):
        level = np.allclose(u[:3], u[3:6], rtol=0, atol=1e-12)
        cycles = u[7] * (u[2] + u[5]) / (4 * math.pi)
        coasts = rests and number == len(command.durations)
        if coasts:
            cycles = math.ceil(cycles) + _COAST
        whole = max(0, math.ceil(cycles - 1.5)) if level else 0
        period = 4 * math.pi / (u[2] + u[5])
        durations += [period] * whole + [(cycles - whole) * period]
        knots += [u[3:6]] * (whole + 1)
        alike = number if level and not coasts else 0
        group[-1] = alike
        group += [alike] * whole + [alike if cycles == whole + 1 else 0]
    return Command(np.array(durations), np.array(knots).T), np.array(group)


def moved(pose: Array, local: Array) -> Array:
    """A pose after a motion (v, psi, x, y) in its frame."""
    cos, sin = math.cos(pose[2]), math.sin(pose[2])
    x, y = local[2], local[3]
    return pose + np.array([cos * x - sin * y, sin * x + cos * y, local[1]])


def apart(pose: Array, planned: Array) -> Array:
    """A pose in the frame of another, its heading within half a turn."""
    cos, sin = math.cos(planned[2]), math.sin(planned[2])
    dx, dy, turn = pose - planned
    return np.array([cos * dx + sin * dy, cos * dy - sin * dx, math.remainder(turn, 2 * math.pi)])


def _map(out: Array, by_lack: Array) -> tuple[Array, Array]:
    """Rows x, y, psi, v of F and B from a motion (1 + 9, 4) in the frame of its start, and the
    derivatives (2, 4) of it and of its derivatives in v."""
    local, S = out[0], out[1:]
    d = np.zeros((11, 4))
    # A rotation at the start rotates the whole motion.
    d[0, 2], d[1, 3] = 1, 1
    d[2] = 0, 1, -local[3], local[2]
    d[3:] = S[0], by_lack[0], S[2] + S[5], S[1], S[2], by_lack[1], S[4], S[5]
    cos, sin = math.cos(local[1]), math.sin(local[1])
    v, psi, x, y = d.T
    rows = np.array([cos * x + sin * y, cos * y - sin * x, psi, v])
    return rows[:, : _STATES + 1], rows[:, _STATES + 1 :]


def _regulator(
    F: Array, B: Array, amplitude: Array, miss: Array, asked: Tolerance
) -> tuple[Array, Array]:
    """Gains and cost-to-go, by the Riccati recursion from the end. miss: rows x, y, psi of the
    planned end relative to the requested one. Along-track errors on the way cost nothing."""
    way, end = np.zeros((3, _STATES + 1)), np.zeros((3, _STATES + 1))
    np.fill_diagonal(way, [0.0, _ON_THE_WAY / asked.path, _ON_THE_WAY / asked.heading])
    np.fill_diagonal(end, 1.0)
    end[:, -1] = miss
    sizes = asked.position, asked.position, asked.heading
    end *= _ACCURATE / np.array(sizes)[:, None]
    P = end.T @ end
    gains, values = [], [P]
    for k in reversed(range(len(F))):
        # Besides the map's rows: the constants, and the corrections coming into force.
        A, b = np.diag([1.0] * 6 + [0.0] * 2 + [1.0]), np.zeros((_STATES + 1, 2))
        A[:4, :_STATES], b[:4], b[6, 0], b[7, 1] = F[k, :, :_STATES], B[k], 1, 1
        # The joint ends as planned.
        most = np.array([_LEAST + _AMPLITUDE * amplitude[k + 1], _OFFSET])
        cost = np.diag((1e6 if k == len(F) - 1 else 1) / most**2)
        gain = np.linalg.solve(cost + b.T @ P @ b, b.T @ P @ A)
        P = way.T @ way + A.T @ P @ (A - b @ gain)
        P = (P + P.T) / 2
        gains.append(gain)
        values.append(P)
    return np.array(gains[::-1]), np.array(values[::-1])


def _filter(F: Array, H: Array) -> Array:
    """Gains of the Kalman filter."""
    P = np.diag(np.square([*NOISE, 0.0, _LACK, _BIAS]))
    noise, gains = np.diag(np.square(NOISE)), []
    for k in range(len(F)):
        h, A = H[k, :, :6], np.eye(6)
        A[:4] = F[k, :, :6]
        L = np.linalg.solve(noise + h @ P @ h.T, h @ P).T
        P = A @ (P - L @ h @ P) @ A.T + np.diag(_UNMODELLED**2)
        gains.append(L)
    return np.array(gains)


def _bend(problem: Problem, command: Command, v: float) -> float:
    """The largest |d2phi/dt2|, rad/s2, for which the torque is within its limit at all angles and
    rates and at speeds up to half more than v, m/s; at least that of the drive."""
    most = float(np.abs(command.at(np.linspace(0, command.seconds, 20_000))[2]).max())
    dynamics = dynamics_of(problem.robot)
    p = dynamics.values(problem.robot)
    room, rate, limit = reach(problem), problem.limits.rate, problem.limits.torque
    if not math.isfinite(limit):
        return 1e6
    rate = rate if math.isfinite(rate) else float(np.abs(command.at(command.times)[1]).max())
    parts = [-1.5 * v, 0, 1.5 * v], np.linspace(-room, room, 41), [-rate, 0, rate]
    box = np.stack(np.meshgrid(*parts)).reshape(3, -1)

    def torque(bend: float) -> Array:
        inputs = [part[None] for part in (*box, np.full(box.shape[1], bend))]
        return np.asarray(dynamics.motion(*inputs, np.tile(p[:, None], box.shape[1]))[3]).ravel()

    still = torque(0.0)
    room_left = (limit - np.abs(still)) / np.maximum(np.abs(torque(1.0) - still), 1e-12)
    return max(most, float(room_left.min()))
