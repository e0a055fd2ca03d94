"""What a person would do without the planner: gaits glued at period ends; and a brute force."""

from __future__ import annotations

import itertools
import math

import numpy as np

from rr_opt.model.command import Command
from rr_opt.model.route import Route
from rr_opt.routing.plan import RoutePlan
from rr_opt.routing.rollout import rollout, steps_for


def glued(plan: RoutePlan) -> Command:
    """The steady gait of each leg for a whole number of periods, then coasting. The way of coasting
    is left out of the last leg."""
    assert plan.coasting
    durations, knots = [], []
    for k, (leg, gait, speed) in enumerate(zip(plan.legs, plan.gaits, plan.speeds, strict=True)):
        last = k == len(plan.legs) - 1
        length = leg.length - (plan.coasting.distance if last else 0.0)
        periods = max(2, round(length / (speed * gait.period)))
        shape = [gait.amplitude, gait.offset, 2 * math.pi / gait.period]
        # A period to change, as a jump of the rate is beyond every servo.
        durations += [gait.period, (periods - 1) * gait.period]
        knots += [shape, shape]
    period = plan.gaits[-1].period
    rest = [0.0, 0.0, 2 * math.pi / period]
    durations += [period, plan.coasting.seconds]
    knots = [[0.0, 0.0, knots[0][2]], *knots, rest, rest]
    return Command(np.array(durations), np.array(knots).T)


PERIODS = (1.0, 1.15, 1.4, 2.0)
OFFSETS = np.linspace(-0.03, 0.03, 13)
COUNTS = np.arange(-6, 7)


def brute_force(plan: RoutePlan, route: Route) -> float:
    """The least time, s, of all drives along a straight line of one gait, of several periods and
    offsets at the rate limit, for several numbers of cycles, and then coasting; inf if none ends
    within the tolerance."""
    limits, tolerance = plan.problem.limits, route.tolerance
    gait, speed, length = plan.gaits[0], plan.speeds[0], plan.legs[0].length
    best = math.inf
    for stretch, offset, more in itertools.product(PERIODS, OFFSETS, COUNTS):
        period = stretch * gait.period
        amplitude = min(limits.rate * period / (2 * math.pi), plan.problem.gait.amplitude.high)
        count = round(length / (speed * period)) + 0.5 * more
        if count < 2:
            continue
        omega = 2 * math.pi / period
        shape, rest = [amplitude, offset, omega], [0.0, 0.0, omega]
        assert plan.coasting
        durations = [period, (count - 1) * period, period, 1.2 * plan.coasting.seconds]
        knots = np.array([[0.0, 0.0, omega], shape, shape, rest, rest]).T
        command = Command(np.array(durations), knots)
        start = route.start.x, route.start.y, route.start.heading + plan.turned
        none = np.zeros((8, 4, 0))
        seen = rollout(plan.problem.robot, command, none, steps_for(command), start)
        end = plan.legs[-1].end
        off = np.hypot(seen.path[2] - end.x, seen.path[3] - end.y) <= tolerance.position
        turned = np.abs(seen.path[1] - end.heading - plan.turned) <= tolerance.heading
        coasts = seen.segment == 3
        still = np.abs(seen.path[0]) <= tolerance.speed
        good = np.flatnonzero(off & turned & coasts & still)
        if len(good):
            best = min(best, float(seen.t[good[0]]))
    return best
