"""The inertia ratio behind a local optimum, which carries it as a share of the ballast's range."""

from __future__ import annotations

from dataclasses import replace

from rr_opt.design.decisions import ballast_interval
from rr_opt.design.maximize_speed import Optimum
from rr_opt.design.solve import Candidate
from rr_opt.robot.ballast import inertia_ratio, with_load_count


def ratio_of(optimum: Optimum, candidate: Candidate) -> float:
    """J20/J10 of one of the optima, in the problem's definition."""
    problem, choice = optimum.problem, optimum.problem.inertia_ratio
    span = ballast_interval(problem.robot, choice)
    amount = span.low + candidate.share * (span.high - span.low)
    platform = problem.robot.platform2
    changed = (
        with_load_count(platform, choice.loads, amount)
        if choice and choice.by == "loads"
        else replace(platform, I=amount)
    )
    return inertia_ratio(
        replace(problem.robot, platform2=changed), choice.about if choice else "joint"
    )
