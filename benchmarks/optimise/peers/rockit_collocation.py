"""rockit: direct collocation of degree 4, the torque held at the collocation points."""

from __future__ import annotations

from collections.abc import Callable

import casadi as ca
import numpy as np

from benchmarks.optimise.peers.posed import Array, Claim, Posed, motion, sine
from benchmarks.optimise.peers.simulated import steady

NAME = "rockit, collocation"
_N = 40


def prepare(posed: Posed) -> Callable[[Array], Claim]:
    """The solver of a problem, built once and then started anew."""
    from rockit import DirectCollocation, Ocp  # type: ignore

    ocp = Ocp(t0=0, T=1)  # time is the phase of the cycle
    decided = [
        ocp.variable() if low < high else ca.MX(low)
        for low, high in zip(posed.least, posed.most, strict=True)
    ]
    amplitude, period, offset, inertia = decided
    turn, v, chi, x, y = ocp.variable(), ocp.state(), ocp.state(), ocp.state(), ocp.state()
    angle = sine(amplitude, period, offset, ocp.t, ca.sin, ca.cos)
    vdot, w, side, torque = motion(posed.robot, inertia, v, angle, ca.sin, ca.cos)
    ocp.set_der(v, period * vdot)
    ocp.set_der(chi, period * w - turn)
    ocp.set_der(x, ca.cos(chi) * v - ca.sin(chi) * side)
    ocp.set_der(y, ca.sin(chi) * v + ca.cos(chi) * side)

    ocp.subject_to(ocp.at_tf(v) == ocp.at_t0(v))
    for state in (chi, x, y):
        ocp.subject_to(ocp.at_t0(state) == 0)
    ocp.subject_to(ocp.at_tf(chi) == 0)
    share = torque / posed.torque
    ocp.subject_to(-1 <= (share <= 1), grid="integrator_roots")  # noqa: SIM300
    for value, low, high in zip(decided, posed.least, posed.most, strict=True):
        if low < high:
            ocp.subject_to(low <= (value <= high))
    ocp.subject_to(amplitude + offset <= posed.reach)
    ocp.subject_to(amplitude - offset <= posed.reach)
    if np.isfinite(posed.rate):
        ocp.subject_to(2 * np.pi * amplitude <= posed.rate * period)
    speed = ca.sqrt(ocp.at_tf(x) ** 2 + ocp.at_tf(y) ** 2)
    ocp.add_objective(-speed)
    ocp.solver(
        "ipopt",
        {
            "expand": True,
            "print_time": False,
            "ipopt.print_level": 0,
            "ipopt.sb": "yes",
            "ipopt.max_cpu_time": 20.0,
        },
    )
    ocp.method(DirectCollocation(N=_N, degree=4))

    # As the documentation advises for solving again and again: one function of the guesses.
    free = [value for value in decided if value.is_symbolic()]
    solver = ocp.to_function(
        "solver",
        [*(ocp.value(one) for one in (*free, turn)), ocp.sample(ocp.x, grid="control")[1]],
        [ocp.value(one) for one in (*decided, speed)],
    )

    def solve(start: Array) -> Claim:
        cycle = steady(posed, start, _N, 1e-6)
        given = [guess for guess, one in zip(start, decided, strict=True) if one.is_symbolic()]
        theta = np.arange(_N + 1) / _N
        paths = [np.append(part, part[0]) for part in (cycle.v, cycle.chi)]
        paths += [cycle.velocity.real * theta, cycle.velocity.imag * theta]
        *gait, reached = (float(one) for one in solver(*given, cycle.turn, np.array(paths)))
        return Claim.of(gait, reached, bool(solver.stats()["success"]))

    return solve
