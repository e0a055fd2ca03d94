"""The rigid motion of one cycle, and the average speed along the circle it makes.

One steady period moves the robot by (dx, dy) and turns it by dpsi, both seen from platform 1 at
the start; repeated, that is a circle about a fixed centre C. P does not stay at one distance
from C within the period, so the chord of P depends on where the period is cut. Seen from the
frame that turns about C at Omega = dpsi/T, P's path is periodic; its mean point is at radius R
and the speed along the mean circle is R |Omega|, whatever the cut.

C runs off to infinity as the gait straightens. Omega C does not:

    Omega C = (dpsi/2)/sin(dpsi/2) / T * Rot(dpsi/2 + 90 deg) (dx, dy)  up to the sign below

and with it Omega p = Rot(-Omega t) (Omega P - Omega C) is formed directly. A straight gait is
the limit and no special case: its Omega p is the chord over T, turned by 90 degrees.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Cycle:
    """What one steady period does.

    dx, dy   displacement of P, m, in platform 1's axes at the start of the period
    dpsi     heading gained, rad
    speed    average speed along the mean circle, m/s, positive along platform 1's axis
    radius   of the mean circle, m; inf for a straight gait
    """

    period: float
    dx: float
    dy: float
    dpsi: float
    speed: float
    radius: float


def cycle_of(period: float, x: ArrayLike, y: ArrayLike, psi: ArrayLike) -> Cycle:
    """The cycle from P's path over one steady period.

    x, y, psi: (N + 1,) at equal steps, both ends included; m, m, rad (unwrapped).
    """
    x, y, psi = (np.asarray(values, float) for values in (x, y, psi))
    start = _rotate(-psi[0], np.array([x - x[0], y - y[0]]))
    dx, dy = start[:, -1]
    dpsi = float(psi[-1] - psi[0])
    omega = dpsi / period
    # C solves C = (dx, dy) + Rot(dpsi) C.
    half = dpsi / 2
    stretch = 1.0 / np.sinc(half / math.pi) / period
    omega_c = stretch * _quarter_turn(_rotate(-half, np.array([dx, dy])))

    turned = omega * np.arange(len(x) - 1) * period / (len(x) - 1)
    omega_p = _rotate(-turned, omega * start[:, :-1] - omega_c[:, None]).mean(axis=1)
    velocity = _quarter_turn(omega_p)
    seen = psi[:-1] - psi[0] - turned
    ahead = velocity @ np.array([np.cos(seen).mean(), np.sin(seen).mean()])
    speed = math.copysign(math.hypot(*omega_p), ahead)
    radius = abs(speed / omega) if omega else math.inf
    return Cycle(period, float(dx), float(dy), dpsi, speed, radius)


def _rotate(angle: ArrayLike, vector: Array) -> Array:
    cos, sin = np.cos(angle), np.sin(angle)
    return np.array([cos * vector[0] - sin * vector[1], sin * vector[0] + cos * vector[1]])


def _quarter_turn(vector: Array) -> Array:
    return np.array([-vector[1], vector[0]])
