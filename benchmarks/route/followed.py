"""Robots that are not as stated, on a route in the laboratory, open loop and with feedback:
`nice python -m benchmarks.route.followed [DRAWS [SEED]]`.

It writes results/bench/route-feedback.md."""

from __future__ import annotations

import math
import sys
from dataclasses import dataclass, field, replace
from typing import Any

import matplotlib as mpl
import numpy as np
from matplotlib.figure import Figure
from numpy.typing import NDArray

import rr_opt as rr
from benchmarks.results import FOLDER, machine
from benchmarks.route.follower import Follower
from benchmarks.route.guided import guided
from benchmarks.route.problems import ROBOTS, ROUTES, START
from rr_lab.case import stream
from rr_lab.effects import rig_with
from rr_lab.run import Conditions
from rr_opt.array import Array
from rr_opt.documents.archive import write_text
from rr_opt.model.command import Command, blended
from rr_opt.model.robot import Robot
from rr_opt.model.route import Route
from rr_opt.results.route import DrivenRoute
from rr_opt.routing.feedback import DELAY, NOISE, Feedback, apart

MASS, INERTIA, FRICTION = 0.02, 0.05, 0.2
ROUTE_NAMES = "straight 1 m", "S-bend"
REST = 0.1
"""s over which the speed at the end is taken."""
_KEPT = 20
"""Samples in which a pose of `DELAY` ago is looked for."""
NOTES = f"""Each draw has a robot whose masses ({MASS:.0%}), moments of inertia ({INERTIA:.0%})
and friction ({FRICTION:.0%}) are wrong, each of each platform by a normal error of that size, drawn
apart, friction no less than a tenth. It is driven in the laboratory's planar engine. The capture
system gives the pose with {1e3 * NOISE[0]:g} mm and {1e3 * NOISE[2]:g} mrad of noise,
{1e3 * DELAY:g} ms late. `within`: ends within 20 mm, 5 deg and 2 mm/s. Open loop is the drive
planned without feedback. Medians and 95 % quantiles are of the distance of P from its place."""


@dataclass
class Guided:
    """A follower as the laboratory's guide."""

    control: Feedback
    rng: np.random.Generator
    follower: Follower = field(init=False)
    u: Array = field(init=False)
    begin: float = 0.0
    over: float = math.inf
    times: list[float] = field(default_factory=list)
    poses: list[Array] = field(default_factory=list)

    def __post_init__(self) -> None:
        self.follower = Follower(self.control)
        self.u = self.follower.first()

    def see(self, t: float, pose: Array) -> None:
        """The pose at a sample."""
        self.times.append(t)
        self.poses.append(pose)

    def angle(self, t: NDArray[Any]) -> Array:
        """The angle of each time, rad."""
        angles, now = np.empty(len(t)), 0
        while now < len(t):
            end = self.begin + self.u[7]
            past = int(np.searchsorted(t, end, "right")) if self.over == math.inf else len(t)
            s = np.minimum((t[now:past] - self.begin) / self.u[7], 1.0)
            angles[now:past] = blended(s, self.u, np.sin, np.cos)[0]
            if past < len(t):
                self._go_on(end)
            now = past
        return angles

    def _go_on(self, end: float) -> None:
        """With the segment after the one that ends now."""
        times, poses = self.times[-_KEPT:], np.array(self.poses[-_KEPT:])
        seen = np.array([np.interp(end - DELAY, times, row) for row in poses.T])
        after = self.follower.next(seen + NOISE * self.rng.standard_normal(3))
        if after is None:
            self.over = end
        else:
            self.begin, self.u = end, after


@dataclass
class Planned:
    """A command that nothing changes, as a guide."""

    command: Command

    @property
    def over(self) -> float:
        """When it ends, s."""
        return self.command.seconds

    def see(self, t: float, pose: Array) -> None:
        """It looks at nothing."""

    def angle(self, t: NDArray[Any]) -> Array:
        """Of the command."""
        return self.command.angle(t)


def drawn(robot: Robot, rng: np.random.Generator) -> Robot:
    """A robot that is not as stated."""

    def wrong(size: float) -> float:
        return max(0.1, 1 + size * rng.standard_normal())

    one, two = (
        replace(
            part,
            m=part.m * wrong(MASS),
            I=part.I * wrong(INERTIA),
            kappa=part.kappa * wrong(FRICTION),
        )
        for part in (robot.platform1, robot.platform2)
    )
    return replace(robot, platform1=one, platform2=two)


def ends(found: DrivenRoute, guide: Guided | Planned, robot: Robot) -> Array:
    """The end's error ahead (m), to the left (m), of the heading (rad); speed (m/s), time (s)."""
    assert found.command
    seconds = 1.8 * found.command.seconds + 5
    start = found.plan.route.start
    pose = start.x, start.y, start.heading + found.plan.turned
    motion = guided(rig_with(robot, ()), guide, Conditions(seconds, "rest", pose))
    at = min(int(guide.over * 100), len(motion.t) - 1)
    end = found.plan.legs[-1].end
    off = apart(motion.one[at], np.array([end.x, end.y, found.plan.heading]))
    speed = math.dist(motion.one[at, :2], motion.one[at - round(100 * REST), :2]) / REST
    return np.array([*off, speed, guide.over])


def within(found: DrivenRoute, ended: Array) -> NDArray[np.bool_]:
    """Which of the ends (n, 5) are within the tolerance."""
    asked = found.plan.route.tolerance
    off = np.hypot(ended[:, 0], ended[:, 1]) <= asked.position
    return off & (np.abs(ended[:, 2]) <= asked.heading) & (ended[:, 3] <= asked.speed)


def scatter(shown: dict[str, dict[str, Array]]) -> None:
    """The ends about their place, m, of each route and loop."""
    with mpl.rc_context({"svg.hashsalt": "route"}):
        figure = Figure((7.0, 3.6), layout="constrained")
        for axes, (name, loops) in zip(
            np.ravel(figure.subplots(1, len(shown))), shown.items(), strict=True
        ):
            for loop, off in loops.items():
                axes.plot(*(1e3 * off.T), "o", ms=3, alpha=0.7, label=loop)
            around = np.linspace(0, 2 * math.pi, 200)
            axes.plot(20 * np.cos(around), 20 * np.sin(around), "k-", lw=1, label="tolerance")
            axes.set_aspect("equal", adjustable="datalim")
            axes.set(title=name, xlabel="ahead, mm", ylabel="to the left, mm")
            axes.legend(frameon=False, fontsize=8)
        figure.savefig(FOLDER / "route-feedback.svg", metadata={"Date": None})


def main(draws: int, seed: int) -> None:
    """The table and the figure."""
    robot, problem = next(iter(ROBOTS.items()))
    drawn_from = f"{machine()}; {draws} draws a route, seed {seed:#x}."
    lines = ["# Routes with feedback", "", drawn_from, "", NOTES, ""]
    lines += [f"## {robot}", "", "| route | loop | within | median, mm | 95 %, mm | time, s |"]
    lines.append("|" + "---|" * 6)
    shown: dict[str, dict[str, Array]] = {}
    figure = ["", "![Where the drives end](route-feedback.svg)"]
    for name in ROUTE_NAMES:
        route, shown[name] = Route(problem, ROUTES[name], START, name=name), {}
        for loop, found in (
            ("open", rr.route(route)),
            ("feedback", rr.route(route, feedback=True)),
        ):
            ended = []
            for draw in range(draws):
                rng = stream(seed, name, draw)
                other = drawn(problem.robot, rng)
                assert found.command
                guide = Guided(found.feedback, rng) if found.feedback else Planned(found.command)
                ended.append(ends(found, guide, other))
            reached = np.array(ended)
            kept, off = within(found, reached), 1e3 * np.hypot(*reached[:, :2].T)
            shown[name][loop] = reached[:, :2]
            lines.append(
                f"| {name} | {loop} | {kept.sum()} of {draws} | {np.median(off):.1f} | "
                f"{np.quantile(off, 0.95):.0f} | {np.median(reached[:, 4]):.1f} |"
            )
            print(lines[-1], flush=True)
        write_text(FOLDER / "route-feedback.md", "\n".join(lines + figure) + "\n")
        scatter(shown)


if __name__ == "__main__":
    given = [int(word, 0) for word in sys.argv[1:]]
    main(*given, *(100, 2028)[len(given) :])
