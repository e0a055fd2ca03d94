"""The motor's work is in the motion or was rubbed away; each is computed by itself."""

import numpy as np
import pytest

from rr_lab.planar.forces import DRY_ONSET
from rr_opt.model.gait import SineGait
from tests.rr_lab.planar.driven import driven
from tests.rr_lab.reduced import LONG

GAIT = SineGait(0.7, 1.0, 0.2)
RATE = 2000.0
ONE, TWO = LONG.platform1, LONG.platform2


def axis(heading):
    return np.array([np.cos(heading), np.sin(heading)])


def left(vector):
    return np.array([-vector[1], vector[0]])


def slope(values):
    return np.gradient(values, 1 / RATE, axis=-1)


def kinetic(motion):
    """J, at every sample, from the places alone."""
    energy = np.zeros(len(motion.t))
    for part, ahead, pose in ((ONE, 1.0, motion.one.T), (TWO, -1.0, motion.two.T)):
        centre = pose[:2] + ahead * part.joint_to_centre * axis(pose[2])
        energy += part.m * (slope(centre) ** 2).sum(0) / 2 + part.I * slope(pose[2]) ** 2 / 2
    return energy


def wheel_speeds(motion):
    """Along and across each wheel (4, n), m/s, of its centre."""
    found = []
    for part, ahead, pose in ((ONE, 1.0, motion.one.T), (TWO, -1.0, motion.two.T)):
        heads = axis(pose[2])
        for side in (1, -1):
            moves = slope(pose[:2] + ahead * part.c * heads + side * part.b * left(heads))
            found.append([(moves * heads).sum(0), (moves * left(heads)).sum(0)])
    return np.array(found).transpose(1, 0, 2)


def viscous(along, across):
    k = np.array([LONG.k1, LONG.k1, LONG.k2, LONG.k2])[:, None]
    return (k * along**2).sum(0)


def dry(along, across):
    force = np.array([5e-3, 5e-3, 8e-3, 8e-3])[:, None]
    rubs = force * along**2 / (along**4 + DRY_ONSET**4) ** 0.25
    return viscous(along, across) + rubs.sum(0)


def creep(along, across):
    return viscous(along, across) + (across**2 / 0.1).sum(0)


CASES = {
    "nothing": ((), viscous),
    "dry": ((("coulomb_friction", {"force1": 5e-3, "force2": 8e-3}),), dry),
    "creep": ((("lateral_slip", {"creep_compliance": 0.1}),), creep),
}


@pytest.mark.parametrize("name", CASES)
def test_balance(name):
    uses, lost = CASES[name]
    motion = driven(LONG, GAIT, 2.6, "running", *uses, rate=RATE, torque=True)
    power = motion.torque * slope(motion.two[:, 2] - motion.one[:, 2])
    losses = lost(*wheel_speeds(motion))
    energy = kinetic(motion)
    # Away from the ends, where differences are one-sided.
    inner = slice(2, -2)
    work, rubbed = (np.trapezoid(each[inner], dx=1 / RATE) for each in (power, losses))
    gained = energy[inner][-1] - energy[inner][0]
    assert rubbed > 1e-3
    assert work == pytest.approx(gained + rubbed, abs=1e-3 * rubbed)
    # And at every instant.
    assert np.abs(power - slope(energy) - losses)[inner].max() < 2e-3 * np.abs(power).max()
