"""A whole drive as one nonlinear program in a few unknowns.

The drive is a sequence of stages. A stage first blends amplitude, offset and frequency from those
of the stage before, over one cycle, and then goes on with them: its unknowns are for how many
cycles, and the three. The first begins from the joint at rest; the last holds it straight and lets
the robot coast. Minimised is the time of the drive. Bounded are

    angle, rate, torque      of the servo, and the grip of the wheels, at their peaks
    the way                  P's distance from the path, and from the end of each leg when it is due
    the end                  place, heading, speed

The motion and all derivatives are those of `rollout`; the solver is sequential linear, then
quadratic, programming.
"""

import math
from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import lru_cache

import casadi as ca
import numpy as np
from scipy.optimize import linprog, minimize, nnls

from rr_opt.array import Array
from rr_opt.model.command import Command, blended
from rr_opt.model.problem import Problem
from rr_opt.model.route import Pose, Tolerance
from rr_opt.routing.path import Leg, signed_distance
from rr_opt.routing.rollout import LOADS, Samples, rollout, steps_for
from rr_opt.verify.grid import reach

_UNKNOWNS = 4
"""Of a stage: cycles after the blend, amplitude (rad), offset (rad), frequency (rad/s). Counted in
cycles, the phases at which blends begin do not depend on the frequencies, and the program is nearly
linear."""
_LOOKS, _CLOSE = 12, 1e-4
"""Parts of a blend in each of which the largest rate is bounded."""
_INSIDE = 0.97
"""The program keeps to this share of each tolerance: steps are finite."""
_TIGHT = 0.999
"""The program keeps to this share of each limit: its bounds are good to `BROKEN`."""
BROKEN = 1e-3
"""By so much, relative, a bound may be broken, and the drive counts as keeping it."""
_TURNS, _TURN = 6, 0.5
"""Gauss-Newton steps for a stage of the guess, and the longest, in scaled unknowns."""
_TIGHTENED, _DENSE = 3, 0.99
"""Solutions with the way bounded more tightly, until P stays so near the path at all samples."""
_LINEAR, _QUADRATIC = 40, 80
_ACTIVE = 1e-4
"""Of bounds that take part in the prices, what is left at most, relative."""
_NUDGE = 1e-6
"""A change of the limit on singularity, relative."""
_LOST = 1e3
"""What counts as the excess where there is no motion."""
_PENALTY, _RADIUS, _SMALLEST, _SETTLED = 10.0, 0.5, 1e-5, 1e-8
"""Most steps of either kind; penalty over the time of the guess; trust region of the scaled
unknowns, at first and at last; gain of time, s, of the last step."""
_PLACES, _BETWEEN = 100, 0.93
"""About how many places have a bound on the distance from the path, and the share of the tolerance
that it is: between them P swings with the gait."""


@dataclass(frozen=True)
class DriveStage:
    """A stage of the drive: guesses of its unknowns, the leg it is on, whether its end is that of
    the leg, whether its amplitude and frequency are as guessed, and the fewest cycles that it
    takes."""

    cycles: float
    amplitude: float
    offset: float
    omega: float
    leg: Leg
    ends: bool = False
    fixed: bool = False
    fewest: float = 0.05

    @property
    def coasts(self) -> bool:
        """Whether the joint is held straight."""
        return self.fixed and self.amplitude == 0


@dataclass(frozen=True)
class SolvedDrive:
    """An answer of the solver.

    violation   largest share by which a bound is broken; where says which
    pieces      of the route, of every segment of the command
    prices      time saved per unit of each limit by which it is raised, s: rate, angle, torque,
                grip, singularity
    stationarity  what is left of the derivatives of the time, relative, when those of active bounds
                are taken off times their prices: 0 at an optimum
    """

    command: Command
    samples: Samples
    violation: float
    where: str
    piece: int
    iterations: int
    success: bool
    pieces: tuple[int, ...]
    prices: dict[str, float]
    stationarity: float


@dataclass(frozen=True)
class Look:
    """A drive with its time, s, and everything that has to be at least 0, relative; with their
    derivatives by the unknowns, and which bound of which piece it is."""

    command: Command
    seconds: float
    rising: Array
    samples: Samples
    values: Array
    slopes: Array
    names: list[tuple[str, int]]

    @property
    def violation(self) -> float:
        """The largest share by which a bound is broken."""
        return max(0.0, -float(self.values.min()))

    def rank(self) -> tuple[bool, float]:
        """Drives that keep all bounds go first, the fastest of them in front."""
        broken = self.violation > BROKEN
        return broken, self.violation if broken else self.seconds


class _Rows:
    """Gathers what has to be at least 0, its derivatives, and its names with pieces."""

    def __init__(self) -> None:
        self.values: list[Array] = []
        self.slopes: list[Array] = []
        self.names: list[tuple[str, int]] = []

    def at_most(
        self, name: str, pieces: list[int], value: Array, slopes: Array, limit: float
    ) -> None:
        """value <= limit."""
        self.values.append(1 - value / limit)
        self.slopes.append(-slopes / limit)
        self.names += [(name, piece) for piece in pieces]

    def within(
        self, name: str, pieces: list[int], value: Array, slopes: Array, limit: float
    ) -> None:
        """|value| <= limit."""
        self.at_most(name, pieces, value, slopes, limit)
        self.at_most(name, pieces, -value, -slopes, limit)

    def near(self, name: str, leg: Leg, samples: Samples, at: int, within: float) -> None:
        """P at a sample lies in an octagon about the end of a leg, within a circle: that is linear
        in the place."""
        end = leg.end
        angles = end.heading + np.arange(8) * math.pi / 4
        normals = np.stack([np.cos(angles), np.sin(angles)], axis=1)
        apart = normals @ (samples.path[2:4, at] - [end.x, end.y])
        slopes = normals @ samples.slopes[2:4, at]
        self.at_most(name, [leg.piece] * 8, apart, slopes, within * math.cos(math.pi / 8))


class DriveProgram:
    """The program of a sequence of stages."""

    def __init__(
        self,
        problem: Problem,
        stages: list[DriveStage],
        tolerance: Tolerance,
        pose: Pose,
        turned: float,
        rest: bool,
    ):
        """turned: heading of platform 1 against the path's; rest: whether it has to stop."""
        self.problem, self.stages, self.tolerance = problem, stages, tolerance
        self.start = (pose.x, pose.y, pose.heading + turned)
        self.turned, self.rest = turned, rest
        self.width = tolerance.path * _BETWEEN
        limits = problem.limits
        self.loads = [k for k, name in enumerate(LOADS) if math.isfinite(getattr(limits, name))]
        guess = np.array([[s.cycles, s.amplitude, s.offset, s.omega] for s in stages])
        self.scale = np.tile([4.0, 0.2, 0.2, 0.0], len(stages))
        self.scale[3::4] = guess[:, 3]
        self.x0 = guess.ravel() / self.scale
        self.steps = steps_for(self.command(guess.ravel()))

    def command(self, z: Array) -> Command:
        """The command of the unknowns, SI."""
        cycles, amplitude, offset, omega = z.reshape(-1, _UNKNOWNS).T
        knots = np.stack([np.repeat(part, 2) for part in (amplitude, offset, omega)])
        knots = np.hstack([[[0.0], [0.0], [omega[0]]], knots])
        turns = np.stack([np.ones(len(cycles)), cycles], axis=1).ravel()
        return Command(4 * math.pi * turns / (knots[2, :-1] + knots[2, 1:]), knots)

    def slopes(self, command: Command) -> Array:
        """Derivatives (8, N, z) of the command's segments by the unknowns."""
        n = len(self.stages)
        d = np.zeros((8, 2 * n, n * _UNKNOWNS))
        for k in range(n):
            for row in range(3):
                own = k * _UNKNOWNS + 1 + row
                d[3 + row, 2 * k, own] = d[row, 2 * k + 1, own] = d[3 + row, 2 * k + 1, own] = 1
                if k:
                    d[row, 2 * k, own - _UNKNOWNS] = 1
        d[2, 0, 3] = 1
        u = command.segments
        both = u[2] + u[5]
        d[7] = -(d[2] + d[5]) * (u[7] / both)[:, None]
        for k in range(n):
            d[7, 2 * k + 1, k * _UNKNOWNS] = 4 * math.pi / both[2 * k + 1]
            d[6, 2 * k + 2 :, k * _UNKNOWNS] = 2 * math.pi
        return d

    def look(self, x: Array) -> Look:
        """The drive of the scaled unknowns and everything that has to be at least 0."""
        with np.errstate(over="ignore", invalid="ignore"):
            return self._look(x)

    def _look(self, x: Array) -> Look:
        z = x * self.scale
        command = self.command(z)
        slopes = self.slopes(command)
        samples = rollout(
            self.problem.robot, command, slopes, self.steps, self.start, loads=self.loads
        )
        rows = _Rows()
        limits, tolerance = self.problem.limits, self.tolerance
        pieces = [stage.leg.piece for stage in self.stages]
        A, w, unit, room = z[1::4], z[3::4], np.eye(len(z)), reach(self.problem)
        for sign in (1, -1):
            gradient = unit[1::4] + sign * unit[2::4]
            rows.at_most("angle", pieces, A + sign * z[2::4], gradient, room * _TIGHT)
        if math.isfinite(limits.rate):
            rate = limits.rate * _TIGHT
            gradient = unit[1::4] * w[:, None] + unit[3::4] * A[:, None]
            rows.at_most("rate", pieces, A * w, gradient, rate)
            blends = command.segments[:, ::2]
            found = _blend_rates().map(len(pieces))(blends, _fastest(blends))
            rates, by = (np.asarray(part) for part in found)
            gradient = by.reshape(_LOOKS, len(pieces), 8)
            gradient = np.einsum("lki,ikz->klz", gradient, slopes[:, ::2]).reshape(-1, len(z))
            of = np.repeat(pieces, _LOOKS).tolist()
            rows.within("rate", of, rates.T.ravel(), gradient, rate)
        of_segment = np.split(np.arange(len(samples.t)), np.cumsum(self.steps)[:-1])
        for k, peaks, by in zip(self.loads, samples.peaks, samples.peak_slopes, strict=True):
            of = np.repeat(pieces, peaks.size // len(pieces)).tolist()
            name = LOADS[k]
            limit = getattr(limits, name) * _TIGHT
            rows.at_most(name, of, peaks.ravel(), by.reshape(peaks.size, -1), limit)
        every = max(1, len(samples.t) // _PLACES)
        for k, stage in enumerate(self.stages):
            mine = np.concatenate(of_segment[2 * k : 2 * k + 2])
            some = mine[every // 2 :: every]
            off, by_x, by_y = signed_distance(stage.leg, *samples.path[2:4, some])
            gradient = (
                by_x[:, None] * samples.slopes[2, some] + by_y[:, None] * samples.slopes[3, some]
            )
            of = [stage.leg.piece] * len(some)
            rows.within("path", of, off, gradient, self.width)
            if stage.ends:
                last = stage is self.stages[-1]
                name, within = (
                    ("position", tolerance.position) if last else ("path", tolerance.path)
                )
                rows.near(name, stage.leg, samples, int(mine[-1]), within * _INSIDE)
        end, piece = samples.path[:, -1:], [pieces[-1]]
        psi = end[1] - self.heading(self.stages[-1].leg, steady=not self.rest)
        rows.within("heading", piece, psi, samples.slopes[1, -1:], tolerance.heading * _INSIDE)
        if self.rest:
            rows.within("speed", piece, end[0], samples.slopes[0, -1:], tolerance.speed * _INSIDE)
        # A step too far may lead through the singular posture, where there is no motion.
        values = np.nan_to_num(
            np.concatenate(rows.values), nan=-_LOST, posinf=-_LOST, neginf=-_LOST
        )
        gradients = np.nan_to_num(np.vstack(rows.slopes), posinf=0.0, neginf=0.0)
        rising = slopes[7].sum(axis=0)
        return Look(command, command.seconds, rising, samples, values, gradients, rows.names)

    @property
    def bounds(self) -> list[tuple[float, float]]:
        """Of the unknowns."""
        box = self.problem.gait
        room = reach(self.problem)
        found = []
        for stage in self.stages:
            omega = 2 * math.pi / box.period.high, 2 * math.pi / box.period.low
            amplitude, offset = (0.0, min(box.amplitude.high, room)), (-room, room)
            if stage.fixed:
                amplitude, omega = (stage.amplitude,) * 2, (stage.omega,) * 2
            if stage.coasts:
                offset = (0.0, 0.0)
            found += [(stage.fewest, math.inf), amplitude, offset, omega]
        return [(low / s, high / s) for (low, high), s in zip(found, self.scale, strict=True)]

    def solve(self, progress: Callable[[str], None]) -> SolvedDrive:
        """The fastest drive near the guess: linear steps until it keeps all bounds, as they lead
        there from far away, then sequential quadratic programming, which follows curved bounds."""
        low, high = np.array(self.bounds).T
        steps = 0

        def step(_: object = None) -> None:
            nonlocal steps
            steps += 1
            progress(f"drive, step {steps} of {_LINEAR + _QUADRATIC}")

        x = self._feasible(self._steered(low, high), low, high, step)
        seen: dict[bytes, Look] = {}

        def look(x: Array) -> Look:
            key = x.tobytes()
            if key not in seen:
                seen.clear()
                seen[key] = self.look(x)
            return seen[key]

        best, found_at, success = look(x), x, False
        for _ in range(_TIGHTENED):
            found = minimize(
                lambda x: (look(x).seconds, look(x).rising * self.scale),
                x,
                jac=True,
                method="SLSQP",
                bounds=list(zip(low, high, strict=True)),
                constraints={
                    "type": "ineq",
                    "fun": lambda x: look(x).values,
                    "jac": lambda x: look(x).slopes * self.scale,
                },
                callback=step,
                options={"maxiter": _QUADRATIC, "ftol": _SETTLED},
            )
            x = np.clip(found.x, low, high)
            if look(x).violation > BROKEN:
                x = self._feasible(x, low, high, step)
            here = look(x)
            if here.rank() < best.rank():
                best, found_at, success = here, x, bool(found.success)
            # Between the places that are bounded P may swing out.
            off = self._farthest(best.samples)
            if best.violation > BROKEN or off <= _DENSE * self.tolerance.path:
                break
            self.width *= _DENSE**2 * self.tolerance.path / off
            seen.clear()
            best, found_at = look(x), x
        worst = int(np.argmin(best.values))
        pieces = tuple(piece for stage in self.stages for piece in [stage.leg.piece] * 2)
        return SolvedDrive(
            best.command,
            best.samples,
            best.violation,
            *best.names[worst],
            steps,
            success,
            pieces,
            *self._prices(found_at, best),
        )

    def _prices(self, x: Array, look: Look) -> tuple[dict[str, float], float]:
        """The prices of limits at an answer, by non-negative least squares over active bounds, and
        its stationarity."""
        low, high = np.array(self.bounds).T
        active, unit = look.values < _ACTIVE, np.eye(len(x))
        sides = unit[:, x - low < _ACTIVE], -unit[:, high - x < _ACTIVE]
        gradient = look.rising * self.scale
        normals = np.hstack([(look.slopes[active] * self.scale).T, *sides])
        found, left = nnls(normals, gradient)
        total = dict.fromkeys(("angle", "rate", *LOADS), 0.0)
        for (name, _), one in zip(np.array(look.names, object)[active], found, strict=False):
            if name in total:
                total[name] += float(one)
        limits, room = self.problem.limits, reach(self.problem)
        prices = {name: one / getattr(limits, name) for name, one in total.items()}
        # The room of the angle ends at one limit or the other.
        prices["angle"] = total["angle"] / room if room == limits.angle else 0.0
        S = limits.singularity
        less = replace(self.problem, limits=replace(limits, singularity=S * (1 - _NUDGE)))
        prices["singularity"] = -total["angle"] / room * (reach(less) - room) / (S * _NUDGE)
        return prices, left / float(np.linalg.norm(gradient))

    def _farthest(self, samples: Samples) -> float:
        """The largest distance of P from the leg that it is on, at all samples, m."""
        off = 0.0
        for k, stage in enumerate(self.stages):
            mine = samples.segment // 2 == k
            found, *_ = signed_distance(stage.leg, *samples.path[2:4, mine])
            off = max(off, float(np.abs(found).max()))
        return off

    def heading(self, leg: Leg, *, steady: bool) -> float:
        """Of platform 1 at the end of a leg, rad: along the path, or as it is in steady motion."""
        along = leg.end.heading + self.turned
        return along + slip(self.problem, leg, self.turned) if steady else along

    def _steered(self, low: Array, high: Array) -> Array:
        """The guess with cycles and offset of stage after stage changed so that each ends near the
        end of its leg, by Gauss-Newton steps."""
        x = np.clip(self.x0, low, high)
        last = np.cumsum(self.steps)[1::2] - 1
        for k, stage in enumerate(self.stages):
            if not stage.ends or stage.coasts or stage.leg is self.stages[-1].leg:
                continue
            free = np.array([4 * k, 4 * k + 2])
            most = (reach(self.problem) - stage.amplitude) / self.scale[4 * k + 2]
            if k > 1 and not self.stages[k - 1].ends:
                free = np.append(free, 4 * k - 2)
            end = stage.leg.end
            goal = np.array([end.x, end.y, self.heading(stage.leg, steady=True)])
            weight = 1 / np.array([self.tolerance.path, self.tolerance.path, 0.1])
            best = math.inf
            place, move = x[free], np.zeros(len(free))
            for _ in range(_TURNS):
                x[free] = np.clip(place + move, low[free], high[free])
                x[free[1:]] = np.clip(x[free[1:]], -most, most)
                command = self.command(x * self.scale)
                part = Command(command.durations[: 2 * k + 2], command.knots[:, : 2 * k + 3])
                slopes = self.slopes(command)[:, : 2 * k + 2]
                steps = self.steps[: 2 * k + 2]
                seen = rollout(self.problem.robot, part, slopes, steps, self.start)
                miss = weight * (seen.path[[2, 3, 1], last[k]] - goal)
                if miss @ miss < best:
                    best, place = miss @ miss, x[free]
                    J = weight[:, None] * (seen.slopes[[2, 3, 1], last[k]] * self.scale)[:, free]
                    move = np.clip(np.linalg.lstsq(J, -miss, rcond=None)[0], -_TURN, _TURN)
                else:
                    move = move / 3
                if np.abs(move).max() < 0.01:
                    break
            x[free] = place
        return x

    def _feasible(self, x: Array, low: Array, high: Array, step: Callable[[], None]) -> Array:
        """Sequential linear programming in a trust region. The merit is the time with an exact
        penalty for the bound that is broken most."""
        here, radius = self.look(x), _RADIUS
        moves = np.tile([1.0, 0.3, 1.0, 0.1], len(self.stages))
        penalty = _PENALTY * here.seconds
        for _ in range(_LINEAR):
            if here.violation <= BROKEN or radius < _SMALLEST:
                break
            step()
            moved = linprog(
                np.append(here.rising * self.scale, penalty),
                A_ub=np.hstack([-here.slopes * self.scale, -np.ones((len(here.values), 1))]),
                b_ub=here.values,
                bounds=[
                    *zip(
                        np.maximum(low - x, -radius) * moves,
                        np.minimum(high - x, radius) * moves,
                        strict=True,
                    ),
                    (0.0, None),
                ],
            )
            if moved.x is None:
                break
            there = np.clip(x + moved.x[:-1], low, high)
            seen = self.look(there)
            before = here.seconds + penalty * here.violation
            expected = before - here.seconds - moved.fun
            gained = before - seen.seconds - penalty * seen.violation
            if gained > 0.05 * expected:
                x, here = there, seen
            if gained > 0.7 * expected:
                radius = min(2 * radius, _RADIUS)
            elif gained < 0.3 * expected:
                radius /= 3
        return x


def slip(problem: Problem, leg: Leg, turned: float) -> float:
    """beta of a leg's steady motion, rad: on a circle P moves at sin(beta) = c1 kappa to the axis
    of platform 1. turned: 0 if platform 1 leads, else pi."""
    beta = math.asin(max(-0.9, min(0.9, problem.robot.platform1.c * leg.curvature)))
    return beta if turned == 0 else -beta


def _fastest(blends: Array) -> Array:
    """Where the rate is largest in each of `_LOOKS` equal parts of blends (8, K): (_LOOKS, K).

    A parabola through the ends and the middle of a part has its vertex near the peak, which a step
    of Newton's method comes to. The rate is level there, so that its derivatives at a fixed place
    are those of the peak.
    """
    half = 0.5 / _LOOKS
    s = np.linspace(0, 1, 2 * _LOOKS + 1)[:, None]
    rate = blended(s, blends[:, None], np.sin, np.cos)[1]
    first, middle, last = rate[:-2:2], rate[1::2], rate[2::2]
    bend = first - 2 * middle + last
    moved = half / 2 * (first - last) / np.where(bend == 0, 1e-300, bend)
    places = s[1::2] + np.stack([np.full_like(moved, -half), moved, np.full_like(moved, half)])
    nearby = blended(places[1] + [[_CLOSE]], blends, np.sin, np.cos)[2]
    here = blended(places[1], blends, np.sin, np.cos)[2]
    change = np.where(nearby == here, 1e-300, nearby - here)
    places[1] = np.clip(places[1] - _CLOSE * here / change, places[0], places[2])
    sizes = np.abs(blended(places, blends, np.sin, np.cos)[1])
    return np.take_along_axis(places, sizes.argmax(axis=0)[None], axis=0)[0]


@lru_cache
def _blend_rates() -> ca.Function:
    """(u, s) -> the rates at `_LOOKS` places of a segment, and their derivatives by u."""
    u, s = ca.SX.sym("u", 8), ca.SX.sym("s", _LOOKS)
    parts = ca.vertsplit(u)
    rates = ca.vertcat(*(blended(s[k], parts, ca.sin, ca.cos)[1] for k in range(_LOOKS)))
    return ca.Function("rates", [u, s], [rates, ca.jacobian(rates, u)])
