"""Whether a start would lead to an optimum that is known already."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from rr_opt.design.decisions import Decisions
from rr_opt.design.landscape import Cycles, Landscape
from rr_opt.design.scan import FINER_NODES, Seed
from rr_opt.design.solve import Candidate

Array = NDArray[np.float64]

_STEPS = 24
_FALL = 1e-4
"""A fall on the way, relative to the optimum, that is the landscape's roughness."""
_CORRECTIONS = 4
_PENALTY = 3.0
"""For an excess of 1 over the torque limit, in speeds of the optimum."""


def leads_to(
    landscape: Landscape, box: Decisions, torque_limit: float, seed: Seed, known: Candidate
) -> bool:
    """The way from a start to an optimum rises all along.

    It is the straight line in the unit box; where that would need too much torque the amplitude is
    lowered. A top between them, or the start on a slope of its own, would make it fall somewhere.
    Turns are not looked at.
    """
    if seed.sign != known.sign or not (known.feasible and known.success):
        return False
    end = box.unit(known.gait.amplitude, known.gait.period, known.gait.offset, known.share)
    start = seed.point.copy()
    if box.mirrored:
        for point in (start, end):
            point[1] = max(point[1], 1 - point[1])
    way = start + np.linspace(0.0, 1.0, _STEPS)[:, None] * (end - start)
    for _ in range(_CORRECTIONS):
        way[:, 2] /= 1 + _excess(landscape.cycles(box.physical(way), FINER_NODES), torque_limit)
    cycles = landscape.cycles(box.physical(way), FINER_NODES)
    height = seed.sign * cycles.speed / abs(known.speed) - _PENALTY * _excess(cycles, torque_limit)
    height[-1] = 1.0
    # A comparison with nan, where nothing settles, is false.
    return bool(np.all(np.diff(height) >= -_FALL))


def _excess(cycles: Cycles, torque_limit: float) -> Array:
    return np.maximum(cycles.peak_torque / torque_limit - 1, 0.0)
