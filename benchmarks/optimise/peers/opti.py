"""CasADi's Opti as its manual's race car does it: multiple shooting, RK4, 100 intervals."""

from __future__ import annotations

from collections.abc import Callable

import casadi as ca
import numpy as np

from benchmarks.optimise.peers.posed import Array, Claim, Posed, motion, sine
from benchmarks.optimise.peers.simulated import steady

NAME = "CasADi Opti, multiple shooting"
_N = 100


def prepare(posed: Posed) -> Callable[[Array], Claim]:
    """The solver of a problem, built once and then started anew."""
    opti = ca.Opti()
    decided = [
        opti.variable() if low < high else ca.MX(low)
        for low, high in zip(posed.least, posed.most, strict=True)
    ]
    amplitude, period, offset, inertia = decided
    turn = opti.variable()
    X = opti.variable(4, _N + 1)  # v, chi and the mean velocity's integrals

    def at(theta, v):
        angle = sine(amplitude, period, offset, theta, ca.sin, ca.cos)
        return motion(posed.robot, inertia, v, angle, ca.sin, ca.cos)

    def rhs(theta, x):
        vdot, w, side, _ = at(theta, x[0])
        c, s = ca.cos(x[1]), ca.sin(x[1])
        V = c * x[0] - s * side, s * x[0] + c * side
        return ca.vertcat(period * vdot, period * w - turn, *V)

    h = 1 / _N
    for k in range(_N):
        t, x = k * h, X[:, k]
        k1 = rhs(t, x)
        k2 = rhs(t + h / 2, x + h / 2 * k1)
        k3 = rhs(t + h / 2, x + h / 2 * k2)
        k4 = rhs(t + h, x + h * k3)
        opti.subject_to(X[:, k + 1] == x + h / 6 * (k1 + 2 * k2 + 2 * k3 + k4))
        opti.subject_to(opti.bounded(-1, at(t, x[0])[3] / posed.torque, 1))
    opti.subject_to(X[0, _N] == X[0, 0])
    opti.subject_to(X[1:, 0] == 0)
    opti.subject_to(X[1, _N] == 0)
    for value, low, high in zip(decided, posed.least, posed.most, strict=True):
        if low < high:
            opti.subject_to(opti.bounded(low, value, high))
    opti.subject_to(amplitude + offset <= posed.reach)
    opti.subject_to(amplitude - offset <= posed.reach)
    if np.isfinite(posed.rate):
        opti.subject_to(2 * np.pi * amplitude <= posed.rate * period)
    opti.minimize(-ca.norm_2(X[2:, _N]))
    opti.solver(
        "ipopt",
        {"expand": True, "print_time": False},
        {"print_level": 0, "sb": "yes", "max_cpu_time": 20.0},
    )

    def solve(start: Array) -> Claim:
        cycle = steady(posed, start, _N, 1e-6)
        for value, guess in zip(decided, start, strict=True):
            if value.is_symbolic():
                opti.set_initial(value, guess)
        opti.set_initial(turn, cycle.turn)
        theta = np.arange(_N + 1) / _N
        path = [np.append(part, part[0]) for part in (cycle.v, cycle.chi)]
        mean = [cycle.velocity.real * theta, cycle.velocity.imag * theta]
        opti.set_initial(X, np.array([*path, *mean]))
        try:
            found, solved = opti.solve(), True
        except RuntimeError:
            found, solved = opti.debug, False
        gait = (float(found.value(x)) for x in decided)
        return Claim.of(gait, -float(found.value(opti.f)), solved)

    return solve
