"""The Roller Racer's steady cycle in plain numpy: many gaits at once, spectrally accurate.

Written by hand and apart from the package, so that one can be held against the other; only
the dataclasses that state a robot are shared. Per gait the forward speed v of axle 1 obeys

    vdot = a(t) v + f(t),      a, f periodic,

whose only periodic solution has a closed form: with E' = a - mean(a), E periodic, the speed
v exp(-E) obeys an equation with a constant coefficient, which Fourier series solve term by
term. Arrays are (gaits, nodes); nodes are equidistant in time over one period.

`python -m benchmarks.optimise.fourier_numpy` checks it against other equations of motion.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.fft import irfft, rfft

from benchmarks.optimise.bodies import Body, body, loaded_body
from rr_opt.model.problem import RatioChoice
from rr_opt.model.robot import Robot

Array = NDArray[np.float64]

_MAGNIFIED = 1e5
"""Largest exp(E) over the least up to which rounding stays below 1e-10."""
_AT_ONCE = 128
"""Gaits."""


class Cycle(NamedTuple):
    """One steady period on (gaits, nodes): v, its rate, psi-dot and the servo's torque."""

    v: Array
    vdot: Array
    w: Array
    torque: Array | None


class Performance(NamedTuple):
    """Per gait: signed mean speed (m/s), turn per period (rad), least S1 (m), |torque| (N m).

    `along` is the part of the mean speed that lies along platform 1's mean axis, -1 to 1. Near 0
    (the heading swings by more than 2 rad) the sign of the speed means little: it may jump.
    `torques` (gaits, windows) holds the peak in each part of the period, `torque` the largest.
    """

    speed: Array
    turn: Array
    along: Array
    s1: Array
    torques: Array

    @property
    def torque(self) -> Array:
        """Peak |torque| of each gait, N m."""
        return self.torques.max(axis=1)


def steady_cycle(one: Body, two: Body, gait: Sequence[Array], nodes: int, torque: bool) -> Cycle:
    """The periodic motion of the gaits (alpha, T, phi0), each a column (gaits, 1).

    Kane's equations with w = -i (s v + c2 q), w2 = w + q, u2 = i (S2 v + c1 c2 s q),
    i = 1/S1, q = dphi: the gyroscopic terms of both collapse to m a products over S1.
    """
    alpha, T, phi0 = gait
    angle = 2 * np.pi * np.arange(nodes) / nodes
    omega = 2 * np.pi / T
    phi = alpha * np.sin(angle) + phi0
    q, dq = alpha * omega * np.cos(angle), -alpha * omega**2 * np.sin(angle)
    a, f = coefficients(one, two, phi, q, dq)
    wave = 1j * omega * np.arange(nodes // 2 + 1)
    ak = rfft(a)
    mean = ak[:, :1].real / nodes
    ak[:, 0] = 0.0
    E = np.exp(irfft(np.divide(ak, wave, out=ak, where=wave != 0), nodes))
    v = E * irfft(rfft(f / E) / (wave - mean), nodes)
    magnified = ~(E.max(axis=1) < _MAGNIFIED * E.min(axis=1))
    if magnified.any():
        v[magnified] = _collocated(a[magnified], f[magnified], T[magnified])
    vdot = a * v + f
    w = yaw_rate(one, two, phi, q, v)
    tau = servo_torque(one, two, phi, q, dq, v, vdot) if torque else None
    return Cycle(v, vdot, w, tau)


def _collocated(a: Array, f: Array, T: Array) -> Array:
    """The periodic solution where friction is so strong that exp(-E) magnifies rounding: the same
    Fourier series as linear equations at the nodes, some gaits at a time."""
    nodes = a.shape[1]
    wave = 2j * np.pi * np.arange(nodes // 2 + 1)
    wave[-1] = 0.0
    slope = irfft(wave[:, None] * rfft(np.eye(nodes), axis=0), nodes, axis=0)
    v = np.empty_like(a)
    for at in range(0, len(a), _AT_ONCE):
        some = slice(at, at + _AT_ONCE)
        matrix = slope / T[some, :, None] - a[some, :, None] * np.eye(nodes)
        v[some] = np.linalg.solve(matrix, f[some, :, None])[..., 0]
    return v


def coefficients(one: Body, two: Body, phi: Array, q: Array, dq: Array) -> tuple[Array, Array]:
    """a and f of vdot = a v + f, where phi, its rate q and that one's rate dq are these."""
    (m1, J1, ma1, c1, b1, k1), (m2, J2, ma2, c2, b2, k2) = one, two
    s, c = np.sin(phi), np.cos(phi)
    S1, S2 = c1 * c + c2, c1 + c2 * c
    ss, i = s * s, 1 / S1
    lever = c1**2 - c2**2  # S2^2 = S1^2 + lever s^2
    j = J1 + J2 + m2 * lever
    qs, g = q * s, 1 / ((m1 + m2) * S1 * S1 + j * ss)
    drag1, drag2 = 2 * k1 * b1**2, 2 * k2 * b2**2
    a = -g * (
        qs * (j * i * S2 + (ma1 * c2 + ma2 * c1))
        + (drag1 + drag2 + 2 * k2 * lever) * ss
        + 2 * (k1 + k2) * S1 * S1
    )
    f = -g * (
        dq * s * (J1 * c2 - J2 * c1 * c + m2 * c1 * c2 * S2)
        + q * q * (c1 * c2 * (j * ss * i + m2 * S1) + ma1 * c2**2 - ma2 * c1**2 * c)
        + qs * (drag1 * c2 - drag2 * c1 * c + 2 * k2 * c1 * c2 * S2)
    )
    return a, f


def yaw_rate(one: Body, two: Body, phi: Array, q: Array, v: Array) -> Array:
    """psi-dot."""
    return -(np.sin(phi) * v + two.c * q) / (one.c * np.cos(phi) + two.c)


def servo_torque(
    one: Body, two: Body, phi: Array, q: Array, dq: Array, v: Array, vdot: Array
) -> Array:
    """On platform 2."""
    (_, J1, ma1, c1, b1, k1), (m2, J2, ma2, c2, b2, k2) = one, two
    s, c = np.sin(phi), np.cos(phi)
    S1, S2 = c1 * c + c2, c1 + c2 * c
    i, lever = 1 / S1, c1**2 - c2**2
    drag1, drag2 = 2 * k1 * b1**2, 2 * k2 * b2**2
    w = yaw_rate(one, two, phi, q, v)
    w2, u2 = w + q, i * (S2 * v + c1 * c2 * s * q)
    dw = -i * (s * vdot + c2 * dq + q * i * (S2 * v + c1 * c2 * s * q))
    du2 = i * (S2 * vdot + c1 * c2 * s * dq + q * i * (lever * s * v + c1 * c2 * S2 * q))
    return i * (
        c1 * c * (J2 * (dw + dq) + drag2 * w2)
        - c2 * (J1 * dw + drag1 * w)
        + c1 * c2 * s * (m2 * du2 + 2 * k2 * u2)
        + v * (ma1 * c2 * w + ma2 * c1 * w2)
    )


def mean_speed(cycle: Cycle, T: Array, c1: float) -> tuple[Array, Array, Array]:
    """Signed mean speed (m/s), turn (rad) and `along`, whatever phase the cycle begins at.

    In the frame that turns steadily at turn/T the heading chi is periodic, and so is P's path
    about the fixed centre: the mean of P's velocity there has length R |turn|/T.
    """
    nodes = cycle.v.shape[1]
    wk = rfft(cycle.w)
    turn = T[:, 0] * wk[:, 0].real / nodes
    wk[:, 0] = 0.0
    wk[:, 1:] /= 2j * np.pi / T * np.arange(1, nodes // 2 + 1)
    axis = np.exp(1j * irfft(wk, nodes))
    velocity = np.mean(axis * (cycle.v - 1j * c1 * cycle.w), axis=1)
    speed = np.abs(velocity)
    along = (velocity * np.conj(axis.mean(axis=1))).real / np.maximum(speed, 1e-300)
    return np.copysign(speed, along), turn, along


def peaks(signal: Array, finer: int, windows: int) -> Array:
    """Largest |signal| in each of `windows` parts of the period, (gaits, windows).

    Resampled on `finer` times the nodes, then a parabola through the top where it is one.
    """
    nodes = signal.shape[1]
    y = np.abs(irfft(rfft(signal), finer * nodes) * finer)
    part = y.shape[1] // windows
    top = y.reshape(len(y), windows, part).argmax(axis=2) + part * np.arange(windows)
    row = np.arange(len(y))[:, None]
    left, mid, right = (y[row, (top + d) % y.shape[1]] for d in (-1, 0, 1))
    slope, bend = (right - left) / 2, np.minimum(right + left - 2 * mid, -1e-30 - 1e-12 * mid)
    return np.where((mid >= left) & (mid >= right), mid - slope**2 / (2 * bend), mid)


def evaluate(
    robot: Robot,
    choice: RatioChoice | None,
    gaits: Sequence[ArrayLike],
    *,
    nodes: int = 64,
    torque: bool = True,
    finer: int = 4,
    windows: int = 1,
) -> Performance:
    """Speed, turn and what the limits look at for `gaits`: arrays alpha, T, phi0 and J20/J10.

    The ratio is left unread when `choice` is None: the robot as it is.
    """
    gaits = np.broadcast_arrays(*(np.atleast_1d(np.asarray(x, float)) for x in gaits))
    alpha, T, phi0, ratio = (x[:, None] for x in gaits)
    two = body(robot.platform2, robot.k2) if choice is None else loaded_body(robot, choice, ratio)
    one = body(robot.platform1, robot.k1)
    with np.errstate(over="ignore", invalid="ignore"):  # nan: too near the singular posture
        cycle = steady_cycle(one, two, (alpha, T, phi0), nodes, torque)
    c1, c2 = robot.platform1.c, robot.platform2.c
    speed, turn, along = mean_speed(cycle, T, c1)
    largest = np.minimum(np.abs(alpha) + np.abs(phi0), np.pi)[:, 0]
    s1 = c1 * np.cos(largest) + c2
    if cycle.torque is None:
        return Performance(speed, turn, along, s1, np.full((len(speed), 1), np.nan))
    return Performance(speed, turn, along, s1, peaks(cycle.torque, finer, windows))
