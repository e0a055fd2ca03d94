"""Runs of the planar engine without noise, and what they are held against."""

import numpy as np

from rr_lab.effects import rig_with
from rr_lab.planar.drive import STEP, drive
from rr_lab.rig import Rig
from rr_lab.run import Conditions
from rr_opt.model.robot import EffectUse


def rig(robot, *uses):
    """The robot with effects, each a name and its values."""
    return rig_with(robot, [EffectUse(name, values) for name, values in uses])


def driven(what, gait, seconds=3.0, start="running", *uses, step=STEP, **conditions):
    """The motion of a rig, or of a robot with effects in it."""
    made = what if isinstance(what, Rig) else rig(what, *uses)
    return drive(made, gait, Conditions(seconds, start, **conditions), step)


def channels(motion):
    """x, y, psi, phi (4, n)."""
    return np.array([*motion.one.T, motion.two[:, 2] - motion.one[:, 2]])
