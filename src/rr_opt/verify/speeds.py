"""Speed and peak torque of any number of gaits, each from as many samples as it needs."""

import math
from dataclasses import dataclass
from functools import lru_cache
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from rr_opt.array import Array
from rr_opt.mechanics.kinematics import G
from rr_opt.model.ballast import with_inertia_ratio
from rr_opt.model.gait import Gait, SineGait
from rr_opt.model.problem import Problem, Spreads
from rr_opt.model.robot import Robot
from rr_opt.motion.dynamics import derive, dynamics_of, model_key
from rr_opt.verify.compiled_cycles import CompiledCycles, Points, Speeds
from rr_opt.verify.fourier import positive_mean
from rr_opt.verify.steady_fourier import Doublings, Motion, SteadyFourier

_Places = tuple[NDArray[np.int_], NDArray[np.int_]]

MOST = 16384
"""Samples of half a period where friction is not viscous."""

SAFETY = 0.25
"""Factor on the tolerance for friction with abrupt transitions, where the change from doubling the
samples depends on where these fall, and may underestimate the error."""


FEWEST, RESOLVE_MOST = 16, 4096
"""Samples per half period of a straight gait; per whole period twice as many."""

_MARGIN = 10.0
"""With viscous friction, the speed's error comes from products of the velocity's highest harmonics,
which may be this many times larger. Other friction has stronger harmonics of its own, and the error
is the change from doubling the samples."""

_CHUNK = 16384
"""Samples per batch in NumPy."""


def resolved(
    model: SteadyFourier,
    robot: Robot,
    alpha: Array,
    phi0: Array,
    T: Array,
    which: NDArray[np.int_] | None,
    p: Array,
    tolerance: float,
) -> Speeds:
    """alpha, phi0 (G,), rad, T (G, B), s, p (len, R) with column which[g] for row g; (G, B)."""
    speed, turn, torque = (np.full(T.shape, np.nan) for _ in range(3))
    into = Speeds(speed, turn, torque, np.zeros(T.shape, bool))
    asked = np.isfinite(T) & (T > 0)
    period = np.where(asked, T, 1.0)
    regular = (least_S1(robot, alpha, phi0) > 0) & asked.any(axis=1)
    needed = _samples(robot, np.abs(alpha) + np.abs(phi0))
    accepted = tolerance * (_MARGIN if model.viscous else SAFETY)
    compiled = model.compiled(T.size)
    for straight in (True, False):
        halves = 1 if straight else 2
        pending = np.flatnonzero(regular & (((phi0 == 0) & model.mirrored) == straight))
        n = FEWEST * halves if model.viscous else 4 * FEWEST
        if compiled and len(pending):
            row, column = np.nonzero(asked[pending])
            at = pending[row], column
            robots = np.zeros(len(row), np.int64) if which is None else which[at[0]]
            points = Points(alpha[at[0]], phi0[at[0]], period[at], robots)
            fewest = needed[at[0]] * halves if model.viscous else None
            _by_code(compiled, points, p, straight, n, fewest, accepted, at, into)
            if not model.viscous:
                continue
            n, pending = 2 * compiled.most, pending[(asked & ~into.converged)[pending].any(axis=1)]
        doublings = Doublings(T.shape)
        most = halves * (RESOLVE_MOST if model.viscous else MOST)
        while len(pending) and n <= most:
            now = pending[needed[pending] * halves <= n]
            parts = min(len(now), max(1, len(now) * n // _CHUNK))
            for block in np.array_split(now, parts) if parts else ():
                robots = p if which is None else p[:, which[block]]
                shapes = alpha[block], phi0[block], period[block]
                found = model.cycles(*shapes, robots, n, straight, tolerance)
                error = found.error if model.viscous else doublings.error(block, found)
                into.keep(block, found, (error <= accepted) & asked[block])
            poor = (asked & ~into.converged)[pending].any(axis=1)
            pending, n = pending[poor], 2 * n
    return into


def _by_code(
    compiled: CompiledCycles,
    points: Points,
    p: Array,
    straight: bool,
    first: int,
    fewest: Array | None,
    accepted: float,
    at: _Places,
    into: Speeds,
) -> None:
    """Write to the places `at` the points whose error is accepted, from `first` samples on.

    fewest: samples needed to resolve a point (K,) with viscous friction; None for other friction,
    where a point takes as many as it needs up to a limit.
    """
    pending, viscous = np.arange(len(points.period)), fewest is not None
    # With other friction, points that need many samples are grouped, by growing limits, as all
    # points of a vector register take as many as the worst.
    factor, most = (2, compiled.most) if viscous else (4, MOST * (1 if straight else 4))
    n = first if viscous else factor * first
    while len(pending) and n <= most:
        now = pending if fewest is None else pending[fewest[pending] <= n]
        if len(now):
            some = points.only(now)
            if viscous:
                found = compiled.viscous(some, p, n, straight)
            else:
                found = compiled.newton(some, p, first, n, straight, accepted)
            into.keep((at[0][now], at[1][now]), found, found.error <= accepted)
            pending = pending[~into.converged[at][pending]]
        n *= factor


def least_S1(robot: Robot, amplitude: ArrayLike, offset: ArrayLike) -> Array:
    """The least S1 = c1 cos phi + c2 over a gait's cycle, m."""
    reach = np.abs(np.asarray(amplitude, float)) + np.abs(np.asarray(offset, float))
    return robot.platform1.c * np.cos(np.minimum(reach, np.pi)) + robot.platform2.c


def _samples(robot: Robot, reach: Array) -> Array:
    """Samples per half period needed to resolve a gait of this reach.

    The motion is analytic in the complex phase up to where alpha sin(theta) reaches the singular
    posture, y = arccosh(phi*/reach) off the real axis: its harmonics decay as exp(-k y).
    """
    ratio = robot.singular_angle / np.maximum(reach, 1e-9)
    return 6.0 / np.arccosh(np.maximum(ratio, 1 + 1e-9))


def robot_with(problem: Problem, ratio: float | None) -> Robot:
    """The problem's robot with this J20/J10; None: as it is.

    Raises InputError for a ratio that cannot be realised.
    """
    if ratio is None:
        return problem.robot
    choice = problem.inertia_ratio
    if choice is None:
        return with_inertia_ratio(problem.robot, ratio)
    return with_inertia_ratio(problem.robot, ratio, choice.about, choice.by, choice.loads)


def model_of(robot: Robot) -> SteadyFourier:
    """The steady-cycle model for robots with the effects of this one."""
    return _model(*model_key(robot))


@lru_cache
def _model(effects: tuple[str, ...], neutral: frozenset[str]) -> SteadyFourier:
    return SteadyFourier(derive(effects, neutral))


def speeds(
    problem: Problem,
    amplitude: ArrayLike,
    period: ArrayLike,
    offset: ArrayLike = 0.0,
    ratio: ArrayLike | None = None,
    tolerance: float = 1e-6,
) -> Speeds:
    """Speed and peak torque of gaits, feasible or not, in their broadcast shape.

    amplitude, offset in rad, period in s, ratio J20/J10 (None or NaN: the robot as it is).
    tolerance: of the speed, relative. Fastest if the last axis is that of the period alone. NaN
    where the gait reaches the singular posture, and where the cycle is not resolved.
    """
    ratios = np.asarray(np.nan if ratio is None else ratio, float)
    inputs = [np.asarray(part, float) for part in (amplitude, offset, ratios)]
    shape = np.broadcast_shapes(*(part.shape for part in inputs), np.shape(period))
    alone = shape != () and all(part.shape[-1:] in ((), (1,)) for part in inputs)
    rows, periods = ((*shape[:-1], 1), shape[-1]) if alone else (shape, 1)
    alpha, phi0, J = (np.broadcast_to(part, rows).ravel() for part in inputs)
    T = np.broadcast_to(np.asarray(period, float), shape).reshape(len(alpha), periods)
    which, p = _parameters(problem, J)
    found = resolved(model_of(problem.robot), problem.robot, alpha, phi0, T, which, p, tolerance)
    speed, turn, torque = (part.reshape(shape) for part in found[:3])
    return Speeds(speed, turn, torque, found.converged.reshape(shape))


def _parameters(problem: Problem, ratio: Array) -> tuple[NDArray[np.int_] | None, Array]:
    """The robots' parameter vectors as columns, and the column of each ratio (NaN: as it is)."""
    dynamics = dynamics_of(problem.robot)
    if np.isnan(ratio).all():
        return None, dynamics.values(problem.robot)[:, None]
    values, which = np.unique(ratio, return_inverse=True)
    columns = [dynamics.values(robot_with(problem, value)) for value in values.tolist()]
    p = np.array(columns).T
    return (None, p) if len(values) == 1 else (which, p)


PHASES, _BLOCK = 256, 64


def motions(problem: Problem, gaits: Array, phases: int = PHASES, *, grip: bool = False) -> Motion:
    """Steady motions of sines, (4, K): amplitude, period, offset, ratio (NaN: as it is), and with
    `grip` the grip needed. Columns are NaN where none is found."""
    amplitude, period, offset, ratio = gaits
    which, p = _parameters(problem, ratio)
    theta = np.arange(phases)[:, None] * (2 * math.pi / phases)
    model, parts = model_of(problem.robot), []
    for at in range(0, max(len(amplitude), 1), _BLOCK):
        here = slice(at, at + _BLOCK)
        swing, rate = amplitude[here] * np.sin(theta), amplitude[here] * np.cos(theta)
        angle = swing + offset[here], rate, -swing
        robots = p if which is None else p[:, which[here]]
        parts.append(model.motion(angle, period[here], robots, grip=grip))
    return Motion(*(np.concatenate(each, axis=-1) for each in zip(*parts, strict=True)))


class Costs(NamedTuple):
    """Of K gaits: mean positive power of the servo, W, and cost of transport."""

    power: Array
    cost_of_transport: Array


@np.errstate(divide="ignore", over="ignore", invalid="ignore")
def costs(problem: Problem, gaits: Array, found: Motion) -> Costs:
    """The costs of sines, (4, K) as in `motions`, with the motion found there."""
    amplitude, period, _, ratio = gaits
    n = len(found.torque)
    theta = np.arange(n)[:, None] * (2 * math.pi / n)
    power = positive_mean(found.torque * (amplitude * np.cos(theta) * 2 * math.pi / period))
    which, p = _parameters(problem, ratio)
    names = dynamics_of(problem.robot).parameters
    mass = p[names.index("m1")] + p[names.index("m2")]
    weight = G * (mass if which is None else mass[which])
    return Costs(power, power / (weight * np.hypot(*found.velocity)))


_SAMPLES, _MOST = 256, 8192
_SETTLED = 1e-6


def speed_of(robot: Robot, gait: Gait) -> tuple[float, float]:
    """The steady speed of a gait, signed, refined until more samples make no difference, and the
    reference for its relative error, m/s.

    The acceleration of a free gait jumps; a sample at a jump is the mean of both sides, so that the
    error decreases with the square of the number of samples, and is extrapolated. NaN where the
    model finds no steady cycle.
    """
    smooth = gait.pieces == 1
    before, samples = math.nan, _SAMPLES if smooth else 4 * gait.pieces
    while True:
        speed, scale = _sampled_speed(robot, gait, samples)
        if abs(speed - before) <= _SETTLED * scale or 2 * samples > _MOST:
            return speed + (0.0 if smooth else (speed - before) / 3), scale
        before, samples = speed, 2 * samples


def _sampled_speed(robot: Robot, gait: Gait, samples: int) -> tuple[float, float]:
    t = np.arange(samples) / samples * gait.period
    bend = gait.acceleration(t)
    if gait.pieces > 1:
        bend = (bend + gait.acceleration(t - 0.25 * gait.period / samples)) / 2
    omega = 2 * math.pi / gait.period
    angle = gait.angle(t), gait.rate(t) / omega, bend / omega**2
    phi, rate, bend = (part[:, None] for part in angle)
    p = dynamics_of(robot).values(robot)[:, None]
    found = model_of(robot).along((phi, rate, bend), np.array([[gait.period]]), p, False)
    if not np.isfinite(found.error[0, 0]):
        return math.nan, math.nan
    return float(found.speed[0, 0]), float(found.scale[0, 0])


DRAWN = 20_000
_DRAWN_TO = 1e-5


@dataclass(frozen=True)
class Drawn:
    """A gait's performance over robots drawn at random from the uncertainty: signed speed, m/s, and
    largest |torque|, N m, (K,)."""

    speed: Array
    torque: Array

    def reaching(self, speed: float) -> float:
        """The share of them that go at least as fast in the same direction."""
        return float((self.speed * np.sign(speed) >= abs(speed)).mean())

    def keeping(self, torque: float) -> float:
        """The share of them within this torque, N m."""
        return float((self.torque <= torque).mean())

    def reached(self, share: float) -> float:
        """The speed, m/s, that this share of them reaches, in the direction that most take."""
        way = float(np.sign(np.median(self.speed)))
        return way * float(np.quantile(way * self.speed, 1 - share))


def drawn(
    robot: Robot, gait: SineGait, spreads: Spreads, scale: float = 1.0, seed: int = 1
) -> Drawn:
    """DRAWN random robots; scale: of all spreads."""
    dynamics, rng, count = dynamics_of(robot), np.random.default_rng(seed), DRAWN
    p = np.repeat(dynamics.values(robot)[:, None], count, axis=1)
    for which, spread in spreads.of(dynamics.parameters).items():
        p[which] *= np.exp(scale * spread * rng.standard_normal(count))
    ones = np.ones(count)
    found = resolved(
        model_of(robot), robot, gait.amplitude * ones, gait.offset * ones,
        gait.period * ones[:, None], np.arange(count), p, _DRAWN_TO,
    )  # fmt: skip
    return Drawn(found.speed[:, 0], found.peak_torque[:, 0])
