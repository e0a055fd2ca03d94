"""The gait that a robot's servo makes of the one that it is told."""

from __future__ import annotations

import numpy as np

from rr_opt.physics.drive import told
from rr_opt.physics.effects import CATALOGUE
from rr_opt.physics.free_joint import free_joint
from rr_opt.robot.fourier_gait import FourierGait
from rr_opt.robot.gait import Gait
from rr_opt.robot.parameters import Robot

_HARMONICS = 24
"""The n-th of an angle whose rate jumps falls as 1/n^2: what is left out moves the speed by less
than a thousandth."""
_SAMPLES = 2048
_SETTLED = 20
"""Periods after which what the servo makes repeats."""


def servo_made(robot: Robot, gait: Gait) -> Gait:
    """The angle made, once it repeats, as a sum of harmonics; the gait itself of a servo without
    effects."""
    uses = [use for use in robot.physics if CATALOGUE[use.name].actuate]
    if not uses:
        return gait
    drive, joint = told(gait, rest=False), free_joint(robot)
    for use in uses:
        actuate = CATALOGUE[use.name].actuate
        drive = actuate(drive, use.values, joint) if actuate else drive
    t = gait.period * (_SETTLED + np.arange(_SAMPLES) / _SAMPLES)
    part = np.fft.rfft(drive.at(t)[0]) / _SAMPLES
    sizes = part[1 : _HARMONICS + 1]
    return FourierGait(
        gait.period,
        float(part[0].real),
        tuple((-2 * sizes.imag).tolist()),
        tuple((2 * sizes.real).tolist()),
    )
