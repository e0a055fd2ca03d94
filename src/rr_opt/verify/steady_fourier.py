"""Steady cycles of many gaits at once by Fourier series: the model behind the sweep.

Where friction is viscous, vdot = a v + b with a and b known along the gait, and the periodic
solution follows in closed form. Other friction is linearised about the current v and solved
repeatedly (Newton-Kantorovich).

On a left-right symmetric robot the mirror image of a motion is a motion. A straight gait becomes
its own mirror image after half a period, so half a period suffices: v repeats, while w, side and
torque change sign.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import casadi as ca
import numpy as np
from numpy.typing import ArrayLike, NDArray

from rr_opt.array import Array
from rr_opt.mechanics.code_generation import over_arrays
from rr_opt.mechanics.compile_cache import WhenItPays
from rr_opt.model.problem import CANCELLED
from rr_opt.motion.dynamics import Dynamics
from rr_opt.verify.compiled_cycles import CompiledCycles, Steady, compiled
from rr_opt.verify.fourier import derivative, integral, peak, refined, solve, solve_stiff, tail


class Doublings:
    """Changes from the last doublings, for the cycles of G shapes at B periods."""

    def __init__(self, shape: tuple[int, ...]) -> None:
        self._before = np.full((3, *shape), np.nan)
        self._change = np.zeros(shape)

    def error(self, rows: NDArray[np.int_], found: Steady) -> Array:
        """Of speed and turn, and of the peak torque in hundredths, relative; inf until two cycles
        of a shape were found in a row.

        One small change may be chance, as samples fall beside or into a sudden turn of friction: so
        the previous change counts too, by the quarter that a doubling leaves at most.
        """
        now = np.where(np.isfinite(found.error), np.array(found[:3]), np.nan)
        scales = (
            found.scale,
            np.maximum(np.abs(found.turn), 1e-3),
            100 * found.peak_torque + 1e-10,
        )
        away = np.abs(now - self._before[:, rows]) / np.array(scales)
        change = away.max(axis=0)
        error = np.maximum(change, self._change[rows] / 4)
        self._before[:, rows] = now
        self._change[rows] = np.where(np.isfinite(change), change, 0.0)
        return np.where(np.isfinite(error), error, np.inf)


_COARSE = 64
"""Samples at which Newton's method starts; each doubling is a warm start from the previous."""

_STEPS, _COARSE_STEPS = 25, 8
_TINY = 1e-12
"""Slower speeds, m/s, count as this."""

_DAMPED = -1e-9
"""Log of the decay of a disturbance of v over a span, at least; else v never settles."""

_BLOCK = {True: 4096, False: 16384}
"""Samples per batch, by whether friction is viscous: enough for NumPy's overhead per operation to
hardly count, few enough for some arrays to fit the processor's cache."""

_PAYS = {True: 200_000, False: 1000}
"""Points beyond which compiling pays off."""


class _Angle(NamedTuple):
    """phi, dphi = rate omega, ddphi = bend omega^2: phi, rate and bend (n, G), rad, omega (G, B),
    rad/s."""

    phi: Array
    rate: Array
    bend: Array
    omega: Array


_Means = tuple[Array, Array, Array]
_Motion = tuple[Array, Array, Array, Array, Array]
"""v, w, side and torque (n, G B); the relative rounding error of v, inf where v is no steady cycle
(G B,)."""


class Motion(NamedTuple):
    """Steady motion of K gaits over n phases.

    velocity, heading   means in the frame that turns with the gait, m/s and 1, (2, K)
    turn                heading gained per period, rad, (K,)
    torque              N m, (n, K)
    grips               side force of each axle over its load, (2, n, K), or (0, n, K) if not asked
    """

    velocity: Array
    heading: Array
    turn: Array
    torque: Array
    grips: Array


class SteadyFourier:
    """The derived model of a set of effects, evaluated over whole arrays."""

    def __init__(self, dynamics: Dynamics):
        motion, names = dynamics.motion, dynamics.motion.name_in()
        self._powers = SpeedPowers(dynamics)
        self.viscous = dynamics.linear and self._powers.reproduce(dynamics)
        self.mirrored = dynamics.mirrored
        self._motion = over_arrays(motion)
        self._tangent = over_arrays(motion.factory("tangent", names, ["vdot", "jac:vdot:v"]))
        self._grip = over_arrays(dynamics.grip)
        powers = self._powers.function if self.viscous else None
        self._code = WhenItPays(
            lambda make: compiled(dynamics, powers, make=make), look=0, pays=_PAYS[self.viscous]
        )

    def compiled(self, points: int) -> CompiledCycles | None:
        """The compiled loops, if there is a compiler and it pays for this number of points; what
        was compiled before is available at once."""
        return self._code.code(points)

    # Non-finite values mark gaits without a steady cycle, and are kept as such.
    @np.errstate(divide="ignore", over="ignore", invalid="ignore")
    def cycles(
        self,
        amplitude: Array,
        offset: Array,
        period: Array,
        p: Array,
        n: int,
        straight: bool,
        tolerance: float = 1e-6,
    ) -> Steady:
        """Steady cycles from n samples of half a period if straight, else of a whole one.

        amplitude, offset (G,), rad, all offsets 0 if straight; period (G, B), s; p the robots'
        parameters, (len, G) or (len, 1); n a power of two. tolerance: of Newton's method.
        """
        theta = np.arange(n)[:, None] * ((1 if straight else 2) * math.pi / n)
        swing, rate = amplitude * np.sin(theta), amplitude * np.cos(theta)
        return self.along((swing + offset, rate, -swing), period, p, straight, tolerance)

    @np.errstate(divide="ignore", over="ignore", invalid="ignore")
    def along(
        self,
        angle: tuple[Array, Array, Array],
        period: Array,
        p: Array,
        straight: bool,
        tolerance: float = 1e-6,
    ) -> Steady:
        """Steady cycles along phi and its first two derivatives in 2 pi t/T, (n, G) each, rad, over
        half a period if straight: such a gait is its own mirror image half a period later."""
        n = len(angle[0])
        powers = self._powers(angle[0], p) if self.viscous else None
        parts = []
        width = max(1, _BLOCK[self.viscous] // (n * period.shape[1]))
        for block in (slice(k, k + width) for k in range(0, len(period), width)):
            T = period[block]
            span = (T / 2 if straight else T).ravel()
            phi, rate, bend = (part[:, block] for part in angle)
            here = _Angle(phi, rate, bend, 2 * math.pi / T)
            if powers is not None:
                known = Powers(*(_columns(part, block) for part in powers))
                v, w, side, torque, rounding = _by_powers(known, here, span)
            else:
                v, w, side, torque, rounding = self._by_newton(
                    _columns(p, block), here, span, tolerance
                )
            speed, turn = _mean_speed(v, w, side, span, straight)
            top = np.abs(v).max(axis=0)
            scale = np.maximum(np.abs(speed), CANCELLED * top) + _TINY
            error = (tail(v, False) + tail(side, straight) + rounding * top) / scale
            error = np.where(np.isfinite(error) & np.isfinite(speed), error, np.inf)
            results = (speed, turn, peak(torque, straight), error, scale)
            parts.append([result.reshape(T.shape) for result in results])
        return Steady(*(np.concatenate(results) for results in zip(*parts, strict=True)))

    @np.errstate(divide="ignore", over="ignore", invalid="ignore")
    def motion(
        self, angle: tuple[Array, Array, Array], period: Array, p: Array, *, grip: bool
    ) -> Motion:
        """A whole period of the steady motion of gaits given as in `along`, one period (s) each."""
        here = _Angle(*angle, 2 * math.pi / period[:, None])
        if self.viscous:
            v, w, side, torque, _ = _by_powers(self._powers(angle[0], p), here, period)
        else:
            v, w, side, torque, _ = self._by_newton(p, here, period, 1e-6)
        grips = np.empty((0, *v.shape))
        if grip:
            omega = 2 * math.pi / period
            sides = self._grip(v, angle[0], angle[1] * omega, angle[2] * omega**2, *p)
            grips = np.array([np.broadcast_to(one, v.shape) for one in sides])
        return Motion(*_means(v, w, side, period, False), torque, grips)

    def _by_newton(self, p: Array, gaits: _Angle, span: Array, tolerance: float) -> _Motion:
        periods, omega = gaits.omega.shape[1], gaits.omega.ravel()
        phi, rate, bend = (
            np.repeat(part, periods, axis=1) for part in (gaits.phi, gaits.rate, gaits.bend)
        )
        if p.shape[1] > 1:
            p = np.repeat(p, periods, axis=1)
        angle = np.array([phi, rate * omega, bend * omega**2])
        v, settled = self._newton(angle, p, span, 1e-2 * tolerance, _STEPS)
        _, w, side, torque = self._motion(v, *angle, *p)
        return v, w, side, torque, np.where(settled, 0.0, np.inf)

    def _newton(
        self, angle: Array, p: Array, span: Array, last: float, steps: int
    ) -> tuple[Array, NDArray[np.bool_]]:
        """v (n, K) along phi, dphi, ddphi (3, n, K), and where the iteration has converged (K,)."""
        if angle.shape[1] > _COARSE:
            coarse, _ = self._newton(angle[:, ::2], p, span, 1e-4, _COARSE_STEPS)
            v = np.where(np.isfinite(coarse).all(axis=0), refined(coarse), 0.0)
        else:
            # The secant of vdot from v = -1 to 1 m/s, on which dry friction has little effect.
            low, high = (self._motion(v, *angle, *p)[0] for v in (-1.0, 1.0))
            v = solve_stiff((high - low) / 2, (high + low) / 2, span)[0]
        columns, settled = np.arange(len(span)), np.zeros(len(span), bool)
        damp, before = np.ones(len(span)), np.full(len(span), np.inf)
        for _ in range(steps):
            here, robots = v[:, columns], _columns(p, columns)
            vdot, slope = self._tangent(here, *angle[:, :, columns], *robots)
            rest = vdot - derivative(here, span[columns])
            step, mean = solve_stiff(slope, rest, span[columns])
            size = np.abs(step).max(axis=0)
            damp = np.where(size > 0.9 * before, damp / 2, np.minimum(1.5 * damp, 1.0))
            v[:, columns] = here + damp * step
            done = (size <= last * np.abs(here).max(axis=0)) & (mean * span[columns] < _DAMPED)
            settled[columns[done]] = True
            going = ~done & np.isfinite(size) & (damp > 1e-3)
            columns, damp, before = columns[going], damp[going], size[going]
            if not len(columns):
                break
        return v, settled


def _columns(x: Array, which: slice | NDArray[np.int_]) -> Array:
    """The columns of x, which may have a single column for all, or be a scalar."""
    return x[:, which] if np.ndim(x) == 2 and x.shape[1] > 1 else x


def _by_powers(powers: Powers, gaits: _Angle, span: Array) -> _Motion:
    c = Powers(*(np.asarray(part)[..., None] for part in powers))
    omega, q, r = gaits.omega, gaits.rate[..., None], gaits.bend[..., None]
    # In powers of omega: the bracketed terms are computed once for all periods.
    a = (c.a_vq * q) * omega + c.a_v
    b = ((c.a_qq * q**2 + c.a_r * r) * omega + c.a_q * q) * omega
    v, mean, rounding = solve(a.reshape(len(a), -1), b.reshape(len(b), -1), span)
    u = v.reshape(a.shape)
    w = c.w_v * u + (c.w_q * q) * omega
    side = c.s_v * u + (c.s_q * q) * omega
    torque = (c.t_vv * u + (c.t_vq * q) * omega + c.t_v) * u
    torque += ((c.t_qq * q**2 + c.t_r * r) * omega + c.t_q * q) * omega
    w, side, torque = (part.reshape(v.shape) for part in (w, side, torque))
    return v, w, side, torque, np.where(mean * span < _DAMPED, rounding, np.inf)


def _means(v: Array, w: Array, side: Array, span: Array, straight: bool) -> _Means:
    """V and E (2, K) and the heading gained in a period, rad, (K,).

    chi = psi - turn t/T is periodic. V is the mean of P's velocity in the frame that turns with the
    gait, E the mean heading there, which defines forward.
    """
    chi = integral(w, span, straight)
    cos, sin = np.cos(chi), np.sin(chi)
    V, E = [(cos * v - sin * side).mean(axis=0)], [cos.mean(axis=0)]
    if straight:
        # In the mirror image sideways is reversed, so Vy = Ey = 0 over the whole period.
        still = np.zeros_like(V[0])
        return np.array([*V, still]), np.array([*E, still]), still
    V, E = [*V, (sin * v + cos * side).mean(axis=0)], [*E, sin.mean(axis=0)]
    return np.array(V), np.array(E), span * w.mean(axis=0)


def _mean_speed(
    v: Array, w: Array, side: Array, span: Array, straight: bool
) -> tuple[Array, Array]:
    """Signed mean speed (m/s) and turn (rad), (K,)."""
    V, E, turn = _means(v, w, side, span, straight)
    return np.copysign(np.hypot(*V), (V * E).sum(axis=0)), turn


class Powers(NamedTuple):
    """Coefficients by output and power; r stands for ddphi."""

    a_vq: Array
    a_v: Array
    a_qq: Array
    a_q: Array
    a_r: Array
    w_v: Array
    w_q: Array
    s_v: Array
    s_q: Array
    t_vv: Array
    t_vq: Array
    t_v: Array
    t_qq: Array
    t_q: Array
    t_r: Array


class SpeedPowers:
    """(phi, p) -> Powers over arrays that broadcast."""

    def __init__(self, dynamics: Dynamics):
        phi, p = ca.SX.sym("phi"), ca.SX.sym("p", len(dynamics.parameters))
        u = ca.SX.sym("u", 3)
        outputs = dynamics.motion(u[0], phi, u[1], u[2], p)

        def at_rest(expression: ca.SX) -> ca.SX:
            return ca.substitute(expression, u, ca.SX.zeros(3, 1))

        slopes = [at_rest(ca.jacobian(output, u)) for output in outputs]
        vdot, torque = (at_rest(ca.hessian(output, u)[0]) for output in (outputs[0], outputs[3]))
        a, w, s, t = slopes
        powers = ca.vertcat(
            *(vdot[0, 1], a[0], vdot[1, 1] / 2, a[1], a[2]),
            *(w[0], w[1], s[0], s[1]),
            *(torque[0, 0] / 2, torque[0, 1], t[0], torque[1, 1] / 2, t[1], t[2]),
        )
        self.function = ca.Function("powers", [phi, p], ca.vertsplit(ca.cse(powers)))
        self._over_arrays = over_arrays(self.function)

    def __call__(self, phi: ArrayLike, p: ArrayLike) -> Powers:
        """phi: an array; p: one array per parameter."""
        return Powers(*self._over_arrays(phi, *np.asarray(p)))

    def reproduce(self, dynamics: Dynamics) -> bool:
        """Whether the polynomials reproduce the motion, checked numerically at many states."""
        draw = np.random.default_rng(0)
        for _ in range(8):
            p = draw.uniform(0.5, 1.5, len(dynamics.parameters))
            phi, (v, q, r) = draw.uniform(-1, 1), draw.uniform(-4, 4, 3)
            c = self(np.float64(phi), p)
            tried = (
                c.a_vq * v * q + c.a_v * v + c.a_qq * q**2 + c.a_q * q + c.a_r * r,
                c.w_v * v + c.w_q * q,
                c.s_v * v + c.s_q * q,
                c.t_vv * v**2 + c.t_vq * v * q + c.t_v * v
                + c.t_qq * q**2 + c.t_q * q + c.t_r * r,
            )  # fmt: skip
            true = [float(value) for value in dynamics.motion(v, phi, q, r, p)]
            if not np.allclose(tried, true, rtol=1e-9, atol=1e-9):
                return False
        return True
