"""The rollout of a command agrees with CVODES, and its derivatives with differences."""

import math

import numpy as np
import pytest

import rr_opt as rr
from rr_opt.model.command import Command
from rr_opt.model.problem import Limits, Problem
from rr_opt.model.route import Pose, Tolerance
from rr_opt.routing.path import Leg
from rr_opt.routing.program import DriveProgram, DriveStage
from rr_opt.routing.replay import peaks, simulate
from rr_opt.routing.rollout import LOADS

DRY = rr.EffectUse("coulomb_friction", {"force1": 0.005, "force2": 0.005})


def program(robot: rr.Robot) -> DriveProgram:
    leg = Leg(0, Pose(0.1, 0.2, 0.3), 1.0, 0.5)
    sizes = [(2.3, 0.2, 0.05, 15.0), (7.1, 0.15, 0.3, 20.0), (3.4, 0.02, -0.1, 18.0)]
    stages = [DriveStage(*size, leg, ends=True) for size in sizes]
    problem = Problem(robot, Limits(grip=0.4))
    return DriveProgram(problem, stages, Tolerance(), leg.start, math.pi, True)


@pytest.mark.parametrize("effects", [(), (DRY,)], ids=["viscous", "dry"])
def test_derivatives(effects):
    from dataclasses import replace

    one = program(replace(rr.prototype(), physics=effects))
    seen = one.look(one.x0)
    # Where dry friction turns about, loads all but jump, and a peak has no one place.
    smooth = np.array([not effects or name not in LOADS for name, _ in seen.names])
    for k in range(len(one.x0)):
        h = np.zeros(len(one.x0))
        h[k] = 1e-6
        there, back = one.look(one.x0 + h), one.look(one.x0 - h)
        scale = one.scale[k] * 2e-6
        change = (there.samples.path[:4, -1] - back.samples.path[:4, -1]) / scale
        assert seen.samples.slopes[:4, -1, k] == pytest.approx(change, rel=1e-4, abs=1e-6)
        assert seen.rising[k] == pytest.approx((there.seconds - back.seconds) / scale, abs=1e-6)
        change = (there.values - back.values) / scale
        assert seen.slopes[smooth, k] == pytest.approx(change[smooth], rel=1e-3, abs=1e-3)


def test_gaps_between_stages():
    """Stages that begin elsewhere leave gaps; with the states that the linear model closes them by,
    their square is left."""
    one = program(rr.prototype())
    ends = one.look(one.x0).samples.path[:, one.joints].T
    assert not one.look(one.x0, ends).gaps.any()

    def gap(by: float) -> tuple[float, float]:
        apart = one.look(one.x0, ends + by * np.array([0.1, 0.2, 0.1, -0.1]))
        closed = apart.samples.path[:, one.joints] + apart.samples.slopes[:, one.joints, -1]
        return np.abs(apart.gaps).max(), np.abs(one.look(one.x0, closed.T).gaps).max()

    (wide, left), (narrow, less) = gap(0.1), gap(0.01)
    assert wide == pytest.approx(10 * narrow, rel=0.2)
    assert left == pytest.approx(100 * less, rel=0.3)
    assert left < 0.1 * wide


def test_the_end_is_that_of_cvodes():
    one = program(rr.prototype())
    seen = one.look(one.x0)
    driven = simulate(one.problem, seen.command, Pose(0.1, 0.2, 0.3), math.pi)
    end = [part[-1] for part in (driven.v, driven.psi, driven.x, driven.y)]
    assert seen.samples.path[:4, -1] == pytest.approx(end, abs=1e-6)
    assert driven.t[-1] == pytest.approx(seen.command.seconds)


def test_peaks_are_those_of_cvodes():
    """Of the torque and of each axle's grip, between the samples of both and on either side of
    knots."""
    one = program(rr.prototype())
    seen = one.look(one.x0)
    driven = simulate(one.problem, seen.command, Pose(0.1, 0.2, 0.3), math.pi)
    reached = {k: value for k, (value, _) in peaks(one.problem, seen.command, driven).items()}
    found = seen.samples.peaks.max(axis=(1, 2, 3))
    assert found[0] == pytest.approx(reached["torque"], rel=2e-5)
    assert max(found[1:]) == pytest.approx(reached["grip"], rel=2e-5)
    fine = np.linspace(0, seen.command.seconds, 100_001)
    phi, rate, _ = np.abs(seen.command.at(fine)).max(axis=1)
    assert [reached["angle"], reached["rate"]] == pytest.approx([phi, rate], rel=2e-5)


def test_a_command_has_no_jump_of_angle_or_rate():
    knots = np.array([[0.0, 0.2, 0.2, 0.1, 0.1], [0.0, 0.3, 0.3, -0.2, -0.2], [15, 15, 15, 20, 20]])
    command = Command(np.array([0.4, 1.1, 0.35, 0.8]), knots.astype(float))
    t = np.linspace(-0.1, command.seconds + 0.3, 40_001)
    phi, rate, bend = command.at(t)
    assert np.diff(phi) / np.diff(t) == pytest.approx((rate[1:] + rate[:-1]) / 2, abs=1e-3)
    assert np.abs(np.diff(rate)).max() <= 1.1 * np.abs(bend).max() * (t[1] - t[0])
    assert rate[0] == 0
