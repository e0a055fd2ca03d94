"""The map's circles are those of the simulation, no gait is tighter than the tightest, and what
the paper says of the offset is true or not as counted gait by gait."""

from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest

from benchmarks.turn.problems import PROTOTYPE, SHORT, robot
from rr_opt.model.gait import SineGait
from rr_opt.model.problem import GaitBounds, Interval
from rr_opt.motion.circle import circle_of
from rr_opt.motion.steady_cycle import energy, grip_needed, steady_cycle
from rr_opt.verify.speeds import speeds
from rr_opt.verify.turn_chart import radius_claim, sign_claim, tightest, turn_map


def test_circles_are_those_of_the_simulation():
    seen = turn_map(PROTOTYPE, (3, 2, 9))
    tried = np.argwhere(seen.keeps)[::5]
    assert len(tried) > 1
    for i, j, k in tried:
        gait = SineGait(seen.amplitude[i], seen.period[j], seen.offset[k])
        made = circle_of(steady_cycle(PROTOTYPE.robot, gait).cycle)
        assert seen.curvature[i, j, k] == pytest.approx(made.curvature, rel=1e-4, abs=1e-9)
        assert seen.speed[i, j, k] == pytest.approx(made.speed, rel=1e-4)


@pytest.mark.parametrize("name", ["grip", "power"])
def test_gaits_of_the_map_keep_every_limit(name):
    """A limit at the middle of what they need by simulation leaves half of them."""
    counts = (3, 2, 9)
    seen, robot = turn_map(PROTOTYPE, counts), PROTOTYPE.robot
    kept, needed = np.argwhere(seen.keeps), []
    for i, j, k in kept:
        gait = SineGait(seen.amplitude[i], seen.period[j], seen.offset[k])
        steady = steady_cycle(robot, gait)
        grip, power = max(grip_needed(steady, robot)), energy(robot, steady).power
        needed.append({"grip": grip, "power": power}[name])
    limits = replace(PROTOTYPE.limits, **{name: float(np.median(needed)) * 1.001})
    less = turn_map(replace(PROTOTYPE, limits=limits), counts)
    few = kept[np.array(needed) <= getattr(limits, name)]
    assert np.argwhere(less.keeps).tolist() == few.tolist()
    assert 0 < len(few) < len(kept)


def test_no_gait_is_tighter():
    bounds = GaitBounds(Interval(0.1, 1.2), Interval(1.0, 3.0))
    problem = replace(SHORT, robot=robot(0.01), gait=bounds)
    found = tightest(problem)
    assert found.error < 1e-6
    made = circle_of(steady_cycle(problem.robot, found.gait).cycle)
    assert made.radius == pytest.approx(found.radius, rel=1e-4)
    rng = np.random.default_rng(1)
    T, alpha, phi0 = rng.uniform(1, 3, 4000), rng.uniform(0.1, 1.2, 4000), rng.uniform(0, 2, 4000)
    S1 = problem.robot.platform1.c * np.cos(alpha + phi0) + problem.robot.platform2.c
    fit = (problem.limits.singularity < S1) & (alpha * 2 * np.pi / T <= problem.limits.rate)
    fit &= alpha + phi0 < 2.0
    seen = speeds(problem, alpha[fit], T[fit], phi0[fit])
    assert np.nanmin(T[fit] * np.abs(seen.speed / seen.turn)) >= found.radius * (1 - 1e-6)


def test_the_claim_counted_by_hand():
    seen = turn_map(PROTOTYPE, (6, 3, 31))
    left = {True: 0, False: 0}
    grows = 0
    for i, j in np.ndindex(6, 3):
        radii = []
        for k in range(1, 31):
            if seen.keeps[i, j, k]:
                gait = SineGait(seen.amplitude[i], seen.period[j], seen.offset[k])
                made = circle_of(steady_cycle(PROTOTYPE.robot, gait).cycle)
                left[made.curvature > 0] += 1
                radii.append(1 / made.curvature)
        same = all(a * radii[0] > 0 for a in radii)
        falls = all(abs(b) < abs(a) * (1 + 1e-5) for a, b in pairwise(radii))
        grows += len(radii) > 1 and not (same and falls)
    sign, radius = sign_claim(seen), radius_claim(seen)
    assert (sign.gaits, sign.rarer) == (sum(left.values()), min(left.values()))
    assert not sign.holds
    assert radius.growing == grows > 0
