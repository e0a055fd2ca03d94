"""The gait that is fast on most of the robots that a problem may mean."""

from dataclasses import replace

import numpy as np

from rr_opt.design.maximize_speed import Optimum
from rr_opt.design.robust import RELIABLE, RobustGait, robust_gait
from rr_opt.model.ballast import inertia_ratio
from rr_opt.model.gait import SineGait
from rr_opt.model.problem import Spreads
from rr_opt.results.fastest import FastestGait
from rr_opt.results.robust import Robust
from rr_opt.verify.speeds import drawn

_MARGIN, _TIGHTENED = 1e-3, 6
"""By so much more than enough robots shall keep the limit, so that the next try does; tries."""
_SCALES = tuple(np.linspace(0.0, 2.0, 9).tolist())


def robust_answer(best: FastestGait, spreads: Spreads) -> Robust | None:
    """The robust gait beside the nominal optimum, and what robots drawn at random make of both."""
    torque, choice = best.problem.limits.torque, best.problem.inertia_ratio
    nominal = best.optimum.best.gait if best.optimum.best else None
    if not isinstance(nominal, SineGait):
        return None
    found = _kept_by_most(best.optimum, spreads)
    if found is None:
        return None
    gaits = (found.robot, found.gait), (best.robot, nominal)
    seen, mine = (drawn(*one, spreads) for one in gaits)
    other, speed = drawn(found.robot, found.gait, spreads, seed=2), seen.reached(RELIABLE)
    first, second = (
        tuple(drawn(*one, spreads, scale).reached(RELIABLE) for scale in _SCALES) for one in gaits
    )
    return Robust(
        gait=best.command_for(found.gait),
        ratio=inertia_ratio(found.robot, choice.about if choice else "joint"),
        speed=speed,
        nominal=found.nominal,
        without=mine.reached(RELIABLE),
        kept=mine.keeping(torque),
        reaching=other.reaching(speed),
        keeping=other.keeping(torque),
        scales=_SCALES,
        curves=(first, second),
    )


def _kept_by_most(optimum: Optimum, spreads: Spreads) -> RobustGait | None:
    """The robust gait, the limit on torque tightened until enough of the robots drawn keep it."""
    problem, torque = optimum.problem, optimum.problem.limits.torque
    tightened = torque
    for _ in range(_TIGHTENED):
        limits = replace(problem.limits, torque=tightened)
        found = robust_gait(replace(optimum, problem=replace(problem, limits=limits)), spreads)
        if found is None:
            return None
        seen = drawn(found.robot, found.gait, spreads)
        if seen.keeping(torque) >= RELIABLE:
            return found
        tightened *= torque / float(np.quantile(seen.torque, RELIABLE + _MARGIN))
    return None
