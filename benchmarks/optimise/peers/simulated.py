"""A gait's steady cycle by scipy: the speed is affine in its start, so two periods give it."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from scipy.integrate import solve_ivp

from benchmarks.optimise.peers.posed import Array, Posed, motion, sine


class Steady(NamedTuple):
    """At equidistant phases from 0 up to, not including, 1: v, heading seen from a frame that
    turns with the gait, torque; and the turn per period (rad), mean velocity (m/s, complex)."""

    v: Array
    chi: Array
    torque: Array
    turn: float
    velocity: complex


def steady(posed: Posed, gait: Array, samples: int, rtol: float) -> Steady:
    """Integrate one period from rest and from a speed, then from where it repeats itself."""
    amplitude, period, offset, inertia = (float(x) for x in gait)

    def at(theta, v, sin=np.sin, cos=np.cos):
        angle = sine(amplitude, period, offset, theta, sin, cos)
        return motion(posed.robot, inertia, v, angle, sin, cos)

    def rhs(theta, y):
        vdot, w, _, _ = at(theta, y[0], math.sin, math.cos)
        return period * vdot, period * w

    def ends(v):
        return solve_ivp(rhs, (0, 1), (v, 0.0), "DOP853", rtol=rtol, atol=1e-12).y[0, -1]

    first, second = ends(0.0), ends(0.1)
    start = first / (1 - (second - first) / 0.1)
    theta = np.arange(samples + 1) / samples
    run = solve_ivp(rhs, (0, 1), (start, 0.0), "DOP853", theta, rtol=rtol, atol=1e-12)
    v, psi = run.y[:, :-1]
    turn = run.y[1, -1]
    chi = psi - turn * theta[:-1]
    _, _, side, torque = at(theta[:-1], v)
    return Steady(v, chi, torque, turn, complex(np.mean(np.exp(1j * chi) * (v + 1j * side))))
