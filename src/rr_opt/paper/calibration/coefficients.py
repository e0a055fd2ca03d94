"""The derived equation of motion as coefficients that know the posture alone, over arrays.

With q = dphi and r = ddphi viscous friction gives

    vdot = (a_vq q + a_v) v + a_qq q^2 + a_q q + a_r r,     w = w_v v + w_q q

and wheel i rolls at u_i = p_i v + s_i q. A force -F(u_i) at each wheel adds
-sum F(u_i) p_i/inertia to vdot. `rr_opt.verify.speed_powers` has the first of these too, and the
torque, which costs five times as much as all that is needed here.
"""

from __future__ import annotations

from functools import lru_cache
from typing import NamedTuple

import casadi as ca
import numpy as np
from numpy.typing import NDArray

from rr_opt.physics.arrays import ArrayFunction, over_arrays
from rr_opt.physics.dynamics import derive
from rr_opt.physics.kinematics import ROBOT_PARAMETERS, mechanism

Array = NDArray[np.float64]


class Linear(NamedTuple):
    """vdot = slope v + drive and w = turn_v v + turn_q q along a gait, (n, G) each, SI."""

    slope: Array
    drive: Array
    turn_v: Array
    turn_q: Array


class Wheels(NamedTuple):
    """p_i and s_i q of the four wheels, (4, n, G) each, and the inertia seen by v, (n, G), kg."""

    along_v: Array
    carried: Array
    inertia: Array


def linear(phi: Array, q: Array, r: Array, p: Array) -> Linear:
    """phi (rad), q (rad/s), r (rad/s2) at n samples of G gaits (n, G); p (13, G)."""
    a_vq, a_v, a_qq, a_q, a_r, w_v, w_q = _functions()[0](phi, *p)
    return Linear(a_vq * q + a_v, (a_qq * q + a_q) * q + a_r * r, w_v, w_q)


def wheels(phi: Array, q: Array, p: Array) -> Wheels:
    """The same for what the wheels do."""
    *rolling, inertia = (np.broadcast_to(part, phi.shape) for part in _functions()[1](phi, *p))
    return Wheels(np.array(rolling[:4]), np.array(rolling[4:]) * q, inertia)


@lru_cache
def _functions() -> tuple[ArrayFunction, ArrayFunction]:
    dynamics, robot = derive(()), mechanism()
    phi, p = ca.SX.sym("phi"), ca.SX.sym("p", len(ROBOT_PARAMETERS))
    v, q, r = (ca.SX.sym(name) for name in "vqr")
    vdot, w, _, _ = dynamics.motion(v, phi, q, r, p)
    bend = ca.hessian(vdot, ca.vertcat(v, q))[0]
    inertia = ca.hessian(dynamics.energy(v, phi, q, p)[0], v)[0]
    here = ca.vertcat(robot.phi, robot.speeds, *(robot.parameters[n] for n in ROBOT_PARAMETERS))
    speeds = [
        ca.substitute(robot.rolling_speed(wheel), here, ca.vertcat(phi, v, 0, 0, q, p))
        for wheel in robot.wheels
    ]

    def coefficients(name: str, *parts: ca.SX) -> ArrayFunction:
        at_rest = ca.substitute(ca.vertcat(*parts), ca.vertcat(v, q, r), ca.SX.zeros(3))
        return over_arrays(ca.Function(name, [phi, p], ca.vertsplit(ca.cse(at_rest))))

    slopes = (ca.jacobian(vdot, x) for x in (v, q, r))
    a_v, a_q, a_r = slopes
    turning = (ca.jacobian(w, x) for x in (v, q))
    rolling = (ca.jacobian(u, x) for x in (v, q) for u in speeds)
    return (
        coefficients("linear", bend[0, 1], a_v, bend[1, 1] / 2, a_q, a_r, *turning),
        coefficients("wheels", *rolling, inertia),
    )
