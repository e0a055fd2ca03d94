"""The sweep's speeds, turns and peak torques are those of the motion that cvodes integrates."""

import numpy as np
import pytest

from rr_opt.model.problem import Limits, Problem
from rr_opt.model.robot import EffectUse, Platform, Robot
from rr_opt.verify.speeds import speeds
from tests.verify.cvodes import reference

NO_LIMITS = Limits(angle=9.0, rate=np.inf, torque=np.inf, singularity=0.0)


def random_robot(draw, effects=()):
    """A robot of the paper's size, give or take a factor of two."""

    def platform(c):
        return Platform(
            m=draw.uniform(0.15, 0.8),
            I=draw.uniform(1e-3, 8e-3),
            c=c,
            a=draw.uniform(-0.02, 0.08),
            b=draw.uniform(0.02, 0.06),
            kappa=draw.uniform(0.02, 0.4) * 0.02**2,
        )

    one, two = platform(draw.uniform(0.15, 0.3)), platform(draw.uniform(0.04, 0.1))
    return Robot(one, two, h=0.02, physics=effects)


def agree(robot, gait, speed=1e-6, torque=1e-5):
    found = speeds(Problem(robot, NO_LIMITS), *gait)
    true = reference(robot, gait)
    assert found.converged
    assert float(found.speed) == pytest.approx(true.speed, rel=speed, abs=1e-10)
    assert float(found.turn) == pytest.approx(true.turn, rel=1e-6, abs=1e-9)
    assert float(found.peak_torque) == pytest.approx(true.peak_torque, rel=torque)


@pytest.mark.parametrize("seed", range(6))
@pytest.mark.parametrize("bend", [0.0, 0.4], ids=["straight", "turning"])
def test_viscous(seed, bend):
    draw = np.random.default_rng(seed)
    robot = random_robot(draw)
    offset = bend * draw.uniform(-1, 1)
    amplitude = draw.uniform(0.2, 0.9) * (robot.singular_angle - abs(offset))
    agree(robot, (amplitude, draw.uniform(0.4, 2.5), offset))


@pytest.mark.parametrize("offset", [0.0, 0.3], ids=["straight", "turning"])
@pytest.mark.parametrize("short", [0.03, 0.004])
def test_near_the_singular_posture(offset, short):
    robot = random_robot(np.random.default_rng(7))
    agree(robot, (robot.singular_angle - offset - short, 1.7, offset), torque=1e-4)


@pytest.mark.parametrize(
    "effects",
    [
        (EffectUse("quadratic_drag", {"coefficient_total": 0.3}),),
        (EffectUse("wheel_inertia", {"J": 4e-6}),),
    ],
    ids=lambda effects: effects[0].name,
)
def test_other_effects(effects):
    robot = random_robot(np.random.default_rng(3), effects)
    agree(robot, (0.8, 0.9, 0.0))
    agree(robot, (0.6, 1.3, -0.25))


@pytest.mark.parametrize("force", [0.005, 0.03])
def test_dry_friction(force):
    effects = (EffectUse("coulomb_friction", {"force1": force, "force2": force / 2}),)
    robot = random_robot(np.random.default_rng(5), effects)
    agree(robot, (0.9, 0.8, 0.0), torque=1e-4)
    agree(robot, (0.7, 1.0, 0.2), torque=1e-4)
