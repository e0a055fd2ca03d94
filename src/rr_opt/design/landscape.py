"""Speed and peak torque of many gaits at once on a coarse grid: starts for multiple shooting.

The steady cycle of K gaits over N phases in whole-array arithmetic. With viscous friction
vdot = a v + b, so each integrator step is an affine map of v, known for all steps in advance; the
cycle closes at the fixed point of their composition. Other friction is linearised in v, repeatedly,
until the cycle converges.
"""

from __future__ import annotations

import ctypes
import math
from dataclasses import dataclass, fields
from functools import lru_cache
from typing import Any

import casadi as ca
import numpy as np

from rr_opt.array import Array
from rr_opt.mechanics.code_generation import ArrayFunction, in_stages, over_arrays, source_file
from rr_opt.mechanics.compile_cache import WhenItPays, library
from rr_opt.mechanics.kinematics import G
from rr_opt.model.ballast import By, Loads, hang
from rr_opt.model.problem import Interval
from rr_opt.model.robot import Robot
from rr_opt.motion.dynamics import Dynamics, derive

_FLAGS = (
    *("-O2", "-march=native", "-mprefer-vector-width=512", "-fno-math-errno"),
    *("-fno-trapping-math", "-fPIC", "-shared"),
)
_PAYS = 500_000
"""Gaits times phases beyond which compiling pays off."""


def _by_code(loop: ctypes.CDLL, gaits: Array, p: Array, nodes: int) -> Cycles:
    """Steady cycles by the compiled, vectorised loop over the gaits; sines with viscous friction
    only.

    gaits: amplitude, period, offset, (3 or more, K); p: parameters (K, n)
    """
    count = gaits.shape[1]
    amplitude, period, offset = np.ascontiguousarray(gaits[:3], dtype=float)
    which = np.arange(count)
    speed, turn, mean = np.empty(count), np.empty(count), np.empty((4, count))
    v, chi, torque = np.empty((3, nodes, count))
    sine, cosine = _waves(nodes)
    given = (amplitude, offset, period, which, p, sine, cosine, speed, turn, mean)
    pointers = (ctypes.c_void_p(one.ctypes.data) for one in (*given, v, chi, torque))
    sizes = (ctypes.c_longlong(one) for one in (count, nodes))
    if not loop.rr_landscape(*sizes, *pointers):
        raise MemoryError
    return Cycles(speed, torque, v, chi, turn, mean)


@lru_cache
def _waves(nodes: int) -> tuple[Array, Array]:
    """Sine and cosine at the nodes and halfway between them."""
    theta = 2 * np.pi * (np.arange(2 * nodes) / (2 * nodes))
    return np.sin(theta), np.cos(theta)


_SECANTS, _TANGENTS = 4, 10
_TOO_SLOW, _SETTLED = 1e-9, 1e-7  # m/s
# Gaits times phases per batch: a few arrays of this length fit the processor's cache.
_BLOCK = 4096


@dataclass(frozen=True)
class Cycles:
    """Steady cycles of K gaits at N phases: the data for a multiple-shooting start.

    speed (K,) signed, m/s; torque (N, K) N m; v, chi (N, K) m/s, rad; turn (K,) rad;
    mean (4, K) V and E as in `multiple_shooting`.
    """

    speed: Array
    torque: Array
    v: Array
    chi: Array
    turn: Array
    mean: Array

    @property
    def peak_torque(self) -> Array:
        """Largest |torque| at the phases, (K,), N m."""
        return np.abs(self.torque).max(axis=0)


class Landscape:
    """The gaits of one robot, with its ballast variable over an interval."""

    def __init__(self, dynamics: Dynamics, robot: Robot, by: By, loads: Loads, ballast: Interval):
        functions = _array_functions(dynamics.effects)
        self._rates, self._torque, self._affine, self._tangent = functions
        self._code = _code(dynamics.effects) if dynamics.linear else None
        self._values = list(dynamics.values(robot))
        self._names, self._effects = dynamics.parameters, dynamics.effects
        self.linear = dynamics.linear
        self._by: By = by
        self._range = ballast.low, ballast.high
        self.loads = loads

    def cycles(self, gaits: Array, nodes: int) -> Cycles:
        """Steady cycles of gaits (4, K): amplitude, period, offset, ballast share."""
        count = gaits.shape[1]
        loop = self._code and self._code.code(count * nodes)
        if loop:
            p = np.empty((count, len(self._names)))
            for column, values in zip(p.T, self._parameters(gaits[3]), strict=True):
                column[:] = values
            return _by_code(loop, gaits, p, nodes)
        blocks = min(math.ceil(count * nodes / _BLOCK), count)
        # A gait that does not converge gives inf or nan; the caller checks.
        with np.errstate(all="ignore"):
            parts = [self._block(part, nodes) for part in np.array_split(gaits, blocks, axis=1)]
        if len(parts) == 1:
            return parts[0]
        return Cycles(
            *(
                np.concatenate([getattr(part, field.name) for part in parts], axis=-1)
                for field in fields(Cycles)
            )
        )

    def _block(self, gaits: Array, nodes: int) -> Cycles:
        return self.along(_angle(gaits, 2 * nodes), gaits[1], gaits[3])

    def along(self, angle: tuple[Array, Array, Array], period: Array, share: Array) -> Cycles:
        """Steady cycles along phi (rad), dphi (rad/s), ddphi (rad/s2) of any shape.

        Each is (2 N, K), at N nodes and halfway between them; period (s) and share are (K,).
        """
        p = self._parameters(share)
        h = period / (len(angle[0]) // 2)
        at_nodes = [part[::2] for part in angle]
        if self.linear:
            a, b, *rates = self._affine(*angle, *p)
            v = _close_affine(a, b, h)[::2]
            gains, shifts = rates[::2], rates[1::2]
            w, side = (
                gain[::2] * v + shift[::2] for gain, shift in zip(gains, shifts, strict=True)
            )
        else:
            v = self._close_by_lines(angle, p, h)
            _, w, side = self._rates(v, *at_nodes, *p)
        (torque,) = self._torque(v, *at_nodes, *p)
        return _summary(v, w, side, torque, period)

    def grips(self, cycles: Cycles, gaits: Array) -> Array:
        """Side force of each axle over its load, (2, N, K), on the cycles of these gaits (4, K)."""
        angle = _angle(gaits, len(cycles.v))
        found = _grip(self._effects)(cycles.v, *angle, *self._parameters(gaits[3]))
        return np.array(np.broadcast_arrays(*found))

    def costs(self, cycles: Cycles, gaits: Array, denser: int = 1) -> tuple[Array, Array]:
        """Mean positive power of the servo, W, and cost of transport, (K,), on the cycles of these
        gaits (4, K); `denser`: factor of oversampling."""
        amplitude, period, _, share = gaits
        n, omega = len(cycles.torque) * denser, 2 * math.pi / period
        theta = 2 * math.pi * np.arange(n)[:, None] / n
        rate = amplitude * omega * np.cos(theta)
        power = mean_positive(dense(cycles.torque, denser) * rate)
        p = dict(zip(self._names, self._parameters(share), strict=True))
        return power, power / ((p["m1"] + p["m2"]) * G * np.abs(cycles.speed))

    def _parameters(self, share: Array) -> list:
        low, high = self._range
        amount = low + share * (high - low)
        values = dict(zip(self._names, self._values, strict=True))
        return list(ballasted(values, self._by, self.loads.each, amount).values())

    def _close_by_lines(self, angle: tuple[Array, ...], p: list, h: Array) -> Array:
        """v at the nodes of the cycle, for friction that is not viscous.

        vdot is linearised in v at every phase and the cycle closed, repeatedly: first by secants
        through v = 0, which converge slowly but from anywhere, then by tangents
        (Newton-Kantorovich). Where the tangents do not converge, the last secant iterate is kept.
        """
        at_rest = self._tangent(np.zeros_like(angle[0]), *angle, *p)[0]
        v = np.zeros_like(angle[0])
        for _ in range(_SECANTS):
            vdot, slope = self._tangent(v, *angle, *p)
            moving = np.abs(v) > _TOO_SLOW
            chord = (vdot - at_rest) / np.where(moving, v, 1.0)
            v = _close_affine(np.where(moving, chord, slope), at_rest, h)
        settled = v
        change = np.zeros(v.shape[1])
        for _ in range(_TANGENTS):
            vdot, slope = self._tangent(v, *angle, *p)
            closed = _close_affine(np.broadcast_to(slope, v.shape), vdot - slope * v, h)
            change = np.abs(closed - v).max(axis=0)
            v = closed
            if np.all(change < _SETTLED):
                break
        return np.where(change < _SETTLED, v, settled)[::2]


def ballasted(
    values: dict[str, Any], by: By, each: tuple[Any, Any, Any], amount: Any
) -> dict[str, Any]:
    """A robot's parameters, numbers or expressions, with the ballast on platform 2: this number of
    loads, each as in `hang`, or this I2 (kg m2)."""
    if by == "inertia":
        return values | {"I2": amount}
    m, I, c, a = (values[f"{symbol}2"] for symbol in ("m", "I", "c", "a"))
    m, I, reach = hang(m, I, c - a, each, amount)
    return values | {"m2": m, "I2": I, "a2": c - reach}


def _angle(gaits: Array, phases: int) -> tuple[Array, Array, Array]:
    """phi, dphi and ddphi (phases, K) of sines (4, K)."""
    amplitude, period, offset = gaits[:3]
    theta = 2 * math.pi * (np.arange(phases) / phases)[:, None]
    omega, sine = 2 * math.pi / period, amplitude * np.sin(theta)
    return sine + offset, amplitude * omega * np.cos(theta), -(omega**2) * sine


@lru_cache
def _array_functions(effects: tuple[str, ...]) -> tuple[ArrayFunction, ...]:
    """Over arrays: vdot, w, side of (v, phi, dphi, ddphi, p); torque of the same; of (phi, dphi,
    ddphi, p) the gain on v and the shift of vdot, w and side, where those are affine in v; vdot and
    its slope in v, of (v, phi, dphi, ddphi, p)."""
    motion = derive(effects).motion
    names = motion.name_in()
    return (
        over_arrays(motion.factory("rates", names, ["vdot", "w", "side"])),
        over_arrays(motion.factory("torque", names, ["torque"])),
        over_arrays(_affine(motion)),
        over_arrays(motion.factory("tangent", names, ["vdot", "jac:vdot:v"])),
    )


@lru_cache
def _grip(effects: tuple[str, ...]) -> ArrayFunction:
    return over_arrays(derive(effects).grip)


@lru_cache
def _code(effects: tuple[str, ...]) -> WhenItPays[ctypes.CDLL]:
    """The compiled loop over the gaits, once gaits times phases make it pay.

    affine  (phi, dphi, ddphi, p) -> gain on v and shift of vdot, w and side, one after the other
    torque  (v, phi, dphi, ddphi, p) -> torque
    """
    motion = derive(effects).motion
    affine = _affine(motion)
    torque = motion.factory("torque", motion.name_in(), ["torque"])

    def build(make: bool) -> ctypes.CDLL | None:
        try:
            lines = in_stages(affine, "affine", (1, 1, 1, 0))
            load = in_stages(torque, "torque", (1, 1, 1, 1, 0))
        except NotImplementedError:
            return None
        lanes, points = (
            source_file("rr_opt.mechanics", name) for name in ("lanes.c", "gait_points.c")
        )
        loop = source_file("rr_opt.design", "landscape.c")
        head = f"#define NP {affine.nnz_in(3)}\n"
        head += f"#define NK_AFFINE {lines.kept[0]}\n#define NK_TORQUE {load.kept[0]}\n"
        parts = [head, lanes, points, lines.source, load.source, loop]
        return library("".join(parts), _FLAGS, make=make)

    return WhenItPays(build, look=0, pays=_PAYS)


def _affine(motion: ca.Function) -> ca.Function:
    v, phi, dphi, ddphi = (ca.SX.sym(name) for name in motion.name_in()[:4])
    p = ca.SX.sym("p", motion.numel_in(4))
    parts = []
    for rate in motion(v, phi, dphi, ddphi, p)[:3]:
        parts += [ca.substitute(part, v, ca.SX(0)) for part in (ca.jacobian(rate, v), rate)]
    return ca.Function(
        "affine", [phi, dphi, ddphi, p], ca.vertsplit(ca.cse(ca.densify(ca.vertcat(*parts))))
    )


def _close_affine(a: Array, b: Array, h: Array) -> Array:
    """v at nodes and midpoints of the periodic solution of v' = a v + b, with a and b given there.

    Hermite-Simpson steps (Lobatto IIIA, order 4): with f = a v + b,

        v_mid = (v_0 + v_1)/2 + h/8 (f_0 - f_1),    v_1 = v_0 + h/6 (f_0 + 4 f_mid + f_1)

    solved for v_1. Explicit steps of the same order cost as much and are unstable where dry
    friction makes a large.
    """
    a0, am, a1 = a[0::2], a[1::2], np.roll(a[0::2], -1, axis=0)
    b0, bm, b1 = b[0::2], b[1::2], np.roll(b[0::2], -1, axis=0)
    divisor = 1 - h / 6 * (a1 + am * (2 - h / 2 * a1))
    gain = (1 + h / 6 * (a0 + am * (2 + h / 2 * a0))) / divisor
    shift = h / 6 * (b0 + 4 * bm + b1 + h / 2 * am * (b0 - b1)) / divisor
    v = np.empty_like(a)
    v[0::2] = _periodic(gain, shift)
    v0, v1 = v[0::2], np.roll(v[0::2], -1, axis=0)
    v[1::2] = (v0 + v1) / 2 + h / 8 * (a0 * v0 + b0 - a1 * v1 - b1)
    return v


def _periodic(gain: Array, shift: Array) -> Array:
    """The periodic solution (N, K) of v_k+1 = gain_k v_k + shift_k.

    Steps are composed in blocks, side by side: a loop over all of them would take ten times longer.
    """
    count, columns = gain.shape
    length = math.isqrt(count - 1) + 1
    blocks = -(-count // length)
    rest = np.zeros((blocks * length - count, columns))
    gains = np.concatenate([gain, rest + 1]).reshape(blocks, length, columns)
    shifts = np.concatenate([shift, rest]).reshape(blocks, length, columns)
    # v = products v_0 + totals, with v_0 at the beginning of each block.
    products = np.ones((length + 1, blocks, columns))
    totals = np.zeros_like(products)
    for k in range(length):
        np.multiply(gains[:, k], products[k], out=products[k + 1])
        np.multiply(gains[:, k], totals[k], out=totals[k + 1])
        totals[k + 1] += shifts[:, k]
    start = np.empty((blocks + 1, columns))
    across, total = 1.0, 0.0
    for g, s in zip(products[-1], totals[-1], strict=True):
        across, total = g * across, g * total + s
    start[0] = np.divide(total, 1 - across)
    for k in range(blocks):
        start[k + 1] = products[-1, k] * start[k] + totals[-1, k]
    path = products[:-1] * start[:-1] + totals[:-1]
    return path.swapaxes(0, 1).reshape(blocks * length, columns)[:count]


def _summary(v: Array, w: Array, side: Array, torque: Array, period: Array) -> Cycles:
    turn = period * w.mean(axis=0)
    rate = period * w - turn
    # Integral over an interval of a periodic function from four nodes, order 4.
    ahead, behind = np.roll(rate, -1, axis=0), np.roll(rate, 1, axis=0)
    inner = 13 * (rate + ahead) - behind - np.roll(rate, -2, axis=0)
    chi = np.cumsum(inner, axis=0) / (24 * len(v))
    chi = np.concatenate([np.zeros((1, v.shape[1])), chi[:-1]])
    cos, sin = np.cos(chi), np.sin(chi)
    mean = np.array(
        [(cos * v - sin * side).mean(0), (sin * v + cos * side).mean(0), cos.mean(0), sin.mean(0)]
    )
    forward = mean[0] * mean[2] + mean[1] * mean[3]
    return Cycles(np.copysign(np.hypot(mean[0], mean[1]), forward), torque, v, chi, turn, mean)


def dense(x: Array, times: int) -> Array:
    """Periodic functions (N, K) oversampled by a factor."""
    if times == 1 or not np.isfinite(x).all():
        return np.repeat(x, times, axis=0)
    return np.fft.irfft(np.fft.rfft(x, axis=0), times * len(x), axis=0) * times


_NEAR = np.arange(-2, 4)
_SEXTIC = np.linalg.inv(np.vander(_NEAR.astype(float), increasing=True))
"""From values at -2 .. 3 to the coefficients of the polynomial through them."""
_POWERS = np.arange(1, 7)
_NEWTON = 4


def mean_positive(x: Array) -> Array:
    """Mean of the positive part of periodic functions (N, K), (K,).

    Between two phases the function is the polynomial through six, integrated from its zero where it
    changes sign. The integrand vanishes there, so the mean is as smooth as the function.
    """
    n = len(x)
    near = np.array([np.roll(x, -k, axis=0) for k in _NEAR])
    weights = (1.0 / _POWERS) @ _SEXTIC
    whole = np.tensordot(weights, near, 1)
    here, there = x, np.roll(x, -1, axis=0)
    total = np.where((here > 0) & (there > 0), whole, 0.0).sum(axis=0)
    rows, columns = np.nonzero((here > 0) != (there > 0))
    p = _SEXTIC @ near[:, rows, columns]
    slope = p[1:] * _POWERS[:5, None]
    start, end = here[rows, columns], there[rows, columns]
    s = start / np.where(start != end, start - end, 1.0)
    for _ in range(_NEWTON):
        steep = np.polynomial.polynomial.polyval(s, slope, tensor=False)
        fall = np.polynomial.polynomial.polyval(s, p, tensor=False)
        s = np.clip(s - fall / np.where(steep != 0, steep, 1.0), 0.0, 1.0)
    below = s * np.polynomial.polynomial.polyval(s, p / _POWERS[:, None], tensor=False)
    part = np.where(start > 0, below, whole[rows, columns] - below)
    return (total + np.bincount(columns, part, minlength=x.shape[1])) / n
