"""The controller of a route keeps a robot on it that is not as it was stated, within the servo's
limits, and is the same in C."""

import json
import math
import re
import shutil
import subprocess
from dataclasses import replace

import numpy as np
import pytest

import rr_opt as rr
from benchmarks.route.follower import Follower
from rr_opt.model.ballast import with_inertia_ratio
from rr_opt.model.command import blended
from rr_opt.motion.dynamics import dynamics_of
from rr_opt.results.route import c_text
from rr_opt.routing.feedback import DELAY, MARGIN, apart, moved
from rr_opt.routing.rollout import stepped

PROBLEM = replace(rr.shipped(), inertia_ratio=None).with_robot(
    with_inertia_ratio(rr.prototype(), 0.3)
)


@pytest.fixture(scope="module")
def straight():
    return rr.route(rr.Route(PROBLEM, (rr.Straight(1),)), feedback=True)


def driven(found, robot, closed=True, follower=None):
    """Pose and speed at the end, the segments made, and the poses seen, without noise."""
    control, v = found.feedback, 0.0
    p, effects = dynamics_of(robot).values(robot), dynamics_of(robot).effects
    follower, planned = follower or Follower(control), iter(control.command.segments.T)
    u = follower.first() if closed else next(planned)
    pose, segments, poses = control.place[0], [], []
    while u is not None:
        late = max(0.0, 1 - DELAY / u[7])
        grid = np.append(np.linspace(0, late, 13), np.linspace(late, 1, 4)[1:])
        out = stepped(effects, p, v, u, grid)[0]
        segments.append(u)
        poses.append(moved(pose, out[:, 11]))
        pose, v = moved(pose, out[:, -1]), float(out[0, -1])
        u = follower.next(poses[-1]) if closed else next(planned, None)
    return pose, v, np.array(segments), np.array(poses)


def rough(factor):
    """The robot with other friction."""
    one, two = (
        replace(part, kappa=factor * part.kappa)
        for part in (PROBLEM.robot.platform1, PROBLEM.robot.platform2)
    )
    return replace(PROBLEM.robot, platform1=one, platform2=two)


def off(found, pose):
    """Distance of a pose from the end of the route."""
    end = found.plan.legs[-1].end
    return math.hypot(*apart(pose, np.array([end.x, end.y, found.plan.heading]))[:2])


@pytest.mark.parametrize("factor", [0.65, 0.8, 1.2])
def test_other_friction(straight, factor):
    follower = Follower(straight.feedback)
    pose, v, segments, _ = driven(straight, rough(factor), follower=follower)
    assert off(straight, pose) < 0.02
    assert follower.z[4] == pytest.approx(1 - factor, abs=0.03)
    assert abs(v) < 0.002
    assert off(straight, driven(straight, rough(factor), closed=False)[0]) > 0.02
    s = np.linspace(0, 1, 300)[:, None]
    path = np.abs(blended(s, segments.T[:, None], np.sin, np.cos))
    assert path[1].max() <= PROBLEM.limits.rate
    ends = np.array(blended(1.0, segments.T, np.sin, np.cos))[:2, :-1]
    starts = np.array(blended(0.0, segments.T, np.sin, np.cos))[:2, 1:]
    assert ends == pytest.approx(starts, abs=1e-9)


def test_the_linear_map_is_that_of_the_motion(straight):
    """One period, begun a little off: the motion moves as F and B say."""
    control, robot = straight.feedback, PROBLEM.robot
    p, effects = dynamics_of(robot).values(robot), dynamics_of(robot).effects
    k, small = 5, 1e-5
    for which in (0, 1, 2, 3, 6, 7):
        z = np.zeros(8)
        z[which] = small
        u = control.command.segments[:, k].copy()
        u[:2] += z[6:]
        grid = np.linspace(0, 1, 40)
        begin = moved(control.place[k], np.array([0, z[2], z[0], z[1]]))
        out = stepped(effects, p, control.speed[k] + z[3], u, grid)[0, :, -1]
        end = apart(moved(begin, out), control.place[k + 1])
        made = np.append(end, out[0] - control.speed[k + 1]) / small
        assert made == pytest.approx(control.F[k, :, which], abs=2e-3)


def test_every_number_in_c(straight):
    control = straight.feedback
    named = {"limit": control.limits * MARGIN, "segment": control.command.segments.T}
    written = dict(
        re.findall(r"static const \w+ rr_(\w+)\[.*?= (.*?);", c_text(control), re.DOTALL)
    )
    assert len(written) == 13
    for name, numbers in written.items():
        read = json.loads(numbers.translate(str.maketrans("{}", "[]")))
        expected = named[name] if name in named else getattr(control, name)
        np.testing.assert_allclose(read, expected, rtol=1e-11, err_msg=name)


@pytest.mark.skipif(not shutil.which("gcc"), reason="needs gcc")
def test_c_is_the_same(straight, tmp_path):
    straight.save(tmp_path, figures=False)
    control = json.loads((tmp_path / "feedback.json").read_text())
    assert np.array(control["gain"]) == pytest.approx(straight.feedback.gain)
    _, _, segments, poses = driven(straight, rough(0.8))
    (tmp_path / "main.c").write_text(
        """
        #include <stdio.h>
        #include "feedback.c"
        int main(void)
        {
            rr_route r;
            double x, y, psi;
            rr_route_begin(&r);
            do
                printf("%.12g %.12g %.12g %.12g\\n", r.segment[3], r.segment[4], r.segment[7],
                       rr_route_angle(&r, 0.1));
            while (scanf("%lf %lf %lf", &x, &y, &psi) == 3 && rr_route_next(&r, x, y, psi));
            return 0;
        }
        """
    )
    strict = ["gcc", "-std=c99", "-Wall", "-Wextra", "-Werror", "-pedantic"]
    for one in ("-c", "feedback.c"), ("main.c", "-lm"):
        subprocess.run([*strict, *one], cwd=tmp_path, check=True)
    given = "\n".join(" ".join(f"{value:.17g}" for value in pose) for pose in poses)
    out = subprocess.run(
        ["./a.out"], cwd=tmp_path, input=given, capture_output=True, text=True, check=True
    )
    seen = np.array([line.split() for line in out.stdout.splitlines()], float)
    angles = [float(blended(0.1 / u[7], u, np.sin, np.cos)[0]) for u in segments]
    assert seen == pytest.approx(np.column_stack([segments[:, [3, 4, 7]], angles]), abs=1e-7)
