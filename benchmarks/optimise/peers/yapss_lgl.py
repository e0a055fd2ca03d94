"""YAPSS: Legendre collocation on segments, second derivatives by CasADi, its own IPOPT."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from benchmarks.optimise.peers.posed import Array, Claim, Posed, motion, sine
from benchmarks.optimise.peers.simulated import steady

NAME = "YAPSS"
_SEGMENTS, _POINTS = 12, 8


def prepare(posed: Posed) -> Callable[[Array], Claim]:
    """The solver of a problem, built once and then started anew."""
    from yapss import Problem  # type: ignore
    from yapss.math import cos, sin, sqrt  # type: ignore

    ocp = Problem(name="gait", nx=[2], nq=[2], nh=[1], ns=5, nd=5)

    def objective(arg) -> None:
        x, y = arg.phase[0].integral
        arg.objective = sqrt(x**2 + y**2)

    def continuous(arg) -> None:
        v, chi = arg.phase[0].state
        amplitude, period, offset, inertia, turn = arg.parameter
        angle = sine(amplitude, period, offset, arg.phase[0].time, sin, cos)
        vdot, w, side, torque = motion(posed.robot, inertia, v, angle, sin, cos)
        arg.phase[0].dynamics[:] = period * vdot, period * w - turn
        arg.phase[0].integrand[:] = cos(chi) * v - sin(chi) * side, sin(chi) * v + cos(chi) * side
        arg.phase[0].path[:] = (torque / posed.torque,)

    def discrete(arg) -> None:
        first, last = arg.phase[0].initial_state, arg.phase[0].final_state
        amplitude, period, offset = arg.parameter[:3]
        arg.discrete[:] = (
            last[0] - first[0],
            last[1],
            amplitude + offset,
            amplitude - offset,
            amplitude / period,
        )

    ocp.functions.objective = objective
    ocp.functions.continuous = continuous
    ocp.functions.discrete = discrete
    ocp.sense = "maximize"

    bounds, phase = ocp.bounds, ocp.bounds.phase[0]
    phase.initial_time.lower = phase.initial_time.upper = 0
    phase.final_time.lower = phase.final_time.upper = 1
    phase.initial_state.lower[1] = phase.initial_state.upper[1] = 0
    phase.path.lower[0], phase.path.upper[0] = -1, 1
    bounds.parameter.lower = [*posed.least, -50]
    bounds.parameter.upper = [*posed.most, 50]
    bounds.discrete.lower = [0, 0, -np.inf, -np.inf, -np.inf]
    bounds.discrete.upper = [0, 0, posed.reach, posed.reach, posed.rate / (2 * np.pi)]
    ocp.mesh.phase[0].collocation_points = _SEGMENTS * [_POINTS]
    ocp.mesh.phase[0].fraction = _SEGMENTS * [1 / _SEGMENTS]
    ocp.derivatives.method = "auto"
    ocp.derivatives.order = "second"
    ocp.ipopt_options.print_level = 0
    ocp.ipopt_options.sb = "yes"
    ocp.ipopt_options.max_cpu_time = 20.0

    def solve(start: Array) -> Claim:
        cycle = steady(posed, start, 50, 1e-6)
        guess = ocp.guess.phase[0]
        guess.time = np.linspace(0, 1, 51)
        guess.state = [np.append(part, part[0]) for part in (cycle.v, cycle.chi)]
        guess.integral = [cycle.velocity.real, cycle.velocity.imag]
        ocp.guess.parameter = [*start, cycle.turn]
        found = ocp.solve()
        gait = (float(x) for x in found.parameter[:4])
        return Claim.of(gait, float(found.objective), found.nlp_info.ipopt_status == 0)

    return solve
