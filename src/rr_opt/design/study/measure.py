"""An optimum, measured on its steady cycle: what a row of a study tells of it."""

from __future__ import annotations

from rr_opt.design.solve import Candidate
from rr_opt.design.study.energy import energy
from rr_opt.design.study.held import held
from rr_opt.design.study.reached import UNITS, reached
from rr_opt.design.study.row import Optimum, Row, gait_record
from rr_opt.motion.steady_cycle import steady_cycle
from rr_opt.outcome import Status
from rr_opt.problem import LARGEST_EXCESS, Problem
from rr_opt.robot.parameters import Robot

_CLAIM = 1e-6
"""Largest difference of a claimed speed from that of the steady cycle, relative."""
_STRAIGHT = 1e-7
"""Heading gained per period below which the robot goes straight, rad."""
_SIDEWAYS = 1e-3


def measured(problem: Problem, best: Candidate, robot: Robot, ratio: float) -> Row:
    """The row of an optimum of a problem, with the robot and the J20/J10 that it chose.

    NOT_CONVERGED if the steady cycle has another speed than the optimiser claims, or breaks a
    limit. Raises NotConvergedError if the gait has no steady cycle.
    """
    gait, steady = best.gait, steady_cycle(robot, best.gait)
    error = abs(steady.speed / best.speed - 1)
    if not error <= _CLAIM:
        message = (
            f"The optimiser claims {best.speed:.6g} m/s and the steady cycle has "
            f"{steady.speed:.6g} m/s, {error:.1e} from it (at most {_CLAIM:.0e} allowed). "
            "Solve the case alone with `rr-opt maximize-speed`."
        )
        return Row(Status.NOT_CONVERGED, message)
    extremes = reached(robot, steady)
    name, excess = problem.limits.worst(extremes)
    if not excess <= LARGEST_EXCESS:
        unit, limit = UNITS[name], getattr(problem.limits, name)
        message = (
            f"The optimiser's gait reaches {extremes[name]:.6g} {unit}. Expected it to keep the "
            f"limit on {name}, {limit:.6g} {unit}, which it breaks by {excess:.1e} of it (at most "
            f"{LARGEST_EXCESS:.0e} allowed). Solve the case alone with `rr-opt maximize-speed`."
        )
        return Row(Status.NOT_CONVERGED, message)
    work, turn = energy(robot, steady), steady.cycle.dpsi
    on = held(problem, best, extremes, ratio)
    optimum = Optimum(
        gait=gait_record(gait),
        sign=best.sign,
        share=best.share,
        speed=best.speed,
        amplitude=gait.amplitude,
        period=gait.period,
        offset=gait.offset,
        ratio=ratio,
        cycle_length=abs(best.speed) * gait.period,
        turn=turn,
        radius=abs(best.speed) * gait.period / abs(turn) if abs(turn) > _STRAIGHT else None,
        peak_angle=extremes["angle"],
        peak_rate=extremes["rate"],
        peak_torque=extremes["torque"],
        least_s1=extremes["singularity"],
        energy_per_metre=work.gross,
        net_energy_per_metre=work.net,
        cost_of_transport=work.cost_of_transport,
        held=on.names,
        prices=on.prices,
        bound_prices=on.bound_prices,
        sideways=abs(best.prices["direction"]) > _SIDEWAYS,
    )
    return Row(Status.OPTIMAL, best.sentence, optimum, iterations=best.iterations)
