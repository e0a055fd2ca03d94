"""Do the intervals keep their word? Nine rows are made by robots that are known, and counted.

The robots are draws from the posterior, so they are such as the paper's may have been. A 95 %
interval that is honest holds the truth 95 times in a hundred.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from rr_opt.paper.calibration.compare import nearest, refits
from rr_opt.paper.calibration.deviance import Law
from rr_opt.paper.calibration.library import Library
from rr_opt.paper.calibration.measured import Measured
from rr_opt.paper.calibration.models import one_way
from rr_opt.paper.calibration.posterior import Posterior, evolve, weights
from rr_opt.paper.calibration.profile import LEVEL
from rr_opt.paper.calibration.simulated import Simulated, simulated

Array = NDArray[np.float64]

_STEPS = 10
_CHAINS, _SWEEPS = 24, 160
"""Of each set's own posterior."""


@dataclass(frozen=True)
class Coverage:
    """Shares of data sets whose 95 % interval holds the truth, one number for each unknown.

    sets       how many
    posterior  the middle 95 % of the posterior
    profile    the profile interval, by each law
    needed     the rise of the deviance that 95 % of the truths stay below, Student's law; 3.84
               if the theorem for many data held
    """

    sets: int
    posterior: Array
    profile: dict[Law, Array]
    needed: Array


def coverage(
    predict: Callable[[Array], Array],
    known: Library,
    drawn: Posterior,
    data: Measured,
    *,
    sets: int,
    tick: Callable[[], None],
) -> Coverage:
    """predict gives signed speeds."""
    draw = np.random.default_rng(4)
    truth = drawn.points[draw.choice(len(drawn.points), sets, replace=False)]
    made = simulated(one_way(predict(truth)), data, draw)
    rises = {}
    for law in ("student", "normal"):
        tick()
        rises[law] = _rises(predict, known, truth, made, law)
    return Coverage(
        sets,
        _posterior_coverage(predict, known, truth, made, draw, tick),
        {law: (rise <= LEVEL).mean(axis=0) for law, rise in rises.items()},
        np.quantile(rises["student"], 0.95, axis=0),
    )


def _rises(
    predict: Callable[[Array], Array], known: Library, truth: Array, made: Simulated, law: Law
) -> Array:
    """The deviance with each unknown held at its truth, above the least, (K, unknowns)."""
    starts = [truth, nearest(known, made, law)]
    free = refits(predict, made, starts, law=law, steps=_STEPS)
    rises = []
    for unknown in range(truth.shape[1]):
        held = [start.copy() for start in starts]
        for start in held:
            start[:, unknown] = truth[:, unknown]
        rises.append(refits(predict, made, held, law=law, steps=_STEPS, fixed=unknown))
    # A fit that holds an unknown may find a valley that the free one missed.
    least = np.minimum(free, np.min(rises, axis=0))
    return np.array(rises).T - least[:, None]


def _posterior_coverage(
    predict: Callable[[Array], Array],
    known: Library,
    truth: Array,
    made: Simulated,
    draw: np.random.Generator,
    tick: Callable[[], None],
) -> Array:
    """Share of the truths inside the middle 95 % of each set's posterior, (unknowns,)."""
    start = []
    for i in range(len(truth)):
        chances = weights(known.deviance(made.one(i)))
        start.append(known.points[draw.choice(len(chances), _CHAINS, p=chances)])
    data = Measured(made.speed, made.error)
    kept = evolve(predict, np.array(start), data, _SWEEPS, draw, tick)
    below = (kept <= truth[None, :, None, :]).mean(axis=(0, 2))
    return ((below >= 0.025) & (below <= 0.975)).mean(axis=0)
