"""The steady cycle: the speed v(0) that a period maps to itself, and the rigid motion it makes.

The period maps v(0) to v(T). With viscous friction the map is affine, so that one Newton step from
anywhere is exact; else Newton's method goes on, safeguarded by a bracket.

One steady period moves the robot by (dx, dy) and turns it by dpsi, both in platform 1's axes at the
start; repeated, that is a circle about a fixed centre C. P does not stay at one distance from C
within the period, so the chord of P depends on where the period is cut. In the frame that turns
about C at Omega = dpsi/T, P's path is periodic; its mean point is at radius R, and the speed along
the mean circle is R |Omega|, whatever the cut.

C moves off to infinity as the gait straightens. With points as complex numbers, Omega C does not:

    Omega C = i (dpsi/2)/sin(dpsi/2)/T exp(-i dpsi/2) (dx + i dy)

so Omega p = exp(-i Omega t) (Omega P - Omega C) is formed directly. A straight gait is the limit
and no special case: its Omega p is the chord over T, turned by 90 degrees.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from functools import lru_cache

import casadi as ca
import numpy as np
from numpy.typing import ArrayLike

from rr_opt.array import Array
from rr_opt.mechanics.kinematics import G
from rr_opt.model.gait import Gait
from rr_opt.model.problem import CANCELLED
from rr_opt.model.robot import Robot
from rr_opt.motion.dynamics import dynamics_of
from rr_opt.motion.integrators import TIGHTEST, cvodes, fixed_steps, whole_steps
from rr_opt.outcome import InputError, NotConvergedError


@dataclass(frozen=True)
class Cycle:
    """The rigid motion of one steady period.

    dx, dy   displacement of P, m, in platform 1's axes at the start of the period
    dpsi     heading gained, rad
    speed    mean speed along the mean circle, m/s, positive along platform 1's axis
    radius   of the mean circle, m; inf for a straight gait
    """

    period: float
    dx: float
    dy: float
    dpsi: float
    speed: float
    radius: float


def cycle_of(period: float, x: ArrayLike, y: ArrayLike, psi: ArrayLike) -> Cycle:
    """The cycle of P's path over one steady period.

    x, y, psi: (N + 1,) at equal steps, both ends included; m, m, rad (unwrapped).
    """
    x, y, psi = (np.asarray(values, float) for values in (x, y, psi))
    P = np.exp(-1j * psi[0]) * (x - x[0] + 1j * (y - y[0]))
    dpsi = float(psi[-1] - psi[0])
    omega, half = dpsi / period, dpsi / 2
    # C solves C = dx + i dy + exp(i dpsi) C.
    omega_c = 1j * np.exp(-1j * half) * P[-1] / (np.sinc(half / math.pi) * period)
    turned = omega * np.arange(len(x) - 1) * period / (len(x) - 1)
    omega_p = np.mean(np.exp(-1j * turned) * (omega * P[:-1] - omega_c))
    heading = np.mean(np.exp(1j * (psi[:-1] - psi[0] - turned)))
    forward = (1j * omega_p * np.conj(heading)).real
    speed = math.copysign(abs(omega_p), forward)
    radius = abs(speed / omega) if omega else math.inf
    return Cycle(period, float(P[-1].real), float(P[-1].imag), dpsi, speed, radius)


_JUST_BEFORE = 1e-6
"""Where the left side of a jump is evaluated, in lengths of a piece."""


def grips(robot: Robot, gait: Gait, t: Array, v: Array, *, before: bool = False) -> list[Array]:
    """Side force over load of axles 1 and 2, (N,) each, at times t (N,) in s with speeds v (N,) in
    m/s; where it jumps, the value after the jump, or `before` it."""
    return _along(dynamics_of(robot).grip, robot, gait, t, v, before)


def grip_needed(steady: SteadyCycle, robot: Robot) -> tuple[float, float]:
    """Of axles 1 and 2 the largest side force over the load on them."""
    sides = (
        grips(robot, steady.gait, steady.t, steady.v, before=before) for before in (False, True)
    )
    one, two = (_peak(steady.gait.pieces, *both) for both in zip(*sides, strict=True))
    return one, two


def torques(robot: Robot, gait: Gait, t: Array, v: Array, *, before: bool = False) -> Array:
    """Torque on platform 2, N m, at times t (N,) in s with speeds v (N,) in m/s; where it jumps,
    the value after the jump, or `before` it."""
    return _along(dynamics_of(robot).motion, robot, gait, t, v, before)[3]


def _along(
    function: ca.Function, robot: Robot, gait: Gait, t: Array, v: Array, before: bool
) -> list[Array]:
    """A function of (v, phi, dphi, ddphi, p) along a gait: (N,) for each of its outputs."""
    values = np.tile(dynamics_of(robot).values(robot)[:, None], len(t))
    at = t - _JUST_BEFORE * gait.period / gait.pieces if before else t
    angle = gait.angle(t), gait.rate(t), gait.acceleration(at)
    return [np.asarray(out).ravel() for out in function(*np.array([v, *angle])[:, None], values)]


def require_regular(robot: Robot, gait: Gait) -> None:
    """Raise InputError for a gait that reaches the singular posture."""
    if gait.peak_angle >= robot.singular_angle:
        raise InputError(
            f"The gait reaches |phi| = {gait.peak_angle:.4g} rad. The robot is singular at "
            f"{robot.singular_angle:.4g} rad, where both axles point at one centre and no motion "
            "without side slip exists. Lower the amplitude or the offset."
        )


_NEWTON_STEPS = 80
_FIRST_STEP, _RUNAWAY = 0.1, 1e4  # m/s
_FLAT = 1e-12
"""A slope of v(T) - v(0) over v(0) that is no smaller in size leaves Newton's step undefined."""


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


@dataclass(frozen=True)
class SteadyCycle(Trajectory):
    """One steady period at N + 1 equal steps, and its rigid motion.

    Every jump of the acceleration is at a sample, where the torque has two values: `torque` is the
    one after the jump, `torque_before` the one before.
    """

    torque_before: Array
    gait: Gait
    cycle: Cycle

    @property
    def speed(self) -> float:
        """Mean speed, m/s, positive along platform 1."""
        return self.cycle.speed


def steady_cycle(robot: Robot, gait: Gait, *, steps: int = 512) -> SteadyCycle:
    """The steady cycle by at least `steps` fixed steps of order 6.

    Raises NotConvergedError if there is none: without friction, or through the singular posture.
    """
    return _close(robot, gait, lambda v0: fixed_steps(robot, gait, v0, steps=steps))


def reference_cycle(robot: Robot, gait: Gait, *, samples: int = 2048) -> SteadyCycle:
    """The steady cycle by CVODES at tight tolerance. Raises as steady_cycle."""
    times = np.linspace(0.0, gait.period, whole_steps(gait, samples) + 1)
    steady = _close(robot, gait, lambda v0: cvodes(robot, gait, v0, times))
    if abs(steady.speed) >= CANCELLED * np.abs(steady.v).max():
        return steady
    return _close(robot, gait, lambda v0: cvodes(robot, gait, v0, times, TIGHTEST))


def _close(robot: Robot, gait: Gait, rollout: Callable[[float], Array]) -> SteadyCycle:
    v0, low, high = 0.0, -math.inf, math.inf
    # Past the singular posture a step can jump over the pole and close a cycle that does not exist.
    singular = gait.peak_angle >= robot.singular_angle
    for _ in range(0 if singular else _NEWTON_STEPS):
        path = rollout(v0)
        gap, slope = path[0, -1] - v0, path[4, -1] - 1.0
        if not np.isfinite(gap) or abs(v0) > _RUNAWAY:
            break
        if abs(gap) <= 1e-12 + 1e-10 * np.abs(path[0]).max():
            return _steady(robot, gait, path)
        # Friction brakes, so v(T) - v(0) falls as v(0) grows: the sign of the gap says on which
        # side the cycle lies, and a Newton step that leaves the bracket is replaced.
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


def _steady(robot: Robot, gait: Gait, path: Array) -> SteadyCycle:
    v, psi, x, y, _ = path
    t = np.linspace(0.0, gait.period, len(v))
    after = torques(robot, gait, t, v)
    before = torques(robot, gait, t, v, before=True) if gait.pieces > 1 else after
    cycle = cycle_of(gait.period, x, y, psi)
    return SteadyCycle(t, x, y, psi, gait.angle(t), v, after, before, gait, cycle)


BETWEEN = 16
"""Points per sample of a cycle among which a peak is looked for."""
_THROUGH = 6
"""Samples that a polynomial between them goes through."""


def peak_torque(steady: SteadyCycle) -> float:
    """Largest |torque|, N m, between the samples too."""
    return _peak(steady.gait.pieces, steady.torque, steady.torque_before)


def _peak(pieces: int, after: Array, before: Array) -> float:
    """Largest size of what has these values after and before the jumps between pieces."""
    each = (len(after) - 1) // pieces
    values = np.hstack([after[:-1].reshape(pieces, each), before[each::each, None]])
    width = min(_THROUGH, values.shape[1])
    windows = np.lib.stride_tricks.sliding_window_view(values, width, axis=1)
    return float(np.abs(windows @ _between(width)).max())


@lru_cache
def _between(width: int) -> Array:
    """Weights (width, points) of samples in the polynomial through them, BETWEEN points a step."""
    at = np.linspace(0, width - 1, BETWEEN * (width - 1) + 1)
    powers = np.vander(np.arange(width), increasing=True).T
    return np.asarray(np.linalg.solve(powers, np.vander(at, width, increasing=True).T), float)


@dataclass(frozen=True)
class Energy:
    """Per metre of the mean circle's path: gross and net work of the servo, J/m, and the cost of
    transport, dimensionless; power: the gross work per second, W.

    The servo's power is torque * dphi/dt. Over a period the kinetic energy returns to what it was,
    so the net work of a period is what friction takes. A servo that brakes does not give energy
    back, though: what its supply has to provide is the positive part of the power alone, the gross
    work, which is never less than the net. The cost of transport is the gross work per metre over
    the robot's weight. Losses within the servo are in neither.
    """

    gross: float
    net: float
    cost_of_transport: float
    power: float


def energy(robot: Robot, steady: SteadyCycle) -> Energy:
    """The energy of a steady cycle."""
    rate = steady.gait.rate(steady.t)
    after, before = steady.torque * rate, steady.torque_before * rate
    net = float(np.sum(after[:-1] + before[1:])) / 2
    gross = float(np.sum(_positive(after[:-1], before[1:])))
    period = steady.gait.period
    path = abs(steady.speed) * period
    step = float(steady.t[1] - steady.t[0])
    per_metre = step / path
    weight = robot.mass * G
    return Energy(
        gross * per_metre, net * per_metre, gross * per_metre / weight, gross * step / period
    )


def _positive(start: Array, end: Array) -> Array:
    """Mean of the positive part of lines from start to end, exactly where one crosses zero."""
    high, low = np.maximum(start, end), np.minimum(start, end)
    crosses = (high > 0) & (low < 0)
    above = np.where(crosses, high**2 / np.where(crosses, 2 * (high - low), 1.0), 0.0)
    return np.where(crosses, above, np.maximum((start + end) / 2, 0.0))
