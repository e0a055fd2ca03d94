"""A term without a name for the corrected robot: rolling resistance as a curve of speed.

Where no effect of the catalogue accounts for what is left, `rolling_force_curve` says what the
wheels do at five speeds. It is fitted as an effect is, by simulation error over whole runs, beside
the parameters; the speed of its last knot is that which the wheels seldom exceed.
"""

from __future__ import annotations

import numpy as np

from rr_opt.diagnose.explain import joined
from rr_opt.diagnose.fit import Fit, solve
from rr_opt.diagnose.model import Quantity
from rr_opt.diagnose.observed import observed
from rr_opt.diagnose.problem import Problem
from rr_opt.diagnose.racer_protocol import Racer
from rr_opt.physics.effects.rolling_force_curve import EFFECT
from rr_opt.robot.parameters import Robot

_FAST = 0.98
"""Quantile of the wheels' speeds at which the curve ends."""


def with_force_curve(model: Racer, robot: Robot, whole: Fit, windows: Fit) -> Fit:
    """The parameters with the curve beside them, over whole runs.

    whole    the parameters alone, over whole runs, say how fast the wheels are
    windows  where it begins, as the parameters are not yet bent there
    """
    name = EFFECT.name
    seen = [observed(model, p, whole.values, whole.effects, s) for p, s in whole.starts.items()]
    speed = float(np.quantile(np.abs(np.concatenate([one.u.ravel() for one in seen])), _FAST))
    size = (robot.k1 + robot.k2) / 2 * speed
    curve = tuple(
        # The speed is where the curve ends, and stays.
        Quantity(f"{name}.{q.name}", q.unit, speed, speed, False, speed, speed, speed)
        if q.name == "speed"
        else Quantity(f"{name}.{q.name}", q.unit, 0.0, size, False, *q.bounds, q.neutral)
        for q in EFFECT.parameters
    )
    quantities = (*model.parameters, *curve)
    problem = Problem(model, tuple(windows.starts), (name,), quantities)
    values = {q.name: q.value for q in quantities}
    return joined(model, solve(problem, values, windows.starts))
