"""The best gaits that a slow search is known to have found pass the check, worse ones do not."""

import json
from pathlib import Path

import pytest

from benchmarks.optimise.problems import PROBLEMS
from rr_opt.model.gait import SineGait
from rr_opt.verify.speeds import speeds
from rr_opt.verify.sweep import check_optimum

BEST = json.loads(
    (Path(__file__).parents[2] / "benchmarks/optimise/best_known.json").read_text(encoding="utf-8")
)
NAMES = ["straight", "paper_torque", "turn_fixed", "tight_margin"]


def known(name, shrink=1.0):
    best = BEST[name]
    gait = SineGait(shrink * best["amplitude"], best["period"], best["offset"])
    return gait, best["inertia_ratio"], best["speed"]


@pytest.mark.parametrize("name", NAMES)
def test_best_known_passes(name):
    gait, ratio, speed = known(name)
    check = check_optimum(PROBLEMS[name], gait, ratio, speed)
    assert check.passed
    assert abs(check.gap) < 1e-5
    assert check.error < 1e-6


@pytest.mark.parametrize("name", NAMES)
def test_a_gait_one_per_cent_smaller_is_caught(name):
    gait, ratio, _ = known(name, shrink=0.99)
    speed = float(speeds(PROBLEMS[name], gait.amplitude, gait.period, gait.offset, ratio).speed)
    check = check_optimum(PROBLEMS[name], gait, ratio, speed)
    assert not check.passed
    assert check.gap < -1e-4
    assert abs(check.best.speed) == pytest.approx(abs(BEST[name]["speed"]), rel=1e-5)


def test_a_speed_that_the_gait_does_not_have_is_caught():
    gait, ratio, speed = known("straight")
    for claimed in (1.01 * speed, -speed):
        check = check_optimum(PROBLEMS["straight"], gait, ratio, claimed)
        assert not check.passed
