"""This project, from default settings: it looks for its starts itself."""

from __future__ import annotations

from collections.abc import Callable

from benchmarks.optimise.peers.posed import Array, Claim, Posed

NAME = "rr_opt"


def prepare(posed: Posed) -> Callable[[Array], Claim]:
    """The solver of a problem."""
    from rr_opt.design.maximize_speed import maximize_speed

    def solve(start: Array) -> Claim:  # noqa: ARG001
        found = maximize_speed(posed.problem)
        if found.best is None or found.robot is None:
            raise ArithmeticError(found.message)
        gait = found.best.gait
        numbers = gait.amplitude, gait.period, gait.offset, found.robot.platform2.I
        return Claim(*numbers, found.best.speed, found.best.success)

    return solve
