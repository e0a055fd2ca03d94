"""A whole drive as one nonlinear program in a few unknowns.

The drive is a sequence of stages. A stage first blends amplitude, offset and frequency from those
of the previous stage, over one cycle, and then holds them: its unknowns are these three and the
number of cycles. The first begins with the joint at rest; in the last the joint is held still and
the robot coasts. The objective is the time of the drive. The constraints are on

    angle, rate, torque      of the servo, and the grip of the wheels, at their peaks
    the way                  P's distance from the path, and from the end of each leg when it is due
    the end                  place, heading, speed

The motion and all derivatives are those of `rollout`. Levenberg-Marquardt steps find a feasible
drive, and sequential quadratic programming (SLSQP) the local optimum near it.
"""

import itertools
import math
from collections.abc import Callable, Sequence
from contextlib import suppress
from dataclasses import dataclass, replace
from functools import cached_property, lru_cache

import casadi as ca
import numpy as np
from numpy.typing import NDArray
from scipy.optimize import minimize, nnls

from rr_opt.array import Array
from rr_opt.model.command import Command, blended
from rr_opt.model.problem import Problem
from rr_opt.model.route import Pose, Tolerance
from rr_opt.motion.dynamics import dynamics_of
from rr_opt.routing.path import Leg, signed_distance
from rr_opt.routing.rollout import LOADS, STEPS, Samples, rollout, stepped, steps_for
from rr_opt.verify.grid import reach

_UNKNOWNS = 4
"""Unknowns of a stage: cycles after the blend, amplitude (rad), offset (rad), frequency (rad/s). In
units of cycles, the phases at which blends begin do not depend on the frequencies, and the program
is nearly linear."""
_LOOKS, _CLOSE = 12, 1e-4
"""Parts of a blend, in each of which the largest rate is bounded."""
_INSIDE, _ROOM = 0.97, 0.01
"""The share of each tolerance that the program uses, and the slack allowed: steps are finite."""
_TIGHT = 0.999
"""The share of each limit that the program uses, as bounds are satisfied only to `BROKEN`."""
BROKEN = 1e-3
"""Relative violation of a bound that still counts as satisfied."""
_SOFT = ("path", "position", "heading")
"""Bounds whose tolerances are relaxed while searching for a feasible drive."""
_MOST, _AIMED, _CREEPING = 3, 4, 1e-4
"""Most cycles of a stage, relative to those of steady speed plus five; corrections of them in the
initial guess; and shortest distance per cycle, m."""
_SPEED = 0.05
"""m/s: a speed gap between stages that weighs as much as the tolerances."""
_RESTORED, _DAMPED, _SOFTEST, _STIFFEST = 60, 1e-2, 1e-6, 1e6
"""Most Levenberg-Marquardt steps, and their damping: initial, least, largest."""
_MOVES = (1.0, 0.3, 1.0, 0.1)
"""Equally damped changes of a stage's scaled unknowns: steering is preferred to slowing."""
_HARD, _SPARE = 10.0, 2e-3
"""Weight of a violated limit relative to a violated tolerance; and the margin that steps aim at."""
_NEWTON, _SHORT = 30, 1e-4
"""Most Newton iterations within one of those steps, and the smallest step length."""
_ROUNDS, _QUADRATIC, _SETTLED = 5, 100, 1e-8
"""Sequential quadratic programming: rounds, iterations in each, and tolerance of the time, s."""
_HASTY, _GAIN, _WORTH, _STATIONARY = 12, 3e-5, 1e-4, 1e-3
"""Iterations in which a round must gain something while drives are compared (for the final optimum,
as many as there are unknowns); that gain; the gain of a round that warrants another, relative; and
the stationarity residual at an optimum."""
_JOINED = 1e-6
"""Gaps that count as closed, in units that weigh as much as the tolerances."""
_COST, _PENALTY = 12.0, 10.0
"""Scaled cost of the drive's time, for well-sized first steps; and, relative to it, the price of
doubling the tolerances."""
_FAR = 0.7
"""Loads with a larger relative margin are left out of a round."""
_ACTIVE = 1e-4
"""Largest relative margin of an active constraint."""
_NUDGE = 1e-6
"""Relative perturbation of the singularity limit."""
_LOST = 1e3
"""The violation assigned where there is no motion."""
_PLACES = 100
"""Approximate number of path sections, each with a bound on its largest distance."""


@dataclass(frozen=True)
class DriveStage:
    """A stage of the drive, with initial guesses of its unknowns.

    leg       the leg it is on
    slip      angle of P's motion to platform 1 at its end, rad
    way       length of the leg driven in the guess, m
    ends      whether it ends with the leg
    fixed     whether amplitude and frequency are fixed to the guess
    fewest    fewest cycles
    straight  whether it ends with the joint straight
    """

    cycles: float
    amplitude: float
    offset: float
    omega: float
    leg: Leg
    slip: float = 0.0
    way: float = 0.0
    ends: bool = False
    fixed: bool = False
    fewest: float = 0.05
    straight: bool = False


@dataclass(frozen=True)
class SolvedDrive:
    """A solution of the program.

    violation   largest relative violation of a bound; where says which
    pieces      the route's piece of every segment of the command
    prices      time saved per unit of each limit by which it is raised, s: rate, angle, torque,
                grip, singularity
    ease        factor on the tolerances of place, heading and way that it satisfies; 1: as asked
    stationarity  relative residual of the gradient of the time, less those of active constraints
                times their prices: 0 at an optimum
    """

    command: Command
    samples: Samples
    violation: float
    where: str
    piece: int
    pieces: tuple[int, ...]
    prices: dict[str, float]
    stationarity: float
    ease: float


@dataclass(frozen=True)
class Look:
    """A drive with its time, s, and all inequality constraints, >= 0, relative; with their
    derivatives by the unknowns, and the bound and piece of each.

    closing  first-order change of the values as gaps between stages are closed
    gaps     between stages: (v, psi, x, y), scaled to weigh as much as the tolerances
    """

    command: Command
    seconds: float
    rising: Array
    samples: Samples
    values: Array
    slopes: Array
    names: list[tuple[str, int]]
    closing: Array
    gaps: Array

    @cached_property
    def soft(self) -> Array:
        """1 for bounds on the place, the heading and the way, else 0."""
        return np.array([float(name in _SOFT) for name, _ in self.names])

    def spare(self, ease: float) -> Array:
        """The values with those tolerances widened by this factor."""
        return self.values + (ease - 1) * self.soft

    @cached_property
    def violation(self) -> float:
        """The largest relative violation of a bound, beyond the slack kept inside the
        tolerances."""
        room = np.array([_ROOM * (name in (*_SOFT, "speed")) for name, _ in self.names])
        return max(0.0, -float((self.values + room).min()))


@dataclass(frozen=True)
class FoundDrive:
    """Scaled unknowns, their drive, and the factor on the tolerances that it satisfies."""

    x: Array
    look: Look
    ease: float

    @property
    def cost(self) -> float:
        """The time, or the violation if bounds are violated."""
        broken = self.look.violation > BROKEN
        return self.look.violation if broken else self.look.seconds

    def rank(self) -> tuple[bool, float]:
        """Sort key: feasible drives first, by time."""
        return self.look.violation > BROKEN, self.cost


class _StalledError(Exception):
    """A round of SQP no longer makes progress."""


class _Rows:
    """Collects inequality constraints, >= 0, with derivatives, names and pieces."""

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
        """P at a sample lies in an octagon, inscribed in a circle, around the end of a leg: a
        linear constraint on its position."""
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
        """turned: heading of platform 1 relative to the path; rest: whether it has to stop."""
        self.problem, self.stages, self.tolerance = problem, stages, tolerance
        self.start = (pose.x, pose.y, pose.heading + turned)
        self.turned, self.rest = turned, rest
        limits = problem.limits
        self.loads = [k for k, name in enumerate(LOADS) if math.isfinite(getattr(limits, name))]
        guess = np.array([[s.cycles, s.amplitude, s.offset, s.omega] for s in stages])
        self.scale = np.tile([4.0, 0.2, 0.2, 0.0], len(stages))
        self.scale[3::4] = guess[:, 3]
        self.x0 = guess.ravel() / self.scale
        self.joined = np.array([_SPEED, tolerance.heading, tolerance.position, tolerance.position])
        self.discretise(self.x0)

    def discretise(self, x: Array) -> None:
        """Choose the number of integration steps for these unknowns."""
        self.steps = steps_for(self.command(x * self.scale))
        self.joints = np.cumsum(self.steps)[1:-1:2] - 1

    def command(self, z: Array) -> Command:
        """The command of the unknowns, SI."""
        cycles, amplitude, offset, omega = z.reshape(-1, _UNKNOWNS).T
        knots = np.stack([np.repeat(part, 2) for part in (amplitude, offset, omega)])
        knots = np.hstack([[[0.0], [0.0], [omega[0]]], knots])
        turns = np.stack([np.ones(len(cycles)), cycles], axis=1).ravel()
        return Command(4 * math.pi * turns / (knots[2, :-1] + knots[2, 1:]), knots)

    def slopes(self, command: Command) -> Array:
        """Derivatives (8, N, z) of the command's segments by the unknowns."""
        n, u = len(self.stages), command.segments
        # By the unknowns of each stage. Its first segment, a blend, begins as the one before ends.
        d, own, both = np.zeros((8, 2 * n, n, _UNKNOWNS)), np.eye(n), u[2] + u[5]
        for row in range(3):
            d[row, 1::2, :, 1 + row] = d[3 + row, ::2, :, 1 + row] = d[
                3 + row, 1::2, :, 1 + row
            ] = own
            d[row, 2::2, :, 1 + row] = own[:-1]
        d[2, 0, 0, 3] = 1
        d[7] = -(d[2] + d[5]) * (u[7] / both)[:, None, None]
        d[7, 1::2, :, 0] = np.diag(4 * math.pi / both[1::2])
        d[6, :, :, 0] = 2 * math.pi * (np.arange(n) < np.arange(2 * n)[:, None] // 2)
        return d.reshape(8, 2 * n, -1)

    @np.errstate(over="ignore", invalid="ignore")
    def look(self, x: Array, starts: Array | None = None) -> Look:
        """The drive of the scaled unknowns with all constraints. starts: v, psi, x, y of all stages
        but the first, if these do not continue the previous ones."""
        z = x * self.scale
        command = self.command(z)
        slopes = np.pad(self.slopes(command), ((0, 0), (0, 0), (0, 1)))
        given = {} if starts is None else {2 * k + 2: one for k, one in enumerate(starts)}
        samples = rollout(
            self.problem.robot, command, slopes, self.steps, self.start,
            loads=self.loads, starts=given,
        )  # fmt: skip
        rows = _Rows()
        limits, tolerance = self.problem.limits, self.tolerance
        pieces = [stage.leg.piece for stage in self.stages]
        A, unit, room = z[1::4], np.eye(len(z), len(z) + 1), reach(self.problem)
        for sign in (1, -1):
            gradient = unit[1::4] + sign * unit[2::4]
            rows.at_most("angle", pieces, A + sign * z[2::4], gradient, room * _TIGHT)
        if math.isfinite(limits.rate):
            self._rates(rows, command, slopes, z, pieces)
        of_segment = np.split(np.arange(len(samples.t)), np.cumsum(self.steps)[:-1])
        for k, peaks, by in zip(self.loads, samples.peaks, samples.peak_slopes, strict=True):
            of = np.repeat(pieces, peaks.size // len(pieces)).tolist()
            name = LOADS[k]
            limit = getattr(limits, name) * _TIGHT
            rows.at_most(name, of, peaks.ravel(), by.reshape(peaks.size, -1), limit)
        window = max(STEPS, len(samples.t) // _PLACES)
        for k, stage in enumerate(self.stages):
            mine = np.concatenate(of_segment[2 * k : 2 * k + 2])
            off, by_x, by_y = self.distance(k, *samples.path[2:4, mine])
            for sign in (1, -1):
                at, weights = _peaks_of(sign * off, window)
                value = (weights * off[at]).sum(axis=1)
                by = [weights[..., None] * part[at][..., None] for part in (by_x, by_y)]
                gradient = (by[0] * samples.slopes[2][mine[at]]).sum(axis=1)
                gradient += (by[1] * samples.slopes[3][mine[at]]).sum(axis=1)
                of = [stage.leg.piece] * len(at)
                rows.at_most("path", of, sign * value, sign * gradient, tolerance.path * _INSIDE)
            if stage.ends:
                last = stage is self.stages[-1]
                name, within = (
                    ("position", tolerance.position) if last else ("path", tolerance.path)
                )
                rows.near(name, stage.leg, samples, int(mine[-1]), within * _INSIDE)
        end, piece = samples.path[:, -1:], [pieces[-1]]
        leg = self.stages[-1].leg
        asked = leg.end.heading + self.turned
        if not self.rest:
            asked += slip(self.problem, leg.curvature, self.turned)
        psi = end[1] - asked
        rows.within("heading", piece, psi, samples.slopes[1, -1:], tolerance.heading * _INSIDE)
        if self.rest:
            rows.within("speed", piece, end[0], samples.slopes[0, -1:], tolerance.speed * _INSIDE)
        # Too long a step may pass through the singular posture, where there is no motion.
        values = np.nan_to_num(
            np.concatenate(rows.values), nan=-_LOST, posinf=-_LOST, neginf=-_LOST
        )
        gradients = np.nan_to_num(np.vstack(rows.slopes), posinf=0.0, neginf=0.0)
        gaps = np.zeros(0)
        if starts is not None:
            gaps = (samples.path[:, self.joints].T - starts) / self.joined
            gaps = np.nan_to_num(gaps.ravel(), nan=_LOST, posinf=_LOST, neginf=-_LOST)
        return Look(
            command, command.seconds, slopes[7].sum(axis=0)[:-1], samples, values,
            gradients[:, :-1], rows.names, gradients[:, -1], gaps,
        )  # fmt: skip

    def _rates(
        self, rows: _Rows, command: Command, slopes: Array, z: Array, pieces: list[int]
    ) -> None:
        """Bounds on the rate: A omega on a stage, and its peaks in parts of blends."""
        A, w, unit, rate = z[1::4], z[3::4], np.eye(len(z), len(z) + 1), self.problem.limits.rate
        rate *= _TIGHT
        gradient = unit[1::4] * w[:, None] + unit[3::4] * A[:, None]
        rows.at_most("rate", pieces, A * w, gradient, rate)
        blends, of = command.segments[:, ::2], np.repeat(pieces, _LOOKS).tolist()
        for sign in (1, -1):
            found = _blend_rates().map(len(pieces))(blends, _fastest(blends, sign))
            rates, by = (sign * np.asarray(part) for part in found)
            gradient = by.reshape(_LOOKS, len(pieces), 8)
            gradient = np.einsum("lki,ikz->klz", gradient, slopes[:, ::2])
            rows.at_most("rate", of, rates.T.ravel(), gradient.reshape(len(of), -1), rate)

    def distance(self, k: int, x: Array, y: Array) -> Array:
        """`signed_distance` of points of a stage: from its leg, or from the previous or next one
        where P is before or beyond it. (3, n)"""
        leg = self.stages[k].leg
        found = np.array(signed_distance(leg, x, y))
        legs = [one.leg for one in self.stages]
        before = next((one for one in legs[k::-1] if one is not leg), None)
        after = next((one for one in legs[k:] if one is not leg), None)
        for other, joint, sign in ((before, leg.start, -1), (after, leg.end, 1)):
            if other:
                cos, sin = math.cos(joint.heading), math.sin(joint.heading)
                away = sign * (cos * (x - joint.x) + sin * (y - joint.y)) > 0
                found[:, away] = signed_distance(other, x[away], y[away])
        return found

    @property
    def bounds(self) -> list[tuple[float, float]]:
        """Bounds of the unknowns."""
        box = self.problem.gait
        room = reach(self.problem)
        found = []
        for stage in self.stages:
            omega = 2 * math.pi / box.period.high, 2 * math.pi / box.period.low
            amplitude, offset = (0.0, min(box.amplitude.high, room)), (-room, room)
            if stage.fixed:
                amplitude, omega = (stage.amplitude,) * 2, (stage.omega,) * 2
            if stage.straight:
                offset = (0.0, 0.0)
            found += [(stage.fewest, _MOST * (stage.cycles + 5)), amplitude, offset, omega]
        return [(low / s, high / s) for (low, high), s in zip(found, self.scale, strict=True)]

    def find(self, step: Callable[[], None], eases: Sequence[float]) -> FoundDrive:
        """A drive near the initial guess: first feasible for a sequence of factors on the
        tolerances, then by sequential quadratic programming, which tightens them at a price."""
        x, starts = self.guess()
        for ease in eases:
            x, starts = self._restored(x, starts, ease, step)
        return self._fastest(x, step, _HASTY)

    def hurried(
        self,
        found: FoundDrive,
        step: Callable[[], None],
        patience: int = _HASTY,
        worth: float = _WORTH,
    ) -> FoundDrive:
        """A drive after rounds of SQP, until it is an optimum or a round gains less than is worth
        another."""
        for _ in range(_ROUNDS):
            if found.ease == 1 and self._prices(found)[1] < _STATIONARY:
                break
            after = self._fastest(found.x, step, patience)
            better = after.rank() < found.rank()
            gain, found = 1 - after.cost / found.cost, after if better else found
            if not better or gain < worth:
                break
        return found

    def solve(self, found: FoundDrive, step: Callable[[], None]) -> SolvedDrive:
        """The local optimum from a feasible drive."""
        found = self.hurried(found, step, len(found.x), worth=0.0)
        look = found.look
        worst = int(np.argmin(look.values))
        pieces = tuple(piece for stage in self.stages for piece in [stage.leg.piece] * 2)
        return SolvedDrive(
            look.command,
            look.samples,
            look.violation,
            *look.names[worst],
            pieces,
            *self._prices(found),
            found.ease,
        )

    def _prices(self, found: FoundDrive) -> tuple[dict[str, float], float]:
        """The shadow prices at a solution, by non-negative least squares over active constraints,
        and its stationarity residual."""
        low, high = np.array(self.bounds).T
        x, look = found.x, found.look
        active, unit = look.values < _ACTIVE, np.eye(len(x))
        sides = unit[:, x - low < _ACTIVE], -unit[:, high - x < _ACTIVE]
        gradient = look.rising * self.scale
        normals = np.hstack([(look.slopes[active] * self.scale).T, *sides])
        made, left = nnls(normals, gradient)
        total = dict.fromkeys(("angle", "rate", *LOADS), 0.0)
        for (name, _), one in zip(np.array(look.names, object)[active], made, strict=False):
            if name in total:
                total[name] += float(one)
        limits, room = self.problem.limits, reach(self.problem)
        prices = {name: one / getattr(limits, name) for name, one in total.items()}
        # The margin of the angle is bounded by one limit or the other.
        prices["angle"] = total["angle"] / room if room == limits.angle else 0.0
        S = limits.singularity
        less = replace(self.problem, limits=replace(limits, singularity=S * (1 - _NUDGE)))
        prices["singularity"] = -total["angle"] / room * (reach(less) - room) / (S * _NUDGE)
        return prices, left / float(np.linalg.norm(gradient))

    def guess(self) -> tuple[Array, Array]:
        """Initial unknowns and starts of stages, simulated one after another. Each begins on the
        path at the final speed of the previous one, platform 1 as in steady motion, with as many
        cycles as its length requires."""
        low, high = np.array(self.bounds).T
        z, starts = np.clip(self.x0, low, high) * self.scale, list[tuple[float, ...]]()
        v, driven, planned = 0.0, 0.0, 0.0
        for k, stage in enumerate(self.stages):
            leg = stage.leg
            if k and leg is not self.stages[k - 1].leg:
                driven = planned = 0.0
            planned += stage.way
            beta = stage.slip
            for _ in range(_AIMED if stage.way else 0):
                end, way = self._driven(k, z, v, beta)
                each = max(abs(end) / math.cos(beta) * 2 * math.pi / stage.omega, _CREEPING)
                cycles = z[4 * k] + (planned - driven - way) / each
                z[4 * k] = min(max(stage.fewest, cycles), _MOST * (stage.cycles + 5))
            v, way = self._driven(k, z, v, beta)
            driven = min(driven + way, leg.length)
            pose = leg.end if stage.ends else leg.at(driven)
            starts.append((v, pose.heading + self.turned + beta, pose.x, pose.y))
        return z / self.scale, np.array(starts[:-1]).reshape(-1, 4)

    def _driven(self, k: int, z: Array, v: float, beta: float) -> tuple[float, float]:
        """Final speed, m/s, of a stage that begins with v, and distance driven by P, m."""
        dynamics, way = dynamics_of(self.problem.robot), 0.0
        p = dynamics.values(self.problem.robot)
        for u in self.command(z).segments[:, 2 * k : 2 * k + 2].T:
            count = max(6, math.ceil(STEPS * u[7] * (u[2] + u[5]) / (4 * math.pi)))
            seen = stepped(dynamics.effects, p, v, u, np.arange(count + 1) / count)[0, 0]
            way += u[7] * (seen.sum() + (v - seen[-1]) / 2) / count
            v = float(seen[-1])
        return v, abs(way) / math.cos(beta)

    def _restored(
        self, x: Array, starts: Array | None, ease: float, step: Callable[[], None]
    ) -> tuple[Array, Array | None]:
        """Levenberg-Marquardt steps on violated bounds and gaps between stages, until there are
        none. Stages start from the linear model's prediction or, if better, continue the previous
        ones."""
        low, high = np.array(self.bounds).T

        def merit(look: Look) -> float:
            broken = weights(look) * np.maximum(_SPARE - look.spare(ease), 0.0)
            return float(broken @ broken + look.gaps @ look.gaps) / 2

        def weights(look: Look) -> Array:
            return np.where(look.soft, 1.0, _HARD)

        damping, moves = _DAMPED, np.tile(_MOVES, len(self.stages))
        self.discretise(x)
        here = self.look(x, starts)
        for _ in range(_RESTORED):
            apart = np.abs(here.gaps).max(initial=0.0)
            if (here.spare(ease).min() >= -BROKEN and apart < _JOINED) or damping > _STIFFEST:
                break
            step()
            J = weights(here)[:, None] * here.slopes * self.scale * moves
            values = weights(here) * (here.spare(ease) + here.closing - _SPARE)
            move, left = _least(J, values, damping, (low - x) / moves, (high - x) / moves)
            move = move * moves
            there, then = np.clip(x + move, low, high), None
            seen = self.look(there)
            if starts is not None:
                change = here.samples.slopes[:, self.joints] @ np.append(move * self.scale, 1.0)
                then = (here.samples.path[:, self.joints] + change).T
                apart = self.look(there, then)
                if merit(apart) < merit(seen):
                    seen = apart
                else:
                    then = seen.samples.path[:, self.joints].T
            expected, gained = merit(here) - left, merit(here) - merit(seen)
            if gained > 0.05 * max(expected, 0.0):
                x, starts = there, then
                self.discretise(x)
                here = self.look(x, starts)
                damping = max(damping / 5, _SOFTEST) if gained > 0.6 * expected else damping
            else:
                damping *= 6
        return x, starts

    def _fastest(self, x: Array, step: Callable[[], None], patience: int) -> FoundDrive:
        """SLSQP on the time, with a price on widened tolerances."""
        low, high = np.array(self.bounds).T
        self.discretise(x)
        seen: dict[bytes, Look] = {}

        def look(y: Array) -> Look:
            key = y[:-1].tobytes()
            if key not in seen:
                seen.clear()
                seen[key] = self.look(y[:-1])
            return seen[key]

        def stepped(y: Array) -> None:
            nonlocal best, at, driven
            step()
            broken = max(0.0, -float(look(y).spare(y[-1]).min()))
            cost = look(y).seconds / unit + price * (y[-1] + broken)
            if cost < best:
                best, at, driven = cost, y.copy(), y[-1] + broken <= 1 + BROKEN
            # An infeasible drive is given more iterations.
            history.append(best if driven else math.inf)
            if len(history) > patience and history[-1 - patience] - best < _GAIN * _COST:
                raise _StalledError

        first = look(np.append(x, 1.0))
        soft = first.soft
        ease = 1 + max(0.0, -float((first.values * soft).min()))
        loads = np.array([name in LOADS for name, _ in first.names])
        near = ~loads | (first.values < _FAR)
        unit, price = first.seconds / _COST, _PENALTY * _COST
        best, at, driven, history = math.inf, np.append(x, ease), False, list[float]()
        with suppress(_StalledError):
            minimize(
                lambda y: (
                    look(y).seconds / unit + price * y[-1],
                    np.append(look(y).rising * self.scale / unit, price),
                ),
                at,
                jac=True,
                method="SLSQP",
                bounds=[*zip(low, high, strict=True), (1.0, ease)],
                constraints={
                    "type": "ineq",
                    "fun": lambda y: look(y).spare(y[-1])[near],
                    "jac": lambda y: np.hstack([look(y).slopes * self.scale, soft[:, None]])[near],
                },
                callback=stepped,
                options={"maxiter": _QUADRATIC, "ftol": _SETTLED / unit},
            )
        x, ease = np.clip(at[:-1], low, high), float(at[-1])
        if ease <= 1 + BROKEN:
            ease = 1.0
            self.discretise(x)
            if self.look(x).violation > BROKEN:
                x, _ = self._restored(x, None, 1.0, step)
        return FoundDrive(x, self.look(x), ease)


def _least(J: Array, values: Array, damping: float, low: Array, high: Array) -> tuple[Array, float]:
    """The step that minimises half the sum of squares of the negative parts of values + J step and
    of the damped step, within bounds; and the first of both. By Newton's method."""

    def broken(step: Array) -> Array:
        return np.minimum(values + J @ step, 0.0)

    def cost(step: Array) -> float:
        return float(broken(step) @ broken(step) + damping * step @ step) / 2

    step = np.clip(np.zeros(J.shape[1]), low, high)
    for _ in range(_NEWTON):
        now = broken(step)
        slope = J.T @ now + damping * step
        free = ~(((step <= low) & (slope > 0)) | ((step >= high) & (slope < 0)))
        K = J[np.ix_(now < 0, free)]
        newton, size = np.zeros(len(step)), 1.0
        newton[free] = np.linalg.solve(K.T @ K + damping * np.eye(K.shape[1]), -slope[free])
        before = cost(step)
        while cost(np.clip(step + size * newton, low, high)) >= before and size > _SHORT:
            size /= 2
        if size <= _SHORT:
            break
        step = np.clip(step + size * newton, low, high)
    return step, float(broken(step) @ broken(step)) / 2


def slip(problem: Problem, curvature: float, turned: float) -> float:
    """beta in steady motion, rad: on a circle P moves at sin(beta) = c1 kappa to the axis of
    platform 1. turned: 0 if platform 1 leads, else pi."""
    beta = math.asin(max(-0.9, min(0.9, problem.robot.platform1.c * curvature)))
    return beta if turned == 0 else -beta


def _fastest(blends: Array, sign: int) -> Array:
    """Where the rate times a sign is largest in each of `_LOOKS` equal parts of blends (8, K):
    (_LOOKS, K).

    The vertex of the parabola through the ends and the middle of a part is close to the peak, and
    is refined by a Newton step. The rate is stationary there, so derivatives at a fixed place are
    those of the peak.
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
    sizes = sign * blended(places, blends, np.sin, np.cos)[1]
    return np.take_along_axis(places, sizes.argmax(axis=0)[None], axis=0)[0]


def _peaks_of(values: Array, window: int) -> tuple[NDArray[np.int_], Array]:
    """Peaks of samples, in windows of about this many: three indices (K, 3) around the largest, and
    their weights (K, 3) at the vertex of the parabola through them, where it is stationary."""
    count = max(1, len(values) // window)
    edges = len(values) * np.arange(count + 1) // count
    at = np.array([low + values[low:high].argmax() for low, high in itertools.pairwise(edges)])
    middle = np.clip(at, 1, len(values) - 2)
    near = middle[:, None] + [-1, 0, 1]
    first, here, last = values[near].T
    bend = first - 2 * here + last
    moved = np.where(bend < 0, 0.5 * (first - last) / np.minimum(bend, -1e-300), at - middle)
    moved = np.where(np.abs(moved) < 1, moved, at - middle)
    return near, np.stack([moved * (moved - 1) / 2, 1 - moved**2, moved * (moved + 1) / 2], axis=1)


@lru_cache
def _blend_rates() -> ca.Function:
    """(u, s) -> the rates at `_LOOKS` places of a segment, and their derivatives by u."""
    u, s = ca.SX.sym("u", 8), ca.SX.sym("s", _LOOKS)
    parts = ca.vertsplit(u)
    rates = ca.vertcat(*(blended(s[k], parts, ca.sin, ca.cos)[1] for k in range(_LOOKS)))
    return ca.Function("rates", [u, s], [rates, ca.jacobian(rates, u)])
