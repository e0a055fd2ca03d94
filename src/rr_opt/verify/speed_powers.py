"""The motion as a polynomial in the speeds, with coefficients that know the posture alone.

For a gait phi(t) with viscous friction Kane's equations give, with q = dphi,

    vdot   = a_vq v q + a_v v + a_qq q^2 + a_q q + a_r ddphi
    w      = w_v v + w_q q                      side = s_v v + s_q q
    torque = t_vv v^2 + t_vq v q + t_v v + t_qq q^2 + t_q q + t_r ddphi

and the coefficients depend on phi and the robot. Gaits that differ in their period alone pass
through the same postures, so a sweep evaluates the coefficients once for all of them.
"""

from __future__ import annotations

from typing import NamedTuple

import casadi as ca
import numpy as np
from numpy.typing import ArrayLike

from rr_opt.array import Array
from rr_opt.mechanics.vectorised import over_arrays
from rr_opt.motion.dynamics import Dynamics


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
        """Whether the polynomials are the motion, tried in numbers at states all over."""
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
