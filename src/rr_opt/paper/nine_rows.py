"""The nine averages of Tables 2 and 3, by any robot that Table 1 leaves possible."""

from __future__ import annotations

from types import MappingProxyType

import numpy as np
from numpy.typing import NDArray

from rr_opt.outcome import InputError
from rr_opt.paper.equation3 import CORRECTED, Signs, steady
from rr_opt.paper.printed import TABLE_1, TABLE_2, TABLE_3
from rr_opt.paper.readings import Reading
from rr_opt.physics.dynamics import dynamics_of
from rr_opt.robot.gait import SineGait
from rr_opt.robot.parameters import Platform, Robot
from rr_opt.verify.speeds import model_of

Array = NDArray[np.float64]

ROWS = (*TABLE_2, *TABLE_3)

BOX = MappingProxyType(
    {
        "a1": (-0.03, 0.03),
        "a2": (-0.03, 0.03),
        "b": (0.02, 0.08),
        "k": (0.01, 1.0),
        "amplitude": (0.2, 1.5),
    }
)
"""Where the unknowns may lie: m, m, m, N s/m, rad; k is fitted in its logarithm."""

_SAMPLES = 64


def prototype(a1: float, a2: float, b: float, k: float) -> Robot:
    """Table 1 with these unknowns; h = 20 mm stands for any, as only k matters."""
    h = 0.02
    known = {name: value for name, (value, _) in TABLE_1.items()}
    return Robot(
        Platform(known["m1"], known["I10"], known["c1 - a1"] + a1, a1, b, k * h**2),
        Platform(known["m2"], known["I20"], known["c2 - a2"] + a2, a2, b, k * h**2),
        h,
    )


def predicted(robot: Robot, reading: Reading, amplitude: float, signs: Signs = CORRECTED) -> Array:
    """Signed speeds of the nine rows, m/s; Table 2 at `amplitude`, rad. NaN where there is none."""
    alpha = np.array([row.amplitude or amplitude for row in ROWS])
    try:
        built = {ratio: reading.build(robot, ratio) for ratio in {row.ratio for row in ROWS}}
    except InputError:
        return np.full(len(ROWS), np.nan)
    robots = [built[row.ratio] for row in ROWS]
    if signs is not CORRECTED:
        gaits = [SineGait(float(a), row.period) for a, row in zip(alpha, ROWS, strict=True)]
        return np.array(
            [
                steady(one, gait, signs).speed if gait.peak_angle < one.singular_angle else np.nan
                for one, gait in zip(robots, gaits, strict=True)
            ]
        )
    p = np.array([dynamics_of(one).values(one) for one in robots]).T
    period = np.array([[row.period] for row in ROWS])
    found = model_of(robot).cycles(alpha, np.zeros(len(ROWS)), period, p, _SAMPLES, True)
    inside = alpha < np.array([one.singular_angle for one in robots])
    return np.where(inside & (found.error[:, 0] < 1e-2), found.speed[:, 0], np.nan)
