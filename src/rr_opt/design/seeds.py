"""Starts for multiple shooting: scan the whole box coarsely, climb from every promising point."""

from __future__ import annotations

from functools import partial

import numpy as np
from numpy.typing import NDArray

from rr_opt.design.climb import Merit, climb
from rr_opt.design.decisions import Decisions
from rr_opt.design.landscape import Cycles, Landscape
from rr_opt.design.scan import (
    CLIMBERS,
    FINER_NODES,
    NODES,
    POINTS,
    PROMISING,
    ROUGH,
    THOROUGH,
    Seed,
    peaks,
    scan,
    search,
    share_of,
)
from rr_opt.design.turn.seeds import turn_seeds
from rr_opt.problem import Interval

Array = NDArray[np.float64]

# A top this much slower than the best is not solved from.
_WORTH_SOLVING = 0.5
_FEW = 2
# What a gait counts as using of the torque limit that has no steady cycle.
_UNSETTLED = 10.0
_WITHIN = (Interval(-np.inf, 1.0),)


def find_seeds(
    landscape: Landscape, decisions: Decisions, torque_limit: float, signs: tuple[int, ...]
) -> tuple[list[Seed], float]:
    """Starts that are each in a basin of their own as far as the scan can tell, best first, and
    the speed of the best, m/s: negative if it goes against its direction."""
    if decisions.turn:
        return turn_seeds(landscape, decisions, decisions.turn, torque_limit, signs)

    def terrain(points: Array, sign: Array, nodes: int = NODES) -> Array:
        cycles = landscape.cycles(decisions.physical(points), nodes)
        speed, torque = sign * cycles.speed, cycles.peak_torque / torque_limit
        settled = np.isfinite(speed) & np.isfinite(torque)
        return np.array([np.where(settled, speed, 0.0), np.where(settled, torque, _UNSETTLED)])

    free = decisions.free
    points = scan(decisions, POINTS[len(free)])
    seen = terrain(points, np.ones(len(points)))
    merit = Merit(_WITHIN, (3 * float(np.abs(seen[0]).max()),))
    candidates = np.concatenate([points for _ in signs])
    sign = np.repeat(signs, len(points))
    values = np.concatenate([merit(np.array([way * seen[0], seen[1]])) for way in signs])
    least = share_of(values.max(), PROMISING)
    chosen = peaks(candidates[:, free], sign, values, CLIMBERS[len(free)], least)
    tops, sign, values = climb(candidates[chosen], sign[chosen], free, terrain, merit, ROUGH)
    worth = values >= share_of(values[0], _WORTH_SOLVING)
    tops, sign = tops[worth], sign[worth]
    if decisions.mirrored:
        tops[:, 1] = np.maximum(tops[:, 1], 1 - tops[:, 1])
    # A few tops are solved from sooner than told apart.
    if len(tops) > _FEW:
        finer = partial(terrain, nodes=FINER_NODES)
        tops, sign, values = climb(tops, sign, free, finer, merit, THOROUGH)
    good = np.flatnonzero(values >= share_of(values[0], _WORTH_SOLVING))
    return [Seed(int(sign[i]), tops[i]) for i in good], float(values[0])


def least_torque(landscape: Landscape, decisions: Decisions) -> float:
    """The smallest peak torque of any gait of the box, N m."""

    def look(cycles: Cycles, _gaits: Array, _sign: Array) -> Array:
        return -cycles.peak_torque[None]

    return -search(landscape, decisions, look, Merit((), ()), (1,))[2]
