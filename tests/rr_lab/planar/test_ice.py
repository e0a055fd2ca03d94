"""Inner forces move no one: on ice a robot at rest keeps its centre, and its spin stays nothing."""

import numpy as np
import pytest

from rr_opt.model.gait import SineGait
from tests.rr_lab.planar.driven import driven, rig
from tests.rr_lab.reduced import LONG, SHORT

GAIT = SineGait(0.8, 1.0, 0.2)
RATE = 4000.0
ICE = 1e-12
USES = ((), (("servo_backlash", {"width": 0.03}),), (("com_offset", {"d1": 0.01, "d2": -0.02}),))


@pytest.mark.parametrize("uses", USES, ids=lambda uses: uses[0][0] if uses else "nothing")
@pytest.mark.parametrize("robot", [LONG, SHORT], ids=["long", "short"])
def test_momentum(robot, uses):
    made = rig(robot, *uses)
    made.mu = ICE
    motion = driven(made, GAIT, 1.2, "rest", rate=RATE, step=1 / RATE)
    parts = []
    for part, ahead, pose, d in (
        (robot.platform1, 1.0, motion.one.T, made.left[0]),
        (robot.platform2, -1.0, motion.two.T, made.left[1]),
    ):
        cos, sin = np.cos(pose[2]), np.sin(pose[2])
        reach = ahead * part.joint_to_centre
        place = pose[:2] + np.array([reach * cos - d * sin, reach * sin + d * cos])
        parts.append((part, place, pose[2]))
    centre = sum(part.m * place for part, place, _ in parts)
    centre = centre / sum(part.m for part, _, _ in parts)
    np.testing.assert_allclose(centre, centre[:, :1] + 0 * centre, atol=1e-5)
    spin, size = 0.0, 0.0
    for part, place, heading in parts:
        x, y = place - centre
        dx, dy = np.gradient(x, 1 / RATE), np.gradient(y, 1 / RATE)
        own = part.I * np.gradient(heading, 1 / RATE) + part.m * (x * dy - y * dx)
        spin, size = spin + own, max(size, np.abs(own).max())
    assert np.abs(spin[100:-2]).max() < 1e-4 * size
    assert np.abs(motion.one[:, 2]).max() > 0.05
