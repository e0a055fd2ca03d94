"""The energy of a motion by equation (3): what the servo gives, and what comes from nowhere."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from rr_opt.paper import two_bodies
from rr_opt.paper.equation3 import Signs, equation3, steady
from rr_opt.robot.gait import SineGait
from rr_opt.robot.parameters import Robot

_CYCLE = 128
"""Instants of a period over which the energy is added up."""


@dataclass(frozen=True)
class Energy:
    """Mean powers over a steady period, W: what the servo gives, what friction takes, and what
    comes from nowhere; the largest force from nowhere, N; and the mean speed, m/s.

    Servo and nowhere add up to friction: `gap` is by how much they do not.
    """

    signs: Signs
    servo: float
    friction: float
    nowhere: float
    force: float
    speed: float

    @property
    def gap(self) -> float:
        """W."""
        return self.servo + self.nowhere - self.friction


def energy_of(robot: Robot, gait: SineGait, signs: Signs) -> Energy:
    """The energy of a steady straight gait that moves by these signs.

    A robot that moves so is pushed, along platform 1 at axle 1, by whatever force makes up the
    difference: the servo does no work on it there, nor does friction change.
    """
    cycle = steady(robot, gait, signs)
    powers = np.zeros((3, _CYCLE))
    largest = 0.0
    every = len(cycle.t) // _CYCLE
    for i, (t, v) in enumerate(zip(cycle.t[::every], cycle.v[::every], strict=True)):
        phi, dphi, ddphi = (float(f(t)) for f in (gait.angle, gait.rate, gait.acceleration))
        q, qd = two_bodies.placed(robot, phi, dphi, float(v))
        slope, drive = equation3(robot, phi, dphi, ddphi, signs)
        free, pushed = (
            two_bodies.forward_acceleration(
                q, qd, two_bodies.accelerate(robot, q, qd, ddphi, push).acceleration
            )
            for push in (0.0, 1.0)
        )
        force = float(slope * v + drive - free) / (pushed - free)
        torque = two_bodies.accelerate(robot, q, qd, ddphi, force).torque
        powers[:, i] = torque * dphi, -two_bodies.friction(robot, q, qd) @ qd, force * v
        largest = max(largest, abs(force))
    servo, taken, nowhere = powers.mean(axis=1).tolist()
    return Energy(signs, servo, taken, nowhere, largest, cycle.speed)
