"""A gait driven for some time, from rest or from the steady state, and measures of the motion."""

import math
from dataclasses import dataclass
from typing import Literal

import numpy as np

from rr_opt.array import Array
from rr_opt.model.gait import Gait
from rr_opt.model.robot import Robot
from rr_opt.motion.dynamics import require_friction
from rr_opt.motion.integrators import cvodes, whole_steps
from rr_opt.motion.steady_cycle import (
    SteadyCycle,
    Trajectory,
    cycle_of,
    require_regular,
    steady_cycle,
    torques,
)
from rr_opt.outcome import InputError

Start = Literal["rest", "steady"]

MOST_SAMPLES = 1_000_000


def rollout(robot: Robot, gait: Gait, seconds: float, start: Start, rate: float) -> Trajectory:
    """Drive a gait for `seconds` from t = 0, sampled `rate` times a second.

    start: `rest` begins with v(0) = 0 and the command running; `steady` with the speed that the
    gait settles to. P begins at the origin, platform 1 heading along x.
    Raises InputError for a gait through the singular posture, and for the steady start of a robot
    without friction; NotConvergedError if no steady state is found.
    """
    count = round(seconds * rate) if np.isfinite(seconds * rate) else MOST_SAMPLES + 1
    if not 0 < count <= MOST_SAMPLES:
        raise InputError(
            f"{seconds:g} s at {rate:g} samples a second is {seconds * rate:.3g} samples. "
            f"Expected between 1 and {MOST_SAMPLES}. Change --seconds or --rate."
        )
    require_regular(robot, gait)
    if start == "steady":
        require_friction(robot)
    v0 = 0.0 if start == "rest" else float(steady_cycle(robot, gait).v[0])
    t = np.arange(count + 1) / rate
    v, psi, x, y, _ = cvodes(robot, gait, v0, t)
    return Trajectory(t, x, y, psi, gait.angle(t), v, torques(robot, gait, t, v))


def repeated(steady: SteadyCycle, cycles: int, every: int = 1) -> Trajectory:
    """The steady cycle driven `cycles` times: each period is the last, moved rigidly.

    every: one in this many samples of a period is kept; the first and the last always are.
    """
    kept = np.arange(0, len(steady.t) - 1, every)
    P, psi = steady.x + 1j * steady.y, steady.psi
    step, turn = P[-1] - P[0], psi[-1] - psi[0]
    headings = turn * np.arange(cycles + 1)
    turned = np.exp(1j * headings)
    starts = P[0] + np.append(0.0, np.cumsum(turned[:-1] * step))
    path = starts[:-1, None] + turned[:-1, None] * (P[kept] - P[0])
    path = np.append(path.ravel(), starts[-1])
    heading = np.append((headings[:-1, None] + psi[kept]).ravel(), psi[0] + headings[-1])
    begins = np.arange(cycles)[:, None] * steady.t[-1]
    t = np.append((begins + steady.t[kept]).ravel(), cycles * steady.t[-1])
    phi, v, torque = (
        np.append(np.tile(part[kept], cycles), part[0])
        for part in (steady.phi, steady.v, steady.torque)
    )
    return Trajectory(t, np.real(path), np.imag(path), heading, phi, v, torque)


_STEPS, _LEAST, _ALL = 2048, 256, 250_000
"""Times in a period, in one of very many, and in all periods together. Between two of 256 times the
peak of a sine is missed by at most 1e-4."""
_SNAP = 1e-9
"""This share of a period, at the end of a motion, is rounding."""
_SETTLED = 1e-9
"""A period that changes v by no more, relative to its largest value, repeats until the end."""


@dataclass(frozen=True)
class Measured:
    """Measures of a motion from its first to its last sample.

    peak_torque  largest |torque| of the servo at any time, N m
    mean_v       mean of v over the last period, m/s; over all of a shorter motion
    speed        along the mean circle of the last period, m/s, positive along platform 1; None for
                 a shorter motion
    """

    peak_torque: float
    mean_v: float
    speed: float | None


def measured(robot: Robot, gait: Gait, driven: Trajectory) -> Measured:
    """Measure a motion that a gait drives from phase 0.

    The samples of a trajectory may be far apart, and hold one side of each jump of the torque. So
    the motion is simulated once more, a period at a time, at times that meet every jump. The last
    period ends with the last of these times that the motion completes.
    """
    whole = math.floor(driven.t[-1] / gait.period + _SNAP)
    count = whole_steps(gait, min(_STEPS, max(_LEAST, _ALL // max(whole, 1))))
    grid = np.linspace(0.0, gait.period, count + 1)
    rest = float(driven.t[-1]) - whole * gait.period
    v, peak, path = float(driven.v[0]), 0.0, None
    for _ in range(whole):
        path = cvodes(robot, gait, v, grid)
        peak = max(peak, _peak(robot, gait, grid, path[0]))
        change, v = path[0, -1] - v, float(path[0, -1])
        if abs(change) <= _SETTLED * np.abs(path[0]).max():
            break
    least = _SNAP * gait.period
    if rest > least:
        begun = grid[grid <= rest + least]
        steps = len(begun)
        begun = begun if rest - begun[-1] <= least else np.append(begun, rest)
        end = cvodes(robot, gait, v, begun)
        peak = max(peak, _peak(robot, gait, begun, end[0]))
        if path is None:
            return Measured(peak, float(np.trapezoid(end[0], begun)) / rest, None)
        path = _last_period(path, end[:, :steps])
    if path is None:
        raise ValueError("a motion that takes no time has no measures")
    v, psi, x, y, _ = path
    speed = cycle_of(gait.period, x, y, psi).speed
    return Measured(peak, float(np.trapezoid(v)) / count, speed)


def _peak(robot: Robot, gait: Gait, t: Array, v: Array) -> float:
    """Largest |torque| from the first to the last of the times t, on both sides of jumps, N m."""
    after = torques(robot, gait, t, v)
    before = torques(robot, gait, t, v, before=True) if gait.pieces > 1 else after
    return float(max(np.abs(after[:-1]).max(), np.abs(before[1:]).max()))


def _last_period(path: Array, begun: Array) -> Array:
    """The states (5, N + 1) of the last N steps, of a period and the one begun after it.

    Both begin with P at the origin and heading 0: the second is moved to the end of the first.
    """
    then = begun.copy()
    P = np.exp(1j * path[1, -1]) * (begun[2] + 1j * begun[3])
    then[1] += path[1, -1]
    then[2], then[3] = path[2, -1] + P.real, path[3, -1] + P.imag
    return np.hstack([path[:, begun.shape[1] - 1 :], then[:, 1:]])
