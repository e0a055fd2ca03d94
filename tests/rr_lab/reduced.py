"""The reduced model, by which the laboratory is judged: CVODES on rr_opt.mechanics."""

import math
from dataclasses import dataclass, replace

import numpy as np
from scipy.optimize import least_squares

from rr_opt.model.gait import FourierGait
from rr_opt.model.robot import Platform, Robot
from rr_opt.motion.integrators import cvodes

LONG = Robot(
    Platform(m=0.403, I=0.00321, c=0.2054, a=0.0246, b=0.0462, kappa=1.98e-5),
    Platform(m=0.291, I=0.00274, c=0.0629, a=0.026, b=0.0687, kappa=1.6e-5),
    h=0.03,
)
SHORT = Robot(
    Platform(m=0.617, I=0.00309, c=0.1474, a=0.0251, b=0.0566, kappa=4.53e-5),
    Platform(m=0.373, I=0.00338, c=0.1067, a=0.0112, b=0.0593, kappa=6.08e-5),
    h=0.025,
)
SIGMA = {"x": 1e-3, "y": 1e-3, "psi": 3e-3}


@dataclass(frozen=True)
class Fitted:
    """rms, in SIGMA, is what is left of a recording; path (3, n) is the model's x, y, psi."""

    rms: float
    path: np.ndarray
    t: np.ndarray


def later(gait, start):
    """The gait with its clock set forward by `start` s."""
    turn = gait.angular_frequency * start
    size = gait.amplitude
    return FourierGait(gait.period, gait.offset, (size * math.cos(turn),), (size * math.sin(turn),))


def fitted(robot, gait, recording, skip=0):
    """The reduced model's path nearest to a recording without noise from sample `skip` on: place,
    heading and first speed are fitted."""
    t = recording.t[skip:]
    seen = np.array([recording.values[channel][skip:] for channel in SIGMA])
    sigma = np.array(list(SIGMA.values()))[:, None]
    gait = later(gait, t[0])

    def path(p):
        _, psi, x, y, _ = cvodes(robot, gait, p[0], t - t[0])
        cos, sin = np.cos(p[1]), np.sin(p[1])
        return np.array([cos * x - sin * y + p[2], sin * x + cos * y + p[3], psi + p[1]])

    def residual(p):
        return ((path(p) - seen) / sigma).ravel()

    start = [0.0, seen[2, 0], seen[0, 0], seen[1, 0]]
    found = least_squares(residual, start, x_scale=(0.1, 0.1, 0.1, 0.1), method="lm")
    return Fitted(float(np.sqrt(np.mean(found.fun**2))), path(found.x), t)


def with_physics(robot, *uses):
    """The robot with effects that both plants know."""
    return replace(robot, physics=uses)
