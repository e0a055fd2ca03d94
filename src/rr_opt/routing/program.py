"""A whole drive as one nonlinear program in a few unknowns.

The drive is a sequence of stages. A stage first blends amplitude, offset and frequency from those
of the stage before, over one cycle, and then goes on with them: its unknowns are for how many
cycles, and the three. The first begins from the joint at rest; in the last the joint stands still
and the robot coasts. Minimised is the time of the drive. Bounded are

    angle, rate, torque      of the servo, and the grip of the wheels, at their peaks
    the way                  P's distance from the path, and from the end of each leg when it is due
    the end                  place, heading, speed

The motion and all derivatives are those of `rollout`. Levenberg-Marquardt steps lead to a drive,
and sequential quadratic programming (SLSQP) to the fastest near it.
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
"""Of a stage: cycles after the blend, amplitude (rad), offset (rad), frequency (rad/s). Counted in
cycles, the phases at which blends begin do not depend on the frequencies, and the program is nearly
linear."""
_LOOKS, _CLOSE = 12, 1e-4
"""Parts of a blend in each of which the largest rate is bounded."""
_INSIDE, _ROOM = 0.97, 0.01
"""The program aims at this share of each tolerance and may miss it by so much: steps are finite."""
_TIGHT = 0.999
"""The program keeps to this share of each limit: its bounds are good to `BROKEN`."""
BROKEN = 1e-3
"""By so much, relative, a bound may be broken, and the drive counts as keeping it."""
_SOFT = ("path", "position", "heading")
"""Bounds whose tolerances are wider on the way to a drive."""
_MOST, _AIMED, _CREEPING = 3, 4, 1e-4
"""Of a stage's cycles, the most over those of steady speed and five more; times that the guess
corrects them; and the least way of a cycle, m."""
_SPEED = 0.05
"""m/s: a gap of the speed between stages that counts as much as the tolerances."""
_RESTORED, _DAMPED, _SOFTEST, _STIFFEST = 60, 1e-2, 1e-6, 1e6
"""Most Levenberg-Marquardt steps, and their damping: at first, at least, at most."""
_MOVES = (1.0, 0.3, 1.0, 0.1)
"""Changes of a stage's scaled unknowns that are damped alike: steering is preferred to slowing."""
_HARD, _SPARE = 10.0, 2e-3
"""So many times more a limit's excess counts than that of a tolerance; and what steps aim at."""
_NEWTON, _SHORT = 30, 1e-4
"""Most steps of Newton's method within one of those, and the shortest."""
_ROUNDS, _QUADRATIC, _SETTLED = 5, 100, 1e-8
"""Of sequential quadratic programming: rounds, steps in each, gain of time, s, of the last step."""
_HASTY, _GAIN, _WORTH, _STATIONARY = 12, 3e-5, 1e-4, 1e-3
"""To tell which drive is the fastest, steps in which a round has to gain something; to come to the
optimum near it, they are as many as the unknowns. What that something is, and what a round has to
gain for another one, relative; and what is left of derivatives at an optimum."""
_JOINED = 1e-6
"""Gaps that are none, over what counts as much as the tolerances."""
_COST, _PENALTY = 12.0, 10.0
"""The time of the drive as the program counts it, so that first steps are neither far nor short,
and over it the price of tolerances twice as wide."""
_FAR = 0.7
"""Loads with so much to spare are left out of a round."""
_ACTIVE = 1e-4
"""Of bounds that take part in the prices, what is left at most, relative."""
_NUDGE = 1e-6
"""A change of the limit on singularity, relative."""
_LOST = 1e3
"""What counts as the excess where there is no motion."""
_PLACES = 100
"""About how many parts of the way have a bound on the largest distance from it."""


@dataclass(frozen=True)
class DriveStage:
    """A stage of the drive, with guesses of its unknowns.

    leg       on which it is
    slip      angle of P's motion to platform 1 at its end, rad
    way       how much of the leg the guess drives, m
    ends      whether its end is that of the leg
    fixed     whether its amplitude and frequency are as guessed
    fewest    cycles that it takes
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

    @property
    def coasts(self) -> bool:
        """Whether the joint is held still."""
        return self.fixed and self.amplitude == 0


@dataclass(frozen=True)
class SolvedDrive:
    """An answer of the solver.

    violation   largest share by which a bound is broken; where says which
    pieces      of the route, of every segment of the command
    prices      time saved per unit of each limit by which it is raised, s: rate, angle, torque,
                grip, singularity
    ease        times the tolerances of place, heading and way that it keeps to; 1: as asked
    stationarity  what is left of the derivatives of the time, relative, when those of active bounds
                are taken off times their prices: 0 at an optimum
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
    """A drive with its time, s, and everything that has to be at least 0, relative; with their
    derivatives by the unknowns, and which bound of which piece it is.

    closing  what is added to the values, to first order, as gaps between stages are closed
    gaps     between stages: (v, psi, x, y) over what counts as much
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
        """The values if those tolerances are so many times as wide."""
        return self.values + (ease - 1) * self.soft

    @cached_property
    def violation(self) -> float:
        """The largest share by which a bound is broken, beyond what the program keeps inside of
        tolerances for rounding."""
        room = np.array([_ROOM * (name in (*_SOFT, "speed")) for name, _ in self.names])
        return max(0.0, -float((self.values + room).min()))


@dataclass(frozen=True)
class FoundDrive:
    """Scaled unknowns, their drive, and times the tolerances that it keeps to."""

    x: Array
    look: Look
    ease: float

    @property
    def cost(self) -> float:
        """The time, or if bounds are broken by how much."""
        broken = self.look.violation > BROKEN
        return self.look.violation if broken else self.look.seconds

    def rank(self) -> tuple[bool, float]:
        """Drives that keep all bounds go first, the fastest of them in front."""
        return self.look.violation > BROKEN, self.cost


class _StalledError(Exception):
    """A round of programming gains nothing any more."""


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
        limits = problem.limits
        self.loads = [k for k, name in enumerate(LOADS) if math.isfinite(getattr(limits, name))]
        guess = np.array([[s.cycles, s.amplitude, s.offset, s.omega] for s in stages])
        self.scale = np.tile([4.0, 0.2, 0.2, 0.0], len(stages))
        self.scale[3::4] = guess[:, 3]
        self.x0 = guess.ravel() / self.scale
        self.joined = np.array([_SPEED, tolerance.heading, tolerance.position, tolerance.position])
        self.discretise(self.x0)

    def discretise(self, x: Array) -> None:
        """Take as many steps of integration as the unknowns ask for."""
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

    @np.errstate(over="ignore", invalid="ignore")
    def look(self, x: Array, starts: Array | None = None) -> Look:
        """The drive of the scaled unknowns and everything that has to be at least 0. starts: v,
        psi, x, y of all stages but the first, if they do not begin as the one before ends."""
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
        # A step too far may lead through the singular posture, where there is no motion.
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
        """`signed_distance` of places of a stage: from its leg, or from the one before or after it
        where P is not yet or no longer beside it. (3, n)"""
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
        """Of the unknowns."""
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
        """A drive near the guess: drives that keep to these times the tolerances one after another,
        then sequential quadratic programming, which narrows them at a price."""
        x, starts = self.guess()
        for ease in eases:
            x, starts = self._restored(x, starts, ease, step)
        return self._fastest(x, step, _HASTY)

    def hurried(
        self, found: FoundDrive, step: Callable[[], None], patience: int = _HASTY
    ) -> FoundDrive:
        """A drive after rounds of programming, until they gain little or it is an optimum."""
        for _ in range(_ROUNDS):
            if found.ease == 1 and self._prices(found)[1] < _STATIONARY:
                break
            after = self._fastest(found.x, step, patience)
            better = after.rank() < found.rank()
            gain, found = 1 - after.cost / found.cost, after if better else found
            if not better or gain < _WORTH:
                break
        return found

    def solve(self, found: FoundDrive, step: Callable[[], None]) -> SolvedDrive:
        """The fastest drive near one that was found."""
        found = self.hurried(found, step, len(found.x))
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
        """The prices of limits at an answer, by non-negative least squares over active bounds, and
        its stationarity."""
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
        # The room of the angle ends at one limit or the other.
        prices["angle"] = total["angle"] / room if room == limits.angle else 0.0
        S = limits.singularity
        less = replace(self.problem, limits=replace(limits, singularity=S * (1 - _NUDGE)))
        prices["singularity"] = -total["angle"] / room * (reach(less) - room) / (S * _NUDGE)
        return prices, left / float(np.linalg.norm(gradient))

    def guess(self) -> tuple[Array, Array]:
        """The unknowns and starts of stages, one stage after another simulated. Each begins on
        the path with the speed that the one before ends with, platform 1 as in steady motion, and
        takes as many cycles as its way asks for."""
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
        """The speed, m/s, after a stage that begins with v, and the way of P, m."""
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
        """Levenberg-Marquardt steps on broken bounds and gaps between stages, until there are none.
        Stages begin where the linear model takes them, or, if that is the better, as the ones
        before end."""
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
        """Sequential quadratic programming on the time with a price on the ease of tolerances."""
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
            # What is no drive yet may take its time.
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
    """The step that minimises half the sum of squares of what is below 0 of values + J step, and of
    the damped step, within bounds; and the first of both. By Newton's method."""

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
    """beta of steady motion, rad: on a circle P moves at sin(beta) = c1 kappa to the axis of
    platform 1. turned: 0 if platform 1 leads, else pi."""
    beta = math.asin(max(-0.9, min(0.9, problem.robot.platform1.c * curvature)))
    return beta if turned == 0 else -beta


def _fastest(blends: Array, sign: int) -> Array:
    """Where the rate times a sign is largest in each of `_LOOKS` equal parts of blends (8, K):
    (_LOOKS, K).

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
    sizes = sign * blended(places, blends, np.sin, np.cos)[1]
    return np.take_along_axis(places, sizes.argmax(axis=0)[None], axis=0)[0]


def _peaks_of(values: Array, window: int) -> tuple[NDArray[np.int_], Array]:
    """Of samples, in windows of about this many: three places (K, 3) about the largest, and
    their weights (K, 3) in the vertex of the parabola through them, which is level there."""
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
