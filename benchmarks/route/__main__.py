"""Ten routes on three robots: `python -m benchmarks.route`. It writes results/bench/route.md."""

from __future__ import annotations

import math
import statistics
import time

import rr_opt as rr
from benchmarks.results import machine, write, yardstick
from benchmarks.route.others import brute_force, glued
from benchmarks.route.problems import ROBOTS, ROUTES, START
from rr_lab.case import Engine, driven
from rr_lab.effects import rig_with
from rr_lab.run import Conditions
from rr_opt.model.route import Route
from rr_opt.results.route import DrivenRoute
from rr_opt.routing.replay import replay

HEAD = (
    "| route | way | time, s | end, mm | planar, % | MuJoCo, % | CPU, s | glued, s | its end, mm | "
    "brute force, s |"
)
NOTES = """`end`: distance of P from its place by CVODES. The tolerance is 20 mm and 5 deg at the
end, 50 mm on the way, and 2 mm/s. `planar`, `MuJoCo`: distance between the ends by CVODES and in
the laboratory with nothing hidden, by either of its engines, relative to the length of the way.
`glued`: steady gaits joined at period ends, then coasting, and where that ends. `brute force`: over
the gait's period and offset, the number of cycles, and coasting; straight routes only. CPU: with
the code compiled."""


def laboratory(found: DrivenRoute, engine: Engine) -> float:
    """Distance between the ends, relative to the way."""
    assert found.seconds
    assert found.replay
    assert found.command
    trajectory = found.replay.trajectory
    pose = START.x, START.y, START.heading + found.plan.turned
    conditions = Conditions(math.ceil(found.seconds), "rest", pose)
    motion = driven(engine, rig_with(found.robot, ()), found.command, conditions)
    at = int(found.seconds * conditions.rate)
    near = int((abs(trajectory.t - motion.t[at])).argmin())
    end = float(trajectory.x[near]), float(trajectory.y[near])
    return math.dist(motion.one[at, :2], end) / sum(leg.length for leg in found.plan.legs)


def row(name: str, route: Route) -> tuple[str, float | None]:
    """A line of the table, and the CPU seconds of a route that is driven."""
    begin = time.process_time()
    found = rr.route(route)
    seconds = time.process_time() - begin
    plan, check = found.plan, found.replay
    if found.seconds is None or check is None:
        return f"| {name} | {found.status.words}: {found.message} |" + " |" * 8, None
    hand = glued(plan)
    by_hand = replay(plan.problem, hand, route.start, plan.legs, plan.turned, plan.heading)
    straight = len(plan.legs) == 1 and plan.legs[0].curvature == 0
    brute = f"{brute_force(plan, route):.2f}" if straight and plan.legs[0].length < 5 else ""
    mark = "" if found.status is rr.Status.OPTIMAL else f" ({found.message})"
    planar, mujoco = (100 * laboratory(found, engine) for engine in ("planar", "mujoco"))
    return (
        f"| {name} | {plan.way} | {found.seconds:.2f}{mark} | {1e3 * check.position:.1f} | "
        f"{planar:.3f} | {mujoco:.3f} | {seconds:.1f} | {hand.seconds:.2f} | "
        f"{1e3 * by_hand.position:.0f} | {brute} |"
    ), seconds


def main() -> None:
    lines = ["# Routes", "", f"{machine()}; one run.", "", NOTES, ""]
    yard, took = yardstick(), []
    for robot, problem in ROBOTS.items():
        lines += [f"## {robot}", "", HEAD, "|" + "---|" * 10]
        for name, pieces in ROUTES.items():
            line, seconds = row(name, Route(problem, pieces, START, name=name))
            lines.append(line)
            print(line, flush=True)
            if seconds:
                took.append(seconds)
        lines.append("")
        write("route", lines, {"yardstick/CPU": yard / statistics.median(took)})


if __name__ == "__main__":
    main()
