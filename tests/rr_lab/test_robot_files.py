"""What a robot file lists under `physics` the laboratory's robot has, too."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from rr_lab.case import record
from rr_lab.effects import NAMED, effect_named, rig_with
from rr_opt.files.robot_file import read_robot
from rr_opt.model.gait import SineGait
from rr_opt.motion.dynamics import values_of
from rr_opt.motion.floor_motion import floor_motion

ROBOT = """\
platform1: {m: 0.6, I: 0.003, c: 0.15, a: 0.025, b: 0.057, kappa: 4.5e-5}
platform2: {m: 0.4, I: 0.003, c: 0.1, a: 0.01, b: 0.06, kappa: 6e-5}
h: 0.025
"""


@pytest.fixture
def robot_with(tmp_path):
    """Reads a robot file with an effect."""

    def read(name, **values):
        given = "".join(f", {key}: {value}" for key, value in values.items())
        path = tmp_path / "robot.yaml"
        path.write_text(f"{ROBOT}physics: [{{name: {name}{given}}}]\n")
        return read_robot(path)

    return read


@pytest.mark.parametrize("name", NAMED)
def test_what_a_file_leaves_out_does_nothing(robot_with, name):
    values = {each.name: each.typical for each in effect_named(name).parameters}
    robot = robot_with(name, **values)
    assert len(robot.physics[0].values) >= len(values)
    rig_with(robot)


def test_a_gear_that_gives(robot_with):
    assert rig_with(robot_with("servo_backlash", width=0.03)).gear is None
    soft = robot_with("servo_backlash", width=0.03, compliance=0.05)
    assert rig_with(soft).gear == pytest.approx(20.0)


def test_a_floor_with_an_edge_moves_the_robot_alike(robot_with):
    robot = robot_with("floor_patch", multiplier=3, normal=0, edge_x=0.5, edge_y=0)
    gait, pose = SineGait(0.7, 1.0), (0.4, 0.0, 3.0)
    seen, plain = (
        record(one, gait, 3.0, pose=pose, engine="planar")
        for one in (robot, replace(robot, physics=()))
    )
    motion = floor_motion(("floor_patch",))
    p = values_of(robot, motion.parameters)

    def rates(t, state):
        return motion.rates(state, [gait.angle(t), gait.rate(t)], p).full().ravel()

    found = solve_ivp(rates, (0, seen.t[-1]), [*pose, 0], t_eval=seen.t, rtol=1e-6, max_step=0.01)
    x = seen.values["x"]
    off = np.abs(found.y[0] - x).max()
    assert off < 0.02 * np.abs(plain.values["x"] - x).max()
