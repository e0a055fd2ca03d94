"""The recording that would narrow down most what is known worst.

Of a linearised fit the covariance of the values is known, and what a new recording adds to its
inverse. The standard deviation of each value is counted against what was known of it beforehand,
or, of an effect and of what nothing was known of, against the value itself.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from rr_opt.diagnose.contest import RANKED_RATE, Rival
from rr_opt.diagnose.explanation import Explanation
from rr_opt.diagnose.intervals import covariance
from rr_opt.diagnose.model import Array, Quantity
from rr_opt.diagnose.plans import Plan, imagined
from rr_opt.diagnose.problem import Problem, box, unscaled
from rr_opt.diagnose.racer import RollerRacer


@dataclass(frozen=True)
class Narrowing:
    """The accepted explanation, and how far (m) a plan may go."""

    model: RollerRacer
    accepted: Explanation
    room: float

    def promises(self, plans: Sequence[Plan]) -> list[float]:
        """By how much a value's relative standard deviation would fall at most with each plan's
        recording; 0 if the plan leaves the floor there is."""
        return [
            0.0 if both is None else float(self._drops(*both).max())
            for both in self._deviations(plans)
        ]

    def rival(self, plan: Plan) -> Rival | None:
        """The accepted explanation, but the value that the plan narrows most is off by one
        standard deviation, and all others adjusted so that the present recordings hardly tell."""
        (both,), fit = self._deviations([plan]), self.accepted.whole
        if both is None:
            return None
        k, spread = int(np.argmax(self._drops(*both))), covariance(fit)
        along = spread[:, k] / math.sqrt(spread[k, k])
        _, high = box(fit.quantities)
        if (high - fit.scaled)[k] < along[k]:
            along = -along
        values = dict(fit.values) | unscaled(fit.quantities, fit.scaled + along)
        q = fit.quantities[k]
        rest = [j for j in range(len(fit.quantities)) if j != k]
        now, then = (one[k] * q.scale for one in both)
        return Rival(
            f"{q.name} = {values[q.name]:.3g} {q.unit} instead of {fit.values[q.name]:.3g}",
            fit.effects,
            tuple(fit.quantities[j] for j in rest),
            values,
            fit.total().H[np.ix_(rest, rest)],
            f"It would tell most about {q.name}, which is {fit.values[q.name]:.3g} {q.unit} and "
            f"would be known to {then:.2g} (one standard deviation) instead of {now:.2g}.",
        )

    def _deviations(self, plans: Sequence[Plan]) -> list[tuple[Array, Array] | None]:
        """Standard deviations of the values, scaled, now and with each plan's recording."""
        fit = self.accepted.whole
        if not fit.quantities:
            return [None] * len(plans)
        made = imagined(self.model, plans, RANKED_RATE, fit.values, fit.effects)
        problem = Problem(made.model, tuple(made.starts), fit.effects, fit.quantities)
        normals = problem.normals(fit.values, made.within(self.room))
        H, now = fit.total().H, np.sqrt(np.diag(covariance(fit)))
        before = _deviations(H)
        out: list[tuple[Array, Array] | None] = []
        for piece in made.starts:
            both = None
            if piece in normals:
                # The model is doubted then as it is now.
                then = now * _deviations(H + normals[piece].H) / before
                both = (now, then) if np.isfinite(then).all() else None
            out.append(both)
        return out

    def _drops(self, now: Array, then: Array) -> Array:
        fit = self.accepted.whole
        return (now - then) / [_size(q, fit.values[q.name]) for q in fit.quantities]


def _deviations(H: Array) -> Array:
    return np.sqrt(np.diag(np.linalg.pinv(H, hermitian=True)))


def _size(q: Quantity, value: float) -> float:
    """Against what a standard deviation of it, scaled, is large or small."""
    if q.known and not q.free:
        return 1.0
    return max(abs(value - (0.0 if q.free else q.neutral)) / q.scale, 1e-3)
