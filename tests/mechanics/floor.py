"""The motion on the floor at a place and heading, with the direct equation of motion behind z."""

from functools import lru_cache
from typing import NamedTuple

import numpy as np

from rr_opt.effects import CATALOGUE
from rr_opt.model.robot import Robot
from rr_opt.motion.dynamics import assembled, values_of
from rr_opt.motion.floor_motion import FloorMotion, floor_motion, solved
from tests.mechanics.cases import State

# The curve without a name is held against the effects that it imitates, beside the diagnosis.
MECHANICAL = tuple(name for name, effect in CATALOGUE.items() if effect.enter and effect.candidate)


class Floor(NamedTuple):
    """xdot, ydot, psidot; d/dt of v, s1, s2 as far as they are free; servo torque."""

    pose: np.ndarray
    speeds: np.ndarray
    torque: float


@lru_cache
def _soft(effects: tuple[str, ...]) -> FloorMotion:
    return solved(assembled(effects))


def on_floor(
    robot: Robot, state: State, place: np.ndarray, sides=(0.0, 0.0), *, for_prediction: bool = True
) -> Floor:
    """The robot's floor motion; axles that may slip do so at `sides`, m/s."""
    motion = (floor_motion if for_prediction else _soft)(tuple(use.name for use in robot.physics))
    p = values_of(robot, motion.parameters)
    v, phi, dphi, ddphi = state
    if motion.slips:
        here, drive = [*place, v, *sides], [phi, dphi, ddphi]
        rates = motion.rates(here, drive, p).full().ravel()
        return Floor(rates[:3], rates[3:], float(motion.torque(here, drive, ddphi, p)))

    def g(angle: float) -> float:
        return float(motion.speeds([*place, 0.0], [angle, 1.0], p)[0])

    here = [*place, v - g(phi) * dphi]
    rates = motion.rates(here, [phi, dphi], p).full().ravel()
    slope = (g(phi + 1e-5) - g(phi - 1e-5)) / 2e-5
    vdot = rates[3] + slope * dphi**2 + g(phi) * ddphi
    torque = float(motion.torque(here, [phi, dphi], ddphi, p))
    return Floor(rates[:3], np.array([vdot]), torque)


def what_is_seen(effects: tuple[str, ...], place: np.ndarray, phi: float, values) -> np.ndarray:
    """x, y, psi, phi as a capture system sees them, of one effect with these values."""
    motion = floor_motion(effects)
    p = [values.get(name.split(".")[-1], np.nan) for name in motion.parameters]
    return motion.observed([*place, 0.0], [phi, 0.0], p).full().ravel()
