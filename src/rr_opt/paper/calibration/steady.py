"""Mean speeds of straight steady cycles, thousands of robots at once.

A straight gait is its own mirror image half a period later, so half a period says everything
and v repeats after it. With viscous friction v is the periodic solution of a linear equation.
With dry friction it is stepped through half a period, and the speed at its start is moved by
Newton's method inside a bracket until the end meets it.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from rr_opt.paper.calibration.coefficients import Linear, Wheels
from rr_opt.physics.effects.coulomb_friction import SMOOTHING_SPEED
from rr_opt.verify.periodic_linear import solve
from rr_opt.verify.spectral import integral

Array = NDArray[np.float64]

_STEPS = 30
_SETTLED = 3e-5
"""A Newton step below this share of the largest |v| is the last."""
_STILL = 1e-7  # m/s
_FIRST_STEP = 0.1  # m/s


def viscous_speed(known: Linear, q: Array, period: Array) -> Array:
    """Mean speed of P (G,), m/s, positive along platform 1; NaN where nothing settles.

    known, q (rad/s): at n equal steps of half a period (n, G); period (s), (G,).
    """
    v, damping = solve(known.slope, known.drive, period / 2)
    return np.where(damping < 0, _mean(v, known, q, period), np.nan)


def dry_speed(known: Linear, rolling: Wheels, force: Array, q: Array, period: Array) -> Array:
    """The same with a dry friction `force` (N, (G,)) at each wheel; samples at mid-step.

    NaN where the search did not settle within its steps.
    """
    step = period / 2 / len(q)
    along, carried = rolling.along_v / SMOOTHING_SPEED, rolling.carried / SMOOTHING_SPEED
    push = force * rolling.along_v / rolling.inertia
    parts = (known.slope, known.drive, along, carried, push)
    v = np.full_like(q, np.nan)
    start = solve(known.slope, known.drive, period / 2)[0][0]
    low, high = np.full(len(step), -np.inf), np.full(len(step), np.inf)
    left = np.arange(len(step))
    for _ in range(_STEPS):
        path, end, gain = _half_period(parts, start, step[left])
        gap = end - start
        move = gap / (1 - gain)
        done = np.abs(move) < _SETTLED * np.abs(path).max(axis=0) + _STILL
        v[:, left[done]] = path[:, done]
        # Friction brakes: the gap falls as the start grows, so its sign says where the cycle is.
        low, high = np.where(gap > 0, start, low), np.where(gap > 0, high, start)
        start = _inside(start, move, gap, low, high)
        going = ~done & np.isfinite(start)
        left, start, low, high = left[going], start[going], low[going], high[going]
        if not len(left):
            break
        parts = tuple(part[..., going] for part in parts)
    return _mean(v, known, q, period)


def _inside(start: Array, move: Array, gap: Array, low: Array, high: Array) -> Array:
    """The next start: Newton's, else the middle of the bracket, else further out."""
    proposed = start + move
    further = start + np.copysign(np.maximum(_FIRST_STEP, np.abs(start)), gap)
    closed = np.isfinite(low) & np.isfinite(high)
    middle = np.where(closed, (np.where(closed, low, 0.0) + np.where(closed, high, 0.0)) / 2,
                      further)  # fmt: skip
    return np.where((proposed > low) & (proposed < high), proposed, middle)


def _half_period(parts: tuple[Array, ...], start: Array, h: Array) -> tuple[Array, Array, Array]:
    """v at mid-step (n, G), v at the end (G,), and how the end moves with the start (G,).

    Each step is exact for the equation linearised where it begins (Rosenbrock-Euler), with the
    coefficients of its middle: of order two, and stable however steep the friction is.
    """
    slope, drive, along, carried, push = parts
    path, v, gain = np.empty_like(drive), start, np.ones_like(start)
    for i in range(len(drive)):
        grip = np.tanh(along[:, i] * v + carried[:, i])
        rate = slope[i] * v + drive[i] - (push[:, i] * grip).sum(axis=0)
        J = slope[i] - (push[:, i] * along[:, i] * (1 - grip**2)).sum(axis=0)
        grown = np.expm1(h * J)
        after = v + rate * grown / J
        path[i] = (v + after) / 2
        v, gain = after, gain * (1 + grown)
    return path, v, gain


def _mean(v: Array, known: Linear, q: Array, period: Array) -> Array:
    """The displacement of P over a period, over the period; see verify.steady_fourier.

    P also moves at -c1 w across platform 1, which adds c1 times the integral of sin(chi) d chi:
    nothing, as cos(chi) is the same half a period later.
    """
    w = known.turn_v * v + known.turn_q * q
    chi = integral(w, period / 2, True)
    ahead = (np.cos(chi) * v).mean(axis=0)
    return np.copysign(ahead, ahead * np.cos(chi).mean(axis=0))
