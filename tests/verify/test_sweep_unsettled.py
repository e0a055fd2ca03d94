"""A gait without a steady cycle, or not resolved, is NaN and counted, never a number."""

import numpy as np

from rr_opt.model.problem import GaitBounds, Interval, Limits, Problem
from rr_opt.model.robot import EffectUse, Robot
from rr_opt.verify.speeds import speeds
from rr_opt.verify.sweep import sweep
from tests.robots import BENCHMARK, with_friction

LIMITS = Limits(angle=2.6, rate=4.0, torque=1.5)
STUCK = Robot(
    BENCHMARK.platform1,
    BENCHMARK.platform2,
    BENCHMARK.h,
    physics=(EffectUse("coulomb_friction", {"force1": 800.0, "force2": 800.0}),),
)


def test_without_friction_no_gait_settles():
    found = speeds(Problem(with_friction(0.0), LIMITS), [0.5, 0.5, 1.0], 1.2, [0.0, 0.2, 0.0])
    assert not found.converged.any()
    assert np.isnan(found.speed).all()
    assert np.isnan(found.peak_torque).all()


def test_past_the_singular_posture_there_is_no_speed():
    reach = BENCHMARK.singular_angle + np.array([-0.01, 0.01])
    found = speeds(Problem(BENCHMARK, LIMITS), reach, 1.0)
    assert found.converged.tolist() == [True, False]
    assert np.isnan(found.speed).tolist() == [False, True]


def test_friction_beyond_what_can_be_resolved_is_counted():
    gait = GaitBounds(Interval(0.3, 0.3), Interval(2.0, 2.0))
    found = sweep(Problem(STUCK, LIMITS, gait)).found
    assert found.speed.size == 1
    assert np.isnan(found.speed).tolist() == [True]
    assert found.failed == 1
    assert not found.feasible.any()
