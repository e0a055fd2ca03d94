"""A rig that is guided by a command that never changes moves as with the command itself."""

import math

import numpy as np
import pytest

import rr_opt as rr
from benchmarks.route.guided import guided
from rr_lab.effects import rig_with
from rr_lab.planar.drive import drive
from rr_lab.run import Conditions


class Guide:
    """A gait that writes down what it is told."""

    def __init__(self, gait):
        self.gait, self.told, self.over = gait, [], math.inf

    def see(self, t, pose):
        self.told.append([t, *pose])

    def angle(self, t):
        return self.gait.angle(t)


def test_as_the_command_itself():
    rig, gait = rig_with(rr.prototype(), ()), rr.SineGait(0.2, 0.5, 0.1)
    conditions = Conditions(1.0, "rest", (0.1, -0.2, 0.3))
    guide = Guide(gait)
    seen, known = guided(rig, guide, conditions), drive(rig, gait, conditions)
    assert seen.t == pytest.approx(known.t)
    # The start differs by a step: `drive` settles for a sample before it.
    assert seen.one == pytest.approx(known.one, abs=2e-5)
    assert np.array(guide.told)[:, 1:] == pytest.approx(seen.one[:-1], abs=1e-12)


def test_it_ends_with_the_guide():
    guide = Guide(rr.SineGait(0.2, 0.5))
    guide.over = 0.305
    seen = guided(rig_with(rr.prototype(), ()), guide, Conditions(1.0, "rest", (0, 0, 0)))
    assert seen.t[-1] == pytest.approx(0.31)
