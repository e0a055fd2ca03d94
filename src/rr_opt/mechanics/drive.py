"""The angle that the servo makes, as a function of time, from standing still or for ever."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import casadi as ca
import numpy as np

from rr_opt.array import Array
from rr_opt.model.gait import Gait


@dataclass(frozen=True)
class Drive:
    """phi(t) of a robot that is told a gait.

    at      t (n,) s -> phi, dphi, ddphi (3, n): rad, rad/s, rad/s2
    period  s
    rest    the robot stands still until t = 0; else it has been driven for ever
    jumps   when dphi jumps, (n,) s in order; for a robot driven for ever in some period, else from
            t = 0 on, where the last period repeats. None if it never does
    """

    at: Callable[[Array], Array]
    period: float
    rest: bool
    jumps: Array | None = None

    @property
    def smooth(self) -> bool:
        """Whether dphi never jumps."""
        return self.jumps is None

    def jumps_within(self, low: float, high: float) -> Array:
        """When dphi jumps between two times, (n,) s in order."""
        if self.jumps is None or not self.jumps.size:
            return np.zeros(0)
        T, first = self.period, self.jumps
        repeats = first[first > first[-1] - T * (1 - 1e-9)]
        turns = np.arange(np.floor((low - repeats[-1]) / T), np.ceil((high - repeats[0]) / T) + 1)
        if self.rest:
            turns = turns[turns > 0]
        often = (repeats + T * turns[:, None]).ravel()
        every = np.concatenate([first, often]) if self.rest else often
        return np.sort(every[(every > low) & (every < high)])


@dataclass(frozen=True)
class FreeJoint:
    """How the joint swings while the servo's torque is zero; see `physics.free_joint`.

    swing  (phi, dphi, z, p) -> ddphi (rad/s2), zdot (m/s2)
    p      the robot's values, SI
    """

    swing: ca.Function
    p: tuple[float, ...]


def told(gait: Gait, rest: bool) -> Drive:
    """The gait itself; before t = 0 a robot at rest is told to keep the offset."""

    def at(t: Array) -> Array:
        path = np.array([gait.angle(t), gait.rate(t), gait.acceleration(t)])
        if rest:
            still = np.asarray(t) < 0
            path[0, still] = gait.offset
            path[1:, still] = 0.0
        return path

    return Drive(at, gait.period, rest)
