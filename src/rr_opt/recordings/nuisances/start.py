"""A stated start from rest of a robot that is already driving.

Friction hardly matters in the first half period. So the nominal robot predicts how axle 1 moves
from rest, and what an initial speed adds. Other deviations are fitted with it: a scale and a delay
of the motion from rest, and a steady acceleration. From rest the initial speed is zero, or what the
jump of the joint's rate gives a robot whose joint is not straight, or in between.
"""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from rr_opt.array import Array
from rr_opt.model.gait import Gait
from rr_opt.model.robot import Robot
from rr_opt.motion.dynamics import dynamics_of
from rr_opt.motion.integrators import fixed_steps
from rr_opt.recordings.gaps import bridged
from rr_opt.recordings.nuisances.evidence import CLEAN, ExaminedRecording
from rr_opt.recordings.warnings import Notice, notice

_BEGINNING = 0.5
"""Share of a period in which the motion depends much more on inertia than on friction."""
_UNSEEN = 0.2
"""Gaps that are bridged, s."""
_ACCURACY, _DELAY = 0.3, 0.05
"""Relative error of the nominal robot's speed, and delay of the servo, s; 1 sigma."""
_STEADY = 0.1
"""Speed that a steady acceleration adds by the end, relative to the largest from rest, 1 sigma.
Random robots with unknown friction had 0.06."""
_OTHER = 2.0
"""Sigmas beyond which the model does not describe the robot."""
_SURE_SPEED = 4.0
"""Sigmas beyond which an initial speed is reported: by chance once in 10,000 recordings."""
_STEPS, _SPEED = 200, 0.1
"""Steps per period, and an initial speed for the model's derivative, m/s."""

_PART = 0.25
"""Share of a period over which distances are compared."""
_SURE = 5.0
_MOST = 0.4
"""A start from rest lacks 0.65 or more of the distance that its later speed would add, also with
strong friction, and 0.44 with centres of mass 3 cm off the axes. A robot that has driven for only a
few periods lacks as much, and is not detected."""
_FEWEST = 4
_FASTEST = 1e3
"""Anything farther or faster is not the motion of a robot, m or m/s."""


def look(given: ExaminedRecording) -> Iterator[Notice]:
    """A start from rest that is none."""
    if given.gait is None or given.start != "rest":
        return
    if given.t[0] >= given.gait.period / 4:
        yield notice("clock.start", first=given.t[0])
        return
    if given.slip.size > CLEAN:
        # The tracked point is not the joint, or the wheels slide: axle 1's rolling is unknown.
        return
    if given.robot is not None:
        found = initial(given, given.robot, given.gait)
        if found is not None and found.drives(found.speed):
            yield notice("start.running", speed=1e3 * found.speed)
    else:
        yield from _against_later(given, given.gait.period)


@dataclass(frozen=True)
class Initial:
    """The speed of axle 1 at t = 0, m/s, and those of a start from rest with their uncertainty,
    1 sigma: zero, and what the jump of the joint gives."""

    speed: float
    allowed: tuple[tuple[float, float], ...]

    def drives(self, speed: float) -> bool:
        """Whether such a speed is beyond anything that rest allows."""
        beyond = [(speed - one) / doubt for one, doubt in self.allowed]
        return min(beyond) > _SURE_SPEED or max(beyond) < -_SURE_SPEED


def initial(given: ExaminedRecording, robot: Robot, gait: Gait) -> Initial | None:
    """The initial speed; None with too few data, or if the model does not describe the robot."""
    n = int(np.searchsorted(given.t, _BEGINNING * gait.period))
    t = given.t[:n]
    x, y, psi = (bridged(given.t, one, _UNSEEN)[:n] for one in given.motion[:3])
    heading = (psi[1:] + psi[:-1]) / 2
    rolled = np.cos(heading) * np.diff(x) + np.sin(heading) * np.diff(y)
    rest, driving = (fixed_steps(robot, gait, v0, steps=_STEPS)[0] for v0 in (0.0, _SPEED))
    sizes = (*rolled, *rest, *driving)
    if n < _FEWEST or not np.isfinite(sizes).all() or np.abs(sizes).max() > _FASTEST:
        return None
    grid = np.linspace(0.0, gait.period, len(rest))
    speed = np.interp(t, grid, rest)
    way = np.interp(t, grid, _ways(grid, rest))
    more = np.interp(t, grid, _ways(grid, driving - rest)) / _SPEED
    steady = _STEADY * float(np.abs(speed).max()) / (t[-1] - t[0])
    A = np.column_stack([more, way, speed, t**2 / 2, np.ones(n)]) / given.sigma[0]
    b = (np.concatenate([[0.0], np.cumsum(rolled)]) - way) / given.sigma[0]
    known = np.diag([0.0, 1 / _ACCURACY, 1 / _DELAY, 1 / steady, 0.0])
    A, b = np.vstack([A, known]), np.concatenate([b, np.zeros(5)])
    found = np.linalg.lstsq(A, b, rcond=None)[0]
    covariance = np.linalg.pinv(A.T @ A)
    if abs(found[1]) > _OTHER * _ACCURACY:
        return None  # it is not that robot
    # The scale of the motion from rest also scales its jump.
    allowed = []
    for jump in (0.0, _jump(robot, gait)):
        of = np.array([1.0, -jump, 0.0, 0.0, 0.0])
        allowed.append((jump * (1 + found[1]), float(np.sqrt(of @ covariance @ of))))
    return Initial(float(found[0]), tuple(allowed))


def _ways(t: Array, speed: Array) -> Array:
    """Distance travelled at t (n,), s, at a speed (n,), m/s, that changes linearly: SciPy's package
    for this takes a fifth of a second to load."""
    return np.concatenate([[0.0], np.cumsum(np.diff(t) * (speed[1:] + speed[:-1]) / 2)])


def _jump(robot: Robot, gait: Gait) -> float:
    """The speed of axle 1 after the joint has jumped from rest to its rate, m/s."""
    dynamics = dynamics_of(robot)
    phi, p = float(gait.angle([0.0])[0]), dynamics.values(robot)
    with_, without = (float(dynamics.motion(0.0, phi, 0.0, one, p)[0]) for one in (1.0, 0.0))
    return (with_ - without) * float(gait.rate([0.0])[0])


def _against_later(given: ExaminedRecording, period: float) -> Iterator[Notice]:
    """Without a known robot: compared with the distance in later periods."""
    ways, speeds = _periods(given, period)
    if len(ways) < _FEWEST:
        return
    late = slice(len(ways) // 2, None)
    part = _PART * period
    # From rest, the speed that later periods begin with is missing throughout.
    lacking = float(np.median(speeds[late])) * part
    first = float(ways[0] - np.median(ways[late]))
    spread = 1.4826 * float(np.median(np.abs(ways[late] - np.median(ways[late]))))
    if not abs(lacking) > _SURE * max(np.sqrt(2) * given.sigma[0], spread):
        return
    if -first / lacking < _MOST:
        yield notice("start.running", speed=1e3 * (lacking + first) / part)


def _periods(given: ExaminedRecording, period: float) -> tuple[Array, Array]:
    """How far axle 1 rolls in the first part of each period from t = 0, m, and its speed there.

    The first is of all periods but those with gaps, the other m/s at their beginning.
    """
    along = given.slip.along / given.stride
    whole = np.concatenate([[0.0], np.cumsum(np.nan_to_num(along))])
    known = np.concatenate([[0], np.cumsum(np.isfinite(along))])
    t = given.t[: len(whole)] + given.step * (given.stride - 1) / 2
    part = max(1, round(_PART * period / given.step))
    ways, speeds = [], []
    for n in range(int((t[-1] - t[0]) / period)):
        at = int(np.searchsorted(t, n * period))
        if at + part >= len(whole) or known[at + part] - known[at] < 0.8 * part:
            if n == 0:
                break
            continue
        ways.append(whole[at + part] - whole[at])
        before = max(at - part // 2, 0)
        after = at + part // 2
        speeds.append((whole[after] - whole[before]) / ((after - before) * given.step))
    return np.array(ways), np.array(speeds)
