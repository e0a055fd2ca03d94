"""The joint angle as a function of time: periodic, or from standing still."""

from collections.abc import Callable
from dataclasses import dataclass

import casadi as ca
import numpy as np

from rr_opt.array import Array
from rr_opt.model.gait import Gait


@dataclass(frozen=True)
class Drive:
    """phi(t) of a robot that is driven by a gait.

    at      t (n,) s -> phi, dphi, ddphi (3, n): rad, rad/s, rad/s2
    period  s
    rest    the robot stands still until t = 0, where dphi may jump; else phi is periodic
    jumps   times at which dphi jumps, (n,) s, increasing: those of one period if phi is periodic,
            else from the start on to where the last period repeats. None if there are none
    """

    at: Callable[[Array], Array]
    period: float
    rest: bool
    jumps: Array | None = None

    @property
    def smooth(self) -> bool:
        """Whether dphi never jumps, but at a start from rest."""
        return self.jumps is None

    def jumps_within(self, low: float, high: float) -> Array:
        """Times between two others at which dphi jumps, (n,) s, increasing."""
        if self.jumps is None or not self.jumps.size:
            return np.zeros(0)
        T, first = self.period, self.jumps
        repeats = first[first > first[-1] - T * (1 - 1e-9)]
        turns = np.arange(np.floor((low - repeats[-1]) / T), np.ceil((high - repeats[0]) / T) + 1)
        if self.rest:
            turns = turns[turns > 0]
        repeated = (repeats + T * turns[:, None]).ravel()
        every = np.concatenate([first, repeated]) if self.rest else repeated
        return np.sort(every[(every > low) & (every < high)])


@dataclass(frozen=True)
class FreeJoint:
    """How the joint moves while the servo exerts no torque; see `motion.floor_motion.free_joint`.

    swing  (phi, dphi, z, p) -> ddphi (rad/s2), zdot (m/s2), mobility (rad/s2 per N m)
    p      values of the robot's parameters, SI
    """

    swing: ca.Function
    p: tuple[float, ...]


def commanded(gait: Gait, rest: bool) -> Drive:
    """The gait itself; a robot that starts from rest is kept at the offset until t = 0."""

    def at(t: Array) -> Array:
        path = np.array([gait.angle(t), gait.rate(t), gait.acceleration(t)])
        if rest:
            still = np.asarray(t) < 0
            path[0, still] = gait.offset
            path[1:, still] = 0.0
        return path

    return Drive(at, gait.period, rest)
