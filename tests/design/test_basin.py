"""A start is passed over only if solving from it leads to the optimum that is known.

Every start of problems with several is solved from, and what was foretold held against it.
"""

from dataclasses import replace

import pytest

from benchmarks.optimise.problems import PROBLEMS
from rr_opt.design.decisions import decisions, settings_of
from rr_opt.design.search import leads_to, refine, solve_from
from rr_opt.design.seeds import find_seeds
from rr_opt.model.gait import SineGait

SIGNS = {"forward": (1,), "backward": (-1,), "either": (1, -1)}


def _solved(name):
    problem = PROBLEMS[name]
    box = decisions(problem)
    (setting,) = settings_of(problem, box)
    seeds, _ = find_seeds(setting.landscape, box, problem.limits.torque, SIGNS[problem.direction])
    ends = []
    for seed in seeds:
        amplitude, period, offset, share = map(float, box.physical(seed.point[None])[:, 0])
        gait = SineGait(amplitude, period, offset)
        ends.append(refine(setting, solve_from(setting, seed.sign, gait, share)))
    return setting, box, seeds, ends


@pytest.mark.parametrize(
    "name", ["reference", "no_rate_limit_turning", "no_rate_limit_backward", "high_friction"]
)
def test_passed_over(name):
    setting, box, seeds, ends = _solved(name)
    torque = setting.problem.limits.torque
    known, passed = ends[0], 0
    for seed, end in zip(seeds[1:], ends[1:], strict=True):
        if leads_to(setting.landscape, box, torque, seed, known):
            passed += 1
            assert abs(end.speed) == pytest.approx(abs(known.speed), rel=1e-5)
    assert passed


def test_falls_or_goes_the_other_way():
    setting, box, (first, *_), (known, *_) = _solved("paper")
    torque = setting.problem.limits.torque
    assert leads_to(setting.landscape, box, torque, first, known)
    away = replace(first, sign=-first.sign)
    assert not leads_to(setting.landscape, box, torque, away, known)
    gait = replace(known.gait, amplitude=0.7 * known.gait.amplitude)
    below = replace(known, gait=gait, speed=0.5 * known.speed)
    assert not leads_to(setting.landscape, box, torque, first, below)
