"""What a recording that is not made yet would tell between two explanations.

The accepted explanation says what would be recorded. Its rival is re-fitted to that and to all
recordings there are, which count through their curvature at the rival's fit; what it then is
still off is what tells the two apart. For a choice among many this is linearised. To check the
chosen one, the rival is fitted to the simulated recording step by step.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from rr_opt.diagnose.explanation import Explanation
from rr_opt.diagnose.model import Array, Piece, Quantity
from rr_opt.diagnose.normal import bounded_step
from rr_opt.diagnose.plans import Imagined, Plan, imagined
from rr_opt.diagnose.problem import Problem, box, scaled, unscaled
from rr_opt.diagnose.racer import RollerRacer

RANKED_RATE, _CHECKED_RATE = 25.0, 100.0
"""Samples a second of a made-up recording, to choose and to check."""


@dataclass(frozen=True)
class Rival:
    """What is to be told from the accepted explanation.

    H      curvature of the present cost at its fit, scaled, by the quantities that are fitted
    tells  a sentence on what the recording is good for, if it is not for the two names
    """

    name: str
    effects: tuple[str, ...]
    quantities: tuple[Quantity, ...]
    values: Mapping[str, float]
    H: Array
    tells: str = ""


@dataclass(frozen=True)
class Contest:
    """An accepted explanation against a rival; room (m) is how far a plan may go."""

    model: RollerRacer
    accepted: Explanation
    rival: Rival
    room: float

    def promises(self, plans: Sequence[Plan]) -> list[float]:
        """By how much the two would differ on each plan's recording after re-fitting, RMS in sigma,
        linearised; 0 if the plan leaves the floor there is."""
        made = self._made(plans, RANKED_RATE)
        rival, near = self.rival, made.within(self.room)
        normals = self._problem(made).normals(rival.values, near)
        u = scaled(rival.quantities, rival.values)
        out = []
        for piece in made.starts:
            promise = 0.0
            if piece in near:
                normal, count = normals[piece], made.model.runs[piece.run].values.size
                d = _step(rival, normal.H, normal.g, u, np.zeros_like(u))
                cost = normal.at(d) + float(d @ rival.H @ d)
                promise = math.sqrt(max(cost, 0.0) / count) if math.isfinite(cost) else 0.0
            out.append(promise)
        return out

    def checked(self, plan: Plan, steps: int = 6) -> float:
        """The same from simulations: the rival is fitted to the recording step by step."""
        made = self._made([plan], _CHECKED_RATE)
        problem, rival = self._problem(made), self.rival
        ((piece, start),) = made.starts.items()
        u0 = scaled(rival.quantities, rival.values)
        u, least = u0, math.inf
        for _ in range(steps):
            values = dict(rival.values) | unscaled(rival.quantities, u)
            normal = problem.normal(piece, values, start)
            now = self._total(problem, piece, values, start, u - u0)
            least = min(least, now)
            d = _step(rival, normal.H, normal.g, u, u - u0)
            # A step that is too long is halved until it helps.
            for part in (1.0, 0.5, 0.25, 0.1):
                moved = start + normal.shift + normal.follow @ (part * d)
                trial = dict(rival.values) | unscaled(rival.quantities, u + part * d)
                reached = self._total(problem, piece, trial, moved, u + part * d - u0)
                if reached < now:
                    break
            else:
                break
            u, start, least = u + part * d, moved, reached
            if now - reached < 0.01 * reached + 0.1:
                break
        return math.sqrt(least / made.model.runs[0].values.size)

    def _total(
        self, problem: Problem, piece: Piece, values: Mapping[str, float], start: Array, d: Array
    ) -> float:
        """What the new recording and the present ones cost together, in chi-square."""
        return problem.cost(values, {piece: start})[0] + float(d @ self.rival.H @ d)

    def _made(self, plans: Sequence[Plan], rate: float) -> Imagined:
        fit = self.accepted.whole
        return imagined(self.model, plans, rate, fit.values, fit.effects)

    def _problem(self, made: Imagined) -> Problem:
        rival = self.rival
        return Problem(
            made.model, tuple(made.starts), rival.effects, rival.quantities, dict(rival.values)
        )


def _step(rival: Rival, H: Array, g: Array, u: Array, moved: Array) -> Array:
    """The rival's best step, given what the new recording says; `moved` so far (n,)."""
    low, high = box(rival.quantities)
    return bounded_step(H + rival.H, g + rival.H @ moved, 1e-9, u, low, high)


def as_rival(other: Explanation) -> Rival:
    """Another explanation as the rival."""
    fit = other.whole
    return Rival(name_of(other), fit.effects, fit.quantities, fit.values, fit.total().H)


def name_of(explanation: Explanation) -> str:
    """Its effects, for a person."""
    return " + ".join(explanation.names).replace("_", " ") or "the model as it is"
