"""The loss is what a long simulation and a plain sweep make of the two robots."""

import math
from dataclasses import replace
from types import MappingProxyType

import numpy as np
import pytest

from rr_opt.model.gait import SineGait
from rr_opt.model.problem import GaitBounds, Limits, Problem
from rr_opt.model.robot import EffectUse
from rr_opt.motion.rollout import rollout
from rr_opt.motion.servo import servo_made
from rr_opt.results.loss import (
    Loss,
    LossUnknown,
    corrected_robot,
    loss_of,
    loss_sentences,
    share_lost,
)
from rr_opt.verify.sweep import sweep


def with_effect(robot, name, **values):
    return replace(robot, physics=(EffectUse(name, MappingProxyType(values)),))


def test_what_the_gait_makes_is_what_a_long_drive_makes(missing):
    reported = missing.loss
    assert isinstance(reported, Loss)
    # From rest by CVODES until it has settled; then the distance of one period.
    T = reported.believed.period
    driven = rollout(missing.corrected_robot, reported.believed, 60 * T, "rest", 50 / T)
    last = np.hypot(driven.x[-1] - driven.x[-51], driven.y[-1] - driven.y[-51])
    assert abs(reported.reached) == pytest.approx(last / T, rel=1e-4)
    assert abs(reported.promised) > abs(reported.reached)


def test_no_gait_of_a_sweep_is_faster_than_the_best(missing):
    robot = missing.corrected_robot
    servo = robot.servo
    limits = Limits(servo.angle_limit, servo.rate_limit, servo.torque_limit)
    tried = sweep(Problem(robot, limits, GaitBounds()), {"amplitude": 12, "period": 12})
    best = abs(tried.refined.speed)
    assert best <= abs(missing.loss.speed) * (1 + 1e-4)
    assert best > 0.9 * abs(missing.loss.speed)
    assert 0 < missing.loss.share < 1


def test_a_right_model_loses_nothing(missing, consistent):
    assert consistent.loss is None
    same = loss_of(missing.experiment, missing.experiment.robot)
    assert abs(same.share) < 1e-6
    assert same.promised == pytest.approx(same.reached)


@pytest.mark.parametrize("effect", ["floor_patch", "floor_tilt", "lateral_slip"])
def test_what_has_no_steady_motion_is_reported_in_a_sentence(missing, effect):
    robot = with_effect(missing.experiment.robot, effect)
    reported = loss_of(missing.experiment, robot)
    assert isinstance(reported, LossUnknown)
    assert effect.replace("_", " ") in reported.sentence


def test_what_the_capture_system_sees_changes_no_speed(missing):
    reported = loss_of(
        missing.experiment, with_effect(missing.experiment.robot, "marker_offset", dx=0.01)
    )
    assert abs(reported.share) < 1e-6


def test_a_lagging_servo_makes_less_and_later(missing):
    gait, tau = SineGait(0.6, 1.2, 0.1), 0.05
    made = servo_made(with_effect(missing.experiment.robot, "servo_lag", tau=tau), gait)
    turn = gait.angular_frequency * tau
    assert made.amplitude == pytest.approx(0.6 / math.hypot(1, turn), rel=1e-6)
    assert made.offset == pytest.approx(0.1)
    t = np.linspace(0, 1.2, 50)
    later = np.sin(gait.angular_frequency * t - math.atan(turn))
    assert np.allclose(made.angle(t), 0.1 + made.amplitude * later, atol=1e-6)


def test_a_servo_that_was_seen_to_be_slow_gets_gaits_it_can_make(missing):
    values = {"servo_rate_limit.rate_limit": 1.7}
    found = replace(missing.found, values=values, parameters={})
    robot = corrected_robot(missing.experiment, found)
    assert robot.servo.rate_limit == 1.7
    reported = loss_of(missing.experiment, robot)
    assert reported.best.peak_rate == pytest.approx(1.7, rel=1e-4)
    # A triangle at the limit is what a servo makes that is asked for far more.
    slow = servo_made(robot, SineGait(1.0, 1.0))
    assert slow.amplitude == pytest.approx(1.7 / 4, rel=0.03)


def test_the_record_has_it(missing, consistent, unexplained):
    reported = missing.record()["loss"]
    assert reported["share_lost"] == pytest.approx(
        1 - reported["speed_reached"] / reported["speed_as_found"]
    )
    assert consistent.record()["loss"] is None
    assert "unidentified physics" in unexplained.record()["loss"]["not_told"]


def test_a_gait_that_drives_the_robot_the_other_way_loses_more_than_all():
    gait = SineGait(1.0, 1.5)
    turned = Loss(gait, promised=0.3, reached=-0.4, best=gait, speed=0.25, unseen=False)
    assert turned.share == pytest.approx(2.6)
    assert share_lost(turned) == "over 100 %"
    assert "over 100 %, as it drives the robot in the opposite direction." in loss_sentences(turned)
    less = replace(turned, reached=0.2)
    assert share_lost(less) == "20 %"
    assert "Speed lost to the wrong model: 20 %." in loss_sentences(less)
    faster = replace(turned, reached=0.26)
    assert "none, as it exceeds the corrected robot's limits." in loss_sentences(faster)


def test_a_gait_that_a_sweep_beats_is_no_best_gait(missing, monkeypatch):
    from rr_opt.results import loss as module
    from rr_opt.verify.evaluate import Found
    from rr_opt.verify.sweep import SweepCheck

    faster = Found(SineGait(1.0, 1.5), None, 0.2, 0.1, 0.0, 0.2)
    beaten = SweepCheck(100, faster, -0.5, 0.0, 1e-6, 0.1, 0.0)
    monkeypatch.setattr(module, "check_optimum", lambda *_: beaten)
    reported = loss_of(missing.experiment, missing.experiment.robot)
    assert isinstance(reported, LossUnknown)
    assert "a grid sweep finds a faster gait" in reported.sentence
