"""A gait driven for some time: the motion from rest or from the steady state, and its repeats."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from rr_opt.motion.integrator import cvodes
from rr_opt.motion.regular import require_regular
from rr_opt.motion.steady_cycle import SteadyCycle, steady_cycle
from rr_opt.motion.torque import torque_after
from rr_opt.outcome import InputError
from rr_opt.physics.dynamics import require_friction
from rr_opt.robot.gait import Gait
from rr_opt.robot.parameters import Robot

Array = NDArray[np.float64]
Start = Literal["rest", "steady"]

MOST_SAMPLES = 1_000_000


@dataclass(frozen=True)
class Trajectory:
    """A motion at equal steps of time.

    t (s); x, y (m) the joint P; psi (rad) the heading of platform 1; phi (rad) the joint angle;
    v (m/s) the speed of axle 1 along platform 1; torque (N m) of the servo on platform 2, where it
    jumps the value after the jump
    """

    t: Array
    x: Array
    y: Array
    psi: Array
    phi: Array
    v: Array
    torque: Array


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
    return Trajectory(t, x, y, psi, gait.angle(t), v, torque_after(robot, gait, t, v))


def one_period(steady: SteadyCycle) -> Trajectory:
    """The steady cycle as a trajectory."""
    return Trajectory(steady.t, steady.x, steady.y, steady.psi, steady.phi, steady.v, steady.torque)


def repeated(steady: SteadyCycle, cycles: int) -> Trajectory:
    """The steady cycle driven `cycles` times: each period is the last, moved rigidly."""
    n = len(steady.t) - 1
    x, y, psi = (part[:n] for part in (steady.x, steady.y, steady.psi))
    turn = steady.psi[-1] - steady.psi[0]
    parts, at, heading = [], np.array([steady.x[0], steady.y[0]]), 0.0
    step = np.array([steady.x[-1] - steady.x[0], steady.y[-1] - steady.y[0]])
    for _ in range(cycles):
        cos, sin = np.cos(heading), np.sin(heading)
        dx, dy = x - x[0], y - y[0]
        parts.append(
            np.array([at[0] + cos * dx - sin * dy, at[1] + sin * dx + cos * dy, psi + heading])
        )
        at = at + np.array([cos * step[0] - sin * step[1], sin * step[0] + cos * step[1]])
        heading += turn
    end = np.array([[at[0]], [at[1]], [steady.psi[0] + heading]])
    x, y, psi = np.hstack([*parts, end])
    t = np.arange(cycles * n + 1) * (steady.t[-1] / n)

    def again(part: Array) -> Array:
        return np.append(np.tile(part[:n], cycles), part[0])

    return Trajectory(t, x, y, psi, again(steady.phi), again(steady.v), again(steady.torque))
