"""What one interval of multiple shooting contributes, and the limits: values and derivatives."""

from __future__ import annotations

import math
from functools import lru_cache
from typing import Any

import casadi as ca

from rr_opt.motion.tableau import Tableau
from rr_opt.physics.dynamics import derive
from rr_opt.robot.ballast import By, hang

DECISIONS = ("amplitude", "period", "offset", "ballast", "turn")
"""alpha (rad), T (s), phi0 (rad), I2 (kg m2) or number of loads on a scale from 0 at its lower
bound to 1 at its upper, heading per period (rad)."""

TURN = ("curvature", "yaw_rate", "heading")
LIMITS = ("rate", "angle+", "angle-", "singularity+", "singularity-", "direction", *TURN)
"""Rows of the program that hold once a period, in their order; torque holds at every node."""


@lru_cache
def interval_of(effects: tuple[str, ...], by: By, method: Tableau) -> IntervalTerms:
    """The terms for these effects, this way of changing the inertia and this method."""
    return IntervalTerms(effects, by, method)


class IntervalTerms:
    """What one interval, and the limits, contribute: values, first and second derivatives.

    step       (v, chi, theta, width, z, fixed) -> v, chi, V, E at the end, torque at the start
    shared     length of `fixed`: robot, loads and ballast range
    """

    def __init__(self, effects: tuple[str, ...], by: By, method: Tableau):
        dynamics = derive(effects)
        names = dynamics.parameters
        z = ca.SX.sym("z", len(DECISIONS))
        amplitude, T, offset, share, turn = ca.vertsplit(z)
        fixed = ca.SX.sym("fixed", len(names) + 5)
        values = _with_ballast(fixed, names, share, by)
        v, chi, theta, width = (ca.SX.sym(name) for name in ("v", "chi", "theta", "width"))

        def motion(theta: ca.SX, v: ca.SX) -> Any:
            omega = 2 * math.pi / T
            swing = amplitude * ca.sin(2 * math.pi * theta)
            rate = amplitude * omega * ca.cos(2 * math.pi * theta)
            return dynamics.motion(v, swing + offset, rate, -(omega**2) * swing, values)

        def rhs(fraction: float, y: ca.SX) -> ca.SX:
            vdot, w, side, _ = motion(theta + fraction * width, y[0])
            cos, sin = ca.cos(y[1]), ca.sin(y[1])
            V = ca.vertcat(cos * y[0] - sin * side, sin * y[0] + cos * side)
            return ca.vertcat(T * vdot, T * w - turn, V, cos, sin)

        end = method.step(rhs, ca.vertcat(v, chi, 0, 0, 0, 0), width)
        out = ca.cse(ca.vertcat(end, motion(theta, v)[3]))
        inner = ca.vertcat(v, chi, z)
        inputs = [v, chi, theta, width, z, fixed]
        weights = ca.SX.sym("weights", out.numel())
        slopes = ca.densify(ca.jacobian(out, inner))
        curves = ca.densify(ca.hessian(ca.dot(weights, out), inner)[0])
        self.shared = fixed.numel()
        self.step = ca.Function("step", inputs, [out])
        self.jacobian = ca.Function("jacobian", inputs, [ca.cse(slopes)])
        self.hessian = ca.Function("hessian", [*inputs, weights], [ca.cse(curves)])

        mean, sign = ca.SX.sym("mean", 4), ca.SX.sym("sign")
        rows = _limit_rows(z, mean, fixed, names, sign)
        lam = ca.SX.sym("lam", len(LIMITS))
        inputs = [z, mean, fixed, sign]
        self.limits = ca.Function("limits", inputs, [rows])
        self.limit_slopes = ca.Function(
            "limit_slopes", inputs, [ca.jacobian(rows, z), ca.jacobian(rows, mean)]
        )
        weighted = ca.dot(lam, rows)
        self.limit_curves = ca.Function(
            "limit_curves",
            [*inputs, lam],
            [
                ca.hessian(weighted, z)[0],
                ca.jacobian(ca.gradient(weighted, z), mean),
                ca.hessian(weighted, mean)[0],
            ],
        )


def _limit_rows(z, mean, fixed, names, sign):
    """Rows of LIMITS; each is bounded by the limit of its name, so a row's multiplier is the
    speed gained per unit of that limit."""
    amplitude, period, offset, turn = z[0], z[1], z[2], z[4]
    V, E = mean[:2], mean[2:]
    c1, c2 = fixed[names.index("c1")], fixed[names.index("c2")]
    return ca.vertcat(
        2 * math.pi * amplitude / period,
        offset + amplitude,
        amplitude - offset,
        c1 * ca.cos(offset + amplitude) + c2,
        c1 * ca.cos(offset - amplitude) + c2,
        sign * ca.dot(V, E),
        turn / (period * ca.norm_2(V)),
        turn / period,
        turn,
    )


def _with_ballast(fixed: ca.SX, names: tuple[str, ...], share: ca.SX, by: By) -> ca.SX:
    """The robot's parameter vector with platform 2 changed by the ballast."""
    values = {name: fixed[i] for i, name in enumerate(names)}
    mass, distance, spread, low, high = ca.vertsplit(fixed[len(names) :])
    amount = low + share * (high - low)
    if by == "loads":
        m, I, c, a = (values[f"{symbol}2"] for symbol in ("m", "I", "c", "a"))
        values["m2"], values["I2"], reach = hang(m, I, c - a, (mass, distance, spread), amount)
        values["a2"] = c - reach
    else:
        values["I2"] = amount
    return ca.vertcat(*values.values())
