"""The steady cycle: the one speed v(0) that a period carries back to itself.

The period maps v(0) to v(T); where friction is viscous the map is affine and one Newton step
from anywhere is exact, otherwise Newton's method goes on inside a bracket until it stands still.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from rr_opt.motion.cycle import Cycle, cycle_of
from rr_opt.motion.integrator import cvodes, fixed_steps, whole_steps
from rr_opt.motion.torque import torque_after, torque_before
from rr_opt.outcome import NotConvergedError
from rr_opt.robot.gait import Gait
from rr_opt.robot.parameters import Robot

Array = NDArray[np.float64]

_NEWTON_STEPS = 80
_FIRST_STEP, _ABSURD = 0.1, 1e4  # m/s
_FLAT = 1e-12


@dataclass(frozen=True)
class SteadyCycle:
    """One steady period at N + 1 equal steps: t (s), phi (rad), v (m/s), psi (rad), x, y (m),
    torque (N m), and the cycle they make.

    Where the acceleration jumps a sample lies, and the torque has two values there: `torque` is
    the one after the jump, `torque_before` the one before.
    """

    gait: Gait
    t: Array
    phi: Array
    v: Array
    psi: Array
    x: Array
    y: Array
    torque: Array
    torque_before: Array
    cycle: Cycle

    @property
    def speed(self) -> float:
        """Average speed, m/s, positive along platform 1."""
        return self.cycle.speed


def steady_cycle(robot: Robot, gait: Gait, *, steps: int = 512) -> SteadyCycle:
    """The steady cycle by fixed steps of order 6, `steps` of them or what the gait's pieces need.

    Raises NotConvergedError if there is none: without friction, say, or in a singular posture.
    """
    return _close(robot, gait, lambda v0: fixed_steps(robot, gait, v0, steps=steps))


def reference_cycle(robot: Robot, gait: Gait, *, samples: int = 2048) -> SteadyCycle:
    """The steady cycle by cvodes at tight tolerance. Raises as steady_cycle."""
    times = np.linspace(0.0, gait.period, whole_steps(gait, samples) + 1)
    return _close(robot, gait, lambda v0: cvodes(robot, gait, v0, times))


def _close(robot: Robot, gait: Gait, rollout: Callable[[float], Array]) -> SteadyCycle:
    v0, low, high = 0.0, -math.inf, math.inf
    # Beyond it a step can jump over the pole and close a cycle that does not exist.
    reached = gait.peak_angle >= robot.singular_angle
    for _ in range(0 if reached else _NEWTON_STEPS):
        path = rollout(v0)
        gap, slope = path[0, -1] - v0, path[4, -1] - 1.0
        if not np.isfinite(gap) or abs(v0) > _ABSURD:
            break
        if abs(gap) <= 1e-12 + 1e-10 * np.abs(path[0]).max():
            return _cycle(robot, gait, path)
        # Friction brakes, so v(T) - v(0) falls as v(0) grows: the sign of the gap says on which
        # side the cycle lies, and what Newton's method proposes is held to it.
        low, high = (v0, high) if gap > 0 else (low, v0)
        proposed = v0 - gap / slope if slope < -_FLAT else math.nan
        if low < proposed < high:
            v0 = proposed
        elif math.isfinite(low) and math.isfinite(high):
            v0 = (low + high) / 2
        else:
            v0 += math.copysign(max(_FIRST_STEP, abs(v0)), gap)
    raise NotConvergedError(
        f"No steady cycle was found for amplitude {gait.amplitude:.4g} rad, period "
        f"{gait.period:.4g} s, offset {gait.offset:.4g} rad. A robot needs friction to settle, "
        "and no gait settles that reaches the singular posture. Check kappa and the angle."
    )


def _cycle(robot: Robot, gait: Gait, path: Array) -> SteadyCycle:
    v, psi, x, y, _ = path
    t = np.linspace(0.0, gait.period, len(v))
    after = torque_after(robot, gait, t, v)
    before = torque_before(robot, gait, t, v) if gait.pieces > 1 else after
    made = cycle_of(gait.period, x, y, psi)
    return SteadyCycle(gait, t, gait.angle(t), v, psi, x, y, after, before, made)
